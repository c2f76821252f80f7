// Which build of pinik the module belongs to.
#pragma once

namespace pinik {

// Identifies the signatures of the module: the digest of its stub, as tests/solving/test_native.py computes it. It must
// equal ABI in pinik/engine.py, which refuses a module from another build.
constexpr const char* abi = "00d16a990ebe3c40";

}  // namespace pinik
