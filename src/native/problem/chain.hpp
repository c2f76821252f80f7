// A fast path for the most common problem: one frame at the end of a chain of one-axis joints without mimic joints.
#pragma once

#include <cstring>
#include <vector>

#include "../model/trigonometry.hpp"
#include "problem.hpp"

namespace pinik {

// Computes residual and Jacobian in one walk along the chain, with the same result as the general pinik::Kinematics.
class Chain {
 public:
  explicit Chain(const Problem& problem) {
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      Link link;
      link.placement = joint.placement;
      link.entry = joint.idx_q;
      link.is_circle = joint.nq == 2;
      link.slides = joint.slides();
      for (std::size_t c = 0; c < problem.coordinates.size(); ++c)
        if (problem.coordinates[c].joint == j) link.column = static_cast<int>(c);
      links_.push_back(link);
    }
    tip_ = problem.terms.front().frame;
    for (std::vector<double>* numbers : {&angles_, &sines_, &cosines_}) numbers->resize(links_.size() + 3);
  }

  // Whether this class can be used for a problem.
  static bool fits(const Problem& problem) {
    if (problem.terms.size() != 1) return false;
    const Term& term = problem.terms.front();
    if (term.has_reference || term.asks_axis || !term.asks_position || term.has_free_axes || term.tolerance.is_box)
      return false;
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      if (!joint.has_one_axis() || joint.follows) return false;
    }
    for (const Coordinate& coordinate : problem.coordinates)
      if (coordinate.movers.size() != 1 || coordinate.movers.front().joint != coordinate.joint) return false;
    return true;
  }

  // The placement of the frame at q. Keeps the axes of the joints for jacobian().
  Placement forward(const double* q) {
    const int count = static_cast<int>(links_.size());
    for (int k = 0; k < count; ++k) angles_[k] = q[links_[k].entry];
    sines_and_cosines(angles_.data(), count, sines_.data(), cosines_.data());
    Column x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0}, p{};
    for (int k = 0; k < count; ++k) {
      Link& link = links_[k];
      const Mat3& R = link.placement.R;
      const Vec3& t = link.placement.p;
      double cosine = cosines_[k], sine = sines_[k], shift = 0.0;
      if (link.slides) {
        shift = angles_[k];
        cosine = 1.0;
        sine = 0.0;
      } else if (link.is_circle) {
        cosine = angles_[k];
        sine = q[link.entry + 1];
      }
      // Applying the joint's rotation to its placement first shortens the dependency chain from link to link.
      const Vec3 a = cosine * R.col(0) + sine * R.col(1), b = cosine * R.col(1) - sine * R.col(0), c = R.col(2);
      const Vec3 moved = t + shift * c;
      p += x * moved[0] + y * moved[1] + z * moved[2];
      const Column next_x = x * a[0] + y * a[1] + z * a[2];
      const Column next_y = x * b[0] + y * b[1] + z * b[2];
      z = x * c[0] + y * c[1] + z * c[2];
      x = next_x;
      y = next_y;
      std::memcpy(link.axis, &z, sizeof z);
      std::memcpy(link.origin, &p, sizeof p);
    }
    p += x * tip_.p[0] + y * tip_.p[1] + z * tip_.p[2];
    Placement at;
    at.p = as_vector(p);
    for (int k = 0; k < 3; ++k) at.R.col(k) = as_vector(x * tip_.R(0, k) + y * tip_.R(1, k) + z * tip_.R(2, k));
    return at;
  }

  // The Jacobian of a point that is fixed to the last link, at the configuration of the last forward().
  template <int Rows>
  void jacobian(const Vec3& point, double turn_weight, Eigen::Matrix<double, Rows, Eigen::Dynamic>& J) const {
    for (const Link& link : links_) {
      if (link.column < 0) continue;
      auto column = J.col(link.column);
      const Eigen::Map<const Vec3> axis(link.axis), origin(link.origin);
      column.template head<3>() = link.slides ? Vec3(axis) : Vec3(axis.cross(point - origin));
      if constexpr (Rows == 6) column.template tail<3>() = link.slides ? Vec3(Vec3::Zero()) : Vec3(turn_weight * axis);
    }
  }

 private:
  using Column = double __attribute__((vector_size(32)));  // a column of a matrix with three rows

  static Vec3 as_vector(const Column& column) { return {column[0], column[1], column[2]}; }

  struct Link {
    Placement placement;  // in the previous link
    int entry = 0;  // in q
    bool is_circle = false, slides = false;
    int column = -1;          // of the Jacobian; −1 for a joint that does not move
    double axis[4] = {}, origin[4] = {};  // in the world; the fourth number is unused
  };

  std::vector<Link> links_;
  Placement tip_;
  std::vector<double> angles_, sines_, cosines_;
};

}  // namespace pinik
