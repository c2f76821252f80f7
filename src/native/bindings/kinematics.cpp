// Placements and Jacobians of a frame at many configurations, computed in threads.
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/shared_ptr.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "../model/frame_walk.hpp"
#include "../solving/pool.hpp"
#include "../solving/robot.hpp"
#include "interface.hpp"
#include "numbers.hpp"
#include "signals.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

constexpr std::uint64_t rows_at_once = 256;

// A walk with the robot that it belongs to.
struct RobotFrameWalk {
  std::shared_ptr<const Robot> robot;
  FrameWalk walk;

  RobotFrameWalk(std::shared_ptr<const Robot> robot, const FrameWalk::Place& frame, const FrameWalk::Place& reference, double unit_error)
      : robot(std::move(robot)), walk(this->robot->mechanism, frame, reference, unit_error) {}
};

// Share `count` rows among threads. `write(walk, first, size)` computes some of them and returns how many came before the
// first faulty one. Returns whether no row was faulty.
template <class Write>
bool write_all(const FrameWalk& walk, std::uint64_t count, int threads, const Write& write) {
  const nb::gil_scoped_release release;
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> stop{false}, faulty{false};
  bool interrupted = false;
  const auto make = [&] {
    return [&, own = walk]() mutable {
      for (std::uint64_t first = next.fetch_add(rows_at_once); first < count && !stop;
           first = next.fetch_add(rows_at_once)) {
        const std::uint64_t size = std::min(rows_at_once, count - first);
        if (write(own, first, size) < size) faulty = stop = true;
      }
    };
  };
  const auto pause = [&] {
    interrupted = interrupted || !no_signal();
    return !interrupted;
  };
  const std::uint64_t blocks = (count + rows_at_once - 1) / rows_at_once;
  if (blocks <= 1)
    make()();  // a thread would take longer than the rows
  else
    share(std::min<std::uint64_t>(static_cast<std::uint64_t>(threads), blocks), stop, make, pause);
  if (interrupted) {
    const nb::gil_scoped_acquire acquire;
    throw nb::python_error();
  }
  return !faulty;
}

nb::object placements(const RobotFrameWalk& self, nb::handle q, int threads) {
  std::size_t count = 0;
  const double* rows = rows_of(q, self.walk.entries(), count);
  if (!rows) return nb::none();
  const auto [array, out] = new_array({count, 4, 4});
  const std::size_t entries = static_cast<std::size_t>(self.walk.entries());
  const bool all = write_all(self.walk, count, threads, [&, out = out](FrameWalk& walk, std::size_t first, std::size_t size) {
    return write_placements(walk, rows + entries * first, size, out + 16 * first);
  });
  return all ? array : nb::none();
}

nb::object jacobians(const RobotFrameWalk& self, nb::handle q, ReferenceFrame axes, int threads) {
  std::size_t count = 0;
  const double* rows = rows_of(q, self.walk.entries(), count);
  if (!rows) return nb::none();
  const std::size_t entries = static_cast<std::size_t>(self.walk.entries());
  const std::size_t columns = static_cast<std::size_t>(self.walk.columns());
  const auto [array, out] = new_array({count, 6, columns});
  const bool all = write_all(self.walk, count, threads, [&, out = out](FrameWalk& walk, std::size_t first, std::size_t size) {
    return write_jacobians(walk, axes, rows + entries * first, size, out + 6 * columns * first);
  });
  return all ? array : nb::none();
}

}  // namespace

void register_kinematics(nb::module_& m) {
  nb::enum_<ReferenceFrame>(m, "ReferenceFrame")
      .value("WORLD", ReferenceFrame::world)
      .value("LOCAL", ReferenceFrame::local)
      .value("LOCAL_WORLD_ALIGNED", ReferenceFrame::local_world_aligned);
  nb::class_<RobotFrameWalk>(m, "FrameWalk")
      .def("__init__",
           [](RobotFrameWalk* self, std::shared_ptr<const Robot> robot, int frame_joint, const Mat3& frame_R,
              const Vec3& frame_p, int reference_joint, const Mat3& reference_R, const Vec3& reference_p,
              double largest_unit_error) {
             const FrameWalk::Place frame{frame_joint, robot->in_joint(frame_joint, frame_R, frame_p)};
             const FrameWalk::Place reference{reference_joint, robot->in_joint(reference_joint, reference_R, reference_p)};
             new (self) RobotFrameWalk(std::move(robot), frame, reference, largest_unit_error);
           },
           "robot"_a, "frame_joint"_a, "frame_rotation"_a, "frame_translation"_a, "reference_joint"_a,
           "reference_rotation"_a, "reference_translation"_a, "largest_unit_error"_a)
      .def("placements", &placements, "q"_a.none(), "threads"_a,
           nb::sig("def placements(self, q: object, threads: int) -> NDArray[numpy.float64] | None"))
      .def("jacobians", &jacobians, "q"_a.none(), "axes"_a, "threads"_a,
           nb::sig("def jacobians(self, q: object, axes: ReferenceFrame, threads: int) -> NDArray[numpy.float64] | None"));
}

}  // namespace pinik
