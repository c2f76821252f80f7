// What a solve answers, converted to Python when it is read.
#include <cmath>

#include "../solving/outcome.hpp"
#include "answers.hpp"
#include "interface.hpp"
#include "numbers.hpp"

namespace pinik {

namespace {

nb::object as_float(double value) { return std::isnan(value) ? nb::none() : nb::object(nb::float_(value)); }

nb::object offset_of(const TargetError& error) {
  if (std::isnan(error.offset[0])) return nb::none();
  return nb::make_tuple(error.offset[0], error.offset[1], error.offset[2]);
}

nb::tuple as_tuple(const std::vector<TargetError>& errors) {
  nb::list list;
  for (const TargetError& error : errors)
    list.append(nb::make_tuple(as_float(error.position), as_float(error.orientation), offset_of(error)));
  return nb::tuple(list);
}

nb::object proof_of(const Answer& answer) {
  if (!answer.proof) return nb::none();
  return nb::make_tuple(answer.proof->target, answer.proof->distance, answer.proof->bound, answer.proof->inner);
}

nb::object goals_of(const Answer& answer) {
  nb::list rows;
  for (const Goal& goal : answer.goals) rows.append(as_array(goal));
  return rows;
}

}  // namespace

nb::tuple as_tuple(const State& state) {
  return nb::make_tuple(as_array(state.q), state.iteration, state.joint_updates, as_tuple(state.errors), state.residual,
                        state.attempt, state.status);
}

namespace {

nb::tuple states_of(const Answer& answer) {
  nb::list states;
  for (const State& state : answer.states) states.append(as_tuple(state));
  return nb::tuple(states);
}

}  // namespace

void register_answers(nb::module_& m) {
  nb::enum_<Status>(m, "Status")
      .value("CONVERGED", Status::converged)
      .value("STALLED", Status::stalled)
      .value("MAX_ITERATIONS", Status::max_iterations)
      .value("TIME_LIMIT", Status::time_limit)
      .value("UNREACHABLE", Status::unreachable)
      .value("COLLIDING", Status::colliding)
      .value("RUNNING", Status::running);
  nb::class_<Answer>(m, "Answer")
      .def_ro("status", &Answer::status)
      .def_prop_ro("q", [](const Answer& a) { return as_array(a.q); },
                   nb::sig("def q(self) -> NDArray[numpy.float64]"))
      .def_prop_ro("start", [](const Answer& a) { return as_array(a.start); },
                   nb::sig("def start(self) -> NDArray[numpy.float64]"))
      .def_prop_ro("errors", [](const Answer& a) { return as_tuple(a.errors); },
                   nb::sig("def errors(self) -> tuple[tuple[float | None, float | None, "
                           "tuple[float, float, float] | None], ...]"))
      .def_ro("iterations", &Answer::iterations)
      .def_ro("joint_updates", &Answer::joint_updates)
      .def_ro("restarts", &Answer::restarts)
      .def_ro("chosen_from", &Answer::chosen_from)
      .def_ro("seconds", &Answer::seconds)
      .def_prop_ro("goals", &goals_of, nb::sig("def goals(self) -> list[NDArray[numpy.float64]]"))
      .def_prop_ro("proof", &proof_of, nb::sig("def proof(self) -> tuple[int, float, float, bool] | None"))
      .def_prop_ro("states", &states_of,
                   nb::sig("def states(self) -> tuple[tuple[NDArray[numpy.float64], int, int, "
                           "tuple[tuple[float | None, float | None, tuple[float, float, float] | None], ...], "
                           "float, int, Status], ...]"));
}

}  // namespace pinik
