// Paths: a whole one in one call, or one tick of a moving target.
#include "../solving/track.hpp"

#include <nanobind/eigen/dense.h>

#include <stdexcept>
#include <string>

#include "columns.hpp"
#include "interface.hpp"
#include "numbers.hpp"
#include "places.hpp"
#include "signals.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig>;
using Goals = nb::ndarray<const double, nb::ndim<3>, nb::c_contig>;

void check(bool fits, const Track& track) {
  if (fits) return;
  throw std::invalid_argument("a start must have " + std::to_string(track.problem().mechanism->nq) +
                              " numbers, and each point must have " + std::to_string(track.problem().terms.size()) +
                              " goals of " + std::to_string(numbers_of_a_goal) + " numbers");
}

nb::tuple follow(Track& track, const Numbers& start, const Goals& goals, OnMiss on_miss) {
  const std::size_t count = goals.shape(0), terms = goals.shape(1), nq = start.shape(0);
  check(nq == static_cast<std::size_t>(track.problem().mechanism->nq) && terms == track.problem().terms.size() &&
            goals.shape(2) == numbers_of_a_goal,
        track);
  Columns columns(count, nq);
  std::uint64_t answered = 0;
  {
    const nb::gil_scoped_release release;
    const auto take = [&](std::uint64_t i, std::vector<Goal>& wanted) {
      for (std::size_t t = 0; t < terms; ++t) wanted[t] = goal_from(goals.data() + numbers_of_a_goal * (i * terms + t));
    };
    const auto put = [&](std::uint64_t i, const Answer& answer) { columns.put(i, answer); };
    const Vector q = Eigen::Map<const Vector>(start.data(), static_cast<Eigen::Index>(nq));
    answered = track.follow(q, count, on_miss, &no_signal, take, put);
  }
  if (PyErr_Occurred()) throw nb::python_error();
  columns.shorten(answered, nq);
  return std::move(columns).arrays(answered, nq);
}

// What a tick came to: q, whether the targets are reached, whether further ticks will bring them nearer, where something touches
// that kept it from going on, and the largest errors.
nb::tuple ticked(Track& track, const Numbers& start, const Numbers& most, const std::vector<Goal>& goals) {
  const Problem& problem = track.problem();
  Eigen::Index nv = 0;
  for (const Joint& joint : problem.mechanism->joints) nv += joint.follows ? 0 : joint.nv;
  check(start.shape(0) == static_cast<std::size_t>(problem.mechanism->nq) && goals.size() == problem.terms.size(), track);
  if (most.shape(0) != static_cast<std::size_t>(nv))
    throw std::invalid_argument("there must be " + std::to_string(nv) + " largest changes; got " +
                                std::to_string(most.shape(0)));
  const auto [answer, approaches, touching] =
      track.tick(Eigen::Map<const Vector>(start.data(), problem.mechanism->nq),
                 Eigen::Map<const Vector>(most.data(), nv), goals);
  const TargetError largest = largest_of(answer.errors);
  return nb::make_tuple(as_array(answer.q), answer.status == Status::converged, approaches,
                        touching ? as_array(*touching) : nb::none(), largest.position, largest.orientation);
}

nb::tuple tick(Track& track, const Numbers& start, const Numbers& most,
               nb::ndarray<const double, nb::shape<-1, numbers_of_a_goal>, nb::c_contig> goals) {
  return ticked(track, start, most, goals_from(goals.data(), goals.shape(0)));
}

nb::object tick_at(Track& track, const Numbers& start, const Numbers& most, nb::handle place) {
  const Problem& problem = track.problem();
  if (problem.terms.size() != 1) return nb::none();
  const std::optional<Goal> goal = goal_at(problem.terms.front(), place, problem.constants.farthest);
  if (!goal) return nb::none();
  return ticked(track, start, most, {*goal});
}

}  // namespace

void register_track(nb::module_& m) {
  nb::enum_<OnMiss>(m, "OnMiss")
      .value("hold", OnMiss::hold)
      .value("nearest", OnMiss::nearest)
      .value("stop", OnMiss::stop);
  nb::class_<Track>(m, "Track")
      .def(nb::init<const Engine&>(), "engine"_a)
      .def("follow", &follow, "start"_a, "goals"_a, "on_miss"_a,
           nb::sig("def follow(self, start: NDArray[numpy.float64], goals: NDArray[numpy.float64], on_miss: OnMiss) -> "
                   "tuple[NDArray[numpy.float64], NDArray[numpy.int32], NDArray[numpy.float64], "
                   "NDArray[numpy.float64], NDArray[numpy.int64], NDArray[numpy.int64], NDArray[numpy.int64], "
                   "NDArray[numpy.int64], NDArray[numpy.float64]]"))
      .def("tick", &tick, "start"_a, "most"_a, "goals"_a,
           nb::sig("def tick(self, start: NDArray[numpy.float64], most: NDArray[numpy.float64], "
                   "goals: NDArray[numpy.float64]) -> "
                   "tuple[NDArray[numpy.float64], bool, bool, NDArray[numpy.float64] | None, float, float]"))
      .def("tick_at", &tick_at, "start"_a, "most"_a, "place"_a.none(),
           nb::sig("def tick_at(self, start: NDArray[numpy.float64], most: NDArray[numpy.float64], place: object) -> "
                   "tuple[NDArray[numpy.float64], bool, bool, NDArray[numpy.float64] | None, float, float] | None"));
}

}  // namespace pinik
