// SPDX-License-Identifier: MIT
/* What a project may choose, in one place. A header microtin_config.h of the project's own, if both
 * the library and its users find it among their includes, is read first; -D does as well.
 *
 *   MICROTIN_INDEX_BITS   width of vertex and half-edge numbers, the same for the library and its
 *                         users, or they do not link: 16 bits reach 10,923 vertices, 32 bits the
 *                         format's 2^24. CMake, pkg-config and Zephyr give it by -D, as their own
 *                         option says: with them it is that option which rules, and
 *                         microtin_config.h must leave it out
 *   MICROTIN_ASSERT(c)    called with what a caller promises and no status tells, such as a
 *                         vertex's number that is in range; nothing if not given
 *   MICROTIN_NO_NAMES     leaves out the strings of microtin_status_name and of
 *                         microtin_query_result_name
 */
#ifndef MICROTIN_CONFIG_H
#define MICROTIN_CONFIG_H

#if defined(__has_include)
#if __has_include("microtin_config.h")
#include "microtin_config.h"
#endif
#endif

/* 16 on AVR, and on 32-bit Arm, RISC-V and Xtensa without an operating system. */
#ifndef MICROTIN_INDEX_BITS
#if defined(__linux__) || defined(__unix__) || defined(__APPLE__) || defined(_WIN32)
#define MICROTIN_INDEX_BITS 32
#elif defined(__AVR__) || defined(__arm__) || defined(__xtensa__)
#define MICROTIN_INDEX_BITS 16
#elif defined(__riscv) && __riscv_xlen == 32
#define MICROTIN_INDEX_BITS 16
#else
#define MICROTIN_INDEX_BITS 32
#endif
#endif
#if MICROTIN_INDEX_BITS != 16 && MICROTIN_INDEX_BITS != 32
#error "MICROTIN_INDEX_BITS must be 16 or 32"
#endif

#ifndef MICROTIN_ASSERT
/* Checks what the caller guarantees. Does nothing unless the project defines it. */
#define MICROTIN_ASSERT(condition) ((void)0)
#endif

#endif
