// SPDX-License-Identifier: MIT
/* What a project may choose, all of it. */
#ifndef MICROTIN_CONFIG_OF_PROJECT_H
#define MICROTIN_CONFIG_OF_PROJECT_H

#define MICROTIN_INDEX_BITS 16
#define MICROTIN_NO_NAMES
#define MICROTIN_NO_SECTORS
#define MICROTIN_ASSERT(condition) ((condition) ? (void)0 : broken_promise())

#ifdef __cplusplus
extern "C"
#endif
    void
    broken_promise(void);

#endif
