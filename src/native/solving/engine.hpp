// One problem with one method and its settings, which can be solved again and again from any thread.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>

#include "attempts.hpp"
#include "by_rows.hpp"
#include "certifier.hpp"
#include "pool.hpp"
#include "robot.hpp"

namespace pinik {

class Engine {
 public:
  // Throws std::invalid_argument if what is to be avoided belongs to another robot.
  Engine(std::shared_ptr<const Robot> robot, const Problem& problem, const Settings& settings)
      : robot_(std::move(robot)), problem_(problem), settings_(settings) {
    if (settings.avoid && &settings.avoid->mechanism() != &robot_->mechanism)
      throw std::invalid_argument("the shapes to be avoided must be those of the engine's robot");
  }

  const Problem& problem() const { return problem_; }

  const Settings& settings() const { return settings_; }

  const std::shared_ptr<const Robot>& robot() const { return robot_; }

  const Mechanism& mechanism() const { return robot_->mechanism; }

  // Solve one problem, of whose time `spent` seconds are used up.
  Answer solve(Vector start, std::vector<Goal> goals, bool nearest, Pause pause, double spent) {
    std::unique_ptr<Worker> worker = borrow();
    Answer answer = worker->solve(*robot_, start, goals, 0, nearest, {nullptr, pause, spent});
    give_back(std::move(worker));
    answer.goals = std::move(goals);
    return answer;
  }

  // Solve `count` problems in several threads. `take` sets the start and the goals of a problem, `put` receives its
  // answer, and `pause` is called now and then and returns whether to continue. The number of a problem seeds its random
  // starts, so that the answers do not depend on the threads.
  template <class Take, class Put, class Pause>
  void solve_many(std::uint64_t count, int threads, bool nearest, const Take& take, const Put& put, Pause pause) {
    std::atomic<std::uint64_t> next{0};
    std::atomic<bool> stop{false};
    const auto make = [&] {
      return [&, worker = borrow()]() mutable {
        Vector start;
        std::vector<Goal> goals;
        for (std::uint64_t i = next++; i < count && !stop; i = next++) {
          take(i, start, goals);
          put(i, worker->solve(*robot_, start, goals, i, nearest, {&stop, nullptr, 0.0}));
        }
        give_back(std::move(worker));
      };
    };
    share(std::min<std::uint64_t>(static_cast<std::uint64_t>(threads), count), stop, make, pause);
  }

 private:
  // The working memory of one thread.
  struct Worker {
    Problem problem;
    Certifier::Memory memory;
    Interrupts interrupts;
    std::optional<Collisions> collisions;
    ByRows<Attempts> attempts;

    Worker(const Robot& robot, const Problem& asked, const Settings& settings)
        : problem(asked), memory(*robot.certifier) {
      if (settings.avoid) collisions.emplace(settings.avoid);
      Collisions* const avoided = collisions ? &*collisions : nullptr;
      attempts.make(problem, settings, interrupts, avoided);
    }

    // Solve one problem; `start` is put inside the limits.
    Answer solve(const Robot& robot, Vector& start, std::vector<Goal>& goals,
                 std::uint64_t target, bool nearest, const Interrupts& now) {
      const Clock::time_point began = Clock::now();
      problem.goals.swap(goals);
      interrupts = now;
      Answer answer;
      attempts.with([&](auto& method) { static_cast<Outcome&>(answer) = method(start, target, nearest); });
      answer.errors = robot.certifier->errors(problem, answer.q, memory);
      if (all_within(problem, answer.errors))
        answer.status = collisions && collisions->touches(answer.q.data()) ? Status::colliding : Status::converged;
      else if (answer.proof)
        answer.status = Status::unreachable;
      else if (answer.status == Status::converged || answer.status == Status::colliding)
        answer.status = Status::stalled;
      problem.goals.swap(goals);
      answer.seconds = now.spent + std::chrono::duration<double>(Clock::now() - began).count();
      return answer;
    }
  };

  const std::shared_ptr<const Robot> robot_;
  const Problem problem_;
  const Settings settings_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;

  std::unique_ptr<Worker> borrow() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Worker> worker = std::move(idle_.back());
        idle_.pop_back();
        return worker;
      }
    }
    return std::make_unique<Worker>(*robot_, problem_, settings_);
  }

  void give_back(std::unique_ptr<Worker> worker) {
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      idle_.push_back(std::move(worker));
    } catch (const std::bad_alloc&) {  // the worker is deleted instead of kept
    }
  }
};

}  // namespace pinik
