// The distinct answers of one solve at which something touches; follows pinik.solving.colliding.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "metric.hpp"

namespace pinik {

class Colliding {
 public:
  Colliding(const Problem& problem, const Limits& limits)
      : constants_(problem.constants), metric_(problem, limits) {}

  void begin() {
    found_.clear();
    hits_.clear();
    last_new_ = 0;
  }

  // Take the answer of an attempt, which are counted from 0.
  void add(const Vector& q, std::int64_t attempt) {
    for (std::size_t k = 0; k < found_.size(); ++k)
      if (metric_.largest(found_[k], q) <= constants_.same_answer) {
        ++hits_[k];
        return;
      }
    found_.push_back(q);
    hits_.push_back(1);
    last_new_ = attempt;
  }

  // Whether further attempts are unlikely to bring another answer than those that collide, if answers are isolated.
  bool is_enough(std::int64_t attempts) const {
    const std::int64_t since = attempts - 1 - last_new_;
    return !found_.empty() && attempts >= constants_.colliding_least &&
           since >= constants_.colliding_since * static_cast<std::int64_t>(found_.size()) &&
           *std::min_element(hits_.begin(), hits_.end()) >= 2;
  }

  const std::vector<Vector>& found() const { return found_; }

 private:
  const Constants& constants_;
  const Metric metric_;
  std::vector<Vector> found_;
  std::vector<int> hits_;
  std::int64_t last_new_ = 0;
};

}  // namespace pinik
