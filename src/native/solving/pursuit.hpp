// A run whose targets move; follows pinik.solving.run, and how its generator is used.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "by_rows.hpp"
#include "engine.hpp"

namespace pinik {

// One run, which goes on from where it is when its targets move. Has the working memory of one thread.
class Pursuit {
 public:
  // Begin at `start`, which is inside the limits.
  Pursuit(const Engine& engine, Vector start, std::vector<Goal> goals, std::int64_t max_iterations,
          const Patience& patience)
      : robot_(engine.robot()), solver_(engine.settings().solver), limited_(engine.settings().limits),
        problem_(engine.problem()), start_(std::move(start)),
        limits_(Limits::of(*problem_.mechanism, limited_, problem_.constants.barely_outside)) {
    problem_.goals = std::move(goals);
    const RunSettings settings{max_iterations, patience, false, false, is_beyond(), engine.settings().polish};
    run_.make(problem_, solver_);
    run_.with([&](auto& own) {
      own.run.begin(start_, start_, limits_, limits_, settings);
      status_ = own.run.look();
    });
  }

  Pursuit(const Pursuit&) = delete;  // run_ refers to the other members
  Pursuit& operator=(const Pursuit&) = delete;

  const Problem& problem() const { return problem_; }

  // The present state. A run that has come to its end stays there until the goals move.
  State state() {
    State state;
    run_.with([&](auto& own) {
      const auto& at = own.run.at();
      state.q = at.q;
      state.errors = at.errors;
      state.residual = at.residual;
      state.iteration = own.run.iteration();
      state.joint_updates = own.run.updates();
    });
    state.status = status_;
    return state;
  }

  // Take at most `most` steps, fewer if the run comes to its end.
  void advance(std::int64_t most) {
    run_.with([&](auto& own) {
      for (std::int64_t k = 0; k < most && status_ == Status::running; ++k) {
        own.run.step();
        status_ = own.run.look();
      }
    });
  }

  // Move the goals, and take the next step towards them.
  void aim_at(std::vector<Goal> goals) {
    run_.with([&](auto& own) {
      const bool waited = own.run.waits(), moved = !(goals == problem_.goals);
      problem_.goals = std::move(goals);
      own.run.go_on(waited, moved, is_beyond());
      own.run.step();
      status_ = own.run.look();
    });
  }

 private:
  template <int Rows>
  struct Own {
    Kinematics<Rows> kinematics;
    Run<Rows> run;

    Own(const Problem& problem, const Solver& solver) : kinematics(problem), run(solver, kinematics) {
      kinematics.target_jacobian = solver.target_jacobian;
    }
  };

  const std::shared_ptr<const Robot> robot_;
  const Solver solver_;
  const bool limited_;
  Problem problem_;
  const Vector start_;
  const Limits limits_;
  Status status_ = Status::running;
  ByRows<Own> run_;

  // Only the damping of Jacobian methods asks for it.
  bool is_beyond() const { return !solver_.sweeps() && shortfall(problem_, limited_).has_value(); }
};

}  // namespace pinik
