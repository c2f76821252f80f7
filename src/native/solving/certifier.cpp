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

template <class JointModel>
void add_one_axis(pinocchio::Model& model, const Mechanism& mechanism, const Joint& joint, const JointModel& own,
                  const pinocchio::SE3& placement, const std::string& name) {
  const auto parent = static_cast<pinocchio::JointIndex>(joint.parent);
  if (!joint.follows) {
    model.addJoint(parent, own, placement, name);
    return;
  }
  for (std::size_t j = 1; j < model.joints.size(); ++j)
    if (!mechanism.joints[j].follows && mechanism.joints[j].idx_q == joint.idx_q) {
      const pinocchio::JointModelMimic mimic(own, model.joints[j], joint.multiplier, joint.offset);
      model.addJoint(parent, mimic, placement, name);
      return;
    }
  throw std::invalid_argument("a mimic joint must come after the joint that it follows");
}

void add(pinocchio::Model& model, const Mechanism& mechanism, std::size_t number) {
  const Joint& joint = mechanism.joints[number];
  const std::string name = std::to_string(number);
  const auto parent = static_cast<pinocchio::JointIndex>(joint.parent);
  const pinocchio::SE3 placement = se3(joint.placement);
  if (joint.kind == JointKind::floating)
    model.addJoint(parent, pinocchio::JointModelFreeFlyer(), placement, name);
  else if (joint.kind == JointKind::planar)
    model.addJoint(parent, pinocchio::JointModelPlanar(), placement, name);
  else if (joint.kind == JointKind::prismatic)
    add_one_axis(model, mechanism, joint, pinocchio::JointModelPZ(), placement, name);
  else if (joint.nq == 2)
    model.addJoint(parent, pinocchio::JointModelRUBZ(), placement, name);
  else
    add_one_axis(model, mechanism, joint, pinocchio::JointModelRZ(), placement, name);
}

pinocchio::SE3 in_world(int joint, const Placement& placement, const pinocchio::Data& data) {
  return data.oMi[static_cast<std::size_t>(joint)] * se3(placement);
}

TargetError error_of(const Term& term, const Goal& goal, double no_direction, const pinocchio::Data& data) {
  pinocchio::SE3 at = in_world(term.frame_joint, term.frame, data);
  if (term.has_reference) at = in_world(term.reference_joint, term.reference, data).actInv(at);
  TargetError error;
  if (term.asks_position) {
    const Vec3 left = term.along.cwiseProduct(goal.position - at.translation());
    error.position = left.norm();
    if (term.tolerance.is_box) error.offset = term.asks_rotation ? Vec3(goal.rotation.transpose() * left) : left;
  }
  if (term.asks_rotation) {
    error.orientation = pinocchio::log3(Mat3(goal.rotation * at.rotation().transpose())).norm();
  } else if (term.asks_axis) {
    const Vec3 axis = at.rotation() * term.axis;
    const Vec3 direction = term.asks_at ? Vec3(goal.at - at.translation()) : goal.direction;
    const bool there = term.asks_at && direction.norm() < no_direction;
    error.orientation = there ? 0.0 : std::atan2(axis.cross(direction).norm(), axis.dot(direction));
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
