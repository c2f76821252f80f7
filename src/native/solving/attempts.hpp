// The attempts of one solve: restarts, and the best state so far; follows pinik.solving.attempts.
#pragma once

#include "choice.hpp"
#include "colliding.hpp"
#include "outcome.hpp"
#include "run.hpp"
#include "settings.hpp"
#include "starts.hpp"
#include "watch.hpp"
#include "way_out.hpp"

namespace pinik {

// Solves one problem after another, with the working memory of one thread.
template <int Rows>
class Attempts {
 public:
  // Without `collisions`, nothing is to be avoided.
  Attempts(const Problem& problem, const Settings& settings, const Interrupts& interrupts, Collisions* collisions)
      : problem_(problem), settings_(settings), watch_(interrupts, settings.time_limit), kinematics_(problem),
        run_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()),
        choice_(problem, limits_, settings.choose_weights), colliding_(problem, limits_), starts_(problem, limits_, settings.seed),
        way_out_(settings_, kinematics_, run_, limits_, loose_, watch_, collisions) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
    for (const Joint& joint : problem.mechanism->joints) has_circles_ = has_circles_ || joint.nq == 2;
  }

  // Solve from `start`, which is put inside the limits, or with `nearest` from the best start in the table, where `start`
  // gives what is not drawn. `target` is the problem's number among many; it seeds the random starts.
  Outcome operator()(Vector& start, std::uint64_t target, bool nearest) {
    watch_.start();
    outcome_ = Outcome();
    least_miss_ = infinity;
    colliding_.begin();
    given_ = start;
    limits_.wrap(start, given_);
    given_ = start;
    target_ = target;
    first_number_ = nearest ? 1 : 0;
    loosens_ = true;
    outcome_.q = start;
    outcome_.proof = shortfall(problem_, settings_.limits);
    if (problem_.coordinates.empty()) {
      attempt(start_of(0, start), problem_.constants.to_the_end, 0, false, false, 0);
      outcome_.status = Status::stalled;
    } else if (settings_.restarts == 0) {
      outcome_.status =
          attempt(start_of(0, start), problem_.constants.to_the_end, settings_.max_iterations, false, false, 0);
    } else {
      outcome_.status = attempt_and_restart(start);
    }
    limits_.wrap(outcome_.q, given_);
    if (has_circles_) outcome_.start = given_;
    return std::move(outcome_);
  }

 private:
  const Problem& problem_;
  const Settings settings_;
  Watch watch_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  const Limits limits_, loose_;
  Outcome outcome_;
  double least_miss_ = infinity;  // of outcome_.q
  std::uint64_t target_ = 0;
  std::int64_t first_number_ = 0;  // 1 if the first attempt begins at the first of starts_
  Choice choice_;
  Colliding colliding_;  // answers at which something touches
  Starts<Rows> starts_;
  WayOut<Rows> way_out_;
  bool has_circles_ = false, loosens_ = true;
  Vector given_, drawn_, answer_;
  Linearization<Rows> inside_;

  Status attempt_and_restart(const Vector& start) {
    const bool proved = outcome_.proof.has_value();
    std::int64_t most = starts_.draws() ? settings_.restarts : 0;
    if (proved) most = std::min<std::int64_t>(most, problem_.constants.restarts_when_unreachable);
    const auto patience =
        static_cast<std::int64_t>(std::ceil(problem_.constants.nothing_new_share * static_cast<double>(most)));
    // With a wide tolerance, the first attempts look for the exact place only. The next one begins where they began.
    const std::int64_t first_loose = std::min<std::int64_t>(problem_.constants.exact_attempts, most);
    choice_.begin();
    Status status = Status::running;
    for (std::int64_t number = 0; number <= most; ++number) {
      outcome_.restarts = number;
      loosens_ = number >= first_loose;
      const Vector& own = start_of(number, start);
      const bool again = problem_.is_wide && number == first_loose && first_number_ == 0;
      status = attempt(again ? start : own, settings_.patience, settings_.max_iterations, !proved, proved, number);
      if (status == Status::time_limit || (status == Status::converged && !settings_.choose_nearest)) break;
      if (status == Status::converged)
        choice_.add(outcome_.q, given_);
      else
        choice_.add_nothing();
      if (choice_.count() > 0 ? choice_.since() >= patience : no_other_answer(number + 1)) break;
    }
    if (choice_.count() > 0) {
      outcome_.q = choice_.nearest(given_);
      outcome_.chosen_from = choice_.count();
      return Status::converged;
    }
    if (status == Status::converged) return status;
    if (colliding_.found().empty() && status != Status::time_limit) {
      loosens_ = true;
      const Vector best = outcome_.q;
      status = attempt(best, problem_.constants.to_the_end, settings_.iterations_to_the_end, false, true,
                       outcome_.restarts + 1);
    }
    return colliding_.found().empty() ? status : leave_touches();
  }

  // Whether further attempts are unlikely to bring another answer than those that collide, which are isolated.
  bool no_other_answer(std::int64_t attempts) {
    const std::vector<Vector>& found = colliding_.found();
    return colliding_.is_enough(attempts) &&
           std::all_of(found.begin(), found.end(), [&](const Vector& q) { return way_out_.is_isolated(q); });
  }

  // Try the way out of the shallowest touches. Take the first answer that is free, or else the shallowest.
  Status leave_touches() {
    std::vector<std::pair<double, std::size_t>> order;
    const std::vector<Vector>& found = colliding_.found();
    for (std::size_t k = 0; k < found.size(); ++k) order.emplace_back(way_out_.depth(found[k]), k);
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), static_cast<std::size_t>(settings_.way_out.ways)));
    double least = infinity;
    for (const auto& [before, number] : order) {
      answer_ = found[number];
      const double depth = way_out_(answer_, given_);
      if (depth >= least) continue;
      least = depth;
      outcome_.q = answer_;
      if (depth < 0.0) return Status::converged;
    }
    outcome_.chosen_from = static_cast<std::int64_t>(found.size());
    return Status::colliding;
  }

  const Vector& start_of(std::int64_t attempt, const Vector& given) {
    const std::int64_t number = attempt + first_number_;
    if (number == 0) return given;
    starts_.next(kinematics_, given, target_, number, drawn_);
    return drawn_;
  }

  Status attempt(const Vector& start, Patience patience, std::int64_t max_iterations, bool bold, bool downhill,
                 std::int64_t number) {
    RunSettings run{max_iterations, patience, bold, downhill, outcome_.proof.has_value(), settings_.polish,
                    loosens_};
    Status ended = Status::running;
    std::int64_t iterations = 0, updates = 0;
    const auto see = [&](const Linearization<Rows>& at, std::int64_t iteration, std::int64_t updated, Status status) {
      iterations = iteration;
      updates = updated;
      if (settings_.trace)
        outcome_.states.push_back({at.q, iteration, updated, at.errors, at.residual, number, status});
      ended = status;
      if (status == Status::converged || (miss(at) < least_miss_ && limits_.contains(at.q))) keep(at);
      if (status == Status::running && watch_.out_of_time()) ended = Status::time_limit;
      if (ended != Status::running && ended != Status::converged && !limits_.contains(at.q)) consider_inside(at);
      return ended == Status::running;
    };
    run_(start, given_, limits_, loose_, run, see);
    outcome_.iterations += iterations;
    outcome_.joint_updates += updates;
    return ended == Status::converged && collides() ? Status::colliding : ended;
  }

  // Whether something touches at the answer, which is then kept among the colliding ones.
  bool collides() {
    answer_ = outcome_.q;
    limits_.wrap(answer_, given_);
    const bool touches = way_out_.touches(answer_);
    if (touches) colliding_.add(answer_, outcome_.restarts);
    return touches;
  }

  // Keep a state outside the limits if it is the best so far after it has been put inside.
  void consider_inside(const Linearization<Rows>& at) {
    inside_.q = at.q;
    limits_.wrap(inside_.q, given_);
    kinematics_.linearize(inside_);
    if (miss(inside_) < least_miss_) keep(inside_);
  }

  void keep(const Linearization<Rows>& at) {
    outcome_.q = at.q;
    least_miss_ = miss(at);
  }

  // How far a state misses the targets [m]: its residual, or its errors beyond the tolerances if one is wide.
  double miss(const Linearization<Rows>& at) const {
    if (!problem_.is_wide) return at.residual;
    const double metres_per_radian = std::sqrt(problem_.squared_metres_per_radian);
    double squared = 0.0;
    for (std::size_t t = 0; t < at.errors.size(); ++t) {
      const Term& term = problem_.terms[t];
      const double own = term.weight * at.errors[t].excess(term.tolerance, metres_per_radian);
      squared += own * own;
    }
    return std::sqrt(squared);
  }
};

}  // namespace pinik
