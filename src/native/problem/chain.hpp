// A fast path for the most common problem: one frame at the end of a chain of one-axis joints without mimic joints.
#pragma once

#include <cstring>
#include <vector>

#include "../model/axes.hpp"
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
    Axes at;
    for (int k = 0; k < count; ++k) {
      Link& link = links_[k];
      double cosine = cosines_[k], sine = sines_[k], shift = 0.0;
      if (link.slides) {
        shift = angles_[k];
        cosine = 1.0;
        sine = 0.0;
      } else if (link.is_circle) {
        cosine = angles_[k];
        sine = q[link.entry + 1];
      }
      at.go_to(link.placement, shift, cosine, sine);
      std::memcpy(link.axis, &at.z, sizeof at.z);
      std::memcpy(link.origin, &at.p, sizeof at.p);
    }
    at.go_to(tip_);
    return at.placement();
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
