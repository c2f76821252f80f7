// How far joints move between two configurations, and how far a target asks them to move; follows
// pinik.solving.changes.
#pragma once

#include <algorithm>
#include <cmath>

#include "../problem/kinematics.hpp"
#include "../solvers/normal_equations.hpp"

namespace pinik {

inline double turn_between(const double* before, const double* after) {
  return std::atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
}

// The signed change of a joint; the length counts as one radian in ways.
inline double joint_change(const Joint& joint, const Vector& before, const Vector& after, double length) {
  const double *from = before.data() + joint.idx_q, *to = after.data() + joint.idx_q;
  if (joint.nq == 1) return (to[0] - from[0]) / (joint.slides() ? length : 1.0);
  if (joint.nq == 2) return turn_between(from, to);
  if (joint.kind == JointKind::planar)
    return std::max(std::hypot(to[0] - from[0], to[1] - from[1]) / length, std::abs(turn_between(from + 2, to + 2)));
  const double way = (Eigen::Map<const Vec3>(to) - Eigen::Map<const Vec3>(from)).norm() / length;
  const double product = std::abs(Eigen::Map<const Eigen::Vector4d>(from + 3).dot(Eigen::Map<const Eigen::Vector4d>(to + 3)));
  return std::max(way, 2.0 * std::acos(std::min(product, 1.0)));
}

inline double largest_change(const Problem& problem, const Vector& before, const Vector& after) {
  double largest = 0.0;
  for (const MovingJoint& moving : problem.moving) {
    const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(moving.joint)];
    largest = std::max(largest, std::abs(joint_change(joint, before, after, problem.size_of_chain)));
  }
  return largest;
}

// The largest change of a joint that is no jump, if the joints leave the configuration of `at`.
template <int Rows>
double largest_asked(const Problem& problem, const Linearization<Rows>& at,
                     Eigen::Matrix<double, Rows, Rows>& working_memory, Vector& step) {
  const Constants& constants = problem.constants;
  const double squared = constants.jump_damping * constants.jump_damping * at.J.squaredNorm();
  double largest = 0.0;
  if (squared > 0.0) {
    damp(at.J, at.e, squared, working_memory, step);
    for (std::size_t c = 0; c < problem.coordinates.size(); ++c) {
      const double part = std::abs(step[static_cast<Eigen::Index>(c)]);
      largest = std::max(largest, problem.coordinates[c].slides ? part / problem.size_of_chain : part);
    }
  }
  return constants.jump_floor + constants.jump_factor * largest;
}

}  // namespace pinik
