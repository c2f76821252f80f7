// Starts that are spread over the configurations whose frames are near to the targets; follows pinik.solving.spread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "starts.hpp"

namespace pinik {

// Shorten the squared distance of each candidate to the nearest marked configuration, in one coordinate of all
// candidates: add to `sums` the squares of `values` minus `value`, modulo whole turns if the coordinate `turns`.
PINIK_FAST static void add_squares(const float* values, float value, bool turns, int count, float* sums) {
  if (turns) {
    for (int i = 0; i < count; ++i) {
      const float d = values[i] - value;
      const float left = d - static_cast<float>(static_cast<int>(d + (d < 0.0f ? -0.5f : 0.5f)));
      sums[i] += left * left;
    }
  } else {
    for (int i = 0; i < count; ++i) sums[i] += (values[i] - value) * (values[i] - value);
  }
}

// Chooses starts one after the other: of the configurations of a table whose frames are nearest to the targets, the one
// that is farthest from all that are marked, which are the starts before and the answers found.
template <int Rows>
class Spread {
 public:
  Spread(const Problem& problem, const Limits& limits, std::uint64_t seed)
      : problem_(problem), limits_(limits), table_(problem, limits, problem.constants.spread_size) {
    // The steps of the additive recurrence Rd (Roberts 2018): powers of 1/φ, where φ is the root of φ^(d+1) = φ + 1.
    const double exponent = 1.0 / (static_cast<double>(table_.drawn().size()) + 1.0);
    double root = 2.0;
    for (int i = 0; i < 64; ++i) root = std::pow(1.0 + root, exponent);
    double step = 1.0;
    steps_.resize(static_cast<std::size_t>(problem.mechanism->nq));
    offsets_.resize(steps_.size());
    for (int j : table_.drawn()) {
      const Joint& joint = problem.mechanism->joints[static_cast<std::size_t>(j)];
      step /= root;
      steps_[static_cast<std::size_t>(joint.idx_q)] = step;
      offsets_[static_cast<std::size_t>(joint.idx_q)] =
          uniform(seed, problem.constants.table_key, 0, static_cast<std::uint64_t>(joint.idx_v));
    }
  }

  // Prepare to choose starts for the present goals. What is not drawn will be as in `start`. Returns their number.
  int begin(Kinematics<Rows>& kinematics, const Vector& start) {
    start_ = &start;
    if (table_.drawn().empty()) return 0;
    table_.rank(kinematics, start, [&](std::uint64_t k, const Joint& joint) {
      const double sum = offsets_[static_cast<std::size_t>(joint.idx_q)] +
                         static_cast<double>(k) * steps_[static_cast<std::size_t>(joint.idx_q)];
      return sum - std::floor(sum);
    });
    choose_nearest();
    const std::size_t count = candidates_.size();
    values_.resize(count * table_.drawn().size());
    float* value = values_.data();
    for (int j : table_.drawn()) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      for (Eigen::Index k : candidates_) *value++ = in_turns(joint, table_.configurations().col(k).data());
    }
    least_.assign(count, std::numeric_limits<float>::infinity());
    return static_cast<int>(count);
  }

  // Write configuration `index` of the table into the drawn entries of `q`.
  void take(Eigen::Index index, Vector& q) const {
    if (!table_.drawn().empty()) table_.take(index, q);
  }

  // Mark a configuration, from which later starts shall be far away.
  void mark(const Vector& q) {
    const int count = static_cast<int>(candidates_.size());
    sums_.assign(candidates_.size(), 0.0f);
    const float* values = values_.data();
    for (int j : table_.drawn()) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(j)];
      add_squares(values, in_turns(joint, q.data()), turns(joint), count, sums_.data());
      values += count;
    }
    for (int i = 0; i < count; ++i) least_[static_cast<std::size_t>(i)] =
        std::min(least_[static_cast<std::size_t>(i)], sums_[static_cast<std::size_t>(i)]);
  }

  // Write the next start into `q` and mark it.
  void next(Vector& q) {
    const auto farthest = std::max_element(least_.begin(), least_.end());
    q = *start_;
    table_.take(candidates_[static_cast<std::size_t>(farthest - least_.begin())], q);
    mark(q);
    *farthest = -1.0f;
  }

 private:
  const Problem& problem_;
  const Limits& limits_;
  Table<Rows> table_;
  std::vector<double> steps_, offsets_;  // by entry of q
  const Vector* start_ = nullptr;
  std::vector<Eigen::Index> candidates_;
  std::vector<float> values_;  // of the candidates, one drawn joint after the other
  std::vector<float> least_;   // squared distance of each candidate to what is nearest of all that is marked
  std::vector<float> sums_;

  bool turns(const Joint& joint) const {
    return joint.nq == 2 || limits_.turning[static_cast<std::size_t>(joint.idx_q)];
  }

  // A joint's value in whole turns, or in 2π lengths of the chain.
  float in_turns(const Joint& joint, const double* q) const {
    const double* own = q + joint.idx_q;
    const double value = joint.nq == 2      ? std::atan2(own[1], own[0])
                         : joint.slides() ? own[0] / problem_.size_of_chain
                                          : own[0];
    return static_cast<float>(value * (0.5 / M_PI));
  }

  // Keep the configurations with the smallest scores, in the order of the table.
  void choose_nearest() {
    const Vector& scores = table_.scores();
    const auto wanted = static_cast<std::size_t>(std::min<Eigen::Index>(problem_.constants.spread_nearest, scores.size()));
    double highest = infinity;
    // The score below which about twice as many lie as are wanted, by every sixteenth of them.
    sample_.clear();
    for (Eigen::Index k = 0; k < scores.size(); k += 16) sample_.push_back(scores[k]);
    const std::size_t place = 2 * wanted / 16 + 1;
    if (place < sample_.size()) {
      std::nth_element(sample_.begin(), sample_.begin() + static_cast<std::ptrdiff_t>(place), sample_.end());
      if ((scores.array() <= sample_[place]).count() >= static_cast<Eigen::Index>(wanted)) highest = sample_[place];
    }
    candidates_.clear();
    for (Eigen::Index k = 0; k < scores.size(); ++k)
      if (scores[k] <= highest) candidates_.push_back(k);
    const auto before = [&](Eigen::Index a, Eigen::Index b) { return scores[a] < scores[b]; };
    std::nth_element(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(wanted - 1),
                     candidates_.end(), before);
    candidates_.resize(wanted);
    std::sort(candidates_.begin(), candidates_.end());
  }

  std::vector<double> sample_;
};

}  // namespace pinik
