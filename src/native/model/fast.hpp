// Functions that are compiled twice: for any processor, and for processors with AVX2 and FMA. The loader chooses one.
#pragma once

#include <cstdlib>  // defines __GLIBC__

// Only code that is inlined into a marked function becomes faster. Flags for a whole file would do more, but they would
// also change the layout of Eigen's types (see alignment.hpp).
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__)
#define PINIK_FAST __attribute__((target_clones("default", "arch=x86-64-v3"), flatten))
#else
#define PINIK_FAST
#endif
