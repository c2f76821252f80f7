// Refuses compiler flags that would change the layout of Eigen's types, or how Eigen allocates memory. pinik and
// Pinocchio's libraries, whose wheels are built for any processor, hand such types to each other and would crash.
#pragma once

#if defined(__AVX__)
#error "pinik must be compiled without -march=native, -mavx and similar flags, because they change the alignment of Eigen's types, which must be that of Pinocchio's libraries"
#endif

#include <Eigen/Core>

static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MAX_STATIC_ALIGN_BYTES == 16,
              "pinik must be compiled with Eigen's default alignment of 16 bytes, which is that of Pinocchio's libraries");
static_assert(EIGEN_MALLOC_ALREADY_ALIGNED == 1,
              "pinik must be compiled so that Eigen takes memory from malloc as it is, like Pinocchio's libraries");
