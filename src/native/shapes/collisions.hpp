// Which shapes of a robot and of the world around it touch; follows pinik.shapes.checker.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "../model/mechanism.hpp"
#include "geometry.hpp"

namespace pinik {

// The shapes of a robot and its world, each fixed to a joint, and the pairs of them that must not touch. Threads share one.
class Shapes {
 public:
  struct Shape {
    std::shared_ptr<const Geometry> geometry;
    int joint = 0;        // 0 is the world
    Placement placement;  // in the joint, along its turned axes
    Box box;              // likewise
  };

  struct Pair {
    int first, second;
    int group;  // pairs of the same two links are one group
  };

  explicit Shapes(const Mechanism& mechanism) : mechanism_(mechanism) {}

  // Add a shape that is fixed to a joint; the placement is one of Pinocchio's model. Returns the shape's number. Throws
  // std::invalid_argument if there is no such joint.
  int add_shape(std::shared_ptr<const Geometry> geometry, int joint, const Placement& placement);

  // Add a pair of shapes. Groups are counted from 0. Throws std::invalid_argument if there is no such shape.
  void add_pair(int first, int second, int group);

  const Mechanism& mechanism() const { return mechanism_; }
  const std::vector<Shape>& shapes() const { return shapes_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  std::size_t groups() const { return groups_; }

 private:
  const Mechanism& mechanism_;
  std::vector<Shape> shapes_;
  std::vector<Pair> pairs_;
  std::size_t groups_ = 0;
};

// A pair of shapes that touch. Depth and normal are those of their convex hulls: moved by the depth against the normal, the
// first shape is free of the second.
struct Touch {
  int pair;                    // its number among the pairs
  double depth;                // how far the hulls go into each other [m]
  Vec3 normal;                 // a unit vector from the first shape to the second, in the world
  std::array<Vec3, 2> points;  // the deepest points of the first and of the second shape, in the world [m]
};

// The pair of shapes that are the least apart.
struct Clearance {
  int pair = -1;               // its number among the pairs; -1 if there are no pairs
  double distance = infinity;  // [m]; where shapes touch, minus the greatest depth
  std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()};  // the nearest points of the first and of the second shape, in the world [m]
};

// Finds what touches at one configuration after the other, with the working memory of one thread. Every q must be a
// configuration of the mechanism: all entries finite, pairs (cos, sin) and quaternions of unit length.
class Collisions {
 public:
  explicit Collisions(std::shared_ptr<const Shapes> shapes);
  ~Collisions();
  Collisions(Collisions&&) noexcept;

  const Shapes& shapes() const { return *shapes_; }

  // Whether any pair touches at q; ends with the first one that does.
  bool touches(const double* q);

  // All pairs that touch at q, in the order of the pairs.
  std::vector<Touch> report(const double* q);

  // The pair that is the least apart at q.
  Clearance clearance(const double* q);

  // Put all shapes where they are at q, for `touches(pair)`.
  void place(const double* q);

  // Put the joints alone where they are at q.
  void place_joints(const double* q);

  // Where the joints were put, along their turned axes.
  const std::vector<Placement>& joints() const { return joints_; }

  // Whether one pair touches where the shapes were placed.
  bool touches(const Shapes::Pair& pair);

 private:
  struct Coal;  // what the narrow phase needs
  std::shared_ptr<const Shapes> shapes_;
  std::vector<Placement> joints_;  // in the world, with turned axes
  std::vector<Box> boxes_;         // in the world, one for each shape
  std::unique_ptr<Coal> coal_;

  bool may_touch(const Shapes::Pair& pair) const;
  void take(const Shapes::Pair& pair);
  Touch touch(int number);
};

}  // namespace pinik
