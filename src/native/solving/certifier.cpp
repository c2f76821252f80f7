// Everything that needs Pinocchio's headers, which take a minute to compile.
#include "certifier.hpp"

#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/multibody/liegroup.hpp>
#include <stdexcept>
#include <string>

namespace pinik {
namespace {

pinocchio::SE3 se3(const Placement& placement) { return {placement.R, placement.p}; }

// The model of a joint with one axis: as in Pinocchio's reader of URDF, one of three for an axis of the frame, or else one
// for any axis.
template <class X, class Y, class Z, class Unaligned>
pinocchio::JointModel along(const Vec3& line) {
  if (line.isApprox(Vec3::UnitX())) return X();
  if (line.isApprox(Vec3::UnitY())) return Y();
  if (line.isApprox(Vec3::UnitZ())) return Z();
  return Unaligned(line.normalized());
}

pinocchio::JointModel model_of(const Joint& joint) {
  using namespace pinocchio;
  if (joint.kind == JointKind::floating) return JointModelFreeFlyer();
  if (joint.kind == JointKind::planar) return JointModelPlanar();
  if (joint.kind == JointKind::prismatic)
    return along<JointModelPX, JointModelPY, JointModelPZ, JointModelPrismaticUnaligned>(joint.line);
  if (joint.nq == 2)
    return along<JointModelRUBX, JointModelRUBY, JointModelRUBZ, JointModelRevoluteUnboundedUnaligned>(joint.line);
  return along<JointModelRX, JointModelRY, JointModelRZ, JointModelRevoluteUnaligned>(joint.line);
}

// The number of the joint that a joint follows.
std::size_t leader_of(const Mechanism& mechanism, const Joint& joint, std::size_t known) {
  for (std::size_t j = 1; j < known; ++j)
    if (!mechanism.joints[j].follows && mechanism.joints[j].idx_q == joint.idx_q) return j;
  throw std::invalid_argument("a mimic joint must come after the joint that it follows");
}

void add(pinocchio::Model& model, const Mechanism& mechanism, std::size_t number) {
  const Joint& joint = mechanism.joints[number];
  pinocchio::JointModel own = model_of(joint);
  if (joint.follows) {
    const pinocchio::JointModel& leader = model.joints[leader_of(mechanism, joint, model.joints.size())];
    own = pinocchio::JointModelMimic(own, leader, joint.multiplier, joint.offset);
  }
  model.addJoint(static_cast<pinocchio::JointIndex>(joint.parent), own, se3(joint.unturned), std::to_string(number));
}

pinocchio::SE3 in_world(int joint, const Placement& placement, const pinocchio::Data& data) {
  return data.oMi[static_cast<std::size_t>(joint)] * se3(placement);
}

// These three sum from left to right, as pinik.solving.verdict does.
double length(const Vec3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

pinocchio::SE3 turn(const Mat3& R) { return {R, Vec3::Zero()}; }

// Every product is one of Pinocchio's, in the order of pinik.solving.verdict, so that both round alike.
TargetError error_of(const Term& term, const Goal& goal, double no_direction, const pinocchio::Data& data) {
  pinocchio::SE3 at = in_world(term.frame_joint, term.unturned_frame, data);
  if (term.has_reference) at = in_world(term.reference_joint, term.unturned_reference, data).actInv(at);
  if (term.has_tool) at = at * se3(term.tool);
  TargetError error;
  if (term.asks_position) {
    const Vec3 left = term.along.cwiseProduct(goal.position - at.translation());
    error.position = length(left);
    if (term.tolerance.is_box) error.offset = term.asks_rotation ? turn(goal.rotation).actInv(left) : left;
  }
  if (term.asks_rotation) {
    error.orientation = length(pinocchio::log3((turn(goal.rotation) * turn(at.rotation()).inverse()).rotation()));
  } else if (term.asks_axis) {
    const Vec3 axis = turn(at.rotation()).act(term.axis);
    const Vec3 line = term.asks_at ? Vec3(goal.at - at.translation()) : goal.direction;
    const bool there = term.asks_at && length(line) < no_direction;
    error.orientation = there ? 0.0 : std::atan2(length(cross(axis, line)), dot(axis, line));
  }
  // An error that cannot be computed counts as a miss.
  if (term.asks_position && !std::isfinite(error.position)) error.position = infinity;
  if (term.asks_orientation() && !std::isfinite(error.orientation)) error.orientation = infinity;
  return error;
}

template <int Dimension, int Nq, int Nv>
void integrate_on(double* own, const double* step) {
  const Eigen::Matrix<double, Nq, 1> q = Eigen::Map<const Eigen::Matrix<double, Nq, 1>>(own);
  const Eigen::Matrix<double, Nv, 1> v = Eigen::Map<const Eigen::Matrix<double, Nv, 1>>(step);
  Eigen::Matrix<double, Nq, 1> moved;
  pinocchio::SpecialEuclideanOperationTpl<Dimension, double>().integrate(q, v, moved);
  Eigen::Map<Eigen::Matrix<double, Nq, 1>> entries(own);
  entries = moved;
}

template <int Dimension, int Nq>
void interpolate_on(const double* from, const double* to, double part, double* own) {
  using Entries = Eigen::Matrix<double, Nq, 1>;
  const Entries start = Eigen::Map<const Entries>(from), end = Eigen::Map<const Entries>(to);
  Entries between;
  pinocchio::SpecialEuclideanOperationTpl<Dimension, double>().interpolate(start, end, part, between);
  Eigen::Map<Entries> entries(own);
  entries = between;
}

template <int Dimension, int Nq, int Nv>
void difference_on(const double* from, const double* to, double* step) {
  const Eigen::Matrix<double, Nq, 1> a = Eigen::Map<const Eigen::Matrix<double, Nq, 1>>(from);
  const Eigen::Matrix<double, Nq, 1> b = Eigen::Map<const Eigen::Matrix<double, Nq, 1>>(to);
  Eigen::Matrix<double, Nv, 1> v = Eigen::Matrix<double, Nv, 1>::Zero();
  pinocchio::SpecialEuclideanOperationTpl<Dimension, double>().difference(a, b, v);
  Eigen::Map<Eigen::Matrix<double, Nv, 1>> entries(step);
  entries = v;
}

}  // namespace

void interpolate_free(JointKind kind, const double* from, const double* to, double part, double* own) {
  if (kind == JointKind::floating)
    interpolate_on<3, 7>(from, to, part, own);
  else
    interpolate_on<2, 4>(from, to, part, own);
}

void integrate_free(JointKind kind, double* own, const double* step) {
  if (kind == JointKind::floating)
    integrate_on<3, 7, 6>(own, step);
  else
    integrate_on<2, 4, 3>(own, step);
}

void difference_free(JointKind kind, const double* from, const double* to, double* step) {
  if (kind == JointKind::floating)
    difference_on<3, 7, 6>(from, to, step);
  else
    difference_on<2, 4, 3>(from, to, step);
}

struct Certifier::Model {
  pinocchio::Model model;
};

struct Certifier::Memory::Data {
  pinocchio::Data data;
};

Certifier::Memory::Memory(const Certifier& certifier)
    : data_(new Data{pinocchio::Data(certifier.model_->model)}) {}
Certifier::Memory::~Memory() = default;

Certifier::Certifier(const Mechanism& mechanism) : model_(std::make_unique<Model>()) {
  for (std::size_t j = 1; j < mechanism.joints.size(); ++j) add(model_->model, mechanism, j);
}
Certifier::~Certifier() = default;

std::vector<TargetError> Certifier::errors(const Problem& problem, const Vector& q, Memory& memory) const {
  pinocchio::Data& data = memory.data_->data;
  pinocchio::forwardKinematics(model_->model, data, q);
  std::vector<TargetError> errors;
  for (std::size_t t = 0; t < problem.terms.size(); ++t)
    errors.push_back(error_of(problem.terms[t], problem.goals[t], problem.constants.no_direction, data));
  return errors;
}

}  // namespace pinik
