// What a solve is asked for: targets compiled for one mechanism; follows pinik.problem.kinematics.
#pragma once

#include <vector>

#include "../model/mechanism.hpp"
#include "constants.hpp"
#include "targets.hpp"

namespace pinik {

// One target: its frame and what it constrains, without the numbers that change from solve to solve.
struct Term {
  int frame_joint = 0, reference_joint = 0;
  Placement frame, reference;  // in their joints, in the joints' turned axes; the frame's includes the tool
  Placement unturned_frame, unturned_reference;  // in their joints, as in Pinocchio's model
  Placement tool;                                // in the frame
  bool has_tool = false;
  bool has_reference = false;
  bool asks_position = false, asks_rotation = false, asks_axis = false, asks_at = false;
  bool has_free_axes = false;
  Vec3 along = Vec3::Ones();  // 1 for the axes of the reference along which the position is constrained, else 0
  Tolerance tolerance;
  Vec3 axis = Vec3::UnitX();  // in the frame
  double weight = 1.0;        // of the position's rows, relative to the heaviest target, which has 1
  double turn_weight = 1.0;   // of the orientation's rows [m]: weight times Problem::size_of_chain
  int row = 0, rows = 0;
  std::vector<char> in_frame_support, in_reference_support;  // by joint
  // Bounds on the distance from the chain's first joint, which prove that a position is out of reach.
  bool has_bounds = false;
  Vec3 base = Vec3::Zero();
  double reach[2] = {infinity, infinity}, hole[2] = {0.0, 0.0};  // [0] without limits, [1] with limits

  bool asks_orientation() const { return asks_rotation || asks_axis; }
};

// A joint that moves with a coordinate, and by how much: the coordinate's own joint, or one that mimics it.
struct Mover {
  int joint;
  double multiplier;
};

// One free coordinate of the tangent space.
struct Coordinate {
  int joint = 0, index = 0;  // its joint, and which of the joint's tangent coordinates it is
  int entry = -1;            // the entry of q that has its limits; −1 if there is none
  std::vector<Mover> movers;  // joints that move a frame relative to its reference
  std::vector<Mover> moved;   // all joints that move, including those that move frame and reference alike
  bool slides = false;  // whether the first mover slides
};

// The contribution of one mover to a column of one term's Jacobian.
struct Part {
  int coordinate, joint, axis;
  double multiplier;
  bool slides, moves_frame, moves_reference;
};

// A joint that has free coordinates: their numbers by tangent coordinate of the joint, −1 where one is not free.
struct MovingJoint {
  int joint;
  int coordinates[6];
};

struct Problem {
  const Mechanism* mechanism = nullptr;
  Constants constants;
  std::vector<Term> terms;
  std::vector<Coordinate> coordinates;  // from the tip to the base, in CCD's order
  std::vector<int> joints;              // all joints that the terms' frames depend on, from the base
  std::vector<std::vector<Part>> parts;  // by term
  std::vector<MovingJoint> moving;       // from the base
  int rows = 0;
  bool is_plain = true;  // whether every coordinate is one entry of q
  double lightest = 1.0, size_of_chain = 1.0;  // the smallest weight; the length of the longest chain [m]
  bool is_wide = false;  // whether an answer inside a wide tolerance is looked for if the exact one is not found
  double squared_metres_per_radian = 1.0;      // what a radian counts in Linearization::distance
  std::vector<Goal> goals;                     // by term; each solve sets them

  // Compute everything that follows from terms and coordinates.
  void finish() {
    rows = 0;
    squared_metres_per_radian = (constants.radian * size_of_chain) * (constants.radian * size_of_chain);
    for (Term& term : terms) {
      term.turn_weight = term.weight * size_of_chain;
      term.row = rows;
      term.rows = 3 * (term.asks_position + term.asks_orientation());
      rows += term.rows;
      term.in_frame_support = support(term.frame_joint);
      term.in_reference_support = support(term.has_reference ? term.reference_joint : 0);
      std::vector<Part> list;
      for (int c = 0; c < static_cast<int>(coordinates.size()); ++c)
        for (const Mover& mover : coordinates[c].moved) {
          const bool frame = term.in_frame_support[mover.joint], reference = term.in_reference_support[mover.joint];
          if (frame || reference)
            list.push_back({c, mover.joint, axis_of(mover.joint, coordinates[c].index), mover.multiplier,
                            slides(mover.joint, coordinates[c].index), frame, reference});
        }
      parts.push_back(std::move(list));
    }
    const int count = static_cast<int>(mechanism->joints.size());
    for (int j = 1; j < count; ++j) {
      bool needed = false, owns = false;
      for (const Term& term : terms) needed = needed || term.in_frame_support[j] || term.in_reference_support[j];
      MovingJoint own{j, {-1, -1, -1, -1, -1, -1}};
      for (int c = 0; c < static_cast<int>(coordinates.size()); ++c)
        if (coordinates[c].joint == j) {
          own.coordinates[coordinates[c].index] = c;
          owns = true;
        }
      if (needed) joints.push_back(j);
      if (owns) moving.push_back(own);
    }
    for (Coordinate& coordinate : coordinates) {
      coordinate.slides = slides(coordinate.movers.front().joint, coordinate.index);
      is_plain = is_plain && coordinate.entry >= 0;
    }
    goals.resize(terms.size());
  }

  bool slides(int joint, int index) const { return mechanism->joints[joint].slides(index); }

  // The joint axis along or about which a tangent coordinate moves: 0, 1 or 2.
  int axis_of(int joint, int index) const { return mechanism->joints[joint].axis(index); }

 private:
  std::vector<char> support(int joint) const {
    std::vector<char> is_in(mechanism->joints.size(), 0);
    for (int j = joint; j > 0; j = mechanism->joints[j].parent) is_in[j] = 1;
    return is_in;
  }
};

// Call `see(change, coordinate)` with the change of each free coordinate from configuration a to b.
template <class See>
inline void each_change(const Problem& problem, const Vector& a, const Vector& b, const See& see) {
  for (const MovingJoint& moving : problem.moving) {
    const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(moving.joint)];
    double own[6];
    problem.mechanism->difference(joint, a.data(), b.data(), own);
    for (int i = 0; i < joint.nv; ++i)
      if (moving.coordinates[i] >= 0) see(own[i], static_cast<std::size_t>(moving.coordinates[i]));
  }
}

// Move q by a step of the free coordinates.
inline void integrate(const Problem& problem, const Vector& dq, Vector& q) {
  for (const MovingJoint& moving : problem.moving) {
    const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(moving.joint)];
    double own[6];
    for (int i = 0; i < joint.nv; ++i) own[i] = moving.coordinates[i] < 0 ? 0.0 : dq[moving.coordinates[i]];
    problem.mechanism->integrate(joint, q.data(), own);
  }
}

// Whether each target's error is within its tolerance.
inline bool all_within(const Problem& problem, const std::vector<TargetError>& errors) {
  for (std::size_t t = 0; t < errors.size(); ++t)
    if (!errors[t].within(problem.terms[t].tolerance)) return false;
  return true;
}

}  // namespace pinik
