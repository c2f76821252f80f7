// A run whose targets move, for the live view.
#include "../solving/pursuit.hpp"

#include <nanobind/eigen/dense.h>

#include <stdexcept>
#include <string>

#include "answers.hpp"
#include "interface.hpp"
#include "numbers.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig>;
using Goals = nb::ndarray<const double, nb::shape<-1, numbers_of_a_goal>, nb::c_contig>;

std::vector<Goal> checked(const Problem& problem, const Goals& goals) {
  if (goals.shape(0) != problem.terms.size())
    throw std::invalid_argument("there must be " + std::to_string(problem.terms.size()) + " goals; got " +
                                std::to_string(goals.shape(0)));
  return goals_from(goals.data(), goals.shape(0));
}

void begin(Pursuit* self, const Engine& engine, const Numbers& start, const Goals& goals, std::int64_t max_iterations,
           const Patience& patience) {
  const auto nq = static_cast<std::size_t>(engine.mechanism().nq);
  if (start.shape(0) != nq)
    throw std::invalid_argument("a start must have " + std::to_string(nq) + " numbers; got " +
                                std::to_string(start.shape(0)));
  const Vector q = Eigen::Map<const Vector>(start.data(), static_cast<Eigen::Index>(nq));
  new (self) Pursuit(engine, q, checked(engine.problem(), goals), max_iterations, patience);
}

}  // namespace

void register_pursuit(nb::module_& m) {
  nb::class_<Pursuit>(m, "Pursuit")
      .def("__init__", &begin, "engine"_a, "start"_a, "goals"_a, "max_iterations"_a, "patience"_a)
      .def("state", [](Pursuit& self) { return as_tuple(self.state()); }, 
           nb::sig("def state(self) -> tuple[NDArray[numpy.float64], int, int, tuple[tuple[float | None, "
                   "float | None, tuple[float, float, float] | None], ...], float, int, Status]"))
      .def("advance", &Pursuit::advance, "most"_a)
      .def("aim_at", [](Pursuit& self, const Goals& goals) { self.aim_at(checked(self.problem(), goals)); }, "goals"_a);
}

}  // namespace pinik
