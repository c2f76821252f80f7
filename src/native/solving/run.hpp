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
    const bool bold = settings.bold && !solver_.sweeps();
    stepping_.damp_by(bold ? kinematics_.problem.constants.bold_part_of_distance : 1.0, settings.beyond);
    const Limits* box = bold && limits.enabled ? &loose : &limits;
    kinematics_.loose = false;
    at_.q = start;
    kinematics_.linearize(at_);
    const Problem& problem = kinematics_.problem;
    const double exact = problem.constants.exact_part_of_chain * problem.size_of_chain * problem.lightest;
    double milestone = at_.residual, scale = 1.0, before = infinity;  // `before` the last polishing step
    std::int64_t since = 0, iteration = 0, updates = 0;
    const auto move_inside = [&] {
      box = &limits;
      limits.wrap(at_.q, near);
      kinematics_.linearize(at_);
      milestone = at_.residual;
      since = 0;
    };
    for (;;) {
      bool reached = all_within(problem, at_.errors);
      if (reached && !limits.contains(at_.q)) {  // only a bold run gets there
        move_inside();
        reached = all_within(problem, at_.errors);
      }
      if (settings.polish && !kinematics_.loose && (reached || before < infinity)) {
        const bool gains = reached && at_.residual <= problem.constants.polishing_gain * before;
        if (gains && at_.residual > exact && iteration < settings.max_iterations) {
          before = at_.residual;
          box = &limits;
          since = 0;
          reached = false;
        } else {
          if (!reached || at_.residual > before) std::swap(at_, next_);
          reached = true;
        }
      }
      if (at_.residual < milestone * (1.0 - settings.patience.progress)) {
        milestone = at_.residual;
        since = 0;
      }
      Status status = Status::running;
      if (reached)
        status = Status::converged;
      else if (since >= settings.patience.iterations)
        status = Status::stalled;
      else if (iteration >= settings.max_iterations)
        status = Status::max_iterations;
      if (status == Status::stalled && settings.loosens && problem.is_wide && !kinematics_.loose && !settings.beyond) {
        kinematics_.loose = true;
        scale = 1.0;
        status = Status::running;
        move_inside();
      }
      if (!see(at_, iteration, updates, status) || status != Status::running) return;
      updates += stepping_.advance(at_, *box, scale, next_.q);
      kinematics_.linearize(next_);
      if (!settings.downhill || solver_.sweeps()) {
        std::swap(at_, next_);
      } else if (next_.residual < at_.residual) {
        std::swap(at_, next_);
        scale = std::min(2.0 * scale, 1.0);
      } else {
        scale /= 4.0;
      }
      ++iteration;
      ++since;
    }
  }

 private:
  const Solver& solver_;
  Kinematics<Rows>& kinematics_;
  Stepping<Rows> stepping_;
  Linearization<Rows> at_, next_;
};

}  // namespace pinik
