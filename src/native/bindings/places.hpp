// Places whose numbers need no conversion. Python checks all others, since it also reports what is wrong.
#pragma once

#include <optional>

#include "../problem/problem.hpp"
#include "numbers.hpp"

namespace pinik {

// Whether this is a rotation matrix up to the last bits.
inline bool is_rotation(const Mat3& R) {
  return (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14 && R.determinant() > 0.0;
}

// Read a point [m]; returns false if it is not one, or if it is farther away than `farthest`.
inline bool read_point(const double* numbers, double farthest, Goal& goal) {
  goal.position = Eigen::Map<const Vec3>(numbers);
  return goal.position.allFinite() && goal.position.cwiseAbs().maxCoeff() <= farthest;
}

// Read a homogeneous matrix, row by row; returns false if there is any doubt about its numbers.
inline bool read_matrix(const double* numbers, double farthest, Goal& goal) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> M(numbers);
  goal.rotation = M.topLeftCorner<3, 3>();
  const Vec3 point = M.topRightCorner<3, 1>();
  return read_point(point.data(), farthest, goal) && M.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) &&
         is_rotation(goal.rotation);
}

// The goal of a target that asks for a position, a rotation or both, from a 4×4 matrix or from a position alone. Nothing
// if there is any doubt about the numbers.
inline std::optional<Goal> goal_at(const Term& term, nanobind::handle place, double farthest) {
  Goal goal;
  if (term.asks_axis || term.has_free_axes) return std::nullopt;
  const double* matrix = numbers_of(place, {4, 4});
  const double* point = matrix || term.asks_rotation ? nullptr : numbers_of(place, {3});
  if (matrix ? !read_matrix(matrix, farthest, goal) : !point || !read_point(point, farthest, goal)) return std::nullopt;
  return goal;
}

}  // namespace pinik
