// One point of a path after the other: each starts where the last one ended, on the same branch; follows
// pinik.solving.walk.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "changes.hpp"
#include "run.hpp"
#include "settings.hpp"
#include "starts.hpp"
#include "watch.hpp"
#include "way_out.hpp"

namespace pinik {

// The result for one point.
struct Stride {
  Status ended = Status::running;
  Vector q;
  std::int64_t iterations = 0, restarts = 0;
  bool approaches = false;  // whether the targets, missed in a tick, will be nearer after further ticks
  std::optional<Vector> touching;  // where something touches that kept the tick from going on
};

// Goes along paths with the working memory of one thread. `problem.goals` are those of the present point.
template <int Rows>
class Walk {
 public:
  // Without `collisions`, nothing is to be avoided.
  Walk(Problem& problem, const Settings& settings, const Interrupts& interrupts, Collisions* collisions)
      : problem_(problem), settings_(settings), watch_(interrupts, settings.time_limit), kinematics_(problem),
        run_(settings_.solver, kinematics_), stepping_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()), starts_(problem, limits_, settings.seed),
        way_out_(settings_, kinematics_, run_, limits_, loose_, watch_, collisions) {
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
    leave_touches(plain_, from);
    if (is_near(plain_, from) || plain_.status == Status::time_limit) return stride(*best_);
    if (!is_beyond() && creep(from, pace)) {
      crept_.status = Status::converged;
      leave_touches(crept_, from);
      if (crept_.status == Status::converged) return stride(crept_);
    }
    if (plain_.status != Status::converged && plain_.status != Status::colliding) {
      best_ = &last_;
      run(plain_.q, {settings_.iterations_to_the_end, problem_.constants.to_the_end, false, true}, last_);
      leave_touches(last_, from);
      if (is_near(last_, from) || last_.status == Status::time_limit) return stride(*best_);
    }
    look_elsewhere(from, number);
    return stride(*best_);
  }

