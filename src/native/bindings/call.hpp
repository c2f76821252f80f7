// Solves for one frame with as little as possible between the caller and the engine.
#pragma once

#include <nanobind/nanobind.h>

#include "../solving/engine.hpp"

namespace pinik {

namespace nb = nanobind;

// Solve for a place and from a start that need no conversion. Nothing if there is any doubt about the numbers.
std::optional<Answer> solve_at(Engine& engine, nb::handle place, nb::handle start, bool nearest);

// Makes solutions of one prepared problem.
class Call {
 public:
  // `neutral` is the start where none is given, `placement` is the class of placements, and `solution` the class of
  // solutions, which hold an answer and `question`.
  Call(nb::typed<nb::object, Engine> engine, nb::object neutral, nb::type_object placement, nb::type_object solution,
       nb::object question)
      : engine_(std::move(engine)), neutral_(std::move(neutral)), placement_(std::move(placement)),
        solution_(std::move(solution)), question_(std::move(question)) {}

  // The solution for a place and a start: float64 arrays, an SE3 as a place, None or "nearest" as a start. None if the
  // engine does not accept them.
  nb::object solve(nb::handle place, nb::handle start) const;

  // For Python's garbage collector.
  int traverse(visitproc visit, void* arg) const;
  void clear();

 private:
  nb::object engine_, neutral_, placement_, solution_, question_;

  nb::object made_from(Answer&& answer) const;
};

}  // namespace pinik
