// Cyclic coordinate descent: one pass over the joints; follows pinik.solvers.ccd.
#pragma once

#include "../model/limits.hpp"
#include "chaser.hpp"
#include "solver.hpp"

namespace pinik {

template <int Rows>
class Sweep {
 public:
  Sweep(const Solver& solver, Kinematics<Rows>& kinematics)
      : solver_(solver), kinematics_(kinematics), constants_(kinematics.problem.constants) {}

  // One pass from the tip to the base, in place. Returns how many joints were updated.
  int operator()(Vector& q, const Limits& limits) {
    const Problem& problem = kinematics_.problem;
    look(q);
    const double relaxation = kinematics_.loose ? solver_.loose_relaxation : solver_.relaxation;
    int updates = 0;
    for (std::size_t c = 0; c < problem.coordinates.size(); ++c) {
      const Coordinate& coordinate = problem.coordinates[c];
      if (all_within()) break;
      ++updates;
      const double part = solver_.stiffness.empty() ? 1.0 : solver_.stiffness[c];
      if (coordinate.movers.size() > 1) {
        advance(coordinate, downhill_change(c, q, limits, part), q, limits);
        look(q);
        continue;
      }
      const int mover = coordinate.movers.front().joint;
      const Placement& joint = kinematics_.world[static_cast<std::size_t>(mover)];
      const Vec3 axis = joint.R.col(problem.axis_of(mover, coordinate.index)), origin = joint.p;
      const double change = best_change(coordinate, axis, origin, q, limits, part * relaxation);
      advance(coordinate, change, q, limits);
      if (problem.mechanism->joints[static_cast<std::size_t>(coordinate.joint)].nv == 1)
        carry(coordinate, axis, origin, change);
      else
        look(q);  // this also turned the axes of the joint's other coordinates
    }
    return updates;
  }

 private:
  const Solver& solver_;
  Kinematics<Rows>& kinematics_;
  const Constants& constants_;
  std::vector<Chaser> chasers_;
  Linearization<Rows> at_;

  void look(const Vector& q) {
    kinematics_.forward(q);
    const double size = kinematics_.problem.size_of_chain;
    const double alpha = solver_.position_weight / (solver_.printed_scaling ? size : size * size);
    chasers_.clear();
    for (std::size_t t = 0; t < kinematics_.problem.terms.size(); ++t)
      chasers_.emplace_back(kinematics_, t, alpha, solver_.max_residual);
  }

  bool all_within() const {
    for (const Chaser& chaser : chasers_)
      if (!chaser.within()) return false;
    return true;
  }

  // How far a coordinate may decrease and increase.
  static std::pair<double, double> room(const Coordinate& coordinate, const Vector& q, const Limits& limits) {
    if (coordinate.entry < 0 || !limits.enabled) return {-infinity, infinity};
    const double value = q[coordinate.entry];
    return {std::min(limits.lower[coordinate.entry] - value, 0.0), std::max(limits.upper[coordinate.entry] - value, 0.0)};
  }

  void advance(const Coordinate& coordinate, double change, Vector& q, const Limits& limits) const {
    const Mechanism& mechanism = *kinematics_.problem.mechanism;
    const Joint& joint = mechanism.joints[static_cast<std::size_t>(coordinate.joint)];
    double step[6] = {};
    step[coordinate.index] = change;
    mechanism.integrate(joint, q.data(), step);
    if (joint.nq == 1 && limits.enabled)
      q[joint.idx_q] = std::min(std::max(q[joint.idx_q], limits.lower[joint.idx_q]), limits.upper[joint.idx_q]);
  }

  // The exact solution of the problem in this one coordinate, scaled and clamped to its limits.
  double best_change(const Coordinate& coordinate, const Vec3& axis, const Vec3& origin, const Vector& q,
                     const Limits& limits, double scale) const {
    const auto [mover, multiplier] = coordinate.movers.front();
    auto [low, high] = room(coordinate, q, limits);
    if (multiplier != 1.0) {
      low *= multiplier;
      high *= multiplier;
      if (low > high) std::swap(low, high);
    }
    double change;
    if (coordinate.slides) {
      change = std::min(std::max(best_slide(mover, axis, origin), low), high);
    } else {
      Mat3 M = Mat3::Zero();
      for (const Chaser& chaser : chasers_)
        if (chaser.moved_by(mover)) M += chaser.correlation(mover, origin);
      Turning g = turning(M, axis);
      if (g.cosine * g.cosine + g.sine * g.sine <= constants_.ccd_suspect * constants_.ccd_suspect * g.along * g.along)
        g = measured_across(mover, axis, origin);
      change = best_turn(g, low, high, scale < 1.0 || solver_.max_step < M_PI);
      // A turn the long way round must not overshoot its goal.
      if (scale > 1.0 && std::abs(change) > M_PI) scale = 1.0;
    }
    change = std::min(std::max(scale * change, low), high) / multiplier;
    return std::min(std::max(change, -solver_.max_step), solver_.max_step);
  }

