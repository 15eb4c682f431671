// SPDX-License-Identifier: MIT
/* What a firmware program gets from its start-up code, whatever the target. */
#ifndef MICROTIN_TOOLCHAINS_FIRMWARE_H
#define MICROTIN_TOOLCHAINS_FIRMWARE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Written by the program. Its result becomes the emulator's exit code. */
int firmware_main(void);

/* Prints one character on the emulator's console. */
void put_char(char c);

#ifdef __cplusplus
}
#endif

#endif
