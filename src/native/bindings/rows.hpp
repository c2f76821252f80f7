// Work on the rows of arrays, shared among threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../solving/pool.hpp"
#include "signals.hpp"

namespace pinik {

// Share `count` rows among threads, without the interpreter's lock. `make()` is called once for each thread; what it
// returns is called with the first row and the number of rows, block by block, and returns whether to go on. Returns
// whether all rows were worked on. Throws if a signal handler raised an exception.
template <class Make>
bool share_rows(std::uint64_t count, int threads, const Make& make) {
  constexpr std::uint64_t rows_at_once = 256;
  constexpr std::uint64_t blocks_alone = 8;  // to start a thread takes longer than so few blocks
  constexpr std::uint64_t blocks_between = 64;
  const nanobind::gil_scoped_release release;
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> stop{false};
  bool interrupted = false;
  const auto make_work = [&] {
    return [&, work = make()]() mutable {
      for (std::uint64_t first = next.fetch_add(rows_at_once); first < count && !stop;
           first = next.fetch_add(rows_at_once))
        if (!work(first, std::min(rows_at_once, count - first))) stop = true;
    };
  };
  const auto pause = [&] {
    interrupted = interrupted || !no_signal();
    return !interrupted;
  };
  const std::uint64_t blocks = (count + rows_at_once - 1) / rows_at_once;
  if (threads == 1 || blocks <= blocks_alone) {
    auto work = make();
    for (std::uint64_t block = 0; block < blocks && !stop; ++block) {
      const std::uint64_t first = block * rows_at_once;
      stop = (block % blocks_between == blocks_between - 1 && !pause()) ||
             !work(first, std::min(rows_at_once, count - first));
    }
  } else {
    share(std::min<std::uint64_t>(static_cast<std::uint64_t>(threads), blocks), stop, make_work, pause);
  }
  if (interrupted) {
    const nanobind::gil_scoped_acquire acquire;
    throw nanobind::python_error();
  }
  return !stop;
}

}  // namespace pinik
