// Joint limits as a box that contains the allowed configurations; follows pinik.model.limits.
#pragma once

#include <vector>

#include "mechanism.hpp"

namespace pinik {

struct Limits {
  bool enabled = true;
  Vector lower, upper;         // for each entry of q; infinite if there is none
  std::vector<char> turning;   // which entries are angles, where a whole turn changes nothing

  static Limits of(const Mechanism& mechanism, bool enabled) {
    Limits limits;
    limits.enabled = enabled;
    limits.lower = Vector::Constant(mechanism.nq, -infinity);
    limits.upper = Vector::Constant(mechanism.nq, infinity);
    limits.turning.assign(static_cast<std::size_t>(mechanism.nq), 0);
    for (const Joint& joint : mechanism.joints)
      if (joint.nq == 1) {
        limits.turning[static_cast<std::size_t>(joint.idx_q)] = !joint.slides() && !joint.shared;
        if (enabled) {
          limits.lower[joint.idx_q] = joint.lower;
          limits.upper[joint.idx_q] = joint.upper;
        }
      }
    return limits;
  }

  // The same box without its limits, except for those that leave a joint a single value.
  Limits loosened() const {
    Limits loose = *this;
    loose.enabled = false;
    for (Eigen::Index i = 0; i < lower.size(); ++i)
      if (lower[i] != upper[i]) {
        loose.lower[i] = -infinity;
        loose.upper[i] = infinity;
      } else {
        loose.enabled = true;
      }
    return loose;
  }

  void clip(Vector& q) const {
    if (enabled) q = q.cwiseMax(lower).cwiseMin(upper);
  }

  bool contains(const Vector& q) const {
    return !enabled || ((q.array() >= lower.array()) && (q.array() <= upper.array())).all();
  }

  // Turn angles outside their limits by whole turns, to the representative nearest to the middle of the range.
  void wrap(Vector& q) const {
    if (!enabled) return;
    for (Eigen::Index i = 0; i < q.size(); ++i)
      if (turning[static_cast<std::size_t>(i)] && (q[i] < lower[i] || q[i] > upper[i])) {
        const double middle = 0.5 * (lower[i] + upper[i]);
        if (!std::isfinite(middle)) continue;
        q[i] -= 2.0 * M_PI * std::nearbyint((q[i] - middle) / (2.0 * M_PI));
      }
  }
};

}  // namespace pinik
