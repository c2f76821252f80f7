// What Pinocchio's own calls of one iteration cost in C++: the frame's Jacobian, the error's logarithm, the integration.
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/parsers/urdf.hpp>
#include <pinocchio/spatial.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int, char** arguments) {
  pinocchio::Model model;
  pinocchio::urdf::buildModel(arguments[1], model);
  const auto frame = model.getFrameId(arguments[2], pinocchio::BODY);
  const int count = std::atoi(arguments[3]);
  pinocchio::Data data(model);
  Eigen::VectorXd q = pinocchio::neutral(model), next = q;
  const Eigen::VectorXd step = Eigen::VectorXd::Constant(model.nv, 1e-3);
  const pinocchio::SE3 target = pinocchio::SE3::Random();
  pinocchio::Data::Matrix6x J = pinocchio::Data::Matrix6x::Zero(6, model.nv);
  double sum = 0.0, best = 1e9;
  for (int round = 0; round < 20; ++round) {
    const auto began = std::chrono::steady_clock::now();
    for (int k = 0; k < count; ++k) {
      pinocchio::computeFrameJacobian(model, data, q, frame, pinocchio::LOCAL_WORLD_ALIGNED, J);
      const pinocchio::SE3& at = data.oMf[frame];
      sum += pinocchio::log3(Eigen::Matrix3d(target.rotation() * at.rotation().transpose())).sum() + J(0, 0);
      pinocchio::integrate(model, q, step, next);
      q.swap(next);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    best = std::min(best, seconds / count);
  }
  std::printf("%.6g %g\n", 1e6 * best, sum);
}
