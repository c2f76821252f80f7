// Placements and Jacobians of one frame at many configurations; follows NamedModel.placement and NamedModel.jacobian.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "axes.hpp"
#include "fast.hpp"
#include "mechanism.hpp"
#include "trigonometry.hpp"

namespace pinik {

// Where and in which axes a velocity is expressed, as in Pinocchio.
enum class ReferenceFrame { world, local, local_world_aligned };

// The joints from one joint, exclusive, to another one, inclusive, and a frame that is fixed to the latter.
class Branch {
 public:
  // One joint of a branch.
  struct Link {
    const Joint* joint;
    double axes[12];  // x, y and z of the joint, and its origin, after the last forward()
  };

  Branch(const Mechanism& mechanism, int from, int to, const Placement& frame) : frame_(frame) {
    for (int j = to; j != from; j = mechanism.joints[static_cast<std::size_t>(j)].parent)
      links_.push_back({&mechanism.joints[static_cast<std::size_t>(j)], {}});
    std::reverse(links_.begin(), links_.end());
    for (std::vector<double>* numbers : {&angles_, &sines_, &cosines_}) numbers->resize(links_.size() + 3);
  }

  const std::vector<Link>& links() const { return links_; }

  // The frame at q, seen from where the branch begins. Remembers the axes of the joints if `remember`.
  Axes forward(const double* q, bool remember) {
    const int count = static_cast<int>(links_.size());
    for (int k = 0; k < count; ++k) {
      const Joint& joint = *links_[k].joint;
      angles_[k] = joint.nq > 1 ? q[joint.idx_q] : joint.multiplier * q[joint.idx_q] + joint.offset;
    }
    sines_and_cosines(angles_.data(), count, sines_.data(), cosines_.data());
    Axes at;
    for (int k = 0; k < count; ++k) {
      const Joint& joint = *links_[k].joint;
      const double* own = q + joint.idx_q;
      switch (joint.kind) {
        case JointKind::prismatic:
          at.go_to(joint.placement, angles_[k], 1.0, 0.0);
          break;
        case JointKind::floating: {
          const Eigen::Map<const Eigen::Quaterniond> turn(own + 3);
          at.go_to(joint.placement * Placement{turn.toRotationMatrix(), Vec3(own[0], own[1], own[2])});
          break;
        }
        case JointKind::planar:
          at.go_to({joint.placement.R, joint.placement.p + joint.placement.R.leftCols<2>() * Eigen::Vector2d(own[0], own[1])},
                   0.0, own[2], own[3]);
          break;
        default:
          if (joint.nq == 2)
            at.go_to(joint.placement, 0.0, own[0], own[1]);
          else
            at.go_to(joint.placement, 0.0, cosines_[k], sines_[k]);
      }
      if (remember) {
        const Column* columns[] = {&at.x, &at.y, &at.z, &at.p};
        for (int c = 0; c < 4; ++c) std::memcpy(links_[k].axes + 3 * c, columns[c], 3 * sizeof(double));
      }
    }
    at.go_to(frame_);
    return at;
  }

 private:
  std::vector<Link> links_;
  Placement frame_;
  std::vector<double> angles_, sines_, cosines_;
};

// A walk to a frame from its reference: the branches of both, from the joint where they meet. Holds the working memory of
// one thread.
class FrameWalk {
 public:
  // A frame and the joint to which it is fixed; the world at first.
  struct Place {
    int joint = 0;
    Placement placement;
  };

  FrameWalk(const Mechanism& mechanism, const Place& frame, const Place& reference, const UnitLength& unit)
      : FrameWalk(mechanism, frame, reference, unit, meeting(mechanism, frame.joint, reference.joint)) {}

  int entries() const { return mechanism_.nq; }

  int columns() const { return columns_; }

  // Write the homogeneous matrix (4, 4) of the frame in its reference, row by row. Returns false, and writes nothing, if q
  // is not a configuration.
  bool placement(const double* q, double* out) {
    if (!check(q)) return false;
    Placement at = frame_.forward(q_.data(), false).placement();
    if (has_reference_) {
      const Placement from = reference_.forward(q_.data(), false).placement();
      at = {from.R.transpose() * at.R, from.R.transpose() * (at.p - from.p)};
    }
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(out);
    matrix << at.R, at.p, Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
    return true;
  }

