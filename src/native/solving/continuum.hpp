// Whether an answer belongs to a continuum, although answers to such a question are usually isolated; follows
// pinik.solving.continuum, whose documentation says how the two are told apart.
#pragma once

#include <Eigen/SVD>
#include <cmath>
#include <optional>
#include <vector>

#include "../model/limits.hpp"
#include "../problem/kinematics.hpp"
#include "metric.hpp"

namespace pinik {

// Finds the dimension of the set of answers around one of them, for the free coordinates of one problem, whose tolerances
// tell what reaches the targets. Motions and kernels are in the joint metric.
template <int Rows>
class Continuum {
 public:
  Continuum(Kinematics<Rows>& kinematics, const Limits& limits)
      : kinematics_(kinematics), problem_(kinematics.problem), scales_(joint_scales(kinematics.problem)) {
    for (std::size_t c = 0; c < problem_.coordinates.size(); ++c) {
      const int entry = problem_.coordinates[c].entry;
      if (entry < 0 || limits.lower[entry] < limits.upper[entry]) free_.push_back(static_cast<Eigen::Index>(c));
    }
  }

  // An orthonormal basis of the kernel of the Jacobian at an answer, in columns.
  Eigen::MatrixXd kernel(const Vector& q) {
    if (free_.empty()) return Eigen::MatrixXd();
    at_.q = q;
    kinematics_.linearize(at_);
    decompose();
    const Vector& sigma = svd_.singularValues();
    const double least = problem_.constants.continuum_singular * (sigma.size() > 0 ? sigma[0] : 0.0);
    const Eigen::Index rank = (sigma.array() > least).count();
    return svd_.matrixV().rightCols(sigma.size() - rank);
  }

  // The dimension of the set of answers around one of them with this kernel; 0 if it is isolated.
  int dimension(const Vector& q, const Eigen::MatrixXd& kernel) {
    const Eigen::Index most = kernel.cols();
    Eigen::Index least = most;
    std::vector<Vector> ways;
    for (const Vector& direction : directions(most)) {
      for (Eigen::Index left : {Eigen::Index{1}, most}) {
        const std::optional<Vector> way = beside(q, problem_.constants.continuum_aside * (kernel * direction), left);
        if (way) {
          if (most == 1) return 1;
          ways.push_back(*way);
          least = std::min(least, this->kernel(Vector(here_)).cols());
        }
        if (most == 1) break;
      }
    }
    if (ways.empty()) return 0;
    Eigen::MatrixXd spanned(ways.front().size(), static_cast<Eigen::Index>(ways.size()));
    for (std::size_t k = 0; k < ways.size(); ++k) spanned.col(static_cast<Eigen::Index>(k)) = ways[k];
    const Vector sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(spanned).singularValues();
    const Eigen::Index rank = (sigma.array() > 0.3 * problem_.constants.continuum_aside).count();
    return static_cast<int>(std::max<Eigen::Index>(1, std::min(rank, least)));
  }

 private:
  Kinematics<Rows>& kinematics_;
  const Problem& problem_;
  const std::vector<double> scales_;  // by coordinate
  std::vector<Eigen::Index> free_;    // the coordinates that the limits leave more than one value
  Linearization<Rows> at_;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd_;
  Vector here_;

  void decompose() {
    Eigen::MatrixXd J(at_.J.rows(), static_cast<Eigen::Index>(free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k)
      J.col(static_cast<Eigen::Index>(k)) = at_.J.col(free_[k]) / scales_[static_cast<std::size_t>(free_[k])];
    svd_.compute(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
  }

  // Write the answer near to q after a motion into here_, by Newton steps without the `left` smallest singular values, and
  // return the motion from q to there. None if there is none that is still at least half as far away.
  std::optional<Vector> beside(const Vector& q, const Vector& aside, Eigen::Index left) {
    here_ = q;
    move(here_, aside);
    double last = infinity;
    for (int k = 0; k < problem_.constants.continuum_iterations; ++k) {
      at_.q = here_;
      kinematics_.linearize(at_);
      if (all_within(problem_, at_.errors)) {
        Vector away = difference(q, here_);
        if (away.norm() > 0.5 * problem_.constants.continuum_aside) return away;
        return std::nullopt;
      }
      if (!(at_.residual < last)) return std::nullopt;
      last = at_.residual;
      decompose();
      const Vector& sigma = svd_.singularValues();
      const Eigen::Index rank = sigma.size() - left;
      if (!(sigma.head(rank).array() > 0.0).all()) return std::nullopt;
      const Vector parts = (svd_.matrixU().leftCols(rank).transpose() * at_.e).cwiseQuotient(sigma.head(rank));
      move(here_, svd_.matrixV().leftCols(rank) * parts);
    }
    return std::nullopt;
  }

  void move(Vector& q, const Vector& step) const {
    Vector dq = Vector::Zero(static_cast<Eigen::Index>(scales_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k)
      dq[free_[k]] = step[static_cast<Eigen::Index>(k)] / scales_[static_cast<std::size_t>(free_[k])];
    integrate(problem_, dq, q);
  }

  Vector difference(const Vector& a, const Vector& b) const {
    Vector all = Vector::Zero(static_cast<Eigen::Index>(scales_.size()));
    each_change(problem_, a, b, [&](double change, std::size_t c) { all[static_cast<Eigen::Index>(c)] = change * scales_[c]; });
    Vector away(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k) away[static_cast<Eigen::Index>(k)] = all[free_[k]];
    return away;
  }

  // Unit directions in a space of some dimensions: both along each axis, and more in the plane of each two.
  std::vector<Vector> directions(Eigen::Index dimension) const {
    const Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(dimension, dimension);
    const int parts = problem_.constants.continuum_parts;
    std::vector<Vector> found;
    for (Eigen::Index a = 0; a < dimension; ++a)
      for (double sign : {1.0, -1.0}) found.push_back(sign * axes.col(a));
    for (Eigen::Index a = 0; a < dimension; ++a)
      for (Eigen::Index b = a + 1; b < dimension; ++b)
        for (int k = 0; k < 2 * parts; ++k) {
          const double turn = M_PI * k / parts;
          found.push_back(std::cos(turn) * axes.col(a) + std::sin(turn) * axes.col(b));
        }
    return found;
  }
};

}  // namespace pinik
