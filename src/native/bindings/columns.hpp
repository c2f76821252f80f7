// The answers to many problems, one column for each of their figures.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "../solving/outcome.hpp"
#include "numbers.hpp"

namespace pinik {

// For each problem: q, status, the largest position and orientation error, iterations, joint updates, restarts, distinct
// answers, seconds.
struct Columns {
  std::vector<double> q, position, orientation, seconds;
  std::vector<int> status;
  std::vector<std::int64_t> iterations, updates, restarts, chosen_from;

  Columns(std::size_t count, std::size_t nq)
      : q(count * nq), position(count), orientation(count), seconds(count), status(count), iterations(count),
        updates(count), restarts(count), chosen_from(count) {}

  // Leave only the first `count` problems.
  void shorten(std::size_t count, std::size_t nq) {
    q.resize(count * nq);
    for (std::vector<double>* column : {&position, &orientation, &seconds}) column->resize(count);
    for (std::vector<std::int64_t>* column : {&iterations, &updates, &restarts, &chosen_from}) column->resize(count);
    status.resize(count);
  }

  void put(std::uint64_t i, const Answer& answer) {
    Eigen::Map<Vector>(q.data() + i * static_cast<std::size_t>(answer.q.size()), answer.q.size()) = answer.q;
    const TargetError largest = largest_of(answer.errors);
    position[i] = largest.position;
    orientation[i] = largest.orientation;
    status[i] = static_cast<int>(answer.status);
    iterations[i] = answer.iterations;
    updates[i] = answer.joint_updates;
    restarts[i] = answer.restarts;
    chosen_from[i] = answer.chosen_from;
    seconds[i] = answer.seconds;
  }

  nb::tuple arrays(std::size_t count, std::size_t nq) && {
    return nb::make_tuple(as_array(std::move(q), {count, nq}), as_array(std::move(status), {count}),
                          as_array(std::move(position), {count}), as_array(std::move(orientation), {count}),
                          as_array(std::move(iterations), {count}), as_array(std::move(updates), {count}),
                          as_array(std::move(restarts), {count}), as_array(std::move(chosen_from), {count}),
                          as_array(std::move(seconds), {count}));
  }
};

}  // namespace pinik
