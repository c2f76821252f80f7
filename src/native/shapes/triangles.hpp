// Two triangles in space.
#pragma once

#include <algorithm>
#include <array>

#include "../model/spatial.hpp"

namespace pinik {

using Corners = std::array<Vec3, 3>;

// Whether a direction separates two triangles by more than a margin [m]; its length does not matter.
inline bool separates(const Vec3& direction, const Corners& a, const Corners& b, double margin) {
  const double a0 = direction.dot(a[0]), a1 = direction.dot(a[1]), a2 = direction.dot(a[2]);
  const double b0 = direction.dot(b[0]), b1 = direction.dot(b[1]), b2 = direction.dot(b[2]);
  const double gap = std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}), std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
  return gap > 0.0 && gap * gap > margin * margin * direction.squaredNorm();
}

// Whether two triangles are apart by more than a margin [m] along one of their normals or a product of their edges. False
// says nothing.
inline bool are_apart(const Corners& a, const Corners& b, double margin) {
  const Corners along_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]}, along_b{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  if (separates(along_a[0].cross(along_a[1]), a, b, margin)) return true;
  if (separates(along_b[0].cross(along_b[1]), a, b, margin)) return true;
  for (const Vec3& one : along_a)
    for (const Vec3& other : along_b)
      if (separates(one.cross(other), a, b, margin)) return true;
  return false;
}

}  // namespace pinik
