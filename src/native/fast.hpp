// Functions compiled twice, for any processor and for those with AVX2 and FMA; the one that runs is chosen at load time.
#pragma once

#include <cstdlib>

// Only what a marked function inlines gains from it. Eigen's types keep their layout, which flags for a whole file
// would change against Pinocchio's libraries.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__)
#define PINIK_FAST __attribute__((target_clones("default", "arch=x86-64-v3"), flatten))
#else
#define PINIK_FAST
#endif
