// Placements and Jacobians of a frame at many configurations, computed in threads.
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/shared_ptr.h>

#include <memory>
#include <utility>

#include "../model/frame_walk.hpp"
#include "../solving/robot.hpp"
#include "interface.hpp"
#include "numbers.hpp"
#include "rows.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

// A walk with the robot that it belongs to.
struct RobotFrameWalk {
  std::shared_ptr<const Robot> robot;
  FrameWalk walk;

  RobotFrameWalk(std::shared_ptr<const Robot> robot, const FrameWalk::Place& frame, const FrameWalk::Place& reference,
                 const UnitLength& unit)
      : robot(std::move(robot)), walk(this->robot->mechanism, frame, reference, unit) {}
};

nb::object placements(const RobotFrameWalk& self, nb::handle q, int threads) {
  std::size_t count = 0;
  const double* rows = blocks_of(q, {self.walk.entries()}, count);
  if (!rows) return nb::none();
  const auto [array, out] = new_array({count, 4, 4});
  const std::size_t entries = static_cast<std::size_t>(self.walk.entries());
  const bool all = share_rows(count, threads, [&, out = out] {
    return [&, out, walk = self.walk](std::size_t first, std::size_t size) mutable {
      return write_placements(walk, rows + entries * first, size, out + 16 * first) == size;
    };
  });
  return all ? array : nb::none();
}

nb::object jacobians(const RobotFrameWalk& self, nb::handle q, ReferenceFrame axes, int threads) {
  std::size_t count = 0;
  const double* rows = blocks_of(q, {self.walk.entries()}, count);
  if (!rows) return nb::none();
  const std::size_t entries = static_cast<std::size_t>(self.walk.entries());
  const std::size_t columns = static_cast<std::size_t>(self.walk.columns());
  const auto [array, out] = new_array({count, 6, columns});
  const bool all = share_rows(count, threads, [&, out = out] {
    return [&, out, walk = self.walk](std::size_t first, std::size_t size) mutable {
      return write_jacobians(walk, axes, rows + entries * first, size, out + 6 * columns * first) == size;
    };
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
              double unit_rounding, double largest_unit_error) {
             const FrameWalk::Place frame{frame_joint, robot->in_joint(frame_joint, frame_R, frame_p)};
             const FrameWalk::Place reference{reference_joint, robot->in_joint(reference_joint, reference_R, reference_p)};
             new (self) RobotFrameWalk(std::move(robot), frame, reference, {unit_rounding, largest_unit_error});
           },
           "robot"_a, "frame_joint"_a, "frame_rotation"_a, "frame_translation"_a, "reference_joint"_a,
           "reference_rotation"_a, "reference_translation"_a, "unit_rounding"_a, "largest_unit_error"_a)
      .def("placements", &placements, "q"_a.none(), "threads"_a,
           nb::sig("def placements(self, q: object, threads: int) -> NDArray[numpy.float64] | None"))
      .def("jacobians", &jacobians, "q"_a.none(), "axes"_a, "threads"_a,
           nb::sig("def jacobians(self, q: object, axes: ReferenceFrame, threads: int) -> NDArray[numpy.float64] | None"));
}

}  // namespace pinik
