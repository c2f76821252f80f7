// Where attempts begin: numbers that depend only on seed, target and attempt; follows pinik.solving.starts.
#pragma once

#include <cstdint>

#include "../model/limits.hpp"
#include "../problem/kinematics.hpp"

namespace pinik {

// The number in [0, 1) that belongs to these four keys, by SplitMix64 (Steele, Lea and Flood 2014).
inline double uniform(std::uint64_t seed, std::uint64_t target, std::uint64_t attempt, std::uint64_t index) {
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ull;
  std::uint64_t z = seed;
  for (std::uint64_t key : {target, attempt, index}) {
    z += golden * (key + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-53;
}

// The range from which a joint's value is drawn, as in pinik.model.joint.Joint.range_to_draw_from.
inline std::pair<double, double> range_to_draw_from(const Joint& joint, double lower, double upper, double slide_about,
                                                    double widest) {
  if (upper - lower <= widest) return {lower, upper};
  const double half = joint.slides() ? 1.0 : M_PI;
  const double middle = std::min(std::max(joint.slides() ? slide_about : 0.0, lower + half), upper - half);
  return {middle - half, middle + half};
}

// Chooses the start of each attempt that is given none: first the configurations of a table, in the order of how near
// their frames are to the targets, then random ones.
template <int Rows>
class Starts {
 public:
  Starts(const Problem& problem, const Limits& limits, std::uint64_t seed)
      : problem_(problem), limits_(limits), seed_(seed) {
    std::vector<char> is_drawn(static_cast<std::size_t>(problem.mechanism->nq), 0);
    for (const Coordinate& coordinate : problem.coordinates) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(coordinate.joint)];
      if (!joint.has_one_axis()) continue;
      drawn_.push_back(coordinate.joint);
      for (int i = 0; i < joint.nq; ++i) is_drawn[static_cast<std::size_t>(joint.idx_q + i)] = 1;
    }
    for (int j : problem.joints) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      for (int i = 0; i < joint.nq; ++i)
        if (!is_drawn[static_cast<std::size_t>(joint.idx_q + i)]) still_.push_back(joint.idx_q + i);
    }
    for (const Term& term : problem.terms)
      features_ += 3 * term.asks_position + 9 * term.asks_rotation + 3 * (term.asks_axis && !term.asks_at);
  }

  // Whether any joint is drawn at random; if none is, all starts are the same.
  bool draws() const { return !drawn_.empty(); }

  // Write start number 1, 2, … of one problem into `q`; number 1 must come first. What is not drawn is as in `start`.
  void next(Kinematics<Rows>& kinematics, const Vector& start, std::uint64_t target, std::int64_t number, Vector& q) {
    if (number > problem_.constants.table_nearest) return draw(start, start, target, static_cast<std::uint64_t>(number), q);
    if (number == 1) rank(kinematics, start);
    Eigen::Index best;
    scores_.minCoeff(&best);
    scores_[best] = infinity;
    q = start;
    for (int j : drawn_) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      for (int i = 0; i < joint.nq; ++i) q[joint.idx_q + i] = table_(joint.idx_q + i, best);
    }
  }

 private:
  const Problem& problem_;
  const Limits& limits_;
  const std::uint64_t seed_;
  std::vector<int> drawn_;  // joints
  std::vector<int> still_;  // entries of q that are not drawn although the targets depend on them
  Eigen::MatrixXd table_;   // (nq, size); empty until it is needed
  // scores_ = lengths_ + seen_ goal_
  Eigen::Index features_ = 0;
  Eigen::MatrixXd seen_;
  Vector lengths_, goal_, scores_;

  void draw(const Vector& start, const Vector& slides_about, std::uint64_t target, std::uint64_t number,
            Vector& q) const {
    q = start;
    for (int j : drawn_) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      const double u = uniform(seed_, target, number, static_cast<std::uint64_t>(joint.idx_v));
      const int entry = joint.idx_q;
      const auto [low, high] =
          range_to_draw_from(joint, limits_.lower[entry], limits_.upper[entry], slides_about[entry],
                             problem_.constants.widest_range);
      const double angle = low + u * (high - low);
      if (joint.nq == 2) {
        q[entry] = std::cos(angle);
        q[entry + 1] = std::sin(angle);
      } else {
        q[entry] = angle;
      }
    }
  }

  bool is_for_another(const Vector& start) const {
    if (table_.size() == 0) return true;
    for (int entry : still_)
      if (table_(entry, 0) != start[entry]) return true;
    return false;
  }

  void make(Kinematics<Rows>& kinematics, const Vector& start) {
    const Eigen::Index size = problem_.constants.table_size;
    const double squared_metres_per_radian = problem_.squared_metres_per_radian;
    table_.resize(start.size(), size);
    seen_.resize(size, features_);
    lengths_.setZero(size);
    const Vector zero = Vector::Zero(start.size());
    Vector q;
    for (Eigen::Index k = 0; k < size; ++k) {
      draw(start, zero, problem_.constants.table_key, static_cast<std::uint64_t>(k), q);
      table_.col(k) = q;
      kinematics.forward(q);
      Eigen::Index f = 0;
      for (const Term& term : problem_.terms) {
        const Placement at = kinematics.seen_from_reference(term);
        const double weight = term.weight * term.weight;
        if (term.asks_position) {
          const Vec3 p = term.along.cwiseProduct(at.p);
          seen_.row(k).template segment<3>(f) = -2.0 * weight * p;
          lengths_[k] += weight * p.squaredNorm();
          f += 3;
        }
        if (term.asks_rotation) {
          seen_.row(k).template segment<9>(f) =
              -weight * squared_metres_per_radian * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(at.R.data());
          f += 9;
        } else if (term.asks_axis && !term.asks_at) {
          seen_.row(k).template segment<3>(f) = -2.0 * weight * squared_metres_per_radian * (at.R * term.axis);
          f += 3;
        }
      }
    }
  }

  // Compute the squared distance of each configuration in the table from the goals, up to a constant. A radian counts as
  // in Linearization::distance, with 2 − 2 cos in place of its square.
  void rank(Kinematics<Rows>& kinematics, const Vector& start) {
    if (is_for_another(start)) make(kinematics, start);
    goal_.resize(features_);
    Eigen::Index f = 0;
    for (std::size_t t = 0; t < problem_.terms.size(); ++t) {
      const Term& term = problem_.terms[t];
      const Goal& goal = problem_.goals[t];
      if (term.asks_position) {
        goal_.template segment<3>(f) = goal.position;
        f += 3;
      }
      if (term.asks_rotation) {
        goal_.template segment<9>(f) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(goal.rotation.data());
        f += 9;
      } else if (term.asks_axis && !term.asks_at) {
        goal_.template segment<3>(f) = goal.direction;
        f += 3;
      }
    }
    scores_ = lengths_;
    scores_.noalias() += seen_ * goal_;
  }
};

}  // namespace pinik
