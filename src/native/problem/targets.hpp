// Where targets are and how far they are missed; follows pinik.problem.targets.
#pragma once

#include <cmath>

#include "../model/spatial.hpp"

namespace pinik {

struct Tolerance {
  double position = 0.0, orientation = 0.0;  // [m], [rad]
};

// The error of one target [m, rad]; NaN for what the target does not constrain.
struct TargetError {
  double position = std::nan(""), orientation = std::nan("");

  bool within(const Tolerance& t) const {
    return !(position > t.position) && !(orientation > t.orientation);
  }
};

// The numbers of one target, in the axes of its reference frame. What the target does not constrain is not read.
struct Goal {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  Vec3 direction = Vec3::UnitX();
  Vec3 at = Vec3::Zero();
};

}  // namespace pinik
