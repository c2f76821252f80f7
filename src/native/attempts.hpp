// The attempts of one solve: restarts, the best so far, and the verdict on it; after pinik.attempts.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>

#include "run.hpp"
#include "starts.hpp"

namespace pinik {

using Clock = std::chrono::steady_clock;
using StopFlag = const std::atomic<bool>*;
using Pause = bool (*)();  // called now and then; says whether to go on

// What may end a solve from outside, as its time limit does: a flag, where there is one, and a call.
struct Interrupts {
  StopFlag stop = nullptr;
  Pause pause = nullptr;
};

struct Settings {
  Solver solver;
  Patience patience;  // of one attempt, where another one waits
  bool limits = true;
  int restarts = 0;
  std::uint64_t seed = 0;
  long max_iterations = 100, iterations_to_the_end = 5000;
  Tolerance tolerance;
  double time_limit = infinity;  // [s]
  bool trace = false;
};

// Which target lies out of reach, by how much, and of which bound: too far, or too near.
struct Shortfall {
  int target = -1;
  double distance = 0.0, bound = 0.0;
  bool inner = false;
};

struct Outcome {
  Status status = Status::running;
  Vector q;  // the best configuration
  long iterations = 0, joint_updates = 0;
  int restarts = 0;
  std::optional<Shortfall> proof;
  std::vector<State> states;  // where a trace is wanted
};

// The target furthest outside its chain's reach, if one is; the bounds were computed by pinik.reach.
inline std::optional<Shortfall> shortfall(const Problem& problem, bool limits) {
  constexpr double rounding = 1e-12;
  std::optional<Shortfall> worst;
  for (std::size_t t = 0; t < problem.terms.size(); ++t) {
    const Term& term = problem.terms[t];
    const double reach = term.reach[limits], hole = term.hole[limits];
    if (!term.asks_position || !term.has_bounds || !std::isfinite(reach)) continue;
    const Vec3& position = problem.goals[t].position;
    const double distance = (position - term.base).norm();
    const double slack = rounding * (reach + position.norm() + term.base.norm());
    Shortfall found{static_cast<int>(t), 0.0, 0.0, false};
    if (distance > reach + slack) {
      found.distance = distance - reach;
      found.bound = reach;
    } else if (distance < hole - slack) {
      found.distance = hole - distance;
      found.bound = hole;
      found.inner = true;
    }
    if (found.distance > 0.0 && (!worst || found.distance > worst->distance)) worst = found;
  }
  return worst;
}

constexpr Patience to_the_end{50, 1e-4};
constexpr int restarts_when_unreachable = 8;

// Solves one problem after another; holds the working memory of one thread.
template <int Rows>
class Attempts {
 public:
  Attempts(const Problem& problem, const Settings& settings, const Interrupts& interrupts)
      : problem_(problem), settings_(settings), interrupts_(interrupts), kinematics_(problem), run_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits)), loose_(limits_.loosened()),
        starts_(problem, limits_, settings.seed) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
  }

  // From a configuration (put inside the limits), or with `nearest` from one that the table knows, what is not drawn as
  // in `start`; `target` is the problem's number among many, a key of the drawn starts.
  Outcome operator()(Vector& start, std::uint64_t target, bool nearest) {
    began_ = paused_ = Clock::now();
    states_seen_ = 0;
    outcome_ = Outcome();
    least_residual_ = infinity;
    limits_.wrap(start);
    limits_.clip(start);
    target_ = target;
    first_number_ = nearest ? 1 : 0;
    outcome_.q = start;
    outcome_.proof = shortfall(problem_, settings_.limits);
    if (outcome_.proof && outcome_.proof->distance <= settings_.tolerance.position) outcome_.proof.reset();
    if (problem_.coordinates.empty()) {
      attempt(start_of(0, start), to_the_end, 0, false, false);
      outcome_.status = Status::stalled;
    } else if (settings_.restarts == 0) {
      outcome_.status = attempt(start_of(0, start), to_the_end, settings_.max_iterations, false, false);
    } else {
      outcome_.status = attempt_and_restart(start);
    }
    return std::move(outcome_);
  }

 private:
  const Problem& problem_;
  const Settings settings_;
  const Interrupts& interrupts_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  const Limits limits_, loose_;
  Outcome outcome_;
  double least_residual_ = infinity;  // of outcome_.q
  std::uint64_t target_ = 0;
  int first_number_ = 0;  // 1 where the first attempt takes the first of starts_
  Clock::time_point began_, paused_;
  int states_seen_ = 0;
  Starts<Rows> starts_;
  Vector drawn_;
  Linearization<Rows> inside_;

  Status attempt_and_restart(const Vector& start) {
    const bool proved = outcome_.proof.has_value();
    int most = starts_.draws() ? settings_.restarts : 0;
    if (proved) most = std::min(most, restarts_when_unreachable);
    for (int number = 0; number <= most; ++number) {
      outcome_.restarts = number;
      const Status status =
          attempt(start_of(number, start), settings_.patience, settings_.max_iterations, !proved, proved);
      if (status == Status::converged || status == Status::time_limit) return status;
    }
    const Vector best = outcome_.q;
    return attempt(best, to_the_end, settings_.iterations_to_the_end, false, true);
  }

  const Vector& start_of(int attempt, const Vector& given) {
    const int number = attempt + first_number_;
    if (number == 0) return given;
    starts_.next(kinematics_, given, target_, number, drawn_);
    return drawn_;
  }

  Status attempt(const Vector& start, Patience patience, long max_iterations, bool bold, bool downhill) {
    RunSettings run{max_iterations, settings_.tolerance, patience, bold, downhill, outcome_.proof.has_value(),
                    outcome_.restarts};
    Status ended = Status::running;
    long iterations = 0, updates = 0;
    run_(start, limits_, loose_, run, [&](const Linearization<Rows>& at, long iteration, long updated, Status status) {
      iterations = iteration;
      updates = updated;
      if (settings_.trace)
        outcome_.states.push_back({at.q, iteration, updated, at.errors, at.residual, outcome_.restarts, status});
      ended = status;
      if (status == Status::converged || (at.residual < least_residual_ && limits_.contains(at.q))) keep(at);
      if (status == Status::running && out_of_time()) ended = Status::time_limit;
      if (ended != Status::running && ended != Status::converged && !limits_.contains(at.q)) consider_inside(at);
      return ended == Status::running;
    });
    outcome_.iterations += iterations;
    outcome_.joint_updates += updates;
    return ended;
  }

  bool out_of_time() {
    constexpr int states_between = 256;
    constexpr std::chrono::milliseconds pauses_apart{50};
    if (interrupts_.stop && interrupts_.stop->load(std::memory_order_relaxed)) return true;
    if (interrupts_.pause && ++states_seen_ % states_between == 0 && Clock::now() - paused_ > pauses_apart) {
      paused_ = Clock::now();
      if (!interrupts_.pause()) return true;
    }
    return settings_.time_limit < infinity &&
           std::chrono::duration<double>(Clock::now() - began_).count() > settings_.time_limit;
  }

  // Take a state outside the limits for what it is worth inside.
  void consider_inside(const Linearization<Rows>& at) {
    inside_.q = at.q;
    limits_.wrap(inside_.q);
    limits_.clip(inside_.q);
    kinematics_.linearize(inside_);
    if (inside_.residual < least_residual_) keep(inside_);
  }

  void keep(const Linearization<Rows>& at) {
    outcome_.q = at.q;
    least_residual_ = at.residual;
  }
};

}  // namespace pinik
