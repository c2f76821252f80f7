// The four methods' parameters, and the steps of the three that take one from Jacobian and residual.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "kinematics.hpp"

namespace pinik {

enum class Method { ccd, transpose, pseudo_inverse, damped_least_squares };
enum class DampingRule { constant, residual, sugihara, manipulability };

struct Patience {
  int iterations = 5;
  double progress = 0.05;
};

// The fields of pinik's solver dataclasses, all methods' together; each method reads its own.
struct Solver {
  Method method = Method::damped_least_squares;
  double max_step = infinity, max_residual = infinity;
  double step_size = 1.0;
  bool target_jacobian = false;
  double alpha = 0.0;  // of the transpose; 0 takes the optimal one
  double cutoff = 1e-3, rest_gain = 0.1;
  std::vector<std::pair<int, double>> rest_posture;  // joint, angle
  double damping = std::sqrt(0.5), manipulability = 0.05;
  DampingRule rule = DampingRule::residual;
  bool by_svd = false;
  std::vector<double> stiffness;  // by coordinate
  double relaxation = 1.0, position_weight = 15.0;
  bool printed_scaling = false;

  bool sweeps() const { return method == Method::ccd; }
};

// A miss that stays is damped as if it were this part of the chain's length, in the geometric mean.
constexpr double of_the_chain = 0.5;

// λ² keeps JJᵀ + λ²I positive definite where rows depend on each other and the damping has faded.
constexpr double smallest_damping_squared = 1e-15;

// The system A x = b for a symmetric, positive definite A, of which the lower triangle is read and overwritten.
template <int Rows>
Eigen::Matrix<double, Rows, 1> solve_definite(Eigen::Matrix<double, Rows, Rows>& A, Eigen::Matrix<double, Rows, 1> x) {
  if constexpr (Rows == Eigen::Dynamic) {
    return A.template selfadjointView<Eigen::Lower>().ldlt().solve(x);
  } else {
    // LDLᵀ without pivoting, the right-hand side eliminated along with the columns; unrolled, it stays in registers.
    double inverse[Rows];
#pragma GCC unroll 8
    for (int j = 0; j < Rows; ++j) {
      inverse[j] = 1.0 / A(j, j);
      double column[Rows];
#pragma GCC unroll 8
      for (int i = j + 1; i < Rows; ++i) {
        column[i] = A(i, j);
        A(i, j) *= inverse[j];
      }
#pragma GCC unroll 8
      for (int k = j + 1; k < Rows; ++k) {
        x[k] -= A(k, j) * x[j];
#pragma GCC unroll 8
        for (int i = k; i < Rows; ++i) A(i, k) -= A(i, j) * column[k];
      }
    }
#pragma GCC unroll 8
    for (int i = 0; i < Rows; ++i) x[i] *= inverse[i];
#pragma GCC unroll 8
    for (int k = Rows - 1; k > 0; --k)
#pragma GCC unroll 8
      for (int i = 0; i < k; ++i) x[i] -= A(k, i) * x[k];
    return x;
  }
}

// JJᵀ, its lower triangle.
inline void square(const Eigen::Matrix<double, 6, Eigen::Dynamic>& J, Eigen::Matrix<double, 6, 6>& A) {
  // Two rows at a time, all sums in registers.
  using Pair = Eigen::Array2d;
  Pair sums[6][3];
  for (auto& row : sums)
    for (Pair& sum : row) sum.setZero();
  for (Eigen::Index c = 0; c < J.cols(); ++c) {
    const double* column = J.data() + 6 * c;
    const Pair pairs[3] = {Eigen::Map<const Pair>(column), Eigen::Map<const Pair>(column + 2),
                           Eigen::Map<const Pair>(column + 4)};
#pragma GCC unroll 8
    for (int j = 0; j < 6; ++j)
#pragma GCC unroll 8
      for (int r = j / 2; r < 3; ++r) sums[j][r] += column[j] * pairs[r];
  }
#pragma GCC unroll 8
  for (int j = 0; j < 6; ++j)
#pragma GCC unroll 8
    for (int r = j / 2; r < 3; ++r) A.block<2, 1>(2 * r, j) = sums[j][r].matrix();
}

inline void square(const Eigen::Matrix<double, 3, Eigen::Dynamic>& J, Eigen::Matrix3d& A) {
  A.setZero();
  for (Eigen::Index c = 0; c < J.cols(); ++c) A += J.col(c) * J.col(c).transpose();
}

inline void square(const Eigen::MatrixXd& J, Eigen::MatrixXd& A) {
  A.setZero(J.rows(), J.rows());
  A.selfadjointView<Eigen::Lower>().rankUpdate(J);
}

// Jᵀ(JJᵀ + λ²I)⁻¹e (thesis, eq. 3.2.9).
template <int Rows>
inline void damped_step(const Eigen::Matrix<double, Rows, Eigen::Dynamic>& J, const Eigen::Matrix<double, Rows, 1>& e,
                        double damping_squared, Eigen::Matrix<double, Rows, Rows>& A, Vector& dq) {
  square(J, A);
  A.diagonal().array() += damping_squared;
  const Eigen::Matrix<double, Rows, 1> x = solve_definite<Rows>(A, e);
  dq.resize(J.cols());
  for (Eigen::Index c = 0; c < J.cols(); ++c) dq[c] = J.col(c).dot(x);
}

PINIK_FAST static void damp(const Eigen::Matrix<double, 3, Eigen::Dynamic>& J, const Eigen::Vector3d& e,
                            double damping_squared, Eigen::Matrix3d& A, Vector& dq) {
  damped_step<3>(J, e, damping_squared, A, dq);
}

PINIK_FAST static void damp(const Eigen::Matrix<double, 6, Eigen::Dynamic>& J, const Eigen::Matrix<double, 6, 1>& e,
                            double damping_squared, Eigen::Matrix<double, 6, 6>& A, Vector& dq) {
  damped_step<6>(J, e, damping_squared, A, dq);
}

inline void damp(const Eigen::MatrixXd& J, const Vector& e, double damping_squared, Eigen::MatrixXd& A, Vector& dq) {
  damped_step<Eigen::Dynamic>(J, e, damping_squared, A, dq);
}

// Steps of the Jacobian methods, after pinik.solvers; holds the working memory of one thread.
template <int Rows>
class Directions {
  using Residual = Eigen::Matrix<double, Rows, 1>;
  using Square = Eigen::Matrix<double, Rows, Rows>;
  using Jacobian = Eigen::Matrix<double, Rows, Eigen::Dynamic>;

