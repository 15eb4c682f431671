// SPDX-License-Identifier: MIT
/* Hooks of a test, which are a mutex. */
#ifndef MICROTIN_CONFIG_OF_LOCKS_H
#define MICROTIN_CONFIG_OF_LOCKS_H

#ifdef __cplusplus
extern "C" {
#endif
void locks_enter(void);
void locks_leave(void);
#ifdef __cplusplus
}
#endif

#define MICROTIN_PACK_ENTER() locks_enter()
#define MICROTIN_PACK_LEAVE() locks_leave()

#endif
