// SPDX-License-Identifier: MIT
/* The configuration of the library. Define these macros with -D, or in a header microtin_config.h
 * of your project, which the library and the code that uses it must find among their includes.
 *
 *   MICROTIN_INDEX_BITS   width of vertex and half-edge indices: 16 bits for up to 10,923 vertices,
 *                         32 bits for up to 2^24. The library and the code that uses it must have
 *                         the same width, or they do not link. CMake, pkg-config and Zephyr pass it
 *                         with -D, from an option of their own: then leave it out of
 *                         microtin_config.h
 *   MICROTIN_ASSERT(c)    called with conditions that the caller guarantees and that no status
 *                         reports, such as a vertex index in range. The default does nothing
 *   MICROTIN_READ_ALIGNMENT
 *                         alignment of the buffers that microtin_pack_next_read returns: 4 to 64, a
 *                         power of two, for DMA and caches; 1, the default, for none. A pack takes
 *                         128 bytes more and the alignment. The library and the code that uses it
 *                         must have the same
 *   MICROTIN_PACK_ENTER(), MICROTIN_PACK_LEAVE()
 *                         take and release a lock of yours, for queries of packs on other cores or
 *                         threads than the loader's (pack.h). Not defined by default. Only the
 *                         compiler that compiles the library needs them
 *   MICROTIN_NO_NAMES     leaves out the strings of microtin_status_name and of
 *                         microtin_query_result_name
 *   MICROTIN_NO_SECTORS   leaves out reads that end with a sector, for packs in files or memory:
 *                         microtin_pack_align_reads accepts 0 alone
 *
 * The library decodes every stream unless one of the following switches is defined. It returns
 * MICROTIN_STATUS_UNSUPPORTED_VERSION for a stream that needs what is left out. Only the compiler
 * that compiles the library needs these switches; sizes and types do not depend on them.
 *
 *   MICROTIN_NO_VOIDS       leaves out terrains with voids
 *   MICROTIN_ONLY_BALANCED  leaves out the codings `quick` and `dense`
 *   MICROTIN_ONLY_QUICK     leaves out the codings `balanced` and `dense`
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

/* 1 unless defined: the buffers of reads are not aligned. */
#ifndef MICROTIN_READ_ALIGNMENT
#define MICROTIN_READ_ALIGNMENT 1
#endif
#if MICROTIN_READ_ALIGNMENT < 1 || MICROTIN_READ_ALIGNMENT > 64 || \
    (MICROTIN_READ_ALIGNMENT & (MICROTIN_READ_ALIGNMENT - 1)) != 0
#error "MICROTIN_READ_ALIGNMENT must be a power of two, 1 to 64"
#endif

#if defined(MICROTIN_PACK_ENTER) != defined(MICROTIN_PACK_LEAVE)
#error "MICROTIN_PACK_ENTER and MICROTIN_PACK_LEAVE belong together"
#endif

#if defined(MICROTIN_ONLY_BALANCED) && defined(MICROTIN_ONLY_QUICK)
#error "MICROTIN_ONLY_BALANCED and MICROTIN_ONLY_QUICK leave no coding; define one of them"
#endif

#ifndef MICROTIN_ASSERT
/* Checks what the caller guarantees. Does nothing unless the project defines it. */
#define MICROTIN_ASSERT(condition) ((void)0)
#endif

#endif
