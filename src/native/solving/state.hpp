// One iteration of a run, and why a run ended; follows pinik.solving.state.
#pragma once

#include <cstdint>
#include <vector>

#include "../problem/targets.hpp"

namespace pinik {

enum class Status { converged, stalled, max_iterations, time_limit, unreachable, colliding, running };

struct State {
  Vector q;
  std::int64_t iteration = 0, joint_updates = 0;
  std::vector<TargetError> errors;
  double residual = infinity;
  std::int64_t attempt = 0;
  Status status = Status::running;
};

}  // namespace pinik
