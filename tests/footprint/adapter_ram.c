// SPDX-License-Identifier: MIT
/* Objects of the adapters as zeroed arrays, whose sizes footprint.py reads. The pack has the
 * numbers of decoder/docs/autopilots.md: nine slots, 356 vertices, 2,952 bytes of a compact tile.
 */
#include "decoder/adapters/ardupilot.h"
#include "decoder/adapters/inav.h"
#include "microtin/compact_pack.h"

char ram_inav[sizeof(microtin_inav)];
char ram_ardupilot[sizeof(microtin_ardupilot)];
char ram_card[sizeof(microtin_card)];
#ifdef MICROTIN_ADAPTERS_COMPACT
char ram_pack[MICROTIN_COMPACT_PACK_BYTES(9, 356, 2952)];
#else
char ram_pack[MICROTIN_PACK_BYTES(9, 356)];
#endif
