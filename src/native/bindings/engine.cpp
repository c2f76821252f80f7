// The engine: solves one problem after another, or many at once.
#include "../solving/engine.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "columns.hpp"
#include "call.hpp"
#include "interface.hpp"
#include "numbers.hpp"
#include "places.hpp"
#include "signals.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

std::string expected(const Engine& engine) {
  return "a start must have " + std::to_string(engine.mechanism().nq) + " numbers, and there must be " +
         std::to_string(engine.problem().terms.size()) + " goals of " + std::to_string(numbers_of_a_goal) + " numbers";
}

Answer solve(Engine& engine, Vector start, std::vector<Goal> goals, bool nearest, double spent = 0.0) {
  if (start.size() != engine.mechanism().nq || goals.size() != engine.problem().terms.size())
    throw std::invalid_argument(expected(engine) + "; got " + std::to_string(start.size()) + " numbers and " +
                                std::to_string(goals.size()) + " goals");
  Answer answer;
  {
    const nb::gil_scoped_release release;
    answer = engine.solve(std::move(start), std::move(goals), nearest, &no_signal, spent);
  }
  if (PyErr_Occurred()) throw nb::python_error();
  return answer;
}

}  // namespace

std::optional<Answer> solve_at(Engine& engine, nb::handle place, nb::handle start, bool nearest) {
  const int nq = engine.mechanism().nq;
  const Problem& problem = engine.problem();
  const double* numbers = numbers_of(start, {nq});
  if (problem.terms.size() != 1 || !numbers) return std::nullopt;
  const std::optional<Goal> goal = goal_at(problem.terms.front(), place, problem.constants.farthest);
  Vector q = Eigen::Map<const Vector>(numbers, nq);
  const UnitLength unit{problem.constants.unit_rounding, problem.constants.largest_unit_error};
  if (!goal || !engine.mechanism().normalize(q, unit)) return std::nullopt;
  return solve(engine, std::move(q), {*goal}, nearest);
}

namespace {

nb::tuple solve_many(Engine& engine, nb::ndarray<const double, nb::ndim<2>, nb::c_contig> starts,
                     nb::ndarray<const double, nb::ndim<3>, nb::c_contig> goals, bool nearest, int threads) {
  const std::size_t count = goals.shape(0), terms = goals.shape(1), nq = starts.shape(1);
  const bool one_start = starts.shape(0) == 1;
  const bool fits = nq == static_cast<std::size_t>(engine.mechanism().nq) && terms == engine.problem().terms.size() &&
                    goals.shape(2) == numbers_of_a_goal && (one_start || starts.shape(0) == count);
  if (!fits) throw std::invalid_argument(expected(engine) + ", with one start or as many as there are problems");
  if (threads < 1)
    throw std::invalid_argument("the number of threads must be at least 1; got " + std::to_string(threads));
  Columns columns(count, nq);
  bool interrupted = false;
  {
    const nb::gil_scoped_release release;
    const auto take = [&](std::uint64_t i, Vector& start, std::vector<Goal>& wanted) {
      start = Eigen::Map<const Vector>(starts.data() + (one_start ? 0 : i) * nq, static_cast<Eigen::Index>(nq));
      wanted.resize(terms);
      for (std::size_t t = 0; t < terms; ++t) wanted[t] = goal_from(goals.data() + numbers_of_a_goal * (i * terms + t));
    };
    const auto put = [&](std::uint64_t i, const Answer& answer) { columns.put(i, answer); };
    const auto pause = [&] {
      interrupted = interrupted || !no_signal();
      return !interrupted;
    };
    engine.solve_many(count, threads, nearest, take, put, pause);
  }
  if (interrupted) throw nb::python_error();
  return std::move(columns).arrays(count, nq);
}

}  // namespace

void register_engine(nb::module_& m) {
  nb::class_<Engine>(m, "Engine")
      .def("__init__",
           [](Engine* self, std::shared_ptr<const Robot> robot, const Problem& problem, const Settings& settings) {
             new (self) Engine(std::move(robot), problem, settings);
           },
           "robot"_a, "problem"_a, "settings"_a)
      .def("solve",
           [](Engine& self, Vector start, nb::ndarray<const double, nb::shape<-1, numbers_of_a_goal>, nb::c_contig> goals,
              bool nearest, double spent) {
             return solve(self, std::move(start), goals_from(goals.data(), goals.shape(0)), nearest, spent);
           },
           "start"_a, "goals"_a, "nearest"_a, "spent"_a = 0.0)
      .def("solve_many", &solve_many, "starts"_a, "goals"_a, "nearest"_a, "threads"_a,
           nb::sig("def solve_many(self, starts: NDArray[numpy.float64], goals: NDArray[numpy.float64], "
                   "nearest: bool, threads: int) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], "
                   "NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.int64], NDArray[numpy.int64], "
                   "NDArray[numpy.int64], NDArray[numpy.int64], NDArray[numpy.float64]]"));
}

}  // namespace pinik
