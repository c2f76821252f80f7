// Where attempts begin: numbers that depend only on seed, target and attempt; follows pinik.solving.starts.
#pragma once

#include <cstdint>

#include "table.hpp"

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

// Chooses the start of each attempt that is given none: first the configurations of a table, in the order of how near
// their frames are to the targets, then random ones.
template <int Rows>
class Starts {
 public:
  Starts(const Problem& problem, const Limits& limits, std::uint64_t seed)
      : problem_(problem), seed_(seed), table_(problem, limits, problem.constants.table_size) {}

  // Whether any joint is drawn at random; if none is, all starts are the same.
  bool draws() const { return !table_.drawn().empty(); }

  // Write start number 1, 2, … of one problem into `q`; number 1 must come first. What is not drawn is as in `start`.
  void next(Kinematics<Rows>& kinematics, const Vector& start, std::uint64_t target, std::int64_t number, Vector& q) {
    if (number > problem_.constants.table_nearest) {
      const auto share = [&](const Joint& joint) {
        return random(target, static_cast<std::uint64_t>(number), joint);
      };
      return table_.draw(start, start, share, q);
    }
    if (number == 1)
      table_.rank(kinematics, start, [&](std::uint64_t k, const Joint& joint) {
        return random(problem_.constants.table_key, k, joint);
      });
    Vector& scores = table_.scores();
    Eigen::Index best;
    scores.minCoeff(&best);
    scores[best] = infinity;  // taken
    q = start;
    table_.take(best, q);
  }

 private:
  const Problem& problem_;
  const std::uint64_t seed_;
  Table<Rows> table_;

  double random(std::uint64_t target, std::uint64_t attempt, const Joint& joint) const {
    return uniform(seed_, target, attempt, static_cast<std::uint64_t>(joint.idx_v));
  }
};

}  // namespace pinik
