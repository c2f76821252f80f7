// Sines and cosines of several angles at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace pinik {

// The loop has no branches, so that the compiler can vectorise it. Angles are reduced to [−π/4, π/4] by π/2 in three
// parts (Cody and Waite) and put into Taylor series. The error is below 2e-16 for angles up to 1e5 rad; beyond them the
// standard library is used. The length of each array must be a multiple of four that is at least `count`.
inline void sines_and_cosines(const double* __restrict angles, int count, double* __restrict sines,
                              double* __restrict cosines) {
  constexpr double to_integer = 6755399441055744.0;  // 1.5 · 2⁵²: adding it rounds to a whole number
  constexpr double half_pi_1 = 0x1.921fb544p+0, half_pi_2 = 0x1.0b4611a6p-34, half_pi_3 = 0x1.3198a2e037073p-69;
  double farthest = 0.0;
  for (int k = 0; k < count; ++k) farthest = std::abs(angles[k]) > farthest ? std::abs(angles[k]) : farthest;
  const int padded = (count + 3) / 4 * 4;
  for (int k = 0; k < padded; ++k) {
    const double x = angles[k];
    const double shifted = x * (2.0 / M_PI) + to_integer;
    const double quarters = shifted - to_integer;
    std::int64_t bits;
    std::memcpy(&bits, &shifted, sizeof bits);
    const double r = ((x - quarters * half_pi_1) - quarters * half_pi_2) - quarters * half_pi_3;
    const double s = r * r;
    double sine = -1.0 / 1307674368000.0;
    sine = sine * s + 1.0 / 6227020800.0;
    sine = sine * s - 1.0 / 39916800.0;
    sine = sine * s + 1.0 / 362880.0;
    sine = sine * s - 1.0 / 5040.0;
    sine = sine * s + 1.0 / 120.0;
    sine = sine * s - 1.0 / 6.0;
    sine = r + r * s * sine;
    double cosine = 1.0 / 20922789888000.0;
    cosine = cosine * s - 1.0 / 87178291200.0;
    cosine = cosine * s + 1.0 / 479001600.0;
    cosine = cosine * s - 1.0 / 3628800.0;
    cosine = cosine * s + 1.0 / 40320.0;
    cosine = cosine * s - 1.0 / 720.0;
    cosine = cosine * s + 1.0 / 24.0;
    cosine = 1.0 - 0.5 * s + s * s * cosine;
    // The number of quarter turns decides which of the two values is the sine, and their signs.
    std::int64_t sine_bits, cosine_bits;
    std::memcpy(&sine_bits, &sine, sizeof sine);
    std::memcpy(&cosine_bits, &cosine, sizeof cosine);
    const std::int64_t odd = -(bits & 1);
    const std::int64_t exchanged = (sine_bits ^ cosine_bits) & odd;
    sine_bits ^= exchanged ^ ((bits & 2) << 62);
    cosine_bits ^= exchanged ^ (((bits + 1) & 2) << 62);
    std::memcpy(&sines[k], &sine_bits, sizeof sine);
    std::memcpy(&cosines[k], &cosine_bits, sizeof cosine);
  }
  if (farthest > 1e5)
    for (int k = 0; k < count; ++k) {
      sines[k] = std::sin(angles[k]);
      cosines[k] = std::cos(angles[k]);
    }
}

}  // namespace pinik
