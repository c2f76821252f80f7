// Configurations with what their frames show, ranked by how near that is to the targets; follows pinik.solving.table.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../model/fast.hpp"
#include "../model/limits.hpp"
#include "../problem/kinematics.hpp"

namespace pinik {

// The range from which a joint's value is drawn, as in pinik.model.joint.Joint.range_to_draw_from.
inline std::pair<double, double> range_to_draw_from(const Joint& joint, double lower, double upper, double slide_about,
                                                    double slide_by, double widest) {
  if (upper - lower <= widest) return {lower, upper};
  const double half = std::min(joint.slides() ? slide_by : M_PI, 0.5 * (upper - lower));
  const double middle = std::min(std::max(joint.slides() ? slide_about : 0.0, lower + half), upper - half);
  return {middle - half, middle + half};
}

// scores = lengths + seen goal, column by column, which compilers turn into wide instructions.
PINIK_FAST static void score(const Eigen::MatrixXd& seen, const Vector& goal, const Vector& lengths, Vector& scores) {
  scores = lengths;
  const Eigen::Index count = scores.size();
  double* const sums = scores.data();
  for (Eigen::Index f = 0; f < goal.size(); ++f) {
    const double* const column = seen.data() + f * count;
    const double factor = goal[f];
    for (Eigen::Index k = 0; k < count; ++k) sums[k] += column[k] * factor;
  }
}

// The table of one problem. Its configurations are made when they are first needed, and used for all targets.
template <int Rows>
class Table {
 public:
  Table(const Problem& problem, const Limits& limits, Eigen::Index size)
      : problem_(problem), limits_(limits), size_(size) {
    std::vector<char> is_drawn(static_cast<std::size_t>(problem.mechanism->nq), 0);
    for (const Coordinate& coordinate : problem.coordinates) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(coordinate.joint)];
      if (!joint.has_one_axis()) continue;
      drawn_.push_back(coordinate.joint);
      if (joint.slides() && limits.upper[joint.idx_q] - limits.lower[joint.idx_q] > problem.constants.widest_range)
        wide_.push_back(joint.idx_q);
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

  // The free joints of one axis: those that are drawn.
  const std::vector<int>& drawn() const { return drawn_; }

  // Write into `q` the configuration where each drawn joint has the part `share(joint)` of its range, and what is not
  // drawn is as in `start`. Slides with no or very wide limits are drawn about `slides_about`.
  template <class Share>
  void draw(const Vector& start, const Vector& slides_about, const Share& share, Vector& q) const {
    q = start;
    for (int j : drawn_) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      const int entry = joint.idx_q;
      const auto [low, high] =
          range_to_draw_from(joint, limits_.lower[entry], limits_.upper[entry], slides_about[entry],
                             problem_.size_of_chain, problem_.constants.widest_range);
      const double angle = low + share(joint) * (high - low);
      if (joint.nq == 2) {
        q[entry] = std::cos(angle);
        q[entry + 1] = std::sin(angle);
      } else {
        q[entry] = angle;
      }
    }
  }

  // Write configuration `index` into the drawn entries of `q`.
  void take(Eigen::Index index, Vector& q) const {
    for (int j : drawn_) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      for (int i = 0; i < joint.nq; ++i) q[joint.idx_q + i] = configurations_(joint.idx_q + i, index);
    }
  }

  // All configurations (nq, size), after the first rank().
  const Eigen::MatrixXd& configurations() const { return configurations_; }

  // The scores of the configurations (size), from the last rank(); they may be overwritten.
  Vector& scores() { return scores_; }

  // Score each configuration by its squared distance from the goals, up to a constant; smaller is nearer. A radian counts
  // as in Linearization::distance, with 2 − 2 cos in place of its square. `share(k, joint)` is what `draw` gets for
  // configuration k if the table is not made yet, or not for what is not drawn in `start`.
  template <class Share>
  void rank(Kinematics<Rows>& kinematics, const Vector& start, const Share& share) {
    // Slides with very wide limits are drawn around the whole number of lengths of the chain that is nearest to `start`, so
    // that starts near each other share a table.
    const double length = problem_.size_of_chain;
    about_.setZero(start.size());
    for (int entry : wide_) about_[entry] = length * std::nearbyint(start[entry] / length);
    if (is_for_another(start)) make(kinematics, start, share);
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
    score(seen_, goal_, lengths_, scores_);
  }

 private:
  const Problem& problem_;
  const Limits& limits_;
  const Eigen::Index size_;
  std::vector<int> drawn_;  // joints
  std::vector<int> still_;  // entries of q that are not drawn although the targets depend on them
  std::vector<int> wide_;   // entries of q that are drawn around the start
  Vector about_, made_about_;  // the middles of their ranges: those that are wanted, and those of the table
  Eigen::MatrixXd configurations_;  // (nq, size); empty until they are needed
  Eigen::Index features_ = 0;
  Eigen::MatrixXd seen_;
  Vector lengths_, goal_, scores_;

  bool is_for_another(const Vector& start) const {
    if (configurations_.size() == 0) return true;
    for (int entry : still_)
      if (configurations_(entry, 0) != start[entry]) return true;
    for (int entry : wide_)
      if (made_about_[entry] != about_[entry]) return true;
    return false;
  }

  template <class Share>
  void make(Kinematics<Rows>& kinematics, const Vector& start, const Share& share) {
    const double squared_metres_per_radian = problem_.squared_metres_per_radian;
    configurations_.resize(start.size(), size_);
    seen_.resize(size_, features_);
    lengths_.setZero(size_);
    made_about_ = about_;
    Vector q;
    for (Eigen::Index k = 0; k < size_; ++k) {
      draw(start, about_, [&](const Joint& joint) { return share(static_cast<std::uint64_t>(k), joint); }, q);
      configurations_.col(k) = q;
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
};

}  // namespace pinik
