// One step of a Jacobian method from residual and Jacobian; follows pinik.solvers.transpose, pseudo_inverse and
// damped_least_squares.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "../problem/kinematics.hpp"
#include "normal_equations.hpp"
#include "solver.hpp"

namespace pinik {

// The steps of the three Jacobian methods, with the working memory of one thread.
template <int Rows>
class Directions {
  using Residual = Eigen::Matrix<double, Rows, 1>;
  using Square = Eigen::Matrix<double, Rows, Rows>;
  using Jacobian = Eigen::Matrix<double, Rows, Eigen::Dynamic>;

 public:
  Directions(const Solver& solver, const Problem& problem) : solver_(solver), problem_(problem) {}

  double part_of_distance = 1.0;  // the part of the distance that sets the damping
  bool beyond = false;            // whether a target is proved out of reach, which increases the damping

  // The step dq of the free coordinates. The columns of `held` ones are zero in `at.J`; `at.distance` sets the damping.
  void step(const Linearization<Rows>& at, const std::vector<char>& held, Vector& dq) {
    if (solver_.stiffness.empty()) return unweighted(at, held, dq);
    weighted_ = at;
    for (Eigen::Index c = 0; c < at.J.cols(); ++c) weighted_.J.col(c) *= root(c);
    unweighted(weighted_, held, dq);
    for (Eigen::Index c = 0; c < at.J.cols(); ++c) dq[c] *= root(c);
  }

 private:
  const Solver& solver_;
  const Problem& problem_;
  Square A_;
  Linearization<Rows> weighted_;

  // The square root of a coordinate's stiffness weight.
  double root(Eigen::Index c) const { return std::sqrt(solver_.stiffness[static_cast<std::size_t>(c)]); }

  void unweighted(const Linearization<Rows>& at, const std::vector<char>& held, Vector& dq) {
    switch (solver_.method) {
      case Method::transpose:
        return transpose(at, dq);
      case Method::pseudo_inverse:
        return pseudo_inverse(at, held, dq);
      case Method::damped_least_squares:
        return damped_least_squares(at, dq);
      case Method::ccd:
        return;  // sweeps instead
    }
  }

  void transpose(const Linearization<Rows>& at, Vector& dq) const {
    dq.noalias() = at.J.transpose() * at.e;
    if (solver_.alpha > 0.0) {
      dq *= solver_.alpha;
      return;
    }
    const Residual JJte = at.J * dq;
    const double squared = JJte.squaredNorm();
    if (squared > 0.0)
      dq *= at.e.dot(JJte) / squared;
    else
      dq.setZero();
  }

  void damped_least_squares(const Linearization<Rows>& at, Vector& dq) {
    const double damping_squared = this->damping_squared(at);
    if (!solver_.by_svd) return damp(at.J, at.e, damping_squared, A_, dq);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(at.J, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const auto& sigma = svd.singularValues();
    const Vector part =
        sigma.array() / (sigma.array().square() + damping_squared) * (svd.matrixU().transpose() * at.e).array();
    dq.noalias() = svd.matrixV() * part;
  }

  double damping_squared(const Linearization<Rows>& at) {
    const double least = problem_.constants.part_of_chain * problem_.size_of_chain;
    const double distance =
        beyond ? std::sqrt(at.distance * std::max(at.distance, least)) : part_of_distance * at.distance;
    double squared = solver_.damping * solver_.damping;
    if (solver_.rule == DampingRule::residual) {
      squared *= distance * distance;
    } else if (solver_.rule == DampingRule::sugihara) {
      squared += 0.5 * distance * distance;
    } else if (solver_.rule == DampingRule::manipulability) {
      square(at.J, A_);
      const Square full = A_.template selfadjointView<Eigen::Lower>();
      const double w = std::sqrt(std::max(full.partialPivLu().determinant(), 0.0));
      const double missing = std::max(0.0, 1.0 - w / solver_.manipulability);
      squared *= missing * missing;
    }
    return squared + problem_.constants.smallest_damping_squared * at.J.squaredNorm();
  }

  void pseudo_inverse(const Linearization<Rows>& at, const std::vector<char>& held, Vector& dq) {
    const bool pulls = !solver_.rest_posture.empty();
    if (!pulls && well_conditioned(at)) {
      dq.noalias() = at.J.transpose() * solve_definite<Rows>(A_, at.e);
      return;
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(at.J, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const auto& sigma = svd.singularValues();
    const double largest = sigma.size() ? sigma[0] : 0.0;
    const double threshold =
        std::max(solver_.cutoff * problem_.lightest, problem_.constants.smallest_cutoff) * largest;
    const Eigen::Index rank = (sigma.array() > threshold).count();
    const auto basis = svd.matrixV().leftCols(rank);
    dq = basis * ((svd.matrixU().leftCols(rank).transpose() * at.e).array() / sigma.head(rank).array()).matrix();
    if (pulls) {
      const Vector pull = rest_pull(at.q, held);
      dq += pull - basis * (basis.transpose() * pull);
    }
  }

  // Whether all singular values are far above the threshold, so that J† = Jᵀ(JJᵀ)⁻¹ (thesis, eq. 3.2.5). Leaves JJᵀ in
  // A_. The bounds used are σ₁² ≤ trace JJᵀ and σₘ² ≥ 1 / trace (JJᵀ)⁻¹.
  bool well_conditioned(const Linearization<Rows>& at) {
    if constexpr (Rows == Eigen::Dynamic) {
      return false;
    } else {
      if (at.J.cols() < Rows) return false;
      square(at.J, A_);
      const Square full = A_.template selfadjointView<Eigen::Lower>();
      const Eigen::LLT<Square> factor(full);
      if (factor.info() != Eigen::Success) return false;
      const double least = 1.0 / factor.solve(Square::Identity()).trace();
      const double ratio = std::max(2.0 * solver_.cutoff * problem_.lightest, worst_condition);
      return least > ratio * ratio * full.trace();
    }
  }

  // JJᵀ squares the condition number; a worse one would cost the step more than nine digits.
  static constexpr double worst_condition = 2e-3;

  Vector rest_pull(const Vector& q, const std::vector<char>& held) const {
    Vector pull = Vector::Zero(static_cast<Eigen::Index>(problem_.coordinates.size()));
    for (std::size_t c = 0; c < problem_.coordinates.size(); ++c)
      for (const auto& [index, angle] : solver_.rest_posture)
        if (problem_.coordinates[c].joint == index && !held[c]) {
          const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(index)];
          const double* own = q.data() + joint.idx_q;
          double left = angle - own[0];
          if (joint.nq == 2) {
            left = angle - std::atan2(own[1], own[0]);
            left = std::remainder(left, 2.0 * M_PI);
          }
          pull[static_cast<Eigen::Index>(c)] = solver_.rest_gain * left;
          if (!solver_.stiffness.empty()) pull[static_cast<Eigen::Index>(c)] *= root(static_cast<Eigen::Index>(c));
        }
    return pull;
  }
};

}  // namespace pinik
