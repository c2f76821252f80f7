// One step of any method: clamped, scaled, and redirected along the limits that it meets; follows
// pinik.solving.stepping.
#pragma once

#include "../solvers/directions.hpp"
#include "../solvers/sweep.hpp"

namespace pinik {

template <int Rows>
class Stepping {
 public:
  Stepping(const Solver& solver, Kinematics<Rows>& kinematics)
      : solver_(solver), kinematics_(kinematics), directions_(solver, kinematics.problem), sweep_(solver, kinematics) {}

  // Set the part of the distance that sets the damping, and whether a target is proved out of reach.
  void damp_by(double part, bool beyond) {
    directions_.part_of_distance = part;
    directions_.beyond = beyond;
  }

  // Write the configuration after the next step into `q`. Returns how many joints a sweep updated.
  int advance(const Linearization<Rows>& from, const Limits& limits, double scale, Vector& q) {
    if (solver_.sweeps()) {
      q = from.q;
      const int updates = sweep_(q, limits);
      if (!q.allFinite()) q = from.q;
      limits.clip(q);
      return updates;
    }
    const Linearization<Rows>* at = &from;
    if (solver_.max_residual < infinity) {
      shortened_ = from;
      shorten(shortened_.e);
      at = &shortened_;
    }
    held_.assign(kinematics_.problem.coordinates.size(), 0);
    step(*at, scale, q);
    if (!limits.enabled) return 0;
    inside_ = q;
    limits.clip(inside_);
    if (inside_ != q) along_limits(*at, limits, scale, q);
    return 0;
  }

 private:
  const Solver& solver_;
  Kinematics<Rows>& kinematics_;
  Directions<Rows> directions_;
  Sweep<Rows> sweep_;
  Linearization<Rows> shortened_, free_;
  std::vector<char> held_;
  Vector dq_, inside_;

  void step(const Linearization<Rows>& at, double scale, Vector& q) {
    const Problem& problem = kinematics_.problem;
    q = at.q;
    if (!std::isfinite(at.residual) || at.J.cols() == 0) return;  // no step; the loop will report that it stalled
    directions_.step(at, held_, dq_);
    if (!dq_.allFinite()) return;
    for (std::size_t c = 0; c < held_.size(); ++c)
      if (held_[c]) dq_[static_cast<Eigen::Index>(c)] = 0.0;
    const double largest = dq_.cwiseAbs().maxCoeff();
    scale *= solver_.step_size;
    if (std::min(largest, solver_.max_step) * scale > problem.constants.farthest) return;
    if (largest > solver_.max_step) scale *= solver_.max_step / largest;
    if (scale != 1.0) dq_ *= scale;
    if (problem.is_plain) {
      for (std::size_t c = 0; c < held_.size(); ++c) q[problem.coordinates[c].entry] += dq_[static_cast<Eigen::Index>(c)];
      return;
    }
    integrate(problem, dq_, q);
  }

  // Repeat the step after the first attempt `q` left the limits. Joints that are at a limit and would move further out
  // are held, so that the others take over their part, until no joint needs to be held; the rest is clipped.
  void along_limits(const Linearization<Rows>& at, const Limits& limits, double scale, Vector& q) {
    const Problem& problem = kinematics_.problem;
    for (;;) {
      inside_ = q;
      limits.clip(inside_);
      bool pushes = false;
      for (std::size_t c = 0; c < held_.size(); ++c) {
        const int entry = problem.coordinates[c].entry;
        if (entry < 0 || held_[c]) continue;
        if (inside_[entry] != q[entry] && inside_[entry] == at.q[entry]) held_[c] = pushes = true;
      }
      if (!pushes) break;
      free_ = at;
      for (std::size_t c = 0; c < held_.size(); ++c)
        if (held_[c]) free_.J.col(static_cast<Eigen::Index>(c)).setZero();
      step(free_, scale, q);
    }
    q = inside_;
  }

  // Shorten the position part of each target to D_max without changing its direction (ClampMag of the thesis).
  void shorten(Eigen::Matrix<double, Rows, 1>& e) const {
    for (const Term& term : kinematics_.problem.terms)
      if (term.asks_position) {
        auto part = e.template segment<3>(term.row);
        const double length = part.norm() / term.weight;
        if (length > solver_.max_residual) part *= solver_.max_residual / length;
      }
  }
};

}  // namespace pinik
