// The damped normal equations, for 3 rows, 6 rows and any number of rows.
#pragma once

#include <Eigen/Cholesky>

#include "../model/fast.hpp"
#include "../model/spatial.hpp"

namespace pinik {

// Solve A x = b for a symmetric, positive definite A. Only the lower triangle of A is read; it is overwritten.
template <int Rows>
Eigen::Matrix<double, Rows, 1> solve_definite(Eigen::Matrix<double, Rows, Rows>& A, Eigen::Matrix<double, Rows, 1> x) {
  if constexpr (Rows == Eigen::Dynamic) {
    return A.template selfadjointView<Eigen::Lower>().ldlt().solve(x);
  } else {
    // LDLᵀ without pivoting, applied to the right-hand side in the same pass. Unrolled, everything stays in registers.
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

// The lower triangle of JJᵀ.
inline void square(const Eigen::Matrix<double, 6, Eigen::Dynamic>& J, Eigen::Matrix<double, 6, 6>& A) {
  // Two rows at a time, with all sums in registers.
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

// dq = Jᵀ(JJᵀ + λ²I)⁻¹e (thesis, eq. 3.2.9).
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

}  // namespace pinik
