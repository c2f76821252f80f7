// What a solve is asked for: targets compiled for one mechanism, as pinik.kinematics.Kinematics compiles them.
#pragma once

#include <limits>
#include <vector>

#include "mechanism.hpp"

namespace pinik {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double no_direction = 1e-9;  // [m] nearer than this to the point that it looks at, a frame looks at it

struct Tolerance {
  double position = 1e-4, orientation = 1e-3;
};

// How far a target is missed; NaN for what it does not ask for.
struct TargetError {
  double position = std::nan(""), orientation = std::nan("");

  bool within(const Tolerance& t) const {
    return !(position > t.position) && !(orientation > t.orientation);
  }
};

// Where one target wants its frame; what it does not ask for is not read. In the reference's axes, where there is one.
struct Goal {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  Vec3 direction = Vec3::UnitX();
  Vec3 at = Vec3::Zero();
};

// One target's frame and what is asked of it, without the numbers that say where.
struct Term {
  int frame_joint = 0, reference_joint = 0;
  Placement frame, reference;  // in their joints
  bool has_reference = false;
  bool asks_position = false, asks_rotation = false, asks_axis = false, asks_at = false;
  Vec3 axis = Vec3::UnitX();  // in the frame
  double weight = 1.0;        // at most 1, the heaviest target's
  int row = 0, rows = 0;
  std::vector<char> in_frame_support, in_reference_support;  // by joint
  // What proves a position out of reach: bounds on its distance from the chain's first joint.
  bool has_bounds = false;
  Vec3 base = Vec3::Zero();
  double reach[2] = {infinity, infinity}, hole[2] = {0.0, 0.0};  // without and with limits

  bool asks_orientation() const { return asks_rotation || asks_axis; }
};

// A joint that moves with a coordinate, and how much of it: the coordinate's own joint, or one that mimics it.
struct Mover {
  int joint;
  double multiplier;
};

// One free tangent coordinate.
struct Coordinate {
  int joint = 0, index = 0;  // whose, and which of its tangent coordinates
  int entry = -1;            // in q, where it has limits
  std::vector<Mover> movers;  // that move a frame relative to its reference
  std::vector<Mover> moved;   // all, those too that move both
  bool slides = false;  // the first mover
};

// One mover's share in one term's Jacobian column.
struct Part {
  int coordinate, joint, axis;
  double multiplier;
  bool slides, moves_frame, moves_reference;
};

// A joint that owns coordinates: their numbers by tangent coordinate of the joint, −1 for those that are not free.
struct MovingJoint {
  int joint;
  int coordinates[6];
};

struct Problem {
  const Mechanism* mechanism = nullptr;
  std::vector<Term> terms;
  std::vector<Coordinate> coordinates;  // distal joints first, as CCD visits them
  std::vector<int> joints;              // all that the terms' frames hang on, base first
  std::vector<std::vector<Part>> parts;  // by term
  std::vector<MovingJoint> moving;       // base first
  int rows = 0;
  bool is_plain = true;  // every coordinate is a number in q
  double lightest = 1.0, size_of_chain = 1.0;  // the smallest weight, the longest chain [m]
  std::vector<Goal> goals;                     // by term; a solve's own

  // Fill in all that follows from terms and coordinates.
  void finish() {
    rows = 0;
    for (Term& term : terms) {
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

  bool slides(int joint, int index) const {
    const Joint& j = mechanism->joints[joint];
    return j.slides() || (j.kind == JointKind::floating && index < 3) || (j.kind == JointKind::planar && index < 2);
  }

  // Which of its own axes a joint's tangent coordinate goes along or about.
  int axis_of(int joint, int index) const { return mechanism->joints[joint].has_one_axis() ? 2 : index % 3; }

 private:
  std::vector<char> support(int joint) const {
    std::vector<char> is_in(mechanism->joints.size(), 0);
    for (int j = joint; j > 0; j = mechanism->joints[j].parent) is_in[j] = 1;
    return is_in;
  }
};

}  // namespace pinik
