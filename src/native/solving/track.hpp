// Paths of one kind of question, one point after the other; follows pinik.solving.track and pinik.solving.tracker.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "engine.hpp"
#include "walk.hpp"

namespace pinik {

// What happens at a point that is missed: the path holds the last configuration that reached its point, goes on from the
// nearest one found, or ends.
enum class OnMiss { hold, nearest, stop };

// Follows paths with the working memory of one thread.
class Track {
 public:
  explicit Track(const Engine& engine)
      : robot_(engine.robot()), settings_(engine.settings()), problem_(engine.problem()), memory_(*robot_->certifier) {
    if (settings_.avoid) collisions_.emplace(settings_.avoid);
    Collisions* const avoided = collisions_ ? &*collisions_ : nullptr;
    walk_.make(problem_, settings_, interrupts_, avoided);
  }

  Track(const Track&) = delete;  // walk_ refers to the other members
  Track& operator=(const Track&) = delete;

  const Problem& problem() const { return problem_; }

  // Follow a path of `count` points from `q`. `take` sets the goals of a point, and `put` receives its answer. Returns the
  // number of points that were answered.
  template <class Take, class Put>
  std::uint64_t follow(Vector q, std::uint64_t count, OnMiss on_miss, Pause pause, const Take& take, const Put& put) {
    constexpr std::uint64_t points_between = 256;
    interrupts_.pause = pause;
    place(q);
    Answer answer;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % points_between == 0 && pause && !pause()) return i;
      const Clock::time_point began = Clock::now();
      take(i, problem_.goals);
      answer.proof.reset();
      walk_.with([&](auto& walk) { keep(walk(q, i), answer); });
      certify(answer);
      if (answer.status == Status::converged || on_miss == OnMiss::nearest) {
        q = answer.q;
      } else {
        answer.q = q;
        answer.errors = robot_->certifier->errors(problem_, q, memory_);
      }
      answer.seconds = std::chrono::duration<double>(Clock::now() - began).count();
      put(i, answer);
      if (answer.status != Status::converged && on_miss == OnMiss::stop) return i + 1;
    }
    return count;
  }

  // What a tick came to: the answer, whether further ticks will bring the targets nearer, and where something touches that
  // kept the tick from going on.
  struct Tick {
    Answer answer;
    bool approaches = false;
    std::optional<Vector> touching;
  };

  // One tick from `q` towards the goals, in which the joints change by at most `most`.
  Tick tick(Vector q, const Vector& most, const std::vector<Goal>& goals) {
    interrupts_.pause = nullptr;
    place(q);
    problem_.goals = goals;
    Tick tick;
    walk_.with([&](auto& walk) {
      const Stride& stride = walk.tick(q, most);
      tick.approaches = stride.approaches;
      tick.touching = stride.touching;
      keep(stride, tick.answer);
    });
    certify(tick.answer);
    return tick;
  }

 private:
  const std::shared_ptr<const Robot> robot_;
  const Settings settings_;
  Problem problem_;
  Certifier::Memory memory_;
  Interrupts interrupts_;
  std::optional<Collisions> collisions_;
  ByRows<Walk> walk_;

  // Put a start inside the limits.
  void place(Vector& q) {
    walk_.with([&](auto& walk) {
      walk.limits().wrap(q, Vector(q));
    });
  }

  static void keep(const Stride& stride, Answer& answer) {
    answer.status = stride.ended;
    answer.q = stride.q;
    answer.iterations = stride.iterations;
    answer.restarts = stride.restarts;
  }

  // Measure an answer's errors by plain Pinocchio; they decide its status.
  void certify(Answer& answer) {
    answer.errors = robot_->certifier->errors(problem_, answer.q, memory_);
    if (all_within(problem_, answer.errors)) {
      answer.status = collisions_ && collisions_->touches(answer.q.data()) ? Status::colliding : Status::converged;
      return;
    }
    answer.proof = shortfall(problem_, settings_.limits);
    if (answer.proof)
      answer.status = Status::unreachable;
    else if (answer.status == Status::converged || answer.status == Status::colliding)
      answer.status = Status::stalled;
  }
};

}  // namespace pinik
