// SPDX-License-Identifier: MIT
// Refuses AVR boards on which the decoder does not fit, when it is compiled instead of when it is
// linked.
#ifdef __AVR__
#include <avr/io.h>

#if defined(FLASHEND) && FLASHEND < 0xBFFF
#error "microtin needs 48 KB of flash on AVR: a Mega 2560, not an Uno, a Nano or a Leonardo"
#endif
#endif
