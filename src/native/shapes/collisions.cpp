#include "collisions.hpp"

#include <coal/collision_data.h>
#include <coal/collision_func_matrix.h>
#include <coal/distance_func_matrix.h>
#include <coal/internal/shape_shape_func.h>
#include <coal/narrowphase/narrowphase.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "objects.hpp"
#include "triangles.hpp"

namespace pinik {
namespace {

// What coal takes as apart by more than this is apart.
constexpr double surely = 1e-5;

const coal::CollisionFunctionMatrix& collision_functions() {
  static const coal::CollisionFunctionMatrix functions;
  return functions;
}

const coal::DistanceFunctionMatrix& distance_functions() {
  static const coal::DistanceFunctionMatrix functions;
  return functions;
}

// Without a request for contacts coal overlooks some shapes that go deep into each other, such as two coaxial cylinders.
coal::CollisionRequest request(coal::CollisionRequestFlag flag) {
  coal::CollisionRequest request(flag, 1);
  request.distance_upper_bound = surely;
  return request;
}

void check_number(int number, std::size_t count, const char* what) {
  if (number < 0 || static_cast<std::size_t>(number) >= count)
    throw std::invalid_argument(std::string("there is no ") + what + " " + std::to_string(number));
}

}  // namespace

int Shapes::add_shape(std::shared_ptr<const Geometry> geometry, int joint, const Placement& placement) {
  check_number(joint, mechanism_.joints.size(), "joint");
  Shape shape;
  const Mat3 turned = mechanism_.joints[static_cast<std::size_t>(joint)].to_line.transpose();
  shape.placement = {turned * placement.R, turned * placement.p};
  shape.box = geometry->box();
  shape.box.at = shape.placement * geometry->box().at;
  shape.geometry = std::move(geometry);
  shape.joint = joint;
  shapes_.push_back(std::move(shape));
  return static_cast<int>(shapes_.size()) - 1;
}

void Shapes::add_pair(int first, int second, int group) {
  check_number(first, shapes_.size(), "shape");
  check_number(second, shapes_.size(), "shape");
  if (group < 0) throw std::invalid_argument("a group's number must be at least 0");
  pairs_.push_back({first, second, group});
  groups_ = std::max(groups_, static_cast<std::size_t>(group) + 1);
}

// The narrow phase of one pair after the other, in which coal's functions want a mesh before a primitive.
struct Collisions::Coal {
  using Object = std::shared_ptr<coal::CollisionGeometry> Geometry::Objects::*;

  const coal::CollisionRequest apart = request(coal::NO_REQUEST), contact = request(coal::CONTACT);
  const coal::DistanceRequest nearest{true};
  coal::GJKSolver solver;
  coal::CollisionResult found;
  coal::DistanceResult gap;
  const Geometry::Objects *first = nullptr, *second = nullptr;  // of the pair, the mesh first if one is a mesh
  coal::Transform3s at_first, at_second;
  bool swapped = false;
  std::vector<std::pair<std::size_t, std::size_t>> open;  // boxes of both trees that are still to be compared

  void take(const Geometry::Objects& a, const Placement& at_a, const Geometry::Objects& b, const Placement& at_b) {
    swapped = b.is_mesh && !a.is_mesh;
    first = swapped ? &b : &a;
    second = swapped ? &a : &b;
    at_first = coal::Transform3s(swapped ? at_b.R : at_a.R, swapped ? at_b.p : at_a.p);
    at_second = coal::Transform3s(swapped ? at_a.R : at_b.R, swapped ? at_a.p : at_b.p);
  }

  bool has_mesh() const { return first->is_mesh; }
  bool are_meshes() const { return first->is_mesh && second->is_mesh; }
  bool has_hulls() const { return first->hull && second->hull; }

