// The geometry of one shape: a primitive solid, or the surface of a mesh.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "boxes.hpp"

namespace pinik {

// Sizes [m] are those of pinik.shapes.solids: a box's three edges, a sphere's radius, a cylinder's or capsule's radius and
// length along z.
enum class SolidKind { box, sphere, cylinder, capsule };

// Never changes, so threads, robots and worlds share one.
class Geometry {
 public:
  Geometry(SolidKind kind, const std::vector<double>& sizes);

  // Vertices [m] without repetitions, and the vertices of each triangle. Throws std::invalid_argument if there are none.
  Geometry(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles);
  ~Geometry();

  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  // Around the geometry, slightly larger than needed.
  const Box& box() const { return box_; }

  // coal's objects; only collisions.cpp and geometry.cpp know them.
  struct Objects;
  const Objects& objects() const { return *objects_; }

 private:
  Box box_;
  std::unique_ptr<Objects> objects_;
};

}  // namespace pinik
