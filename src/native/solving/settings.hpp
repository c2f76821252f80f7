// What a solve was asked for besides its targets; follows pinik.solving.attempts.Settings.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "../problem/constants.hpp"
#include "../problem/targets.hpp"
#include "../shapes/collisions.hpp"
#include "../solvers/solver.hpp"

namespace pinik {

// The numbers of pinik.solving.way_out.
struct WayOutSettings {
  int ways = 0;  // answers from which a way out is tried
  int steps = 0, iterations = 0;
  double longest_step = not_given, gap = not_given, probe = not_given;
  double same_rank = not_given, stuck = not_given, damping = not_given;
};

struct Settings {
  Solver solver;
  Patience patience;  // of an attempt that is not the last
  bool limits = true;
  std::int64_t restarts = 0;
  std::uint64_t seed = 0;
  std::int64_t max_iterations = 0;         // of one attempt
  std::int64_t iterations_to_the_end = 0;  // of the last run, which continues the best of the failed attempts
  double time_limit = infinity;  // [s]
  bool trace = false;
  bool choose_nearest = false;  // of all distinct answers; otherwise the first one is taken
  std::vector<double> choose_weights;  // for each coordinate, a factor on its change
  bool polish = true;  // whether a run goes on once it has reached the targets
  std::shared_ptr<const Shapes> avoid;  // what must not touch; null if nothing is to be avoided
  WayOutSettings way_out;
};

}  // namespace pinik
