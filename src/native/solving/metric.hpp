// How far two configurations are apart; follows pinik.solving.metric.
#pragma once

#include <vector>

#include "../model/limits.hpp"
#include "../problem/problem.hpp"

namespace pinik {

// Changes of the free coordinates in radians, or in lengths of the chain; whole turns of hinges count as no change.
class Metric {
 public:
  Metric(const Problem& problem, const Limits& limits) : problem_(problem) {
    for (const Coordinate& coordinate : problem.coordinates) {
      scales_.push_back(problem.slides(coordinate.joint, coordinate.index) ? 1.0 / problem.size_of_chain : 1.0);
      turns_.push_back(coordinate.entry >= 0 && limits.turning[static_cast<std::size_t>(coordinate.entry)]);
    }
  }

  // The root of the sum of the squared changes.
  double length(const Vector& a, const Vector& b) const {
    double sum = 0.0;
    each(a, b, [&](double change) { sum += change * change; });
    return std::sqrt(sum);
  }

  // The largest change.
  double largest(const Vector& a, const Vector& b) const {
    double most = 0.0;
    each(a, b, [&](double change) { most = std::max(most, std::abs(change)); });
    return most;
  }

 private:
  const Problem& problem_;
  std::vector<double> scales_;  // by coordinate
  std::vector<char> turns_;

  template <class See>
  void each(const Vector& a, const Vector& b, const See& see) const {
    if (problem_.is_plain) {
      for (std::size_t c = 0; c < scales_.size(); ++c) {
        const int entry = problem_.coordinates[c].entry;
        see(turned(b[entry] - a[entry], c) * scales_[c]);
      }
      return;
    }
    for (const MovingJoint& moving : problem_.moving) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(moving.joint)];
      double own[6];
      problem_.mechanism->difference(joint, a.data(), b.data(), own);
      for (int i = 0; i < joint.nv; ++i) {
        if (moving.coordinates[i] < 0) continue;
        const auto c = static_cast<std::size_t>(moving.coordinates[i]);
        see(turned(own[i], c) * scales_[c]);
      }
    }
  }

  double turned(double change, std::size_t c) const {
    constexpr double turn = 2.0 * M_PI;
    return turns_[c] && std::abs(change) > M_PI ? change - turn * std::nearbyint(change / turn) : change;
  }
};

}  // namespace pinik
