// Residuals that stop pulling inside a tolerance; follows pinik.problem.slack.
#pragma once

#include <cmath>

#include "../model/spatial.hpp"

namespace pinik {

// The part of an error that lies outside a tolerance, and the factor on the rows of its Jacobian.
struct Outside {
  Vec3 left = Vec3::Zero();
  Mat3 factor = Mat3::Zero();
};

// For a ball of radius `allowed`.
inline Outside outside_ball(const Vec3& e, double allowed) {
  const double length = e.norm();
  if (length <= allowed) return {};
  const Vec3 u = e / length;
  const double across = std::sqrt(1.0 - allowed / length);
  return {(length - allowed) * u, across * Mat3::Identity() + (1.0 - across) * u * u.transpose()};
}

// For a box with these half sizes, whose axes are the columns of `axes`.
inline Outside outside_box(const Vec3& e, const Vec3& allowed, const Mat3& axes) {
  const Vec3 own = axes.transpose() * e;
  Vec3 left, active;
  for (int k = 0; k < 3; ++k) {
    const double beyond = std::abs(own[k]) - allowed[k];
    left[k] = beyond > 0.0 ? std::copysign(beyond, own[k]) : 0.0;
    active[k] = beyond > 0.0 ? 1.0 : 0.0;
  }
  return {axes * left, axes * active.asDiagonal() * axes.transpose()};
}

}  // namespace pinik
