// SPDX-License-Identifier: MIT
// Settings for gcc and clang. Included before all other code, since it holds for what follows.
#ifndef MICROTIN_SHARED_COMPILER_HPP
#define MICROTIN_SHARED_COMPILER_HPP

// GCC 12 at -O2, where there are no vector registers, puts two 16-bit numbers into a word and takes
// the high half of the word's square for that of each: seen on RISC-V and on x86 without SSE.
#if defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) &&     \
    !defined(__OPTIMIZE_SIZE__) && !defined(__SSE2__) && !defined(__VX__) && \
    !defined(__ARM_NEON) && !defined(__ALTIVEC__) && !defined(__riscv_vector)
#pragma GCC optimize("no-tree-vectorize")
#endif

// Where size counts, GCC keeps more values at hand than there are registers, and moves instructions
// apart: without that Cortex-M4 needs 170 bytes less, Cortex-M0 240.
#if defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE_SIZE__)
#pragma GCC optimize("no-tree-fre", "no-move-loop-invariants")
#pragma GCC optimize("no-caller-saves", "no-schedule-insns2")
#endif

// Where speed counts, rare code, and code that is vectorised only if no loop is around it, is kept
// out of its callers (OUT_OF_LINE). Where size counts, which on AVR is everywhere, there is one
// copy of what is small but wanted in many places (ONE_COPY), and of what is wanted in few and
// folds by what is known there: where speed counts that is put in place (FOLDED). What is smaller
// than a call of it, or wanted in one place, is put there (IN_PLACE): compilers do not see that no
// other file calls it.
#if defined(__OPTIMIZE_SIZE__) || defined(__AVR__)
#define MICROTIN_SIZE_COUNTS
#endif
#define MICROTIN_IN_PLACE __attribute__((always_inline))
#if defined(__OPTIMIZE_SIZE__)
#define MICROTIN_OUT_OF_LINE
#else
#define MICROTIN_OUT_OF_LINE __attribute__((noinline))
#endif
#if !defined(MICROTIN_SIZE_COUNTS)
#define MICROTIN_ONE_COPY
#define MICROTIN_FOLDED MICROTIN_IN_PLACE inline
#elif defined(__clang__)
#define MICROTIN_ONE_COPY __attribute__((noinline))
#define MICROTIN_FOLDED MICROTIN_ONE_COPY inline
#else
#define MICROTIN_ONE_COPY __attribute__((noinline, noclone))
#define MICROTIN_FOLDED MICROTIN_ONE_COPY inline
#endif

// A struct of two 16-bit numbers that, where size counts, is read and written at once.
#if defined(MICROTIN_SIZE_COUNTS)
#define MICROTIN_WORD alignas(uint32_t)
#else
#define MICROTIN_WORD
#endif

// A function that keeps no call but those of ONE_COPY, also where size counts and others share what
// it calls.
#if defined(__GNUC__) && !defined(__clang__)
#define MICROTIN_WITHOUT_CALLS __attribute__((flatten))
#else
#define MICROTIN_WITHOUT_CALLS
#endif

// Where a table of some KB is cheaper than a division, and a copy of some KB of code cheaper than a
// call (ROOMY_IN_PLACE). The tables are made by constructors with loops, which C++11 lacks.
#if (defined(__x86_64__) || defined(__aarch64__)) && !defined(__OPTIMIZE_SIZE__) && \
    __cplusplus >= 201402L
#define MICROTIN_LARGE_TABLES
#define MICROTIN_ROOMY_IN_PLACE MICROTIN_IN_PLACE inline
#else
#define MICROTIN_ROOMY_IN_PLACE inline
#endif

// Where a multiplication makes 32 bits at most: wider ones are calls.
#if defined(__ARM_ARCH_6M__) || defined(__AVR__) || (defined(__riscv) && !defined(__riscv_mul))
#define MICROTIN_NARROW_MACHINE
#endif

#endif
