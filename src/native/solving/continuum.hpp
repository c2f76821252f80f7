// How many dimensions the set of answers has around one of them; follows pinik.solving.continuum, whose documentation says
// how they are told.
#pragma once

#include <Eigen/SVD>
#include <cmath>
#include <map>
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

  // An answer made as exact as Newton steps can: beside a double place errors of 1e-9 are far from it.
  Vector settled(const Vector& q) {
    if (free_.empty()) return q;
    Vector best = q;
    double last = infinity;
    here_ = q;
    for (int k = 0; k < problem_.constants.continuum_iterations; ++k) {
      at_.q = here_;
      kinematics_.linearize(at_);
      if (!(at_.residual < last)) break;
      best = here_;
      last = at_.residual;
      go_nearer(0);
    }
    return best;
  }

  // An orthonormal basis of the kernel of the Jacobian at an answer, in columns.
  Eigen::MatrixXd kernel(const Vector& q) {
    const Eigen::Index size = static_cast<Eigen::Index>(free_.size());
    return decomposed_at(q) ? svd_.matrixV().rightCols(size - rank(problem_.constants.continuum_singular)) : Eigen::MatrixXd();
  }

  // The number of free coordinates, without those that the limits leave a single value.
  std::size_t free() const { return free_.size(); }

  // The rank of the Jacobian at any configuration: singular values above this part of the largest count.
  Eigen::Index rank_at(const Vector& q, double threshold) { return decomposed_at(q) ? rank(threshold) : 0; }

  // The dimension of the set of answers around one of them, at which the kernel is this one, larger than the dimension
  // that is usual for such a question; 0 if it is isolated.
  int dimension(const Vector& q, const Eigen::MatrixXd& kernel, Eigen::Index usual) {
    const Eigen::Index most = kernel.cols(), least = std::max<Eigen::Index>(usual, 1);
    std::map<Eigen::Index, std::vector<Vector>> ways;  // by the dimension of the kernel beside the answer
    std::map<Eigen::Index, Vector> places;             // one of the answers there
    for (const Vector& direction : directions(most)) {
      for (const Eigen::Index left : {least, most}) {
        const std::optional<Vector> way = beside(q, problem_.constants.continuum_aside * (kernel * direction), left);
        if (way && most == 1) return 1;
        if (way) {
          const Vector found = here_;
          const Eigen::Index left_there = this->kernel(found).cols();
          ways[left_there].push_back(*way);
          places.try_emplace(left_there, found);
        }
        if (least == most) break;
      }
    }
    Eigen::Index largest = usual > 0 && ways.count(usual) ? usual : 0;
    std::vector<Vector> motions;  // single places of a part of the set may have larger kernels than most
    for (auto part = ways.rbegin(); part != ways.rend(); ++part) {
      motions.insert(motions.end(), part->second.begin(), part->second.end());
      largest = std::max(largest, std::min(part->first, spanned(motions)));
    }
    for (auto place = places.rbegin(); place != places.rend(); ++place)  // a very singular answer shows only some of them
      if (place->first > largest && place->first < most)
        largest = std::max<Eigen::Index>(largest, dimension(place->second, this->kernel(place->second), usual));
    return static_cast<int>(largest);
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
    svd_.compute(J, Eigen::ComputeThinU | Eigen::ComputeFullV);
  }

  // Decompose the Jacobian at a configuration; false if there is no free coordinate.
  bool decomposed_at(const Vector& q) {
    if (free_.empty()) return false;
    at_.q = q;
    kinematics_.linearize(at_);
    decompose();
    return true;
  }

  // The number of singular values above a part of the largest.
  Eigen::Index rank(double threshold) const {
    const Vector& sigma = svd_.singularValues();
    return (sigma.array() > threshold * (sigma.size() > 0 ? sigma[0] : 0.0)).count();
  }

  // The dimension of the space that motions beside an answer span.
  Eigen::Index spanned(const std::vector<Vector>& motions) const {
    Eigen::MatrixXd all(motions.front().size(), static_cast<Eigen::Index>(motions.size()));
    for (std::size_t k = 0; k < motions.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = motions[k];
    const Vector sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(all).singularValues();
    return (sigma.array() > 0.3 * problem_.constants.continuum_aside).count();
  }

  // Write the answer near to q after a motion into here_, by Newton steps without the `left` last directions, and
  // return the motion from q to there. None if there is none that is still at least a quarter as far away.
  std::optional<Vector> beside(const Vector& q, const Vector& aside, Eigen::Index left) {
    here_ = q;
    move(here_, aside);
    double last = infinity;
    for (int k = 0; k < problem_.constants.continuum_iterations; ++k) {
      at_.q = here_;
      kinematics_.linearize(at_);
      if (all_within(problem_, at_.errors)) {
        Vector away = difference(q, here_);
        if (away.norm() > 0.25 * problem_.constants.continuum_aside) return away;
        return std::nullopt;
      }
      if (!(at_.residual < last)) return std::nullopt;
      last = at_.residual;
      go_nearer(left);
    }
    return std::nullopt;
  }

  // Make a Newton step from here_, whose linearization is at_, without the `left` last directions.
  void go_nearer(Eigen::Index left) {
    decompose();
    const Eigen::Index seen = rank(problem_.constants.search_rank_threshold);
    const Eigen::Index used = std::min(static_cast<Eigen::Index>(free_.size()) - left, seen);
    const Vector parts =
        (svd_.matrixU().leftCols(used).transpose() * at_.e).cwiseQuotient(svd_.singularValues().head(used));
    move(here_, svd_.matrixV().leftCols(used) * parts);
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
    const int parts = dimension == 2 ? problem_.constants.continuum_parts : problem_.constants.continuum_few_parts;
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
