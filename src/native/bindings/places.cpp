// Places read in threads.
#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "interface.hpp"
#include "numbers.hpp"
#include "places.hpp"
#include "rows.hpp"

namespace pinik {

using namespace nb::literals;

namespace {

// Read places into goals (N, 18), and which of them Python must check: those that are not rotations up to the last bits,
// or not points. Nothing if the places are no contiguous float64 array (N, 4, 4) or (N, 3).
nb::object read_places(nb::handle places, double farthest, int threads) {
  std::size_t count = 0;
  const double* matrices = blocks_of(places, {4, 4}, count);
  const double* points = matrices ? nullptr : blocks_of(places, {3}, count);
  if (!matrices && !points) return nb::none();
  const auto [goals, out] = new_array({count, numbers_of_a_goal});
  std::mutex mutex;
  std::vector<std::int64_t> doubtful;
  share_rows(count, threads, [&, out = out] {
    return [&, out](std::uint64_t first, std::uint64_t size) {
      for (std::uint64_t i = first; i < first + size; ++i) {
        Goal goal;
        const bool sure = matrices ? read_matrix(matrices + 16 * i, farthest, goal) : read_point(points + 3 * i, farthest, goal);
        write_goal(goal, static_cast<bool>(matrices), out + numbers_of_a_goal * i);
        if (sure) continue;
        const std::lock_guard<std::mutex> lock(mutex);
        doubtful.push_back(static_cast<std::int64_t>(i));
      }
      return true;
    };
  });
  std::sort(doubtful.begin(), doubtful.end());
  const std::size_t number = doubtful.size();
  return nb::make_tuple(goals, as_array(std::move(doubtful), {number}));
}

}  // namespace

void register_places(nb::module_& m) {
  m.def("read_places", &read_places, "places"_a.none(), "farthest"_a, "threads"_a,
        nb::sig("def read_places(places: object, farthest: float, threads: int) -> "
                "tuple[NDArray[numpy.float64], NDArray[numpy.int64]] | None"));
}

}  // namespace pinik
