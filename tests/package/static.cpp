// SPDX-License-Identifier: MIT
// Static objects of every kind.
#include "microtin/compact_pack.hpp"
#include "microtin/microtin.hpp"
#include "microtin/pack.hpp"

#ifndef LATER
#define LATER (microtin::later)
#endif

microtin::Terrain<1000> terrain LATER;
microtin::Pack<4, 500> pack LATER;
microtin::CompactPack<4, 500> compact_pack LATER;
microtin::Buckets<10> buckets;
microtin::CompactTerrain<1000> compact;
