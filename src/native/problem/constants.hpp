// The numbers of the algorithm that both engines use. pinik.solving.native.constants hands them over, so that each is
// written once, in the Python module that it belongs to. The defaults only mark what has not been handed over.
#pragma once

#include <cstdint>
#include <limits>

namespace pinik {

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

// A run has stalled after this many iterations in which the residual fell by less than this part.
struct Patience {
  std::int64_t iterations = 0;
  double progress = not_given;
};

struct Constants {
  // pinik.checks and pinik.model
  double farthest = not_given;
  double widest_range = not_given;
  double largest_unit_error = not_given;
  double unit_rounding = not_given;
  double barely_outside = not_given;
  // pinik.problem
  double radian = not_given;
  double no_direction = not_given;
  double reach_rounding = not_given;
  double slack_share = not_given;
  double wide_angle = not_given;
  // pinik.solvers
  double smallest_damping_squared = not_given;
  double smallest_cutoff = not_given;
  double ccd_rounding = not_given;
  double ccd_suspect = not_given;
  double ccd_no_column = not_given;
  int ccd_halvings = 0;
  double ccd_wide_position = not_given;
  // pinik.solving
  double bold_part_of_distance = not_given;
  double part_of_chain = not_given;
  double polishing_gain = not_given;
  double exact_part_of_chain = not_given;
  Patience to_the_end;
  int restarts_when_unreachable = 0;
  int exact_attempts = 0;
  double same_answer = not_given;
  int colliding_least = 0;
  int colliding_since = 0;
  double nothing_new_share = not_given;
  int table_size = 0;
  int table_nearest = 0;
  std::uint64_t table_key = 0;
  int spread_size = 0;
  int spread_nearest = 0;
  double exact_answer = not_given;
  Patience search_patience;
  int search_least = 0;
  int search_since = 0;
  int search_samples = 0;
  int search_ranks = 0;
  double search_rank_threshold = not_given;
  double search_approach = not_given;
  double search_basin = not_given;
  double search_outside = not_given;
  double search_spacing = not_given;
  double search_nearly_singular = not_given;
  double search_alike = not_given;
  double continuum_singular = not_given;
  double continuum_aside = not_given;
  int continuum_iterations = 0;
  int continuum_parts = 0;
  int continuum_few_parts = 0;
  double jump_floor = not_given;
  double jump_factor = not_given;
  double jump_damping = not_given;
  double opposite = not_given;
  int creep_halvings = 0;
  std::int64_t tick_iterations = 0;
};

}  // namespace pinik
