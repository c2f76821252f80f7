// One point of a path after the other: each starts where the last one ended, on the same branch; follows
// pinik.solving.walk.
#pragma once

#include <cmath>
#include <vector>

#include "changes.hpp"
#include "run.hpp"
#include "settings.hpp"
#include "starts.hpp"
#include "watch.hpp"

namespace pinik {

// The result for one point.
struct Stride {
  Status ended = Status::running;
  Vector q;
  std::int64_t iterations = 0, restarts = 0;
  bool slowed = false;  // by the largest changes of the joints, in a tick
};

// Goes along paths with the working memory of one thread. `problem.goals` are those of the present point.
template <int Rows>
class Walk {
 public:
  Walk(Problem& problem, const Settings& settings, const Interrupts& interrupts)
      : problem_(problem), settings_(settings), watch_(interrupts, settings.time_limit), kinematics_(problem),
        run_(settings_.solver, kinematics_), stepping_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()), starts_(problem, limits_, settings.seed) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
  }

  const Limits& limits() const { return limits_; }

  // Go from `from`, which is inside the limits, to the problem's goals. `number` is the index of the point.
  const Stride& operator()(const Vector& from, std::uint64_t number) {
    watch_.start();
    stride_.iterations = stride_.restarts = 0;
    const Pace pace{settings_.max_iterations, settings_.patience, false, true};
    best_ = &plain_;
    run(from, pace, plain_);
    if (is_near(plain_, from) || plain_.status == Status::time_limit) return stride(*best_);
    if (!is_beyond() && creep(from, pace)) return stride(*best_);
    if (plain_.status != Status::converged) {
      best_ = &last_;
      run(plain_.q, {settings_.iterations_to_the_end, problem_.constants.to_the_end, false, true}, last_);
      if (is_near(last_, from) || last_.status == Status::time_limit) return stride(*best_);
    }
    look_elsewhere(from, number);
    return stride(*best_);
  }

  // Move towards the problem's goals as far as `most`, the largest changes of the joints by tangent coordinate, allows
  // within one tick, and never to another branch.
  const Stride& tick(const Vector& from, const Vector& most) {
    watch_.start();
    stride_.iterations = stride_.restarts = 0;
    const Pace pace{std::min(settings_.max_iterations, problem_.constants.tick_iterations), settings_.patience, false,
                    true};
    at_.q = from;
    kinematics_.linearize(at_);
    stepping_.damp_by(1.0, false);
    stepping_.advance(at_, limits_, 1.0, stride_.q);
    const double excess = largest_excess(from, stride_.q, most);
    targets_ = problem_.goals;
    if (excess > 1.0) {
      see_present(from);
      aim_between(1.0 / excess);
    }
    best_ = &plain_;
    run(from, pace, plain_);
    bool found = !is_jump(from, plain_.q);
    if (!found) {
      const std::vector<Goal> all = targets_;
      found = creep(from, pace);
      targets_ = all;
    }
    problem_.goals = targets_;
    stride(*best_);
    if (!found) stride_.q = from;
    const double beyond = largest_excess(from, stride_.q, most);
    if (beyond > 1.0) shorten(from, 1.0 / beyond);
    stride_.slowed = excess > 1.0 || beyond > 1.0;
    return stride_;
  }

 private:
  struct Pace {
    std::int64_t max_iterations;
    Patience patience;
    bool bold, downhill;
  };

  // The best state of a run inside the limits, with the status of its last state.
  struct Ran {
    Status status = Status::running;
    Vector q;
  };

  Problem& problem_;
  const Settings settings_;
  Watch watch_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  Stepping<Rows> stepping_;
  const Limits limits_, loose_;
  Starts<Rows> starts_;
  Stride stride_;
  Ran plain_, last_, crept_, tried_, elsewhere_;
  const Ran* best_ = nullptr;
  std::vector<Goal> origins_, targets_;
  Linearization<Rows> at_;
  Eigen::Matrix<double, Rows, Rows> square_;
  Vector step_, drawn_;

  const Stride& stride(const Ran& ran) {
    stride_.ended = ran.status;
    stride_.q = ran.q;
    return stride_;
  }

  bool is_beyond() const { return shortfall(problem_, settings_.limits).has_value(); }

  void run(const Vector& start, const Pace& pace, Ran& ran) {
    const RunSettings settings{pace.max_iterations, pace.patience,           pace.bold,
                               pace.downhill,       !pace.bold && is_beyond(), settings_.polish};
    double least = infinity;
    std::int64_t iterations = 0;
    const auto see = [&](const Linearization<Rows>& at, std::int64_t iteration, std::int64_t, Status status) {
      iterations = iteration;
      ran.status = status;
      if (iteration == 0 || status == Status::converged || (at.residual < least && limits_.contains(at.q))) {
        ran.q = at.q;
        least = at.residual;
      }
      if (status == Status::running && watch_.out_of_time()) ran.status = Status::time_limit;
      return ran.status == Status::running;
    };
    run_(start, start, limits_, loose_, settings, see);
    stride_.iterations += iterations;
  }

  bool is_near(const Ran& ran, const Vector& from) {
    return ran.status == Status::converged && !is_jump(from, ran.q);
  }

  bool is_jump(const Vector& before, const Vector& after) {
    const double change = largest_change(problem_, before, after);
    if (change <= problem_.constants.jump_floor) return false;
    at_.q = before;
    kinematics_.linearize(at_);
    return change > largest_asked(problem_, at_, square_, step_);
  }

  // Approach the goals in smaller steps, each half of the last if it fails. Returns whether that succeeds; best_ is then
  // its answer.
  bool creep(const Vector& from, const Pace& pace) {
    targets_ = problem_.goals;
    see_present(from);
    crept_.q = from;
    crept_.status = Status::running;
    double done = 0.0, step = 0.5;
    const double smallest = std::ldexp(1.0, -problem_.constants.creep_halvings);
    while (done < 1.0 && step >= smallest) {
      const double part = std::min(done + step, 1.0);
      aim_between(part);
      run(crept_.q, pace, tried_);
      if (tried_.status == Status::time_limit) break;
      if (is_near(tried_, crept_.q)) {
        done = part;
        std::swap(crept_, tried_);
      } else {
        step /= 2.0;
      }
    }
    problem_.goals = targets_;
    if (done < 1.0) return false;
    best_ = &crept_;
    return true;
  }

  // Set best_ to the answer nearest to `from`, of the one that it has and those of the restarts, if there is one.
  void look_elsewhere(const Vector& from, std::uint64_t number) {
    if (is_beyond() || !starts_.draws()) return;
    double least = best_->status == Status::converged ? largest_change(problem_, from, best_->q) : infinity;
    const Pace pace{settings_.max_iterations, settings_.patience, true, false};
    for (std::int64_t attempt = 1; attempt <= settings_.restarts; ++attempt) {
      stride_.restarts = attempt;
      starts_.next(kinematics_, from, number, attempt, drawn_);
      run(drawn_, pace, tried_);
      if (tried_.status == Status::time_limit) return;
      if (tried_.status != Status::converged) continue;
      limits_.wrap(tried_.q, from);
      const double change = largest_change(problem_, from, tried_.q);
      if (change < least) {
        least = change;
        std::swap(elsewhere_, tried_);
        best_ = &elsewhere_;
        if (!is_jump(from, elsewhere_.q)) return;
      }
    }
  }

  // Set origins_ to goals of the same kinds that the frames meet at q.
  void see_present(const Vector& q) {
    kinematics_.forward(q);
    origins_ = targets_;
    for (std::size_t t = 0; t < origins_.size(); ++t) {
      const Term& term = problem_.terms[t];
      const Placement at = kinematics_.seen_from_reference(term);
      Goal& goal = origins_[t];
      goal.position = at.p;
      goal.rotation = at.R;
      goal.direction = at.R * term.axis;
      goal.at = at.p + goal.direction * (targets_[t].at - at.p).norm();
    }
  }

  // Set the problem's goals to a part of the way from origins_ to targets_.
  void aim_between(double part) {
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      const Term& term = problem_.terms[t];
      const Goal &origin = origins_[t], &target = targets_[t];
      Goal& goal = problem_.goals[t];
      goal.position = origin.position + part * (target.position - origin.position);
      goal.at = origin.at + part * (target.at - origin.at);
      if (term.asks_rotation) {
        double angle = 0.0;
        const Vec3 whole = log3(target.rotation * origin.rotation.transpose(), angle);
        goal.rotation = angle > 0.0 ? Mat3(rotation_about(whole / angle, part * angle) * origin.rotation) : origin.rotation;
      }
      if (term.asks_axis && !term.asks_at) {
        const Vec3 direction = origin.direction + part * (target.direction - origin.direction);
        const double length = direction.norm();
        goal.direction = length < problem_.constants.no_direction ? target.direction : Vec3(direction / length);
      }
    }
  }

  // The largest change of a joint with one axis, relative to the largest that is allowed.
  double largest_excess(const Vector& before, const Vector& after, const Vector& most) const {
    double largest = 0.0;
    for (const MovingJoint& moving : problem_.moving) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(moving.joint)];
      if (joint.has_one_axis())
        largest = std::max(largest, std::abs(joint_change(joint, before, after, 1.0)) / most[joint.idx_v]);
    }
    return largest;
  }

  // Move stride_.q back towards `from`, so that this part of the way is left.
  void shorten(const Vector& from, double part) {
    const Vector to = stride_.q;
    for (const MovingJoint& moving : problem_.moving) {
      const Joint& joint = problem_.mechanism->joints[static_cast<std::size_t>(moving.joint)];
      double* own = stride_.q.data() + joint.idx_q;
      const double* start = from.data() + joint.idx_q;
      if (!joint.has_one_axis()) {
        interpolate_free(joint.kind, start, to.data() + joint.idx_q, part, own);
        continue;
      }
      const double step = part * joint_change(joint, from, to, 1.0);
      std::copy_n(start, joint.nq, own);
      problem_.mechanism->integrate(joint, stride_.q.data(), &step);
    }
    limits_.clip(stride_.q);
  }
};

}  // namespace pinik