  // Σ w (d − c)·a / Σ w over the pairs that the joint changes; for one pair Welman's eq. 4.24.
  double best_slide(int joint, const Vec3& axis, const Vec3& origin) const {
    double pull = 0.0, weight = 0.0;
    for (const Chaser& chaser : chasers_) {
      if (!chaser.moved_by(joint)) continue;
      const double sign = chaser.moves_frame(joint) ? 1.0 : -1.0;
      chaser.for_each_pair(origin, [&](const Vec3& c, const Vec3& d, double w) {
        pull += sign * chaser.weight * w * (d - c).dot(axis);
        weight += chaser.weight * w;
      });
    }
    return weight > 0.0 ? pull / weight : 0.0;
  }

  // k₂ − k₁ and k₃ of g (Welman's eq. 4.19), and the size of the terms that were subtracted.
  struct Turning {
    double cosine, sine, along;
  };

  // For M = Σ w c dᵀ.
  static Turning turning(const Mat3& M, const Vec3& axis) {
    const double k1 = axis.dot(M * axis), k2 = M.trace();
    const double k3 = axis.dot(Vec3(M(1, 2) - M(2, 1), M(2, 0) - M(0, 2), M(0, 1) - M(1, 0)));
    return {k2 - k1, k3, std::abs(k1) + std::abs(k2)};
  }

  // The same without subtracting large numbers. Returns zero where the result could be rounding alone, which happens when
  // the effector lies on the joint's axis, or when the axis to be turned is the joint's axis.
  Turning measured_across(int joint, const Vec3& axis, const Vec3& origin) const {
    Chaser::Across sum;
    for (const Chaser& chaser : chasers_) {
      if (!chaser.moved_by(joint)) continue;
      const Chaser::Across own = chaser.across(joint, axis, origin);
      sum.cosine += own.cosine;
      sum.sine += own.sine;
      sum.blur += own.blur;
    }
    if (std::hypot(sum.cosine, sum.sine) <= constants_.ccd_rounding * sum.blur) return {0.0, 0.0, 0.0};
    return {sum.cosine, sum.sine, 0.0};
  }

  // The φ in [low, high] that maximises cosine · cos φ + sine · sin φ.
  static double best_turn(const Turning& g, double low, double high, bool shortest) {
    if (g.cosine == 0.0 && g.sine == 0.0) return 0.0;
    const double best = std::atan2(g.sine, g.cosine);
    if (low <= best && best <= high) return best;
    if (shortest) return std::min(std::max(best, low), high);
    for (double other : {best - 2.0 * M_PI, best + 2.0 * M_PI})
      if (low <= other && other <= high) return other;
    double chosen = 0.0, most = -infinity;
    for (double end : {low, 0.0, high})
      if (std::isfinite(end) && std::cos(end - best) > most) {
        most = std::cos(end - best);
        chosen = end;
      }
    return chosen;
  }

  void carry(const Coordinate& coordinate, const Vec3& axis, const Vec3& origin, double change) {
    const auto [mover, multiplier] = coordinate.movers.front();
    const double amount = change * multiplier;
    if (coordinate.slides) {
      for (Chaser& chaser : chasers_) chaser.carry(mover, origin, nullptr, axis * amount);
    } else {
      const Mat3 R = rotation_about(axis, amount);
      for (Chaser& chaser : chasers_) chaser.carry(mover, origin, &R, Vec3::Zero());
    }
  }

  // A change that reduces the residual, for a leader whose followers move the targets as well. It turns about several
  // axes at once, so there is no closed form; a Gauss-Newton step along its column is halved until the residual falls.
  double downhill_change(std::size_t c, const Vector& q, const Limits& limits, double part) {
    const Coordinate& coordinate = kinematics_.problem.coordinates[c];
    at_.q = q;
    kinematics_.linearize(at_);
    const auto column = at_.J.col(static_cast<Eigen::Index>(c));
    const double squared = column.squaredNorm();
    const Problem& problem = kinematics_.problem;
    const double least = constants_.ccd_no_column * problem.lightest * problem.size_of_chain;
    if (squared <= least * least) return 0.0;  // the motion of its followers cancels it
    const auto [low, high] = room(coordinate, q, limits);
    const double wanted = part * column.dot(at_.e) / squared;
    double change = std::min({std::max({wanted, low, -solver_.max_step}), high, solver_.max_step});
    const double before = at_.e.squaredNorm();
    for (int k = 0; k < constants_.ccd_halvings; ++k) {
      at_.q = q;
      advance(coordinate, change, at_.q, limits);
      kinematics_.linearize(at_);
      if (at_.e.squaredNorm() < before) return change;
      change /= 2.0;
    }
    return 0.0;
  }
};

}  // namespace pinik
