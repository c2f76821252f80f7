// Boxes around shapes, and a quick test that tells most pairs of them apart.
#pragma once

#include "../model/spatial.hpp"

namespace pinik {

// A box with any orientation; all lengths in metres.
struct Box {
  Placement at;                // of its centre
  Vec3 half = Vec3::Zero();    // half of each edge
  double radius = 0.0;         // of a ball about the centre that holds what the box holds
};

// Whether an axis separates the boxes: a normal of a face, or a product of two edges. Gottschalk, Lin, Manocha, "OBBTree"
// (SIGGRAPH 1996), section 5.
inline bool are_apart(const Box& a, const Box& b) {
  constexpr double rounding = 1e-9;  // of products of edges that are nearly parallel
  const Vec3 &ha = a.half, &hb = b.half;
  const Mat3 C = a.at.R.transpose() * b.at.R;
  const Mat3 A = (C.array().abs() + rounding).matrix();
  const Vec3 t = a.at.R.transpose() * (b.at.p - a.at.p);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(t[i]) > ha[i] + A.row(i).dot(hb)) return true;
    if (std::abs(t.dot(C.col(i))) > hb[i] + A.col(i).dot(ha)) return true;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double reach = ha[i1] * A(i2, j) + ha[i2] * A(i1, j) + hb[j1] * A(i, j2) + hb[j2] * A(i, j1);
      if (std::abs(t[i2] * C(i1, j) - t[i1] * C(i2, j)) > reach) return true;
    }
  }
  return false;
}

}  // namespace pinik
