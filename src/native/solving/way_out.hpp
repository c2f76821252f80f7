// The way out of a slight touch: small steps in which the parts move away from each other and the targets stay reached;
// follows pinik.solving.way_out.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <vector>

#include "../shapes/collisions.hpp"
#include "run.hpp"
#include "settings.hpp"
#include "watch.hpp"

namespace pinik {

// Leads away from touches, for one kind of question, with the working memory of one thread.
template <int Rows>
class WayOut {
 public:
  // Without `collisions`, nothing is to be avoided.
  WayOut(const Settings& settings, Kinematics<Rows>& kinematics, Run<Rows>& run, const Limits& limits,
         const Limits& loose, Watch& watch, Collisions* collisions)
      : settings_(settings), own_(settings.way_out), kinematics_(kinematics), run_(run), limits_(limits), loose_(loose),
        watch_(watch), collisions_(collisions) {}

  // Whether anything touches at q.
  bool touches(const Vector& q) { return collisions_ && collisions_->touches(q.data()); }

  // The depth of the deepest touch at q [m]; −1 if nothing touches.
  double depth(const Vector& q) { return deepest(collisions_->report(q.data())); }

  // Whether the targets leave no motion at the answer q: whether their Jacobian has no kernel.
  bool is_isolated(const Vector& q) {
    at_.q = q;
    kinematics_.loose = false;
    kinematics_.linearize(at_);
    Eigen::JacobiSVD<Eigen::MatrixXd> svd{Eigen::MatrixXd(at_.J)};
    svd.setThreshold(own_.same_rank);
    return svd.rank() == at_.J.cols();
  }

  // Go on from an answer `q` at which something touches, as long as the touches become less deep. `near` is the
  // configuration to which hinges are turned. Writes the last answer into `q` and returns its depth.
  double operator()(Vector& q, const Vector& near) {
    std::vector<Touch> touches = collisions_->report(q.data());
    double depth = deepest(touches);
    for (int k = 0; k < own_.steps && !touches.empty(); ++k) {
      if (!step(q, touches) || !reach(near)) break;
      touches = collisions_->report(there_.data());
      const double now = deepest(touches);
      if (now >= depth) break;
      std::swap(q, there_);
      depth = now;
    }
    return depth;
  }

 private:
  const Settings& settings_;
  const WayOutSettings& own_;
  Kinematics<Rows>& kinematics_;
  Run<Rows>& run_;
  const Limits &limits_, &loose_;
  Watch& watch_;
  Collisions* const collisions_;
  Linearization<Rows> at_;
  Vector aside_, there_, probe_;

  static double deepest(const std::vector<Touch>& touches) {
    double depth = -1.0;
    for (const Touch& touch : touches) depth = std::max(depth, touch.depth);
    return depth;
  }

  // Write a configuration where the parts are apart into aside_, as far as the targets' Jacobian stays zero. Returns false
  // if there is none. With the derivatives G of the distances and the projection N onto the kernel of the Jacobian, the step
  // is N Gᵀ (G N Gᵀ + μ²I)⁻¹ d, where d are the depths and the gap that is aimed at.
  bool step(const Vector& q, const std::vector<Touch>& touches) {
    const auto count = static_cast<Eigen::Index>(touches.size());
    at_.q = q;
    kinematics_.loose = false;
    kinematics_.linearize(at_);
    if (at_.J.cols() == 0) return false;
    const Eigen::MatrixXd G = derivatives(q, touches);
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(at_.J), Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(own_.same_rank);
    const auto V = svd.matrixV().leftCols(svd.rank());
    const Eigen::MatrixXd projected = G - (G * V) * V.transpose();
    const double size = projected.norm();
    if (!(size > own_.stuck * G.norm())) return false;
    Vector wanted = Vector::Constant(count, own_.gap * kinematics_.problem.size_of_chain);
    for (Eigen::Index k = 0; k < count; ++k) wanted[k] += touches[static_cast<std::size_t>(k)].depth;
    Eigen::MatrixXd square = projected * projected.transpose();
    square.diagonal().array() += own_.damping * size * own_.damping * size;
    Vector dq = projected.transpose() * square.llt().solve(wanted);
    dq *= std::min(1.0, own_.longest_step / dq.cwiseAbs().maxCoeff());
    move(q, dq, aside_);
    limits_.clip(aside_);
    return true;
  }

  // By how much each touch (rows) opens as each free coordinate (columns) moves. The points of contact move with their
  // parts, along the normal: so the distance changes, to first order.
  Eigen::MatrixXd derivatives(const Vector& q, const std::vector<Touch>& touches) {
    const auto count = static_cast<Eigen::Index>(kinematics_.problem.coordinates.size());
    const std::vector<Placement>& joints = collisions_->joints();
    std::vector<std::array<Vec3, 2>> own;  // the points of contact, in their joints
    collisions_->place_joints(q.data());
    for (const Touch& touch : touches) {
      own.emplace_back();
      for (std::size_t side = 0; side < 2; ++side) {
        const Placement& joint = joints[joint_of(touch, side)];
        own.back()[side] = joint.R.transpose() * (touch.points[side] - joint.p);
      }
    }
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(touches.size()), count);
    Vector dq = Vector::Zero(count);
    for (Eigen::Index c = 0; c < count; ++c)
      for (const double sign : {1.0, -1.0}) {
        dq[c] = sign * own_.probe;
        move(q, dq, probe_);
        dq[c] = 0.0;
        collisions_->place_joints(probe_.data());
        for (std::size_t k = 0; k < touches.size(); ++k) {
          const Placement &first = joints[joint_of(touches[k], 0)], &second = joints[joint_of(touches[k], 1)];
          const Vec3 gap = second.p + second.R * own[k][1] - first.p - first.R * own[k][0];
          G(static_cast<Eigen::Index>(k), c) += sign * touches[k].normal.dot(gap) / (2.0 * own_.probe);
        }
      }
    return G;
  }

  std::size_t joint_of(const Touch& touch, std::size_t side) const {
    const Shapes::Pair& pair = collisions_->shapes().pairs()[static_cast<std::size_t>(touch.pair)];
    const int shape = side == 0 ? pair.first : pair.second;
    return static_cast<std::size_t>(collisions_->shapes().shapes()[static_cast<std::size_t>(shape)].joint);
  }

  // Write the configuration after a step of the free coordinates into `there`.
  void move(const Vector& q, const Vector& dq, Vector& there) const {
    there = q;
    integrate(kinematics_.problem, dq, there);
  }

  // Write the configuration near aside_ that reaches the targets again into there_. Returns false if there is none.
  bool reach(const Vector& near) {
    const RunSettings settings{std::min<std::int64_t>(own_.iterations, settings_.max_iterations),
                               settings_.patience, false, true, false, settings_.polish, false};
    Status ended = Status::running;
    const auto see = [&](const Linearization<Rows>& at, std::int64_t, std::int64_t, Status status) {
      ended = status;
      there_ = at.q;
      return status == Status::running && !watch_.out_of_time();
    };
    run_(aside_, near, limits_, loose_, settings, see);
    limits_.wrap(there_, near);
    return ended == Status::converged;
  }
};

}  // namespace pinik
