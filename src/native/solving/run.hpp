// One run of one method from one start: the loop; follows pinik.solving.run.
#pragma once

#include "state.hpp"
#include "stepping.hpp"

namespace pinik {

struct RunSettings {
  std::int64_t max_iterations = 0;
  Patience patience;
  bool bold = false, downhill = false, beyond = false, polish = false;
  bool loosens = true;  // whether a run that stalls looks for an answer inside wide tolerances
};

// A run in progress. Solves run it to its end; a `Pursuit` (pursuit.hpp) lets its targets move meanwhile.
template <int Rows>
class Run {
 public:
  Run(const Solver& solver, Kinematics<Rows>& kinematics)
      : solver_(solver), kinematics_(kinematics), stepping_(solver, kinematics) {}

  // Run from `start`, which is inside the limits. Calls `see(at, iteration, updates, status)` with every state, including
  // the start's, and stops when it returns false. What ends outside the limits is turned to be near to `near`.
  template <class See>
  void operator()(const Vector& start, const Vector& near, const Limits& limits, const Limits& loose,
                  const RunSettings& settings, See see) {
    begin(start, near, limits, loose, settings);
    for (;;) {
      const Status status = look();
      if (!see(at_, iteration_, updates_, status) || status != Status::running) return;
      step();
    }
  }

  // Begin a run, whose first state is at `start`. The limits and `near` must outlive it.
  void begin(const Vector& start, const Vector& near, const Limits& limits, const Limits& loose,
             const RunSettings& settings) {
    settings_ = settings;
    limits_ = &limits;
    near_ = &near;
    const bool bold = settings.bold && !solver_.sweeps();
    stepping_.damp_by(bold ? kinematics_.problem.constants.bold_part_of_distance : 1.0, settings.beyond);
    box_ = bold && limits.enabled ? &loose : &limits;
    kinematics_.loose = false;
    at_.q = start;
    kinematics_.linearize(at_);
    const Problem& problem = kinematics_.problem;
    exact_ = problem.constants.exact_part_of_chain * problem.size_of_chain * problem.lightest;
    milestone_ = at_.residual;
    scale_ = 1.0;
    before_ = infinity;
    since_ = iteration_ = updates_ = 0;
    last_ = settings.max_iterations;
  }

  // Judge the present state; may turn it into the limits, or loosen the tolerances.
  Status look() {
    const Problem& problem = kinematics_.problem;
    bool reached = all_within();
    if (reached && !limits_->contains(at_.q)) {  // only a bold run gets there
      move_inside();
      reached = all_within();
    }
    if (settings_.polish && !kinematics_.loose && (reached || before_ < infinity)) {
      const bool gains = reached && at_.residual <= problem.constants.polishing_gain * before_;
      if (gains && at_.residual > exact_ && iteration_ < last_) {
        before_ = at_.residual;
        box_ = limits_;
        since_ = 0;
        reached = false;
      } else {
        if (!reached || at_.residual > before_) std::swap(at_, next_);
        reached = true;
        before_ = infinity;
      }
    }
    if (at_.residual < milestone_ * (1.0 - settings_.patience.progress)) {
      milestone_ = at_.residual;
      since_ = 0;
    }
    if (reached) return Status::converged;
    if (since_ >= settings_.patience.iterations) {
      if (!can_loosen()) return Status::stalled;
      kinematics_.loose = true;
      scale_ = 1.0;
      move_inside();
      return Status::running;
    }
    return iteration_ >= last_ ? Status::max_iterations : Status::running;
  }

  // Take the next step.
  void step() {
    updates_ += stepping_.advance(at_, *box_, scale_, next_.q);
    kinematics_.linearize(next_);
    if (!settings_.downhill || solver_.sweeps()) {
      std::swap(at_, next_);
    } else if (next_.residual < at_.residual) {
      std::swap(at_, next_);
      scale_ = std::min(2.0 * scale_, 1.0);
    } else {
      scale_ /= 4.0;
    }
    ++iteration_;
    ++since_;
  }

  // Whether the run has a wide tolerance, and no answer yet, but has not stalled either.
  bool waits() const { return can_loosen() && since_ < settings_.patience.iterations && !all_within(); }

  // Go on with the goals that the problem has now, and with the iteration limit begun anew. Goals that move before they
  // are reached leave no time to stall, so a run with a wide tolerance looks for answers inside it at once. `waited` is
  // what waits() was before, `moved` whether the goals are others, and `beyond` whether one is proved out of reach.
  void go_on(bool waited, bool moved, bool beyond) {
    kinematics_.loose = kinematics_.loose || (waited && moved);
    settings_.beyond = beyond;
    stepping_.damp_by(1.0, beyond);
    kinematics_.linearize(at_);
    if (moved || !waited) {
      milestone_ = infinity;
      since_ = 0;
    }
    last_ = iteration_ + settings_.max_iterations;
    before_ = infinity;
  }

  const Linearization<Rows>& at() const { return at_; }
  std::int64_t iteration() const { return iteration_; }
  std::int64_t updates() const { return updates_; }

 private:
  const Solver& solver_;
  Kinematics<Rows>& kinematics_;
  Stepping<Rows> stepping_;
  Linearization<Rows> at_, next_;
  RunSettings settings_;
  const Limits* limits_ = nullptr;
  const Limits* box_ = nullptr;  // the limits of the steps; a bold run's are loose until it comes to its end
  const Vector* near_ = nullptr;
  double exact_ = 0.0, milestone_ = 0.0, scale_ = 1.0;
  double before_ = infinity;  // the residual before the last polishing step
  std::int64_t since_ = 0, iteration_ = 0, updates_ = 0, last_ = 0;

  void move_inside() {
    box_ = limits_;
    limits_->wrap(at_.q, *near_);
    kinematics_.linearize(at_);
    milestone_ = at_.residual;
    since_ = 0;
  }

  bool can_loosen() const {
    return settings_.loosens && kinematics_.problem.is_wide && !kinematics_.loose && !settings_.beyond;
  }

  bool all_within() const { return pinik::all_within(kinematics_.problem, at_.errors); }
};

}  // namespace pinik