  // Move towards the problem's goals as far as `most`, the largest changes of the joints by tangent coordinate, allows
  // within one tick, and never to another branch. It ends where nothing touches, unless something touches at `from`.
  const Stride& tick(const Vector& from, const Vector& most) {
    go(from, most);
    keep_free(from, most);
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
  WayOut<Rows> way_out_;
  Stride stride_;
  Ran plain_, last_, crept_, tried_, elsewhere_, straight_;
  const Ran* best_ = nullptr;
  std::vector<Goal> origins_, targets_;
  Linearization<Rows> at_;
  Eigen::Matrix<double, Rows, Rows> square_;
  Vector step_, drawn_, first_;

  const Stride& stride(const Ran& ran) {
    stride_.ended = ran.status;
    stride_.q = ran.q;
    return stride_;
  }

  // Move towards the problem's goals within one tick, whatever touches.
  void go(const Vector& from, const Vector& most) {
    watch_.start();
    stride_.iterations = stride_.restarts = 0;
    const Pace pace = pace_of_a_tick();
    const double least = problem_.constants.to_the_end.progress;
    run(from, pace, plain_);
    const bool near = !is_jump(from, plain_.q);
    const double ticks = largest_excess(from, plain_.q, most);
    stride(plain_);
    if (near && ticks <= 1.0) {
      stride_.approaches = plain_.status == Status::max_iterations || plain_.status == Status::time_limit;
      return;
    }
    const bool leads = near && plain_.status == Status::converged;
    const double before = residual_at(from);
    go_straight(from, most, pace, near);
    if (leads) {
      if (largest_excess(stride_.q, plain_.q, most) > ticks - 0.5) {
        stride_.q = plain_.q;
        shorten(from, most);
      }
    } else if (residual_at(stride_.q) >= before) {
      go_down(from, most, before);
    }
    stride_.approaches = largest_excess(from, stride_.q, most) >= least || residual_at(stride_.q) <= (1.0 - least) * before;
  }

  // If something touches at the end of a tick, take the way out of it, which leaves the frames where the tick takes them;
  // or the largest of halved parts of the tick at whose end nothing touches. If nothing helps, stay. Where something touches
  // at `from` already, what is less deep will do. Follows pinik.solving.detour.
  void keep_free(const Vector& from, const Vector& most) {
    stride_.touching.reset();
    if (!way_out_.touches(stride_.q)) return;
    const double before = way_out_.depth(from);
    const Vector wanted = stride_.q;
    if (takes(before, false, wanted)) return;
    go_aside(from);
    const bool is_on_the_way = largest_excess(from, stride_.q, most) > 1.0;
    shorten(from, most);
    if (takes(before, false, wanted)) {
      stride_.approaches = stride_.approaches || is_on_the_way;
      return;
    }
    stride_.q = wanted;
    for (int k = 0; k < problem_.constants.creep_halvings; ++k) {
      shorten(from, 0.5);
      if (takes(before, true, wanted)) return;
    }
    stride_.q = from;
    stride_.touching = before < 0.0 ? wanted : from;
  }

  // Whether a tick may end at stride_.q, where touches are less deep than `before`.
  bool takes(double before, bool is_cut, const Vector& wanted) {
    const double depth = way_out_.depth(stride_.q);
    if (depth >= std::max(before, 0.0)) return false;
    if (depth >= 0.0)
      stride_.touching = stride_.q;
    else if (is_cut)
      stride_.touching = wanted;
    return true;
  }

  // Set stride_.q to the end of the way out of what touches there, with the frames where they are there.
  void go_aside(const Vector& from) {
    const std::vector<Goal> all = problem_.goals;
    targets_ = all;
    see_present(stride_.q);
    problem_.goals = origins_;
    way_out_(stride_.q, from);
    problem_.goals = all;
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

  // Go out of a touch at an answer; if there is no way out, the run counts as a miss.
  void leave_touches(Ran& ran, const Vector& from) {
    if (ran.status == Status::converged && way_out_.touches(ran.q) && way_out_(ran.q, from) >= 0.0)
      ran.status = Status::colliding;
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

  // Approach the goals in smaller steps, each half of the last if it fails. Returns whether that reaches them; crept_ is
  // how far it came.
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
    return done >= 1.0;
  }

  Pace pace_of_a_tick() const {
    const std::int64_t iterations = std::min(settings_.max_iterations, problem_.constants.tick_iterations);
    const std::int64_t half = std::max(iterations / 2, std::int64_t{1});
    const double share = std::min(static_cast<double>(half) / static_cast<double>(settings_.patience.iterations), 1.0);
    return {iterations, {half, share * settings_.patience.progress}, false, true};
  }

  // The residual at q, whose targets pull inside wide tolerances too.
  double residual_at(const Vector& q) {
    kinematics_.loose = false;
    at_.q = q;
    kinematics_.linearize(at_);
    return at_.residual;
  }

  // Set stride_.q to a place on the straight way of the frames to the goals, within the largest changes. The first step of
  // the method says how much of the way that is.
  void go_straight(const Vector& from, const Vector& most, const Pace& pace, bool near) {
    residual_at(from);
    stepping_.damp_by(1.0, false);
    stepping_.advance(at_, limits_, 1.0, first_);
    const double excess = largest_excess(from, first_, most);
    const Ran* ran = &plain_;
    const std::vector<Goal> all = problem_.goals;
    if (excess > 1.0) {
      targets_ = all;
      see_present(from);
      aim_between(1.0 / excess);
      run(from, pace, straight_);
      ran = &straight_;
      near = !is_jump(from, straight_.q);
    }
    if (!near) {
      creep(from, pace);
      ran = &crept_;
    }
    problem_.goals = all;
    stride_.q = ran->q;
    shorten(from, most);
  }

  // Set stride_.q to a part of the method's first step after which the residual is below `before`, or to `from`.
  void go_down(const Vector& from, const Vector& most, double before) {
    stride_.q = first_;
    shorten(from, most);
    for (int k = 0; k < problem_.constants.creep_halvings; ++k) {
      if (residual_at(stride_.q) < before) return;
      shorten(from, 0.5);
    }
    stride_.q = from;
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
      if (way_out_.touches(tried_.q)) continue;
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
        goal.direction = length < problem_.constants.opposite ? target.direction : Vec3(direction / length);
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

  // Move stride_.q back towards `from`, until no change is larger than `most`.
  void shorten(const Vector& from, const Vector& most) {
    const double excess = largest_excess(from, stride_.q, most);
    if (excess > 1.0) shorten(from, 1.0 / excess);
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
