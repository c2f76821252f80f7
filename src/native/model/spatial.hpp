// Points, rotations and placements, in Eigen's own types.
#pragma once

#include "alignment.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace pinik {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vector = Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The placement of one frame in another: rotation, and translation [m].
struct Placement {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  Placement operator*(const Placement& b) const { return {R * b.R, p + R * b.p}; }
};

// The rotation vector of R [rad], whose length `angle` lies in [0, π].
inline Vec3 log3(const Mat3& R, double& angle) {
  const Vec3 twice(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));  // 2 sin(angle) times the axis
  const double sine = 0.5 * twice.norm(), cosine = 0.5 * (R.trace() - 1.0);
  angle = std::atan2(sine, cosine);
  if (sine > 1e-4 || (cosine > 0.0 && sine > 1e-9)) return (0.5 * angle / sine) * twice;
  if (cosine > 0.0) return 0.5 * twice;
  // Near half a turn the sine is too small to give the axis, but the quaternion still has it.
  Eigen::Quaterniond quaternion(R);
  if (quaternion.w() < 0.0) quaternion.coeffs() = -quaternion.coeffs();
  const double length = quaternion.vec().norm();
  angle = 2.0 * std::atan2(length, quaternion.w());
  return quaternion.vec() * (angle / length);
}

// The rotation about a unit axis by an angle [rad].
inline Mat3 rotation_about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

// The rotation vector of the shortest rotation from unit vector a to unit vector b; `angle` is its length [rad].
inline Vec3 shortest_rotation(const Vec3& a, const Vec3& b, double& angle) {
  const Vec3 normal = a.cross(b);
  const double sine = normal.norm(), cosine = a.dot(b);
  angle = std::atan2(sine, cosine);
  if (sine > 1e-12) return normal * (angle / sine);
  if (cosine > 0.0) return Vec3::Zero();
  // a and b are opposite, so any axis perpendicular to a will do. Build one from the coordinate axis that is
  // farthest from a.
  int index;
  a.cwiseAbs().minCoeff(&index);
  const Vec3 across = a.cross(Vec3::Unit(index));
  angle = M_PI;
  return across * (M_PI / across.norm());
}

}  // namespace pinik
