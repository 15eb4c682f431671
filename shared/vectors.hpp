// SPDX-License-Identifier: MIT
// Which instructions for several 16-bit numbers at once the machine has: MICROTIN_PAIRS if it
// multiplies two pairs of them.
#ifndef MICROTIN_SHARED_VECTORS_HPP
#define MICROTIN_SHARED_VECTORS_HPP

#include "shared/compiler.hpp"

#if defined(__SSE2__) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
#if defined(__has_include)
#if __has_include(<stdlib.h>)  // gcc's emmintrin.h includes it
#define MICROTIN_PAIRS
#include <emmintrin.h>
#endif
#endif
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <arm_acle.h>
#endif

#endif
