// The time limit of a solve, and what may end it from outside; follows the deadlines of pinik.solving.attempts.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "../model/spatial.hpp"

namespace pinik {

using Clock = std::chrono::steady_clock;
using StopFlag = const std::atomic<bool>*;
using Pause = bool (*)();  // called now and then; returns whether to continue

// What may end a solve from outside: a flag and a call, either of which may be missing, and what is used up of its time.
struct Interrupts {
  StopFlag stop = nullptr;
  Pause pause = nullptr;
  double spent = 0.0;  // [s]
};

class Watch {
 public:
  Watch(const Interrupts& interrupts, double time_limit) : interrupts_(interrupts), time_limit_(time_limit) {}

  // Begin a solve.
  void start() {
    if (time_limit_ < infinity) began_ = Clock::now();  // reading the clock takes as long as a step
    left_ = time_limit_ - interrupts_.spent;
    paused_ = Clock::time_point();
    states_seen_ = 0;
  }

  // Whether a solve must end. Call this after each state.
  bool out_of_time() {
    constexpr int states_between = 256;
    constexpr std::chrono::milliseconds pauses_apart{50};
    if (interrupts_.stop && interrupts_.stop->load(std::memory_order_relaxed)) return true;
    if (interrupts_.pause && ++states_seen_ % states_between == 0 && Clock::now() - paused_ > pauses_apart) {
      paused_ = Clock::now();
      if (!interrupts_.pause()) return true;
    }
    return time_limit_ < infinity && std::chrono::duration<double>(Clock::now() - began_).count() > left_;
  }

 private:
  const Interrupts& interrupts_;
  const double time_limit_;
  double left_ = infinity;
  Clock::time_point began_, paused_;
  std::int64_t states_seen_ = 0;
};

}  // namespace pinik
