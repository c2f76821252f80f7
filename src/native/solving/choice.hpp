// The distinct answers that the attempts of one solve found, and the one nearest to the start; follows
// pinik.solving.choice.
#pragma once

#include <vector>

#include "../model/limits.hpp"
#include "../problem/problem.hpp"
#include "metric.hpp"

namespace pinik {

class Choice {
 public:
  // `weights` has a factor for each coordinate of the problem.
  Choice(const Problem& problem, const Limits& limits, const std::vector<double>& weights)
      : problem_(problem), limits_(limits), weights_(weights), scales_(joint_scales(problem)) {}

  void begin() {
    found_.clear();
    since_ = 0;
  }

  // Count an attempt that failed.
  void add_nothing() { ++since_; }

  // Take the answer of one more attempt from `start`.
  void add(Vector q, const Vector& start) {
    ++since_;
    limits_.wrap(q, start);
    for (const Vector& other : found_)
      if (largest_difference(problem_, other, q, scales_) <= problem_.constants.same_answer) return;
    found_.push_back(std::move(q));
    since_ = 0;
  }

  std::int64_t count() const { return static_cast<std::int64_t>(found_.size()); }

  // How many attempts there were since the last new answer.
  std::int64_t since() const { return since_; }

  // The answer whose largest weighted joint change from the start is smallest.
  const Vector& nearest(const Vector& start) const {
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const double now = largest_difference(problem_, start, found_[k], weights_);
      if (now < least) {
        least = now;
        best = k;
      }
    }
    return found_[best];
  }

 private:
  const Problem& problem_;
  const Limits& limits_;
  const std::vector<double> weights_, scales_;  // by coordinate
  std::vector<Vector> found_;
  std::int64_t since_ = 0;
};

}  // namespace pinik
