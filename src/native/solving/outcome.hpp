// The result of a solve; follows pinik.solving.attempts.Outcome.
#pragma once

#include <optional>

#include "../problem/reach.hpp"
#include "state.hpp"

namespace pinik {

struct Outcome {
  Status status = Status::running;
  Vector q;  // the best configuration
  Vector start;  // the start, moved inside the limits; empty if the robot has no (cos, sin) pairs
  std::int64_t iterations = 0, joint_updates = 0;  // of all attempts
  std::int64_t restarts = 0;
  std::int64_t chosen_from = 1;  // distinct answers
  std::optional<Shortfall> proof;
  std::vector<State> states;  // empty unless a trace is requested
};

// An outcome whose errors Pinocchio has measured; they decide its status.
struct Answer : Outcome {
  std::vector<TargetError> errors;
  std::vector<Goal> goals;  // the targets
  double seconds = 0.0;
};

}  // namespace pinik
