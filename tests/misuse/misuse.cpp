// SPDX-License-Identifier: MIT
// A program that the tests compile with capacities, and copies, that must be refused or not.
#include "microtin/microtin.hpp"

microtin::Terrain<TERRAIN> terrain;
microtin::Decoder<DECODER> decoder(terrain);

#if defined(BUCKETS)
microtin::Buckets<BUCKETS> buckets;
#endif
#if defined(COPY_TERRAIN)
microtin::Terrain<TERRAIN> other_terrain(terrain);
#endif
#if defined(COPY_DECODER)
microtin::Decoder<DECODER> other_decoder(decoder);
#endif
