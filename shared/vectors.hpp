// SPDX-License-Identifier: MIT
// Which instructions for several 16-bit numbers at once the machine has: MICROTIN_PAIRS if it
// multiplies two pairs of them.
#ifndef MICROTIN_SHARED_VECTORS_HPP
#define MICROTIN_SHARED_VECTORS_HPP

#include "shared/compiler.hpp"

#if defined(__SSE2__) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
// gcc's emmintrin.h includes mm_malloc.h, for which a freestanding <stdlib.h> has no malloc, or is
// not there. Nothing here allocates.
#if !defined(__clang__) && !__STDC_HOSTED__ && !defined(_MM_MALLOC_H_INCLUDED)
#define _MM_MALLOC_H_INCLUDED
#include <emmintrin.h>
#undef _MM_MALLOC_H_INCLUDED
#else
#include <emmintrin.h>
#endif
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <arm_acle.h>
#endif

#endif
