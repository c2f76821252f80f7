// The search for all answers to one question.
#include "../solving/search.hpp"

#include <nanobind/eigen/dense.h>

#include <stdexcept>
#include <string>

#include "interface.hpp"
#include "numbers.hpp"
#include "signals.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

// For each free answer inside the limits: q, the largest errors, the number of its start, and how many starts led to it.
// Then how many answers collide and how many are outside, the starts, the iterations, the redundancy, whether time ran out, and the seconds.
nb::tuple columns(Findings&& findings, std::size_t nq) {
  std::vector<double> q, position, orientation;
  std::vector<std::int64_t> start, hits;
  std::int64_t colliding = 0, outside = 0;
  for (const Found& answer : findings.answers) {
    if (!answer.inside) ++outside;
    if (answer.collides) ++colliding;
    if (!answer.certified || answer.collides) continue;
    q.insert(q.end(), answer.q.data(), answer.q.data() + answer.q.size());
    position.push_back(answer.error.position);
    orientation.push_back(answer.error.orientation);
    start.push_back(answer.start);
    hits.push_back(answer.hits);
  }
  const std::size_t count = start.size();
  return nb::make_tuple(as_array(std::move(q), {count, nq}), as_array(std::move(position), {count}),
                        as_array(std::move(orientation), {count}), as_array(std::move(start), {count}),
                        as_array(std::move(hits), {count}), colliding, outside, findings.starts, findings.iterations,
                        findings.redundancy, findings.ended_early, findings.seconds);
}

nb::tuple search(Searcher& searcher, Vector start,
                 nb::ndarray<const double, nb::shape<-1, numbers_of_a_goal>, nb::c_contig> goals) {
  const Problem& problem = searcher.problem();
  const auto nq = static_cast<std::size_t>(problem.mechanism->nq);
  if (static_cast<std::size_t>(start.size()) != nq || goals.shape(0) != problem.terms.size())
    throw std::invalid_argument("a start must have " + std::to_string(nq) + " numbers, and there must be " +
                                std::to_string(problem.terms.size()) + " goals; got " + std::to_string(start.size()) +
                                " numbers and " + std::to_string(goals.shape(0)) + " goals");
  Findings findings;
  {
    const nb::gil_scoped_release release;
    findings = searcher.search(std::move(start), goals_from(goals.data(), goals.shape(0)), &no_signal);
  }
  if (PyErr_Occurred()) throw nb::python_error();
  return columns(std::move(findings), nq);
}

}  // namespace

void register_search(nb::module_& m) {
  nb::class_<Searcher>(m, "Searcher")
      .def(nb::init<const Engine&>(), "engine"_a)
      .def("search", &search, "start"_a, "goals"_a,
           nb::sig("def search(self, start: NDArray[numpy.float64], goals: NDArray[numpy.float64]) -> "
                   "tuple[NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], "
                   "NDArray[numpy.int64], NDArray[numpy.int64], int, int, int, int, int, bool, float]"));
}

}  // namespace pinik
