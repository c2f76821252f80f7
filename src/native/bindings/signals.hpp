// Ctrl-C during long calls.
#pragma once

#include <nanobind/nanobind.h>

namespace pinik {

// Let Python handle signals, from the thread that called it; returns false if a handler raised an exception, which is
// then set.
inline bool no_signal() {
  const nanobind::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() == 0;
}

}  // namespace pinik
