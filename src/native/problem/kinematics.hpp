// Residual and Jacobian of a problem at one configuration; follows pinik.problem.term and pinik.problem.kinematics.
#pragma once

#include <optional>
#include <vector>

#include "../model/fast.hpp"
#include "chain.hpp"
#include "slack.hpp"

namespace pinik {

// The targets linearised at one configuration; Rows is 3, 6 or Eigen::Dynamic.
template <int Rows>
struct Linearization {
  Vector q;
  Eigen::Matrix<double, Rows, 1> e;
  Eigen::Matrix<double, Rows, Eigen::Dynamic> J;  // one column for each coordinate of the problem
  std::vector<TargetError> errors;
  double residual = 0.0;  // ‖e‖
  double distance = 0.0;  // the error of all targets in one number [m]
};

template <int Rows>
inline void see_chain(Chain& chain, const Problem& problem, bool at_target, Linearization<Rows>& at) {
  const Goal& goal = problem.goals.front();
  const Placement frame = chain.forward(at.q.data());
  const Vec3 e = goal.position - frame.p;
  at.e.template head<3>() = e;
  const double squared = e.squaredNorm();
  TargetError& error = at.errors.front();
  error.position = std::sqrt(squared);
  double turned = 0.0;
  if constexpr (Rows == 6) {
    const double size = problem.size_of_chain;
    at.e.template tail<3>() = size * log3(goal.rotation * frame.R.transpose(), error.orientation);
    turned = error.orientation * error.orientation;
  }
  at.residual = std::sqrt(squared + problem.size_of_chain * problem.size_of_chain * turned);
  at.distance = std::sqrt(squared + problem.squared_metres_per_radian * turned);
  chain.jacobian(at_target ? goal.position : frame.p, problem.size_of_chain, at.J);
}

PINIK_FAST static void see(Chain& chain, const Problem& problem, bool at_target, Linearization<3>& at) {
  see_chain(chain, problem, at_target, at);
}

PINIK_FAST static void see(Chain& chain, const Problem& problem, bool at_target, Linearization<6>& at) {
  see_chain(chain, problem, at_target, at);
}

// Forward kinematics, residual and Jacobian, with the working memory of one thread.
template <int Rows>
class Kinematics {
 public:
  const Problem& problem;
  bool target_jacobian = false;  // whether the Jacobian is that of the target's position instead of the frame's (thesis, eq. 3.9)
  bool loose = false;            // whether residuals stop pulling inside their tolerances
  std::vector<Placement> world;  // placements by joint, from the last forward()

  explicit Kinematics(const Problem& problem) : problem(problem), world(problem.mechanism->joints.size()) {
    if (Rows != Eigen::Dynamic && Chain::fits(problem)) chain_.emplace(problem);
  }

  void forward(const Vector& q) {
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[j];
      world[j] = problem.mechanism->moved(world[joint.parent], joint, q.data());
    }
  }

  Placement frame(const Term& term) const { return world[term.frame_joint] * term.frame; }

  // The placement of the frame in its reference, in which the target's numbers are given.
  Placement seen_from_reference(const Term& term) const {
    const Placement at = frame(term);
    if (!term.has_reference) return at;
    const Placement reference = world[term.reference_joint] * term.reference;
    return {reference.R.transpose() * at.R, reference.R.transpose() * (at.p - reference.p)};
  }

  // The goal in the world, at the configuration of the last forward(). Along free axes, its position is the frame's.
  Goal wanted(std::size_t index) const {
    const Term& term = problem.terms[index];
    Goal goal = problem.goals[index];
    if (term.has_free_axes)
      goal.position = term.along.cwiseProduct(goal.position) +
                      (Vec3::Ones() - term.along).cwiseProduct(seen_from_reference(term).p);
    if (!term.has_reference) return goal;
    const Placement at = world[term.reference_joint] * term.reference;
    return {at.p + at.R * goal.position, at.R * goal.rotation, at.R * goal.direction, at.p + at.R * goal.at};
  }

  // The axes of the frame in which a target is expressed, in the world.
  Mat3 reference_axes(const Term& term) const {
    return term.has_reference ? Mat3(world[term.reference_joint].R * term.reference.R) : Mat3(Mat3::Identity());
  }

  // The axes of the box of a target's tolerance, for its goal in the world.
  Mat3 box_axes(const Term& term, const Goal& goal) const {
    return term.asks_rotation ? goal.rotation : reference_axes(term);
  }

  // The part of a position error that lies outside the target's tolerance.
  Outside outside_tolerance(const Term& term, const Vec3& e, const Mat3& box_axes) const {
    const double share = problem.constants.slack_share;
    return term.tolerance.is_box ? outside_box(e, share * term.tolerance.box, box_axes)
                                 : outside_ball(e, share * term.tolerance.position);
  }

