// Robots and problems, described joint by joint and target by target.
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "../problem/problem.hpp"
#include "../solving/robot.hpp"
#include "interface.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

void add_joint(Robot& robot, JointKind kind, int parent, const Mat3& R, const Vec3& p, const Vec3& axis, int idx_q,
               int nq, int idx_v, int nv, bool follows, double multiplier, double offset, double lower, double upper,
               bool turns) {
  Mechanism& mechanism = robot.mechanism;
  Joint joint;
  joint.kind = kind;
  joint.parent = parent;
  if (joint.has_one_axis()) joint.to_line = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
  joint.unturned = {R, p};
  joint.line = axis;
  const Mat3 from_parent = robot.joint(parent).to_line.transpose();
  joint.placement = Placement{from_parent * R * joint.to_line, from_parent * p};
  joint.idx_q = idx_q;
  joint.nq = nq;
  joint.idx_v = idx_v;
  joint.nv = nv;
  joint.follows = follows;
  joint.multiplier = multiplier;
  joint.offset = offset;
  joint.lower = lower;
  joint.upper = upper;
  joint.turns = turns;
  mechanism.nq += nq;
  mechanism.joints.push_back(joint);
}

void add_term(Problem& problem, const Robot& robot, int frame_joint, const Mat3& frame_R, const Vec3& frame_p,
              bool has_tool, const Mat3& tool_R, const Vec3& tool_p, bool has_reference, int reference_joint, const Mat3& reference_R, const Vec3& reference_p,
              bool asks_position, bool asks_rotation, bool asks_axis, bool asks_at, const Vec3& along,
              const Tolerance& tolerance, const Vec3& axis, double weight,
              bool has_bounds, const Vec3& base, std::array<double, 2> reach, std::array<double, 2> hole) {
  Term term;
  term.frame_joint = frame_joint;
  term.unturned_frame = {frame_R, frame_p};
  term.has_tool = has_tool;
  term.tool = {tool_R, tool_p};
  term.unturned_reference = {reference_R, reference_p};
  term.frame = robot.in_joint(frame_joint, frame_R, frame_p) * term.tool;
  term.has_reference = has_reference;
  term.reference_joint = reference_joint;
  term.reference = robot.in_joint(reference_joint, reference_R, reference_p);
  term.asks_position = asks_position;
  term.asks_rotation = asks_rotation;
  term.asks_axis = asks_axis;
  term.asks_at = asks_at;
  term.has_free_axes = asks_position && along != Vec3::Ones();
  if (asks_position) term.along = along;
  term.tolerance = tolerance;
  term.axis = axis;
  term.weight = weight;
  term.has_bounds = has_bounds;
  term.base = base;
  for (std::size_t k = 0; k < 2; ++k) {
    term.reach[k] = reach[k];
    term.hole[k] = hole[k];
  }
  problem.terms.push_back(term);
}

using Movers = std::vector<std::pair<int, double>>;

void add_coordinate(Problem& problem, int joint, int index, int entry, const Movers& movers, const Movers& moved) {
  Coordinate coordinate;
  coordinate.joint = joint;
  coordinate.index = index;
  coordinate.entry = entry;
  for (const auto& [mover, multiplier] : movers) coordinate.movers.push_back({mover, multiplier});
  for (const auto& [mover, multiplier] : moved) coordinate.moved.push_back({mover, multiplier});
  problem.coordinates.push_back(coordinate);
}