  // Write the Jacobian (6, columns) of the frame relative to its reference, which takes the place of the world in `axes`,
  // row by row. Returns false, and writes nothing, if q is not a configuration.
  bool jacobian(const double* q, ReferenceFrame axes, double* out) {
    if (!check(q)) return false;
    const Placement frame = frame_.forward(q_.data(), true).placement();
    const Placement reference = reference_.forward(q_.data(), true).placement();
    const Vec3& point = axes == ReferenceFrame::world ? reference.p : frame.p;
    const Mat3 turn = (axes == ReferenceFrame::local ? frame.R : reference.R).transpose();
    std::fill_n(out, 6 * columns_, 0.0);
    add(frame_, 1.0, point, turn, out);
    add(reference_, -1.0, point, turn, out);
    return true;
  }

 private:
  const Mechanism& mechanism_;
  Branch frame_, reference_;
  bool has_reference_;
  UnitLength unit_;
  int columns_ = 0;
  Vector q_;

  FrameWalk(const Mechanism& mechanism, const Place& frame, const Place& reference, const UnitLength& unit, int meeting)
      : mechanism_(mechanism), frame_(mechanism, meeting, frame.joint, frame.placement),
        reference_(mechanism, meeting, reference.joint, reference.placement),
        has_reference_(reference.joint != 0 || !reference.placement.R.isIdentity(0.0) || !reference.placement.p.isZero(0.0)),
        unit_(unit) {
    for (const Joint& joint : mechanism.joints) columns_ += joint.nv;
  }

  // The last joint that is on the way to both; a joint's number is greater than its parent's.
  static int meeting(const Mechanism& mechanism, int a, int b) {
    while (a != b) {
      int& later = a > b ? a : b;
      later = mechanism.joints[static_cast<std::size_t>(later)].parent;
    }
    return a;
  }

  bool check(const double* q) {
    q_ = Eigen::Map<const Vector>(q, mechanism_.nq);
    return mechanism_.normalize(q_, unit_);
  }

  // Add what the joints of one branch contribute to the velocity of a point.
  void add(const Branch& branch, double sign, const Vec3& point, const Mat3& turn, double* out) const {
    Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>> J(out, 6, columns_);
    for (const Branch::Link& link : branch.links()) {
      const Joint& joint = *link.joint;
      const int count = joint.has_one_axis() ? 1 : joint.nv;  // a follower has no column of its own
      const Eigen::Map<const Vec3> origin(link.axes + 9);
      for (int i = 0; i < count; ++i) {
        const Vec3 axis = sign * joint.multiplier * Eigen::Map<const Vec3>(link.axes + 3 * joint.axis(i));
        auto column = J.col(joint.idx_v + i);
        if (joint.slides(i)) {
          column.head<3>() += turn * axis;
        } else {
          column.head<3>() += turn * axis.cross(point - origin);
          column.tail<3>() += turn * axis;
        }
      }
    }
  }
};

// Write the placements of `count` configurations, one after another. Returns how many came before the first faulty one.
PINIK_FAST static std::size_t write_placements(FrameWalk& walk, const double* q, std::size_t count, double* out) {
  const std::size_t entries = static_cast<std::size_t>(walk.entries());
  std::size_t row = 0;
  while (row < count && walk.placement(q + row * entries, out + row * 16)) ++row;
  return row;
}

// Write their Jacobians, likewise.
PINIK_FAST static std::size_t write_jacobians(FrameWalk& walk, ReferenceFrame axes, const double* q, std::size_t count,
                                              double* out) {
  const std::size_t entries = static_cast<std::size_t>(walk.entries());
  const std::size_t numbers = 6 * static_cast<std::size_t>(walk.columns());
  std::size_t row = 0;
  while (row < count && walk.jacobian(q + row * entries, axes, out + row * numbers)) ++row;
  return row;
}

}  // namespace pinik