  void linearize(Linearization<Rows>& at) {
    const auto columns = static_cast<Eigen::Index>(problem.coordinates.size());
    at.errors.resize(problem.terms.size());
    if constexpr (Rows != Eigen::Dynamic) {
      if (chain_ && !loose) {
        at.J.resize(Rows, columns);
        return see(*chain_, problem, target_jacobian, at);
      }
    }
    forward(at.q);
    at.e.resize(problem.rows);
    at.J.setZero(problem.rows, columns);
    double distance = 0.0;
    for (std::size_t t = 0; t < problem.terms.size(); ++t) distance += linearize_term(t, at);
    at.residual = at.e.norm();
    at.distance = std::sqrt(distance);
  }

 private:
  std::optional<Chain> chain_;

  // Write one term's rows and return its contribution to the squared distance.
  double linearize_term(std::size_t index, Linearization<Rows>& at) const {
    const Term& term = problem.terms[index];
    const Placement frame = this->frame(term);
    const Goal goal = wanted(index);
    TargetError& error = at.errors[index];
    error = TargetError();
    double own = 0.0;
    int row = term.row;
    if (term.asks_position) {
      Vec3 e = goal.position - frame.p;
      error.position = e.norm();
      if (term.tolerance.is_box) error.offset = box_axes(term, goal).transpose() * e;
      const Vec3 point = target_jacobian ? goal.position : frame.p;
      for (const Part& part : problem.parts[index]) {
        auto column = at.J.template block<3, 1>(row, part.coordinate);
        if (part.moves_frame) column += term.weight * velocity(part, point);
        if (part.moves_reference) column -= term.weight * velocity(part, goal.position);
      }
      if (term.has_free_axes) {
        const Mat3 axes = reference_axes(term);
        scale_rows(at, row, axes * term.along.asDiagonal() * axes.transpose());
      }
      if (loose) {
        const Outside outside = outside_tolerance(term, e, box_axes(term, goal));
        scale_rows(at, row, outside.factor);
        e = outside.left;
      }
      at.e.template segment<3>(row) = term.weight * e;
      own += e.squaredNorm();
      row += 3;
    }
    if (term.asks_orientation()) {
      Vec3 e = orientation(index, term, frame, goal, row, at, error.orientation);
      double angle = error.orientation;
      if (loose) {
        const Outside outside = outside_ball(e, problem.constants.slack_share * term.tolerance.orientation);
        scale_rows(at, row, outside.factor);
        e = outside.left;
        angle = e.norm();
      }
      at.e.template segment<3>(row) = term.turn_weight * e;
      own += problem.squared_metres_per_radian * angle * angle;
    }
    return term.weight * term.weight * own;
  }

  static void scale_rows(Linearization<Rows>& at, int row, const Mat3& factor) {
    at.J.template middleRows<3>(row) = (factor * at.J.template middleRows<3>(row)).eval();
  }

  Vec3 orientation(std::size_t index, const Term& term, const Placement& frame, const Goal& goal, int row,
                   Linearization<Rows>& at, double& angle) const {
    const std::vector<Part>& parts = problem.parts[index];
    auto column = [&](const Part& part) { return at.J.template block<3, 1>(row, part.coordinate); };
    if (term.asks_rotation) {
      for (const Part& part : parts)
        if (!part.slides && part.moves_frame != part.moves_reference)
          column(part) += (part.moves_frame ? term.turn_weight : -term.turn_weight) * turn(part);
      return log3(goal.rotation * frame.R.transpose(), angle);
    }
    const Vec3 axis = frame.R * term.axis;
    if (!term.asks_at) {
      for (const Part& part : parts)
        if (!part.slides && part.moves_frame != part.moves_reference)
          column(part) += (part.moves_frame ? term.turn_weight : -term.turn_weight) * across(axis, turn(part));
      return shortest_rotation(axis, goal.direction, angle);
    }
    const Vec3 line = goal.at - frame.p;
    const double distance = line.norm();
    angle = 0.0;
    if (distance < problem.constants.no_direction) return Vec3::Zero();
    const Vec3 direction = line / distance;
    for (const Part& part : parts) {
      Vec3 turning = Vec3::Zero(), shift = Vec3::Zero();
      if (part.moves_frame) {
        if (!part.slides) turning = across(axis, turn(part));
        shift = velocity(part, frame.p);
      }
      if (part.moves_reference) shift -= velocity(part, goal.at);
      column(part) += term.turn_weight * (turning + direction.cross(shift) / distance);
    }
    return shortest_rotation(axis, direction, angle);
  }

  static Vec3 across(const Vec3& axis, const Vec3& vector) { return vector - axis * axis.dot(vector); }

  // The angular velocity that a coordinate gives to the links behind its joint.
  Vec3 turn(const Part& part) const { return part.multiplier * world[part.joint].R.col(part.axis); }

  // The velocity that a coordinate gives to a point behind its joint.
  Vec3 velocity(const Part& part, const Vec3& point) const {
    const Placement& joint = world[part.joint];
    const Vec3 axis = part.multiplier * joint.R.col(part.axis);
    return part.slides ? axis : Vec3(axis.cross(point - joint.p));
  }
};

}  // namespace pinik