 public:
  Directions(const Solver& solver, const Problem& problem) : solver_(solver), problem_(problem) {}

  double share_of_distance = 1.0;  // that damping goes by
  bool beyond = false;             // whether a target is proved out of reach, where damping goes by more

  // dq of the free coordinates, those held left out; `at.e` is what is pulled by, `at.distance` what damps.
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

  // √w of a coordinate.
  double root(Eigen::Index c) const { return std::sqrt(solver_.stiffness[static_cast<std::size_t>(c)]); }

  void unweighted(const Linearization<Rows>& at, const std::vector<char>& held, Vector& dq) {
    switch (solver_.method) {
      case Method::transpose:
        return transpose(at, dq);
      case Method::pseudo_inverse:
        return pseudo_inverse(at, held, dq);
      default:
        return damped_least_squares(at, dq);
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
    const double distance = beyond ? std::sqrt(at.distance * std::max(at.distance, of_the_chain * problem_.size_of_chain))
                                   : share_of_distance * at.distance;
    double squared = solver_.damping * solver_.damping;
    if (solver_.rule == DampingRule::residual) {
      squared *= distance * distance;
    } else if (solver_.rule == DampingRule::sugihara) {
      squared += 0.5 * distance * distance;
    } else if (solver_.rule == DampingRule::manipulability) {
      square(at.J, A_);
      const Square full = A_.template selfadjointView<Eigen::Lower>();
      const double w = std::sqrt(std::max(full.determinant(), 0.0));
      const double missing = std::max(0.0, 1.0 - w / solver_.manipulability);
      squared *= missing * missing;
    }
    return squared + smallest_damping_squared;
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
    const double threshold = std::max(solver_.cutoff * problem_.lightest * largest, 1e-12);
    const Eigen::Index rank = (sigma.array() > threshold).count();
    const auto basis = svd.matrixV().leftCols(rank);
    dq = basis * ((svd.matrixU().leftCols(rank).transpose() * at.e).array() / sigma.head(rank).array()).matrix();
    if (pulls) {
      const Vector pull = rest_pull(at.q, held);
      dq += pull - basis * (basis.transpose() * pull);
    }
  }

  // Whether no singular value can lie near the threshold, so that J† = Jᵀ(JJᵀ)⁻¹ (thesis, eq. 3.2.5); leaves JJᵀ in A_.
  // σ₁² ≤ trace JJᵀ, and σₘ² ≥ 1 / trace (JJᵀ)⁻¹.
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

  // Squared by JJᵀ, a worse condition would cost the step more than nine digits.
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
