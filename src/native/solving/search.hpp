// The search for all distinct answers to one question; follows pinik.solving.search.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "engine.hpp"
#include "metric.hpp"
#include "run.hpp"
#include "settings.hpp"
#include "spread.hpp"
#include "watch.hpp"

namespace pinik {

// One answer.
struct Found {
  Vector q;
  bool inside = true;        // whether it is inside the limits
  std::int64_t start = 0;    // the number of the start from which it was found
  std::int64_t hits = 1;     // how many starts led to it
  double basin = 0.0;        // the distance from which a run that comes nearer is taken to end here
  TargetError error;         // the largest of all targets, by plain Pinocchio
  bool certified = false;    // whether all are within tolerance
  bool collides = false;     // whether something touches that is to be avoided
};

// What a search came to.
struct Findings {
  std::vector<Found> answers;
  std::int64_t starts = 0, iterations = 0;
  int redundancy = 0;  // the dimension of the set of answers at a general configuration
  bool ended_early = false;  // by the time limit
  double seconds = 0.0;
};

// Searches for the answers to one question after another, with the working memory of one thread.
template <int Rows>
class Search {
 public:
  Search(const Problem& problem, const Settings& settings, const Interrupts& interrupts)
      : problem_(sharpened(problem)), settings_(settings), watch_(interrupts, settings.time_limit),
        kinematics_(problem_), run_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()), metric_(problem_, limits_), spread_(problem_, limits_, settings.seed) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
  }

  // Search for the answers to `goals`, from `start`, which is put inside the limits, and from other starts.
  Findings operator()(Vector& start, const std::vector<Goal>& goals) {
    problem_.goals = goals;
    watch_.start();
    limits_.wrap(start, Vector(start));
    findings_ = Findings();
    last_new_ = 0;
    const std::int64_t most = std::min<std::int64_t>(spread_.begin(kinematics_, start), settings_.restarts);
    spread_.mark(start);
    if (redundancy_ < 0) redundancy_ = redundancy(start);
    findings_.redundancy = redundancy_;
    Vector q = start;
    for (std::int64_t number = 0;; ++number) {
      attempt(q, start, number);
      if (findings_.ended_early || number >= most || is_enough()) return std::move(findings_);
      spread_.next(q);
    }
  }

 private:
  Problem problem_;
  const Settings settings_;
  Watch watch_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  const Limits limits_, loose_;
  const Metric metric_;
  Spread<Rows> spread_;
  Findings findings_;
  int redundancy_ = -1;  // unknown until the first search
  std::int64_t last_new_ = 0;
  Vector before_, reached_;
  Linearization<Rows> at_;

  // The problem with tolerances that only exact answers meet.
  static Problem sharpened(Problem problem) {
    for (Term& term : problem.terms) {
      const double exact = problem.constants.exact_answer;
      const double allowed = term.tolerance.is_box ? term.tolerance.box.minCoeff() : term.tolerance.position;
      term.tolerance.position = std::min(allowed, exact * problem.size_of_chain);
      term.tolerance.orientation = std::min(term.tolerance.orientation, exact);
      term.tolerance.is_box = false;
    }
    problem.is_wide = false;
    return problem;
  }

  // How many dimensions the answers have at a general configuration: free coordinates without the rank of the Jacobian.
  int redundancy(const Vector& start) {
    Eigen::Index rank = 0;
    for (int k = 1; k <= problem_.constants.search_ranks; ++k) {
      at_.q = start;
      spread_.take(k, at_.q);
      kinematics_.linearize(at_);
      Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(at_.J));
      svd.setThreshold(problem_.constants.search_rank_threshold);
      rank = std::max(rank, svd.rank());
    }
    return static_cast<int>(static_cast<Eigen::Index>(problem_.coordinates.size()) - rank);
  }

  // Whether further starts are unlikely to bring a new answer: of isolated answers, each inside the limits was found twice, and
  // there were three starts for each since the last new one.
  bool is_enough() const {
    const Constants& constants = problem_.constants;
    if (findings_.starts < (redundancy_ > 0 ? constants.search_samples : constants.search_least)) return false;
    if (redundancy_ > 0) return true;
    const auto count = static_cast<std::int64_t>(findings_.answers.size());
    if (findings_.starts - 1 - last_new_ < constants.search_since * count) return false;
    for (const Found& answer : findings_.answers)
      if (answer.inside && answer.hits < 2) return false;
    return true;
  }

  // Run from one start. If answers are isolated, the run may leave the limits to the end, since an answer outside counts
  // as known too, and it ends as soon as it is heading for a known one.
  void attempt(const Vector& from, const Vector& near, std::int64_t number) {
    ++findings_.starts;
    const bool isolated = redundancy_ == 0;
    const RunSettings run{settings_.max_iterations, problem_.constants.search_patience, true, false, false, settings_.polish, false};
    Found* known = nullptr;
    Status ended = Status::running;
    const auto see = [&](const Linearization<Rows>& at, std::int64_t iteration, std::int64_t, Status status) {
      ended = status;
      reached_ = at.q;
      ++findings_.iterations;
      if (status != Status::running) return false;
      findings_.ended_early = watch_.out_of_time();
      if (findings_.ended_early) return false;
      if (isolated && iteration > 0) known = heading_for(at.q);
      before_ = at.q;
      return known == nullptr;
    };
    run_(from, near, isolated ? loose_ : limits_, loose_, run, see);
    if (!known && ended != Status::converged) return;
    for (Found& answer : findings_.answers)
      if (!known && metric_.largest(reached_, answer.q) <= problem_.constants.same_answer) known = &answer;
    if (known)
      ++known->hits;
    else
      add(near, number);
  }

  // The known answer that a run from `before_` to q is heading for: it is nearby, and the last step led towards it.
  Found* heading_for(const Vector& q) {
    for (Found& answer : findings_.answers) {
      const double now = metric_.length(q, answer.q);
      if (now < answer.basin && now < problem_.constants.search_approach * metric_.length(before_, answer.q))
        return &answer;
    }
    return nullptr;
  }

  void add(const Vector& near, std::int64_t number) {
    Found answer;
    answer.q = reached_;
    limits_.wrap(answer.q, near);
    answer.inside = metric_.largest(answer.q, reached_) <= problem_.constants.search_outside;
    if (!answer.inside) answer.q = reached_;
    answer.start = number;
    if (redundancy_ == 0) answer.basin = problem_.constants.search_basin * least_singular_value(answer.q);
    spread_.mark(answer.q);
    findings_.answers.push_back(std::move(answer));
    last_new_ = number;
  }

  // A lower bound of the Jacobian's smallest singular value, per length of the chain: σ² ≥ 1 / trace (JᵀJ)⁻¹.
  double least_singular_value(const Vector& q) {
    at_.q = q;
    kinematics_.linearize(at_);
    const Eigen::MatrixXd square = at_.J.transpose() * at_.J;
    const Eigen::LLT<Eigen::MatrixXd> factor(square);
    if (factor.info() != Eigen::Success) return 0.0;
    const double trace = factor.solve(Eigen::MatrixXd::Identity(square.rows(), square.cols())).trace();
    return std::isfinite(trace) && trace > 0.0 ? 1.0 / std::sqrt(trace) / problem_.size_of_chain : 0.0;
  }
};

