// Joint limits as a box that contains the allowed configurations; follows pinik.model.limits.
#pragma once

#include <vector>

#include "mechanism.hpp"

namespace pinik {

struct Limits {
  bool enabled = true;
  double barely_outside = 0.0;  // [rad] the distance beyond a limit from which a hinge makes no turn
  Vector lower, upper;         // for each entry of q; infinite if there is none
  std::vector<char> turning;   // which entries are angles, where a whole turn changes nothing

  static Limits of(const Mechanism& mechanism, bool enabled, double barely_outside) {
    Limits limits;
    limits.barely_outside = barely_outside;
    limits.enabled = enabled;
    limits.lower = Vector::Constant(mechanism.nq, -infinity);
    limits.upper = Vector::Constant(mechanism.nq, infinity);
    limits.turning.assign(static_cast<std::size_t>(mechanism.nq), 0);
    for (const Joint& joint : mechanism.joints)
      if (joint.nq == 1) {
        limits.turning[static_cast<std::size_t>(joint.idx_q)] = joint.turns;
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

  // Move q inside the limits, with its hinges turned by whole turns to be as near to `near` as possible.
  void wrap(Vector& q, const Vector& near) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const bool inside = q[i] >= lower[i] && q[i] <= upper[i];
      if (inside && std::abs(q[i] - near[i]) <= M_PI) continue;
      if (turning[static_cast<std::size_t>(i)]) q[i] = turned(q[i], near[i], lower[i], upper[i], inside);
      q[i] = std::min(std::max(q[i], lower[i]), upper[i]);
    }
  }

 private:
  double turned(double angle, double near, double low, double high, bool inside) const {
    constexpr double turn = 2.0 * M_PI;
    const double nearest = angle - turn * std::nearbyint((angle - near) / turn);
    const double above = std::max(nearest - high, 0.0), below = std::max(low - nearest, 0.0);
    if (!inside && above + below <= barely_outside) return nearest;
    const double result = nearest - turn * std::ceil(above / turn) + turn * std::ceil(below / turn);
    const double middle = 0.5 * (low + high);
    if ((result >= low && result <= high) || !std::isfinite(middle)) return result;
    return angle - turn * std::nearbyint((angle - middle) / turn);
  }
};

}  // namespace pinik
