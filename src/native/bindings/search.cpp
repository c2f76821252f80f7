// The search for all answers to one question.
#include "../solving/search.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "interface.hpp"
#include "numbers.hpp"
#include "places.hpp"
#include "signals.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

// For each free answer inside the limits: q, the distance from the start, the largest errors, the number of its start, how
// many starts led to it, and the dimension of the set of answers around it. Then how many answers collide and how many are
// outside, the starts, how many of them arrived, the iterations, the redundancy, whether time ran out, and the seconds.
nb::tuple columns(const Findings& findings, std::size_t nq) {
  std::vector<double> q, distance, position, orientation;
  std::vector<std::int64_t> start, hits, dimension;
  std::int64_t colliding = 0, outside = 0;
  for (const Found& answer : findings.answers) {
    if (!answer.inside) ++outside;
    if (!answer.certified) continue;
    if (*answer.collides) {
      ++colliding;
      continue;
    }
    q.insert(q.end(), answer.q.data(), answer.q.data() + answer.q.size());
    distance.push_back(answer.distance);
    position.push_back(answer.error.position);
    orientation.push_back(answer.error.orientation);
    start.push_back(answer.start);
    hits.push_back(answer.hits);
    dimension.push_back(answer.dimension);
  }
  const std::size_t count = start.size();
  return nb::make_tuple(as_array(std::move(q), {count, nq}), as_array(std::move(distance), {count}),
                        as_array(std::move(position), {count}), as_array(std::move(orientation), {count}),
                        as_array(std::move(start), {count}), as_array(std::move(hits), {count}),
                        as_array(std::move(dimension), {count}), colliding, outside, findings.starts, findings.arrived,
                        findings.iterations, findings.redundancy, findings.ended_early, findings.seconds);
}

// The findings, and the start inside the limits.
nb::tuple searched(Searcher& searcher, Vector start, const std::vector<Goal>& goals) {
  Findings findings;
  {
    const nb::gil_scoped_release release;
    findings = searcher.search(start, goals, &no_signal);
  }
  if (PyErr_Occurred()) throw nb::python_error();
  return nb::make_tuple(columns(findings, static_cast<std::size_t>(start.size())), as_array(start));
}

nb::tuple search(Searcher& searcher, Vector start,
                 nb::ndarray<const double, nb::shape<-1, numbers_of_a_goal>, nb::c_contig> goals) {
  const Problem& problem = searcher.problem();
  const auto nq = static_cast<std::size_t>(problem.mechanism->nq);
  if (static_cast<std::size_t>(start.size()) != nq || goals.shape(0) != problem.terms.size())
    throw std::invalid_argument("a start must have " + std::to_string(nq) + " numbers, and there must be " +
                                std::to_string(problem.terms.size()) + " goals; got " + std::to_string(start.size()) +
                                " numbers and " + std::to_string(goals.shape(0)) + " goals");
  return searched(searcher, std::move(start), goals_from(goals.data(), goals.shape(0)));
}

nb::object search_at(Searcher& searcher, Vector start, nb::handle place) {
  const Problem& problem = searcher.problem();
  if (problem.terms.size() != 1 || start.size() != problem.mechanism->nq) return nb::none();
  const std::optional<Goal> goal = goal_at(problem.terms.front(), place, problem.constants.farthest);
  if (!goal) return nb::none();
  return searched(searcher, std::move(start), {*goal}) + nb::make_tuple(nb::make_tuple(as_array(*goal)));
}

}  // namespace

void register_search(nb::module_& m) {
  nb::class_<Searcher>(m, "Searcher")
      .def(nb::init<const Engine&>(), "engine"_a)
      .def("search", &search, "start"_a, "goals"_a,
           nb::sig("def search(self, start: NDArray[numpy.float64], goals: NDArray[numpy.float64]) -> "
                   "tuple[tuple[NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], "
                   "NDArray[numpy.float64], NDArray[numpy.int64], NDArray[numpy.int64], NDArray[numpy.int64], int, int, int, "
                   "int, int, int | None, bool, float], NDArray[numpy.float64]]"))
      .def("search_at", &search_at, "start"_a, "place"_a.none(),
           nb::sig("def search_at(self, start: NDArray[numpy.float64], place: object) -> "
                   "tuple[tuple[NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], "
                   "NDArray[numpy.float64], NDArray[numpy.int64], NDArray[numpy.int64], NDArray[numpy.int64], int, int, int, "
                   "int, int, int | None, bool, float], NDArray[numpy.float64], tuple[NDArray[numpy.float64]]] | None"));
}

}  // namespace pinik