  bool collide(Object of, const coal::CollisionRequest& asked) {
    const coal::CollisionGeometry *a = (first->*of).get(), *b = (second->*of).get();
    found.clear();
    solver.set(asked);
    collision_functions().collision_matrix[a->getNodeType()][b->getNodeType()](a, at_first, b, at_second, &solver, asked,
                                                                               found);
    return found.isCollision();
  }

  // Whether the surfaces of two meshes touch: as coal's own search, but it asks coal only for triangles that no plane parts.
  bool surfaces_touch() {
    const Mat3 R = at_first.getRotation().transpose() * at_second.getRotation();
    const Placement second_in_first{
        R, at_first.getRotation().transpose() * (at_second.getTranslation() - at_first.getTranslation())};
    solver.set(contact);
    open.assign(1, {0, 0});
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      const Node &own = first->tree[a], &other = second->tree[b];
      Box turned = other.box;
      turned.at = second_in_first * other.box.at;
      if (are_apart(own.box, turned)) continue;
      if (own.parts < 0 && other.parts < 0) {
        if (triangles_touch(own.triangle, other.triangle, second_in_first)) return true;
      } else if (other.parts < 0 || (own.parts >= 0 && own.box.radius > other.box.radius)) {
        for (int k : {1, 0}) open.push_back({static_cast<std::size_t>(own.parts + k), b});
      } else {
        for (int k : {1, 0}) open.push_back({a, static_cast<std::size_t>(other.parts + k)});
      }
    }
    return false;
  }

  bool triangles_touch(int a, int b, const Placement& second_in_first) {
    const Vec3* own = first->corners.data() + 3 * a;
    const Vec3* other = second->corners.data() + 3 * b;
    const Corners here{own[0], own[1], own[2]};
    Corners there;
    for (std::size_t k = 0; k < 3; ++k) there[k] = second_in_first.p + second_in_first.R * other[k];
    if (are_apart(here, there, surely)) return false;
    const coal::TriangleP triangle(own[0], own[1], own[2]), opposite(other[0], other[1], other[2]);
    Vec3 p, q, normal;
    const double distance = coal::internal::ShapeShapeDistance<coal::TriangleP, coal::TriangleP>(
        &triangle, at_first, &opposite, at_second, &solver, true, p, q, normal);
    return distance <= contact.collision_distance_threshold;
  }

  double distance(Object of) {
    const coal::CollisionGeometry *a = (first->*of).get(), *b = (second->*of).get();
    gap.clear();
    solver.set(nearest);
    return distance_functions().distance_matrix[a->getNodeType()][b->getNodeType()](a, at_first, b, at_second, &solver,
                                                                                    nearest, gap);
  }

  // A pair of vectors, that of the pair's own first shape first.
  std::array<Vec3, 2> in_order(const std::array<coal::Vec3s, 2>& points) const {
    return {points[swapped ? 1 : 0], points[swapped ? 0 : 1]};
  }
};

Collisions::Collisions(std::shared_ptr<const Shapes> shapes)
    : shapes_(std::move(shapes)), joints_(shapes_->mechanism().joints.size()), boxes_(shapes_->shapes().size()),
      coal_(std::make_unique<Coal>()) {
  for (std::size_t k = 0; k < boxes_.size(); ++k) boxes_[k] = shapes_->shapes()[k].box;
}

Collisions::~Collisions() = default;
Collisions::Collisions(Collisions&&) noexcept = default;

void Collisions::place(const double* q) {
  place_joints(q);
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    const Shapes::Shape& shape = shapes_->shapes()[k];
    if (shape.joint != 0) boxes_[k].at = joints_[static_cast<std::size_t>(shape.joint)] * shape.box.at;
  }
}

void Collisions::place_joints(const double* q) {
  const Mechanism& mechanism = shapes_->mechanism();
  for (std::size_t j = 1; j < joints_.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    joints_[j] = mechanism.moved(joints_[static_cast<std::size_t>(joint.parent)], joint, q);
  }
}

