// Where targets are and how far they are missed; follows pinik.problem.targets and pinik.problem.tolerance.
#pragma once

#include <cmath>
#include <vector>

#include "../model/spatial.hpp"

namespace pinik {

struct Tolerance {
  double position = 0.0, orientation = 0.0;  // [m], [rad]
  bool is_box = false;       // whether `box` replaces `position`
  Vec3 box = Vec3::Zero();   // half sizes [m]

  // The largest distance that is within tolerance.
  double farthest() const { return is_box ? box.norm() : position; }
};

// The error of one target [m, rad]; NaN for what the target does not constrain.
struct TargetError {
  double position = std::nan(""), orientation = std::nan("");
  Vec3 offset = Vec3::Constant(std::nan(""));  // along the axes of the tolerance's box; NaN if it is no box

  bool within(const Tolerance& t) const {
    if (t.is_box && (offset.array().abs() > t.box.array()).any()) return false;
    return (t.is_box || !(position > t.position)) && !(orientation > t.orientation);
  }

  // How far the errors exceed the tolerance, in one number [m].
  double excess(const Tolerance& t, double metres_per_radian) const {
    double beyond = 0.0;
    if (!t.is_box)
      beyond = std::fmax(position - t.position, 0.0);
    else if (!std::isnan(offset[0]))
      beyond = (offset.cwiseAbs() - t.box).cwiseMax(0.0).norm();
    return std::hypot(beyond, metres_per_radian * std::fmax(orientation - t.orientation, 0.0));
  }
};

// The largest position and orientation error of several targets.
inline TargetError largest_of(const std::vector<TargetError>& errors) {
  TargetError largest;
  for (const TargetError& error : errors) {
    largest.position = std::fmax(largest.position, error.position);
    largest.orientation = std::fmax(largest.orientation, error.orientation);
  }
  return largest;
}

// The numbers of one target, in the axes of its reference frame. What the target does not constrain is not read.
struct Goal {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  Vec3 direction = Vec3::UnitX();
  Vec3 at = Vec3::Zero();

  bool operator==(const Goal& other) const {
    return position == other.position && rotation == other.rotation && direction == other.direction && at == other.at;
  }
};

}  // namespace pinik