// Searches for the answers to the questions of one engine, and has Pinocchio measure them.
class Searcher {
 public:
  explicit Searcher(const Engine& engine)
      : robot_(engine.robot()), settings_(engine.settings()), problem_(engine.problem()), memory_(*robot_->certifier) {
    if (settings_.avoid) collisions_.emplace(settings_.avoid);
    if (problem_.rows == 3)
      search_.emplace<1>(problem_, settings_, interrupts_);
    else if (problem_.rows == 6)
      search_.emplace<2>(problem_, settings_, interrupts_);
    else
      search_.emplace<3>(problem_, settings_, interrupts_);
  }

  Searcher(const Searcher&) = delete;  // search_ refers to the other members
  Searcher& operator=(const Searcher&) = delete;

  const Problem& problem() const { return problem_; }

  Findings search(Vector start, const std::vector<Goal>& goals, Pause pause) {
    const Clock::time_point began = Clock::now();
    interrupts_.pause = pause;
    problem_.goals = goals;
    Findings findings;
    std::visit(
        [&](auto& search) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(search)>, std::monostate>) findings = search(start, goals);
        },
        search_);
    for (Found& answer : findings.answers) {
      if (!answer.inside) continue;
      answer.certified = true;
      const std::vector<TargetError> errors = robot_->certifier->errors(problem_, answer.q, memory_);
      for (std::size_t t = 0; t < errors.size(); ++t) {
        answer.certified = answer.certified && errors[t].within(problem_.terms[t].tolerance);
        answer.error.position = std::fmax(answer.error.position, errors[t].position);
        answer.error.orientation = std::fmax(answer.error.orientation, errors[t].orientation);
      }
      answer.collides = answer.certified && collisions_ && collisions_->touches(answer.q.data());
    }
    findings.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    return findings;
  }

 private:
  const std::shared_ptr<const Robot> robot_;
  const Settings settings_;
  Problem problem_;
  Certifier::Memory memory_;
  Interrupts interrupts_;
  std::optional<Collisions> collisions_;
  std::variant<std::monostate, Search<3>, Search<6>, Search<Eigen::Dynamic>> search_;
};

}  // namespace pinik
