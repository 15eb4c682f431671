// SPDX-License-Identifier: MIT
/* What the boards have in addition to a console: a memory card and a clock that interrupts. */
#ifndef MICROTIN_TOOLCHAINS_BOARD_H
#define MICROTIN_TOOLCHAINS_BOARD_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Finds the card: the file card.img in the folder where the emulator was started. Returns 1, or 0
 * if there is none. */
int open_card(void);

/* Reads a sector of 512 bytes. Returns how many the card has there, or -1 if reading failed. */
int32_t read_sector(uint32_t sector, uint8_t* bytes);

/* From now on calls a function in an interrupt, some thousand times a second. */
void start_ticks(void (*on_tick)(void));

#ifdef __cplusplus
}
#endif

#endif