void register_constants(nb::module_& m) {
  nb::class_<Constants>(m, "Constants")
      .def(nb::init<>())
      .def_rw("farthest", &Constants::farthest)
      .def_rw("widest_range", &Constants::widest_range)
      .def_rw("largest_unit_error", &Constants::largest_unit_error)
      .def_rw("unit_rounding", &Constants::unit_rounding)
      .def_rw("barely_outside", &Constants::barely_outside)
      .def_rw("radian", &Constants::radian)
      .def_rw("no_direction", &Constants::no_direction)
      .def_rw("reach_rounding", &Constants::reach_rounding)
      .def_rw("slack_share", &Constants::slack_share)
      .def_rw("wide_angle", &Constants::wide_angle)
      .def_rw("smallest_damping_squared", &Constants::smallest_damping_squared)
      .def_rw("smallest_cutoff", &Constants::smallest_cutoff)
      .def_rw("ccd_rounding", &Constants::ccd_rounding)
      .def_rw("ccd_suspect", &Constants::ccd_suspect)
      .def_rw("ccd_no_column", &Constants::ccd_no_column)
      .def_rw("ccd_halvings", &Constants::ccd_halvings)
      .def_rw("ccd_wide_position", &Constants::ccd_wide_position)
      .def_rw("bold_part_of_distance", &Constants::bold_part_of_distance)
      .def_rw("part_of_chain", &Constants::part_of_chain)
      .def_rw("polishing_gain", &Constants::polishing_gain)
      .def_rw("exact_part_of_chain", &Constants::exact_part_of_chain)
      .def_rw("to_the_end", &Constants::to_the_end)
      .def_rw("restarts_when_unreachable", &Constants::restarts_when_unreachable)
      .def_rw("exact_attempts", &Constants::exact_attempts)
      .def_rw("same_answer", &Constants::same_answer)
      .def_rw("colliding_least", &Constants::colliding_least)
      .def_rw("colliding_since", &Constants::colliding_since)
      .def_rw("nothing_new_share", &Constants::nothing_new_share)
      .def_rw("table_size", &Constants::table_size)
      .def_rw("table_nearest", &Constants::table_nearest)
      .def_rw("table_key", &Constants::table_key)
      .def_rw("spread_size", &Constants::spread_size)
      .def_rw("spread_nearest", &Constants::spread_nearest)
      .def_rw("exact_answer", &Constants::exact_answer)
      .def_rw("search_patience", &Constants::search_patience)
      .def_rw("search_least", &Constants::search_least)
      .def_rw("search_since", &Constants::search_since)
      .def_rw("search_samples", &Constants::search_samples)
      .def_rw("search_ranks", &Constants::search_ranks)
      .def_rw("search_rank_threshold", &Constants::search_rank_threshold)
      .def_rw("search_approach", &Constants::search_approach)
      .def_rw("search_basin", &Constants::search_basin)
      .def_rw("search_outside", &Constants::search_outside)
      .def_rw("search_spacing", &Constants::search_spacing)
      .def_rw("search_nearly_singular", &Constants::search_nearly_singular)
      .def_rw("search_alike", &Constants::search_alike)
      .def_rw("continuum_singular", &Constants::continuum_singular)
      .def_rw("continuum_aside", &Constants::continuum_aside)
      .def_rw("continuum_iterations", &Constants::continuum_iterations)
      .def_rw("continuum_parts", &Constants::continuum_parts)
      .def_rw("continuum_few_parts", &Constants::continuum_few_parts)
      .def_rw("jump_floor", &Constants::jump_floor)
      .def_rw("jump_factor", &Constants::jump_factor)
      .def_rw("jump_damping", &Constants::jump_damping)
      .def_rw("opposite", &Constants::opposite)
      .def_rw("creep_halvings", &Constants::creep_halvings)
      .def_rw("tick_iterations", &Constants::tick_iterations);
}

}  // namespace

void register_descriptions(nb::module_& m) {
  nb::enum_<JointKind>(m, "JointKind")
      .value("revolute", JointKind::revolute)
      .value("continuous", JointKind::continuous)
      .value("prismatic", JointKind::prismatic)
      .value("floating", JointKind::floating)
      .value("planar", JointKind::planar);
  nb::class_<Patience>(m, "Patience")
      .def(nb::init<std::int64_t, double>(), "iterations"_a, "progress"_a);
  register_constants(m);
  nb::class_<Tolerance>(m, "Tolerance")
      .def("__init__",
           [](Tolerance* self, double position, double orientation, bool is_box, const Vec3& box) {
             new (self) Tolerance{position, orientation, is_box, box};
           },
           "position"_a, "orientation"_a, "is_box"_a, "box"_a);
  nb::class_<Robot>(m, "Robot")
      .def(nb::init<>())
      .def("add_joint", &add_joint, "kind"_a, "parent"_a, "rotation"_a, "translation"_a, "axis"_a, "idx_q"_a, "nq"_a,
           "idx_v"_a, "nv"_a, "follows"_a, "multiplier"_a, "offset"_a, "lower"_a, "upper"_a, "turns"_a)
      .def("finish", &Robot::finish);
  nb::class_<Problem>(m, "Problem")
      .def("__init__",
           [](Problem* self, const Robot& robot, const Constants& constants) {
             new (self) Problem();
             self->mechanism = &robot.mechanism;
             self->constants = constants;
           },
           nb::keep_alive<1, 2>(), "robot"_a, "constants"_a)
      .def("add_term", &add_term, "robot"_a, "frame_joint"_a, "frame_rotation"_a, "frame_translation"_a,
           "has_tool"_a, "tool_rotation"_a, "tool_translation"_a, "has_reference"_a, "reference_joint"_a, "reference_rotation"_a, "reference_translation"_a,
           "asks_position"_a, "asks_rotation"_a, "asks_axis"_a, "asks_at"_a, "along"_a, "tolerance"_a, "axis"_a, "weight"_a, "has_bounds"_a,
           "base"_a, "reach"_a, "hole"_a)
      .def("add_coordinate", &add_coordinate, "joint"_a, "index"_a, "entry"_a, "movers"_a, "moved"_a)
      .def("finish",
           [](Problem& self, double lightest, double size_of_chain, bool is_wide) {
             self.lightest = lightest;
             self.is_wide = is_wide;
             self.size_of_chain = size_of_chain;
             self.finish();
           },
           "lightest"_a, "size_of_chain"_a, "is_wide"_a);
}

}  // namespace pinik
