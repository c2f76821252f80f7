// The search for all distinct answers to one question; follows pinik.solving.search.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <memory>
#include <utility>
#include <vector>

#include "continuum.hpp"
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
  int dimension = 0;         // of the set of answers around it
  double basin = 0.0;        // the distance from which a run that comes nearer is taken to end here
  double distance = 0.0;     // the largest change of a joint from the start [rad or m]
  TargetError error;         // the largest of all targets, by plain Pinocchio
  bool certified = false;    // whether all are within tolerance
  std::optional<bool> collides;  // whether something touches that is to be avoided; none if that is not known yet
};

// What a search came to.
struct Findings {
  std::vector<Found> answers;
  std::int64_t starts = 0, iterations = 0;
  std::int64_t arrived = 0;        // how many starts led to an answer, inside the limits or not
  std::optional<int> redundancy;   // the largest dimension of the set of answers; none if none was found
  bool ended_early = false;  // by the time limit
  double seconds = 0.0;
};

// Searches for the answers to one question after another, with the working memory of one thread.
template <int Rows>
class Search {
 public:
  // Without `collisions`, nothing is to be avoided.
  Search(const Problem& problem, const Settings& settings, const Interrupts& interrupts, Collisions* collisions)
      : problem_(sharpened(problem)), settings_(settings), watch_(interrupts, settings.time_limit),
        kinematics_(problem_), run_(settings_.solver, kinematics_),
        limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()), metric_(problem_, limits_), continuum_(kinematics_, limits_),
        collisions_(collisions), spread_(problem_, limits_, settings.seed) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
  }

  // Search for the answers to `goals`, from `start`, which is inside the limits, and from other starts.
  Findings operator()(const Vector& start, const std::vector<Goal>& goals) {
    problem_.goals = goals;
    watch_.start();
    findings_ = Findings();
    last_new_ = colliding_ = 0;
    const std::int64_t most = std::min<std::int64_t>(spread_.begin(kinematics_, start), settings_.restarts);
    stride_ = 2 * (static_cast<std::size_t>(most) + 1);
    columns_.resize(stride_ * problem_.coordinates.size());
    before_.resize(stride_);
    now_.resize(stride_);
    spread_.mark(start);
    if (redundancy_ < 0) redundancy_ = redundancy(start);
    Vector q = start;
    for (std::int64_t number = 0;; ++number) {
      attempt(q, start, number);
      if (findings_.ended_early || number >= most || is_enough()) break;
      spread_.next(q);
    }
    for (const Found& answer : findings_.answers)
      if (answer.inside) findings_.redundancy = std::max(findings_.redundancy.value_or(0), answer.dimension);
    return std::move(findings_);
  }

 private:
  Problem problem_;
  const Settings settings_;
  Watch watch_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  const Limits limits_, loose_;
  const Metric metric_;
  Continuum<Rows> continuum_;
  Collisions* const collisions_;
  Spread<Rows> spread_;
  Findings findings_;
  int redundancy_ = -1;  // the dimension of the answers at a general configuration; unknown until the first search
  std::int64_t last_new_ = 0, colliding_ = 0;  // the start of the last new answer, and how many starts led to colliding ones
  Vector reached_;
  std::size_t stride_ = 0;               // the most answers that there can be
  std::vector<double> columns_;          // the coordinates of the answers, for metric_
  std::vector<double> before_, now_;     // squared distances of the present run's last two states from each answer
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
      rank = std::max(rank, continuum_.rank_at(Vector(at_.q), problem_.constants.search_rank_threshold));
    }
    return static_cast<int>(static_cast<Eigen::Index>(continuum_.free()) - rank);
  }

  // Whether further starts are unlikely to bring a new answer. Of infinitely many there are enough. Of isolated answers, each
  // inside the limits was found twice, and there were three starts for each since the last new one.
  bool is_enough() const {
    const Constants& constants = problem_.constants;
    std::int64_t isolated = 0, once = 0;
    for (const Found& answer : findings_.answers) {
      if (answer.dimension > 0) continue;
      ++isolated;
      if (answer.inside && answer.hits < 2) ++once;
    }
    if (redundancy_ > 0 && (isolated == 0 || isolated < static_cast<std::int64_t>(findings_.answers.size())))
      return findings_.starts - colliding_ >= constants.search_samples;
    return findings_.starts >= constants.search_least && once == 0 &&
           findings_.starts - 1 - last_new_ >= constants.search_since * isolated;
  }

  // Run from one start. If answers are isolated, the run may leave the limits to the end, since an answer outside counts
  // as known too. A continuum outside the limits may have another part inside them, so a second run looks for one there.
  void attempt(const Vector& from, const Vector& near, std::int64_t number) {
    ++findings_.starts;
    Found* answer = run(redundancy_ == 0 ? loose_ : limits_, from, near, number);
    if (answer) ++findings_.arrived;
    if (answer && answer->dimension > 0 && !answer->inside) {
      Vector inside = answer->q;
      limits_.wrap(inside, near);
      answer = run(limits_, inside, near, number);
    }
    if (answer && answer->collides.value_or(false)) ++colliding_;
  }

  // The answer that a run leads to, with one more hit; none if to none. If answers are isolated, the run ends as soon as it
  // is heading for a known one.
  Found* run(const Limits& limits, const Vector& from, const Vector& near, std::int64_t number) {
    const RunSettings settings{settings_.max_iterations, problem_.constants.search_patience, true, false, false, settings_.polish, false};
    Found* known = nullptr;
    Status ended = Status::running;
    const auto see = [&](const Linearization<Rows>& at, std::int64_t iteration, std::int64_t, Status status) {
      ended = status;
      reached_ = at.q;
      ++findings_.iterations;
      if (status != Status::running) return false;
      findings_.ended_early = watch_.out_of_time();
      if (findings_.ended_early) return false;
      if (redundancy_ == 0) known = heading_for(at.q, iteration > 0);
      return known == nullptr;
    };
    run_(from, near, limits, loose_, settings, see);
    if (!known && ended != Status::converged) return nullptr;
    for (Found& answer : findings_.answers)
      if (!known && metric_.largest(reached_, answer.q) <= problem_.constants.same_answer) known = &answer;
    if (!known) return add(near, number);
    ++known->hits;
    return known;
  }

  // The known answer that a run is heading for, which is now at q: it is nearby, and the last step led towards it.
  Found* heading_for(const Vector& q, bool has_stepped) {
    const double approach = problem_.constants.search_approach * problem_.constants.search_approach;
    std::vector<Found>& answers = findings_.answers;
    before_.swap(now_);
    metric_.squared(q, columns_.data(), stride_, answers.size(), [&](std::size_t k) -> const Vector& { return answers[k].q; },
                    now_.data());
    if (has_stepped)
      for (std::size_t k = 0; k < answers.size(); ++k)
        if (now_[k] < answers[k].basin * answers[k].basin && now_[k] < approach * before_[k]) return &answers[k];
    return nullptr;
  }

  // Add an answer; or count it for the known one of a continuum that stands for it, and return that one.
  Found* add(const Vector& near, std::int64_t number) {
    Found answer;
    answer.q = reached_;
    limits_.wrap(answer.q, near);
    answer.inside = metric_.largest(answer.q, reached_) <= problem_.constants.search_outside;
    if (!answer.inside) answer.q = reached_;
    answer.start = number;
    answer.dimension = redundancy_;
    const double least = least_singular_value(answer.q);
    answer.basin = problem_.constants.search_basin * least;
    const bool is_singular = least < problem_.constants.search_nearly_singular;
    const Vector exact = is_singular ? continuum_.settled(answer.q) : Vector();
    const Eigen::MatrixXd kernel = is_singular ? continuum_.kernel(exact) : Eigen::MatrixXd();
    if (redundancy_ > 0 || kernel.cols() > 0) answer.collides = answer.inside && touches(answer.q);
    if (kernel.cols() > redundancy_) {
      for (Found& other : findings_.answers) {
        if (redundancy_ > 0 || !stands_for(other, answer)) continue;
        ++other.hits;
        return &other;
      }
      answer.dimension = continuum_.dimension(exact, kernel, redundancy_);
    }
    spread_.mark(answer.q);
    metric_.store(answer.q, findings_.answers.size(), stride_, columns_.data());
    if (answer.dimension == 0 || redundancy_ > 0) last_new_ = number;
    findings_.answers.push_back(std::move(answer));
    return &findings_.answers.back();
  }

  bool touches(const Vector& q) const { return collisions_ && collisions_->touches(q.data()); }

  // Whether a known answer belongs to a continuum and is like a singular one nearby.
  bool stands_for(const Found& known, const Found& answer) const {
    return known.dimension > 0 && known.inside == answer.inside && known.collides == answer.collides &&
           metric_.largest(known.q, answer.q) <= problem_.constants.search_spacing;
  }

  // A lower bound of the Jacobian's smallest singular value, per length of the chain: σ² ≥ 1 / trace (JᵀJ)⁻¹; with more
  // columns than rows, JJᵀ takes the place of JᵀJ.
  double least_singular_value(const Vector& q) {
    at_.q = q;
    kinematics_.linearize(at_);
    Eigen::MatrixXd square;
    if (at_.J.rows() >= at_.J.cols()) square = at_.J.transpose() * at_.J;
    else square = at_.J * at_.J.transpose();
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
      : robot_(engine.robot()), settings_(engine.settings()), problem_(engine.problem()), memory_(*robot_->certifier),
        limits_(Limits::of(*problem_.mechanism, settings_.limits, problem_.constants.barely_outside)),
        ones_(problem_.coordinates.size(), 1.0) {
    if (settings_.avoid) collisions_.emplace(settings_.avoid);
    search_.make(problem_, settings_, interrupts_, collisions_ ? &*collisions_ : nullptr);
  }

  Searcher(const Searcher&) = delete;  // search_ refers to the other members
  Searcher& operator=(const Searcher&) = delete;

  const Problem& problem() const { return problem_; }

  // Search from `start`, which is put inside the limits. The answers are ordered by their distance from there.
  Findings search(Vector& start, const std::vector<Goal>& goals, Pause pause) {
    const Clock::time_point began = Clock::now();
    interrupts_.pause = pause;
    problem_.goals = goals;
    Findings findings;
    limits_.wrap(start, Vector(start));
    if (shortfall(problem_, settings_.limits)) return findings;  // a target is proved out of reach
    search_.with([&](auto& search) { findings = search(start, goals); });
    for (Found& answer : findings.answers) {
      if (!answer.inside) continue;
      answer.distance = largest_difference(problem_, start, answer.q, ones_);
      const std::vector<TargetError> errors = robot_->certifier->errors(problem_, answer.q, memory_);
      answer.certified = all_within(problem_, errors);
      answer.error = largest_of(errors);
      if (answer.certified && !answer.collides) answer.collides = collisions_ && collisions_->touches(answer.q.data());
    }
    std::stable_sort(findings.answers.begin(), findings.answers.end(),
                     [&](const Found& a, const Found& b) { return is_before(a, b); });
    findings.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    return findings;
  }

 private:
  const std::shared_ptr<const Robot> robot_;
  const Settings settings_;
  Problem problem_;
  Certifier::Memory memory_;
  const Limits limits_;
  Interrupts interrupts_;
  std::optional<Collisions> collisions_;
  const std::vector<double> ones_;  // by coordinate
  ByRows<Search> search_;

  // Whether one answer comes before another: by its distance, and where those are alike by its configuration.
  bool is_before(const Found& a, const Found& b) const {
    const double unit = problem_.constants.search_alike;
    const double from = std::nearbyint(a.distance / unit), to = std::nearbyint(b.distance / unit);
    if (from != to) return from < to;
    for (Eigen::Index i = 0; i < a.q.size(); ++i) {
      const double mine = std::nearbyint(a.q[i] / unit), other = std::nearbyint(b.q[i] / unit);
      if (mine != other) return mine < other;
    }
    return false;
  }
};

}  // namespace pinik
