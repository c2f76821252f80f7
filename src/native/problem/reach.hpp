// The proof that a target is out of reach; follows pinik.problem.reach, which computes the bounds.
#pragma once

#include <cmath>
#include <optional>

#include "problem.hpp"

namespace pinik {

// Which target is out of reach, how far beyond which bound [m], and whether it is too near rather than too far.
struct Shortfall {
  int target = -1;
  double distance = 0.0, bound = 0.0;
  bool inner = false;
};

// The target that is farthest out of reach, by more than its tolerance, if there is one.
inline std::optional<Shortfall> shortfall(const Problem& problem, bool limits) {
  std::optional<Shortfall> worst;
  for (std::size_t t = 0; t < problem.terms.size(); ++t) {
    const Term& term = problem.terms[t];
    const double reach = term.reach[limits], hole = term.hole[limits];
    if (!term.asks_position || !term.has_bounds || !std::isfinite(reach)) continue;
    // Along free axes, the nearest position to the base.
    const Vec3 position = term.along.cwiseProduct(problem.goals[t].position - term.base) + term.base;
    const double distance = (position - term.base).norm();
    const double slack = problem.constants.reach_rounding * (reach + position.norm() + term.base.norm());
    Shortfall found{static_cast<int>(t), 0.0, 0.0, false};
    if (distance > reach + slack) {
      found.distance = distance - reach;
      found.bound = reach;
    } else if (distance < hole - slack && !term.has_free_axes) {
      found.distance = hole - distance;
      found.bound = hole;
      found.inner = true;
    }
    if (found.distance > term.tolerance.farthest() && (!worst || found.distance > worst->distance)) worst = found;
  }
  return worst;
}

}  // namespace pinik