bool Collisions::may_touch(const Shapes::Pair& pair) const {
  const Box& a = boxes_[static_cast<std::size_t>(pair.first)];
  const Box& b = boxes_[static_cast<std::size_t>(pair.second)];
  const double reach = a.radius + b.radius;
  return (a.at.p - b.at.p).squaredNorm() <= reach * reach && !are_apart(a, b);
}

void Collisions::take(const Shapes::Pair& pair) {
  const Shapes::Shape& a = shapes_->shapes()[static_cast<std::size_t>(pair.first)];
  const Shapes::Shape& b = shapes_->shapes()[static_cast<std::size_t>(pair.second)];
  coal_->take(a.geometry->objects(), joints_[static_cast<std::size_t>(a.joint)] * a.placement, b.geometry->objects(),
              joints_[static_cast<std::size_t>(b.joint)] * b.placement);
}

bool Collisions::touches(const Shapes::Pair& pair) {
  if (!may_touch(pair)) return false;
  take(pair);
  // Hulls that are apart hold surfaces that are, and are far quicker to compare than the triangles.
  if (coal_->has_mesh() && coal_->has_hulls() && !coal_->collide(&Geometry::Objects::hull, coal_->apart) &&
      coal_->found.distance_lower_bound > surely)
    return false;
  if (coal_->are_meshes()) return coal_->surfaces_touch();
  return coal_->collide(&Geometry::Objects::exact, coal_->contact);
}

bool Collisions::touches(const double* q) {
  place(q);
  const std::vector<Shapes::Pair>& pairs = shapes_->pairs();
  return std::any_of(pairs.begin(), pairs.end(), [this](const Shapes::Pair& pair) { return touches(pair); });
}

Touch Collisions::touch(int number) {
  take(shapes_->pairs()[static_cast<std::size_t>(number)]);
  if (!coal_->has_hulls() || !coal_->collide(&Geometry::Objects::hull, coal_->contact))
    coal_->collide(&Geometry::Objects::exact, coal_->contact);
  const coal::Contact& contact = coal_->found.getContact(0);
  const Vec3 normal = coal_->swapped ? Vec3(-contact.normal) : Vec3(contact.normal);
  // coal's depth is a signed distance.
  return {number, std::max(-contact.penetration_depth, 0.0), normal, coal_->in_order(contact.nearest_points)};
}

std::vector<Touch> Collisions::report(const double* q) {
  place(q);
  std::vector<Touch> found;
  const std::vector<Shapes::Pair>& pairs = shapes_->pairs();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (touches(pairs[k])) found.push_back(touch(static_cast<int>(k)));
  return found;
}

Clearance Collisions::clearance(const double* q) {
  const std::vector<Touch> touching = report(q);
  if (!touching.empty()) {
    const auto less = [](const Touch& a, const Touch& b) { return a.depth < b.depth; };
    const Touch& deepest = *std::max_element(touching.begin(), touching.end(), less);
    return {deepest.pair, -deepest.depth, deepest.points};
  }
  // Balls and hulls are never farther apart than what they hold; from the nearest on, most pairs need no more than them.
  const std::vector<Shapes::Pair>& pairs = shapes_->pairs();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Box& a = boxes_[static_cast<std::size_t>(pairs[k].first)];
    const Box& b = boxes_[static_cast<std::size_t>(pairs[k].second)];
    order.emplace_back((a.at.p - b.at.p).norm() - a.radius - b.radius, k);
  }
  std::sort(order.begin(), order.end());
  Clearance least;
  for (const auto& [bound, number] : order) {
    if (bound >= least.distance) break;
    take(pairs[number]);
    if (coal_->has_mesh() && coal_->has_hulls() && coal_->distance(&Geometry::Objects::hull) - surely >= least.distance)
      continue;
    const double distance = std::max(coal_->distance(&Geometry::Objects::exact), 0.0);
    if (distance < least.distance) least = {static_cast<int>(number), distance, coal_->in_order(coal_->gap.nearest_points)};
  }
  return least;
}

}  // namespace pinik
