// coal's objects for one geometry.
#pragma once

#include <coal/BVH/BVH_model.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include "geometry.hpp"

namespace pinik {

// A box around some triangles of a mesh, and where its two parts are among all boxes; one triangle's box has none.
struct Node {
  Box box;
  int parts = -1;     // the first part; the second is the next one
  int triangle = -1;  // of a box without parts
};

struct Geometry::Objects {
  std::shared_ptr<coal::CollisionGeometry> exact;  // decides whether it touches: a solid primitive, or a mesh's surface
  std::shared_ptr<coal::CollisionGeometry> hull;   // the convex hull of it as a solid; none for a flat mesh
  std::vector<Node> tree;     // of a mesh; the first one holds all
  std::vector<Vec3> corners;  // of a mesh's triangles, three for each [m]
  bool is_mesh = false;
};

}  // namespace pinik
