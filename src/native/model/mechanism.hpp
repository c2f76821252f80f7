// A robot's joints, prepared for fast forward kinematics.
#pragma once

#include <vector>

#include "spatial.hpp"

namespace pinik {

enum class JointKind { revolute, continuous, prismatic, floating, planar };

// One movable joint, as pinik.model.joint describes it. Index 0 of a mechanism's joints is the world.
struct Joint {
  JointKind kind = JointKind::revolute;
  int parent = 0;
  Placement placement;         // in the parent joint; both are turned so that their axes become z
  Mat3 to_line = Mat3::Identity();  // the rotation that turns z onto the joint's axis
  Placement unturned;               // in the parent joint, as in Pinocchio's model
  Vec3 line = Vec3::UnitZ();        // the axis in the joint's own frame, as in Pinocchio's model
  int idx_q = 0, nq = 0;       // a follower has nq = 0 and the idx_q of its leader
  int idx_v = 0, nv = 0;
  bool follows = false;
  double multiplier = 1.0, offset = 0.0;
  double lower = 0.0, upper = 0.0;  // [rad or m]; infinite if there are none
  bool turns = false;               // whether a whole turn of it changes nothing

  bool has_one_axis() const { return kind != JointKind::floating && kind != JointKind::planar; }
  bool slides() const { return kind == JointKind::prismatic; }

  // Whether a tangent coordinate of the joint moves along an axis instead of turning about it.
  bool slides(int coordinate) const {
    return slides() || (kind == JointKind::floating && coordinate < 3) || (kind == JointKind::planar && coordinate < 2);
  }

  // The joint axis along or about which a tangent coordinate moves: 0, 1 or 2.
  int axis(int coordinate) const { return has_one_axis() ? 2 : coordinate % 3; }
};

// How much the squared length of a (cos, sin) pair or a quaternion may differ from 1: it is left as it is up to
// `rounding`, scaled up to `largest_error`, and refused beyond that.
struct UnitLength {
  double rounding, largest_error;
};

// Apply a tangent step to the entries of a floating or planar joint, in place.
void integrate_free(JointKind kind, double* own, const double* step);

// Write the entries of a floating or planar joint at a part of the way between two placements into `own`.
void interpolate_free(JointKind kind, const double* from, const double* to, double part, double* own);

// Write the tangent step of a floating or planar joint from one placement to another into `step`.
void difference_free(JointKind kind, const double* from, const double* to, double* step);

// The joints of a robot, in the order of Pinocchio's model.
class Mechanism {
 public:
  std::vector<Joint> joints{Joint()};  // the world
  int nq = 0;

  // The placement of a joint in the world for the configuration q, when its parent is at `parent`.
  Placement moved(const Placement& parent, const Joint& joint, const double* q) const {
    Placement at = parent * joint.placement;
    const double* own = q + joint.idx_q;
    switch (joint.kind) {
      case JointKind::prismatic:
        at.p += at.R.col(2) * (joint.multiplier * own[0] + joint.offset);
        break;
      case JointKind::floating: {
        const Eigen::Map<const Eigen::Quaterniond> turn(own + 3);
        at = at * Placement{turn.toRotationMatrix(), Vec3(own[0], own[1], own[2])};
        break;
      }
      case JointKind::planar:
        at.p += at.R.col(0) * own[0] + at.R.col(1) * own[1];
        turn_about_z(at.R, own[2], own[3]);
        break;
      default:
        if (joint.nq == 2) {
          turn_about_z(at.R, own[0], own[1]);
        } else {
          const double angle = joint.multiplier * own[0] + joint.offset;
          turn_about_z(at.R, std::cos(angle), std::sin(angle));
        }
    }
    return at;
  }

  // Apply a tangent step of one joint to q, in place; `step` points to the joint's own entries.
  void integrate(const Joint& joint, double* q, const double* step) const {
    double* own = q + joint.idx_q;
    if (joint.nq == 1) {
      own[0] += step[0];
    } else if (joint.nq == 2) {
      const double c = std::cos(step[0]), s = std::sin(step[0]);
      const double x = c * own[0] - s * own[1], y = s * own[0] + c * own[1];
      const double scale = 0.5 * (3.0 - x * x - y * y);  // one Newton step towards unit length
      own[0] = scale * x;
      own[1] = scale * y;
    } else {
      integrate_free(joint.kind, own, step);
    }
  }

  // Write the tangent step of one joint from configuration a to b into `step`.
  void difference(const Joint& joint, const double* a, const double* b, double* step) const {
    const double *from = a + joint.idx_q, *to = b + joint.idx_q;
    if (joint.nq == 1)
      step[0] = to[0] - from[0];
    else if (joint.nq == 2)
      step[0] = std::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    else
      difference_free(joint.kind, from, to, step);
  }

  // Scale (cos, sin) pairs and quaternions to unit length. Returns false if one is refused, or if a number is not finite.
  bool normalize(Vector& q, const UnitLength& unit) const {
    if (q.size() != nq || !q.allFinite()) return false;
    for (const Joint& joint : joints) {
      const int size = joint.kind == JointKind::floating ? 4 : joint.kind == JointKind::planar || joint.nq == 2 ? 2 : 0;
      if (size == 0) continue;
      auto circle = q.segment(joint.idx_q + joint.nq - size, size);
      const double squared = circle.squaredNorm();
      if (std::abs(squared - 1.0) > unit.largest_error) return false;
      if (std::abs(squared - 1.0) > unit.rounding) circle /= std::sqrt(squared);
    }
    return true;
  }

 private:
  static void turn_about_z(Mat3& R, double c, double s) {
    const Vec3 x = R.col(0), y = R.col(1);
    R.col(0) = c * x + s * y;
    R.col(1) = c * y - s * x;
  }
};

}  // namespace pinik
