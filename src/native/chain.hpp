// The commonest question made fast: one frame, carried by a chain of one-axis joints that mimic nothing.
#pragma once

#include <vector>

#include "problem.hpp"

namespace pinik {

// Residual and Jacobian in one walk along the chain; what the general pinik::Kinematics computes for such a problem.
class Chain {
 public:
  explicit Chain(const Problem& problem) {
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      links_.push_back({joint.placement, joint.idx_q, joint.nq == 2, joint.slides(), -1, Vec3::Zero(), Vec3::Zero()});
      for (std::size_t c = 0; c < problem.coordinates.size(); ++c)
        if (problem.coordinates[c].joint == j) links_.back().column = static_cast<int>(c);
    }
    tip_ = problem.terms.front().frame;
  }

  // Whether a problem is of that kind.
  static bool fits(const Problem& problem) {
    if (problem.terms.size() != 1) return false;
    const Term& term = problem.terms.front();
    if (term.has_reference || term.asks_axis || !term.asks_position) return false;
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      if (!joint.has_one_axis() || joint.follows) return false;
    }
    for (const Coordinate& coordinate : problem.coordinates)
      if (coordinate.movers.size() != 1 || coordinate.movers.front().joint != coordinate.joint) return false;
    return true;
  }

  // Where the frame is with the values q; keeps the joints' lines for jacobian().
  Placement forward(const double* q) {
    Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), p = Vec3::Zero();
    for (Link& link : links_) {
      const Mat3& R = link.placement.R;
      const Vec3& t = link.placement.p;
      p += t[0] * x + t[1] * y + t[2] * z;
      const Vec3 a = R(0, 0) * x + R(1, 0) * y + R(2, 0) * z;
      const Vec3 b = R(0, 1) * x + R(1, 1) * y + R(2, 1) * z;
      const Vec3 c = R(0, 2) * x + R(1, 2) * y + R(2, 2) * z;
      z = c;
      const double* own = q + link.entry;
      if (link.slides) {
        x = a;
        y = b;
        p += own[0] * z;
      } else {
        const double cosine = link.is_circle ? own[0] : std::cos(own[0]);
        const double sine = link.is_circle ? own[1] : std::sin(own[0]);
        x = cosine * a + sine * b;
        y = cosine * b - sine * a;
      }
      link.axis = z;
      link.origin = p;
    }
    Placement at;
    at.p = p + tip_.p[0] * x + tip_.p[1] * y + tip_.p[2] * z;
    for (int k = 0; k < 3; ++k) at.R.col(k) = tip_.R(0, k) * x + tip_.R(1, k) * y + tip_.R(2, k) * z;
    return at;
  }

  // The columns of the last forward(), for a point that the last link carries.
  template <int Rows>
  void jacobian(const Vec3& point, Eigen::Matrix<double, Rows, Eigen::Dynamic>& J) const {
    for (const Link& link : links_) {
      if (link.column < 0) continue;
      auto column = J.col(link.column);
      if (link.slides)
        column.template head<3>() = link.axis;
      else
        column.template head<3>() = link.axis.cross(point - link.origin);
      if constexpr (Rows == 6) {
        if (link.slides)
          column.template tail<3>().setZero();
        else
          column.template tail<3>() = link.axis;
      }
    }
  }

 private:
  struct Link {
    Placement placement;  // in the link before
    int entry;            // of q
    bool is_circle, slides;
    int column;         // of the Jacobian; −1 for a joint that holds still
    Vec3 axis, origin;  // in the world
  };

  std::vector<Link> links_;
  Placement tip_;
};

}  // namespace pinik
