#include "objects.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace pinik {
namespace {

// coal's distances are exact to 1e-6 m; boxes that touch within this never tell shapes apart that it takes as touching.
constexpr double margin = 1e-5;

std::shared_ptr<coal::ShapeBase> primitive(SolidKind kind, const std::vector<double>& sizes) {
  const std::size_t needed = kind == SolidKind::box ? 3 : kind == SolidKind::sphere ? 1 : 2;
  if (sizes.size() != needed) throw std::invalid_argument("a shape has another number of sizes");
  switch (kind) {
    case SolidKind::box:
      return std::make_shared<coal::Box>(sizes[0], sizes[1], sizes[2]);
    case SolidKind::sphere:
      return std::make_shared<coal::Sphere>(sizes[0]);
    case SolidKind::cylinder:
      return std::make_shared<coal::Cylinder>(sizes[0], sizes[1]);
    default:
      return std::make_shared<coal::Capsule>(sizes[0], sizes[1]);
  }
}

Box box_around(SolidKind kind, const std::vector<double>& sizes) {
  Box box;
  switch (kind) {
    case SolidKind::box:
      box.half = 0.5 * Vec3(sizes[0], sizes[1], sizes[2]);
      box.radius = box.half.norm();
      break;
    case SolidKind::sphere:
      box.half = Vec3::Constant(sizes[0]);
      box.radius = sizes[0];
      break;
    case SolidKind::cylinder:
      box.half = Vec3(sizes[0], sizes[0], 0.5 * sizes[1]);
      box.radius = std::hypot(sizes[0], 0.5 * sizes[1]);
      break;
    default:
      box.half = Vec3(sizes[0], sizes[0], sizes[0] + 0.5 * sizes[1]);
      box.radius = box.half[2];
  }
  return box;
}

Box box_of(const coal::OBB& given) {
  Box box;
  box.at = {given.axes, given.To};
  box.half = given.extent;
  box.half.array() += margin;
  box.radius = box.half.norm();
  return box;
}

// coal's tree of boxes.
std::vector<Node> tree_of(const coal::BVHModel<coal::OBBRSS>& model) {
  std::vector<Node> tree;
  for (unsigned int k = 0; k < model.getNumBVs(); ++k) {
    const auto& given = model.getBV(k);
    tree.push_back({box_of(given.bv.obb), given.isLeaf() ? -1 : given.leftChild(), given.isLeaf() ? given.primitiveId() : -1});
  }
  return tree;
}

}  // namespace

Geometry::Geometry(SolidKind kind, const std::vector<double>& sizes) : objects_(std::make_unique<Objects>()) {
  objects_->exact = primitive(kind, sizes);
  objects_->exact->computeLocalAABB();
  objects_->hull = objects_->exact;
  box_ = box_around(kind, sizes);
  box_.half.array() += margin;
  box_.radius += margin;
}

Geometry::Geometry(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles)
    : objects_(std::make_unique<Objects>()) {
  if (vertices.empty() || triangles.empty()) throw std::invalid_argument("a mesh has no triangles");
  const auto model = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
  std::vector<coal::Triangle> faces;
  for (const auto& corners : triangles) {
    for (int corner : corners)
      if (corner < 0 || static_cast<std::size_t>(corner) >= vertices.size())
        throw std::invalid_argument("a triangle names a vertex that does not exist");
    faces.emplace_back(corners[0], corners[1], corners[2]);
  }
  model->beginModel(static_cast<unsigned int>(faces.size()), static_cast<unsigned int>(vertices.size()));
  model->addSubModel(vertices, faces);
  model->endModel();
  model->computeLocalAABB();
  objects_->exact = model;
  objects_->is_mesh = true;
  objects_->tree = tree_of(*model);
  for (const auto& triangle : triangles)
    for (int corner : triangle) objects_->corners.push_back(vertices[static_cast<std::size_t>(corner)]);
  box_ = objects_->tree[0].box;
  box_.radius = 0.0;
  for (const Vec3& vertex : vertices) box_.radius = std::max(box_.radius, (vertex - box_.at.p).norm() + margin);
  try {
    model->buildConvexHull(true);
    objects_->hull = model->convex;
    objects_->hull->computeLocalAABB();
  } catch (const std::exception&) {  // qhull makes no hull of a flat mesh
    objects_->hull = nullptr;
  }
}

Geometry::~Geometry() = default;

}  // namespace pinik
