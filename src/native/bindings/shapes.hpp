// Shapes as Python holds them: `pinik._native.Shapes`.
#pragma once

#include <memory>
#include <utility>

#include "../shapes/collisions.hpp"
#include "../solving/robot.hpp"

namespace pinik {

// Shapes with the robot that they belong to. They must not change once a checker has been made of them.
struct RobotShapes {
  std::shared_ptr<const Robot> robot;
  std::shared_ptr<Shapes> shapes;

  explicit RobotShapes(std::shared_ptr<const Robot> given)
      : robot(std::move(given)), shapes(std::make_shared<Shapes>(robot->mechanism)) {}

  int entries() const { return robot->mechanism.nq; }
};

}  // namespace pinik
