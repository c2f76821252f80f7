// Collisions of a robot's shapes with each other and with the world around it.
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <mutex>
#include <tuple>

#include "interface.hpp"
#include "numbers.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

using Triple = std::tuple<double, double, double>;
using TouchNumbers = std::tuple<int, double, Triple, Triple, Triple, std::pair<int, int>>;

Triple triple(const Vec3& v) { return {v[0], v[1], v[2]}; }

const double* configuration(const RobotShapes& self, nb::handle q) {
  const double* numbers = numbers_of(q, {self.entries()});
  if (!numbers) throw std::invalid_argument("q must be a contiguous float64 array (nq,)");
  return numbers;
}

const double* configurations(const RobotShapes& self, nb::handle q, std::size_t& count) {
  const double* numbers = blocks_of(q, {self.entries()}, count);
  if (!numbers) throw std::invalid_argument("q must be a contiguous float64 array (n, nq)");
  return numbers;
}

int group_of(const RobotShapes& self, int pair) { return self.shapes->pairs()[static_cast<std::size_t>(pair)].group; }

std::pair<int, int> joints_of(const RobotShapes& self, int pair) {
  const Shapes::Pair& own = self.shapes->pairs()[static_cast<std::size_t>(pair)];
  const std::vector<Shapes::Shape>& shapes = self.shapes->shapes();
  return {shapes[static_cast<std::size_t>(own.first)].joint, shapes[static_cast<std::size_t>(own.second)].joint};
}

std::vector<TouchNumbers> report(const RobotShapes& self, nb::handle q) {
  std::vector<TouchNumbers> found;
  for (const Touch& touch : Collisions(self.shapes).report(configuration(self, q)))
    found.emplace_back(group_of(self, touch.pair), touch.depth, triple(touch.normal), triple(touch.points[0]),
                       triple(touch.points[1]), joints_of(self, touch.pair));
  return found;
}

std::tuple<int, double, Triple, Triple> clearance(const RobotShapes& self, nb::handle q) {
  const Clearance least = Collisions(self.shapes).clearance(configuration(self, q));
  return {least.pair < 0 ? -1 : group_of(self, least.pair), least.distance, triple(least.points[0]), triple(least.points[1])};
}

nb::object touches(const RobotShapes& self, nb::handle q, int threads) {
  std::size_t count = 0;
  const double* rows = configurations(self, q, count);
  const std::size_t entries = static_cast<std::size_t>(self.entries());
  std::vector<std::uint8_t> touching(count);
  share_rows(count, threads, [&] {
    return [&, collisions = Collisions(self.shapes)](std::size_t first, std::size_t size) mutable {
      for (std::size_t k = first; k < first + size; ++k) touching[k] = collisions.touches(rows + entries * k);
      return true;
    };
  });
  return as_array(std::move(touching), {count});
}

// In how many of the configurations each group of pairs touches.
nb::object counts(const RobotShapes& self, nb::handle q, int threads) {
  std::size_t count = 0;
  const double* rows = configurations(self, q, count);
  const std::size_t entries = static_cast<std::size_t>(self.entries());
  const std::vector<Shapes::Pair>& pairs = self.shapes->pairs();
  std::vector<std::int64_t> sums(self.shapes->groups());
  std::mutex lock;
  share_rows(count, threads, [&] {
    std::vector<std::size_t> last(sums.size(), count);  // the last configuration in which each group touched
    return [&, last, collisions = Collisions(self.shapes)](std::size_t first, std::size_t size) mutable {
      std::vector<std::int64_t> own(sums.size());
      for (std::size_t k = first; k < first + size; ++k) {
        collisions.place(rows + entries * k);
        for (const Shapes::Pair& pair : pairs) {
          const std::size_t group = static_cast<std::size_t>(pair.group);
          if (last[group] == k || !collisions.touches(pair)) continue;
          last[group] = k;
          ++own[group];
        }
      }
      const std::lock_guard<std::mutex> hold(lock);
      for (std::size_t group = 0; group < sums.size(); ++group) sums[group] += own[group];
      return true;
    };
  });
  const std::size_t size = sums.size();
  return as_array(std::move(sums), {size});
}

}  // namespace

void register_collisions(nb::module_& m) {
  nb::enum_<SolidKind>(m, "SolidKind")
      .value("box", SolidKind::box)
      .value("sphere", SolidKind::sphere)
      .value("cylinder", SolidKind::cylinder)
      .value("capsule", SolidKind::capsule);
  nb::class_<Geometry>(m, "Geometry")
      .def(nb::init<SolidKind, const std::vector<double>&>(), "kind"_a, "sizes"_a)
      .def_static(
          "mesh",
          [](nb::handle vertices, const std::vector<std::array<int, 3>>& triangles) {
            std::size_t count = 0;
            const double* numbers = blocks_of(vertices, {3}, count);
            if (!numbers) throw std::invalid_argument("vertices must be a contiguous float64 array (n, 3)");
            std::vector<Vec3> points(count);
            for (std::size_t k = 0; k < count; ++k) points[k] = Eigen::Map<const Vec3>(numbers + 3 * k);
            return std::make_shared<Geometry>(points, triangles);
          },
          "vertices"_a, "triangles"_a);
  nb::class_<RobotShapes>(m, "Shapes")
      .def(nb::init<std::shared_ptr<const Robot>>(), "robot"_a)
      .def("add_shape",
           [](RobotShapes& self, std::shared_ptr<const Geometry> geometry, int joint, const Mat3& R, const Vec3& p) {
             return self.shapes->add_shape(std::move(geometry), joint, {R, p});
           },
           "geometry"_a, "joint"_a, "rotation"_a, "translation"_a)
      .def("add_pair", [](RobotShapes& self, int first, int second, int group) { self.shapes->add_pair(first, second, group); },
           "first"_a, "second"_a, "group"_a)
      .def("report", &report, "q"_a)
      .def("clearance", &clearance, "q"_a)
      .def("touches", &touches, "q"_a, "threads"_a,
           nb::sig("def touches(self, q: object, threads: int) -> NDArray[numpy.uint8]"))
      .def("counts", &counts, "q"_a, "threads"_a,
           nb::sig("def counts(self, q: object, threads: int) -> NDArray[numpy.int64]"));
}

}  // namespace pinik
