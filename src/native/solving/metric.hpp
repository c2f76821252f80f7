// How far two configurations are apart; follows pinik.solving.metric.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../model/fast.hpp"
#include "../model/limits.hpp"
#include "../problem/problem.hpp"

namespace pinik {

// Add to `sums` the squares of `values` minus `value`, each times `scale`, modulo whole turns of length `turn` unless that is 0.
PINIK_FAST static void add_squared_changes(const double* values, double value, double scale, double turn,
                                           std::size_t count, double* sums) {
  const double inverse = turn > 0.0 ? 1.0 / turn : 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double change = values[k] - value;
    const double left = (change - turn * std::nearbyint(change * inverse)) * scale;
    sums[k] += left * left;
  }
}

// The factors on free coordinates: 1 for radians, and 1 per length of the chain for metres.
inline std::vector<double> joint_scales(const Problem& problem) {
  std::vector<double> scales;
  for (const Coordinate& coordinate : problem.coordinates)
    scales.push_back(problem.slides(coordinate.joint, coordinate.index) ? 1.0 / problem.size_of_chain : 1.0);
  return scales;
}

// The largest change of a free coordinate from configuration a to b, each times its factor.
inline double largest_difference(const Problem& problem, const Vector& a, const Vector& b,
                                 const std::vector<double>& factors) {
  double largest = 0.0;
  each_change(problem, a, b, [&](double change, std::size_t c) { largest = std::max(largest, std::abs(change) * factors[c]); });
  return largest;
}

// Changes of the free coordinates in radians, or in lengths of the chain; whole turns of hinges count as no change.
class Metric {
 public:
  Metric(const Problem& problem, const Limits& limits) : problem_(problem), scales_(joint_scales(problem)) {
    for (const Coordinate& coordinate : problem.coordinates) {
      const int entry = coordinate.entry;
      entries_.push_back(entry);
      // Of a turn and its inverse, 0 stands for a coordinate that makes none.
      turns_.push_back(entry >= 0 && limits.turning[static_cast<std::size_t>(entry)] ? 2.0 * M_PI : 0.0);
      inverse_turns_.push_back(turns_.back() > 0.0 ? 1.0 / turns_.back() : 0.0);
    }
  }

  // The sum of the squared changes.
  double squared(const Vector& a, const Vector& b) const {
    double sum = 0.0;
    each(a, b, [&](double change) { sum += change * change; });
    return sum;
  }

  // The largest change.
  double largest(const Vector& a, const Vector& b) const {
    double most = 0.0;
    each(a, b, [&](double change) { most = std::max(most, std::abs(change)); });
    return most;
  }

  // Write the squared distances of many configurations from q. `columns` has their coordinates, one after the other, with
  // `stride` numbers for each, if every coordinate is an entry of q; else they are taken from `configuration(k)`.
  template <class Configuration>
  void squared(const Vector& q, const double* columns, std::size_t stride, std::size_t count,
               const Configuration& configuration, double* sums) const {
    if (!problem_.is_plain) {
      for (std::size_t k = 0; k < count; ++k) sums[k] = squared(q, configuration(k));
      return;
    }
    std::fill(sums, sums + count, 0.0);
    for (std::size_t c = 0; c < entries_.size(); ++c)
      add_squared_changes(columns + c * stride, q[entries_[c]], scales_[c], turns_[c], count, sums);
  }

  // Write the coordinates of q into number k of `columns`, as above.
  void store(const Vector& q, std::size_t k, std::size_t stride, double* columns) const {
    if (problem_.is_plain)
      for (std::size_t c = 0; c < entries_.size(); ++c) columns[c * stride + k] = q[entries_[c]];
  }

 private:
  const Problem& problem_;
  std::vector<int> entries_;  // by coordinate
  std::vector<double> scales_, turns_, inverse_turns_;

  template <class See>
  void each(const Vector& a, const Vector& b, const See& see) const {
    if (problem_.is_plain) {
      const std::size_t count = entries_.size();
      for (std::size_t c = 0; c < count; ++c) see(turned(b[entries_[c]] - a[entries_[c]], c) * scales_[c]);
      return;
    }
    each_change(problem_, a, b, [&](double change, std::size_t c) { see(turned(change, c) * scales_[c]); });
  }

  // Rounds half away from zero by a conversion, which is quicker than a call.
  double turned(double change, std::size_t c) const {
    const double turns = change * inverse_turns_[c];
    return change - turns_[c] * static_cast<double>(static_cast<std::int64_t>(turns + (turns < 0.0 ? -0.5 : 0.5)));
  }
};

}  // namespace pinik
