// Threads that share work.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace pinik {

// Get the memory that a thread needs for its first exception. Without it the C library would end the process when the
// exception is thrown, above all an exception about missing memory.
inline void prepare_to_throw() {
  [[maybe_unused]] const volatile int count = std::uncaught_exceptions();
}

// Threads that are joined on every way out, since the destructor of a running thread ends the process.
struct Pool {
  std::vector<std::thread> threads;

  ~Pool() {
    for (std::thread& thread : threads) thread.join();
  }
};

// Call `make()` for each of `threads` threads, in the calling thread, and then what it returned in a thread of its own.
// Returns when all threads have ended. Fewer of them run if memory or the system's threads run out. `pause` is called
// every 20 ms and returns whether to continue; if it returns false, or if a thread throws, `stop` is set, and the
// threads should then end soon. An exception that was thrown in a thread is rethrown here.
template <class Make, class Pause>
void share(std::size_t threads, std::atomic<bool>& stop, const Make& make, Pause pause) {
  if (threads == 0) return;
  prepare_to_throw();
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t working = 0;
  std::exception_ptr failure;
  const auto run = [&](auto& work) {
    const auto wait_until_all_have_started = [&] { const std::lock_guard<std::mutex> lock(mutex); };
    wait_until_all_have_started();
    prepare_to_throw();
    std::exception_ptr caught;
    try {
      work();
    } catch (...) {
      caught = std::current_exception();
      stop = true;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    if (caught) failure = caught;
    if (--working == 0) ended.notify_one();
  };
  {
    Pool pool;
    pool.threads.reserve(threads);  // so that no allocation can fail after a thread has started
    // For prepare_to_throw() in the threads. A block of this size comes from the system itself and goes back to it when it
    // is freed, which is where a new thread gets its memory from if there is little. Untouched, it costs nothing.
    std::unique_ptr<char[]> spare(new char[65 << 20]);
    static_cast<volatile char*>(spare.get())[0] = 0;  // keeps the compiler from leaving it out
    std::unique_lock<std::mutex> lock(mutex);
    try {
      while (pool.threads.size() < threads) {
        pool.threads.emplace_back([&run, work = make()]() mutable { run(work); });
        ++working;
      }
    } catch (...) {  // those that have started do the work
      if (pool.threads.empty()) throw;
    }
    spare.reset();
    while (!ended.wait_for(lock, std::chrono::milliseconds(20), [&] { return working == 0; })) {
      lock.unlock();
      if (!pause()) stop = true;
      lock.lock();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pinik
