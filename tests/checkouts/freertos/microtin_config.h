// SPDX-License-Identifier: MIT
/* The hooks that decoder/docs/rtos.md names for tasks of equal priority. */
#ifndef MICROTIN_TESTS_CHECKOUTS_FREERTOS_MICROTIN_CONFIG_H
#define MICROTIN_TESTS_CHECKOUTS_FREERTOS_MICROTIN_CONFIG_H

#ifdef EQUAL_PRIORITY
#ifdef __cplusplus
extern "C" {
#endif
void pack_enter(void);
void pack_leave(void);
#ifdef __cplusplus
}
#endif
#define MICROTIN_PACK_ENTER() pack_enter()
#define MICROTIN_PACK_LEAVE() pack_leave()
#endif

#endif
