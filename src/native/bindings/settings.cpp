// Solvers and settings.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "../solving/settings.hpp"
#include "interface.hpp"
#include "shapes.hpp"

namespace pinik {

using namespace nb::literals;

void register_settings(nb::module_& m) {
  nb::enum_<Method>(m, "Method")
      .value("ccd", Method::ccd)
      .value("jt", Method::transpose)
      .value("pinv", Method::pseudo_inverse)
      .value("dls", Method::damped_least_squares);
  nb::enum_<DampingRule>(m, "DampingRule")
      .value("constant", DampingRule::constant)
      .value("residual", DampingRule::residual)
      .value("sugihara", DampingRule::sugihara)
      .value("manipulability", DampingRule::manipulability);
  nb::class_<Solver>(m, "Solver")
      .def(nb::init<>())
      .def_rw("method", &Solver::method)
      .def_rw("rule", &Solver::rule)
      .def_rw("max_step", &Solver::max_step)
      .def_rw("max_residual", &Solver::max_residual)
      .def_rw("step_size", &Solver::step_size)
      .def_rw("target_jacobian", &Solver::target_jacobian)
      .def_rw("alpha", &Solver::alpha)
      .def_rw("cutoff", &Solver::cutoff)
      .def_rw("rest_gain", &Solver::rest_gain)
      .def_rw("rest_posture", &Solver::rest_posture)
      .def_rw("damping", &Solver::damping)
      .def_rw("manipulability", &Solver::manipulability)
      .def_rw("by_svd", &Solver::by_svd)
      .def_rw("stiffness", &Solver::stiffness)
      .def_rw("relaxation", &Solver::relaxation)
      .def_rw("loose_relaxation", &Solver::loose_relaxation)
      .def_rw("position_weight", &Solver::position_weight)
      .def_rw("printed_scaling", &Solver::printed_scaling);
  nb::class_<WayOutSettings>(m, "WayOutSettings")
      .def(nb::init<>())
      .def_rw("ways", &WayOutSettings::ways)
      .def_rw("steps", &WayOutSettings::steps)
      .def_rw("iterations", &WayOutSettings::iterations)
      .def_rw("longest_step", &WayOutSettings::longest_step)
      .def_rw("gap", &WayOutSettings::gap)
      .def_rw("probe", &WayOutSettings::probe)
      .def_rw("same_rank", &WayOutSettings::same_rank)
      .def_rw("stuck", &WayOutSettings::stuck)
      .def_rw("damping", &WayOutSettings::damping);
  nb::class_<Settings>(m, "Settings")
      .def(nb::init<>())
      .def_rw("solver", &Settings::solver)
      .def_rw("patience", &Settings::patience)
      .def_rw("limits", &Settings::limits)
      .def_rw("restarts", &Settings::restarts)
      .def_rw("seed", &Settings::seed)
      .def_rw("max_iterations", &Settings::max_iterations)
      .def_rw("iterations_to_the_end", &Settings::iterations_to_the_end)
      .def_rw("time_limit", &Settings::time_limit)
      .def_rw("trace", &Settings::trace)
      .def_rw("choose_nearest", &Settings::choose_nearest)
      .def_rw("choose_weights", &Settings::choose_weights)
      .def_rw("polish", &Settings::polish)
      .def_rw("way_out", &Settings::way_out)
      .def("avoid", [](Settings& self, const RobotShapes& shapes) { self.avoid = shapes.shapes; }, "shapes"_a);
}

}  // namespace pinik
