// States as Python holds them.
#pragma once

#include <nanobind/nanobind.h>

#include "../solving/state.hpp"

namespace pinik {

// A tuple in the order of the fields of `pinik.solving.state.State`, with the engine's own status.
nanobind::tuple as_tuple(const State& state);

}  // namespace pinik
