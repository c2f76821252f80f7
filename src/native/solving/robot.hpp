// A robot as the engine keeps it.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "../model/mechanism.hpp"
#include "certifier.hpp"

namespace pinik {

struct Robot {
  Mechanism mechanism;
  std::unique_ptr<Certifier> certifier;

  // Call this when all joints have been added.
  void finish() { certifier = std::make_unique<Certifier>(mechanism); }

  const Joint& joint(int number) const {
    const std::vector<Joint>& joints = mechanism.joints;
    if (number < 0 || static_cast<std::size_t>(number) >= joints.size())
      throw std::invalid_argument("a joint's number must be at least 0 and less than " + std::to_string(joints.size()) +
                                  "; got " + std::to_string(number));
    return joints[static_cast<std::size_t>(number)];
  }

  // A placement in a joint, in the joint's turned axes.
  Placement in_joint(int number, const Mat3& R, const Vec3& p) const {
    const Mat3 turned = joint(number).to_line.transpose();
    return {turned * R, turned * p};
  }
};

}  // namespace pinik
