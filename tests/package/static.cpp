// SPDX-License-Identifier: MIT
// Static objects of every kind, with all members, of which otherwise only those are compiled that
// somebody calls.
#include "microtin/compact_pack.hpp"
#include "microtin/microtin.hpp"
#include "microtin/pack.hpp"

#ifndef LATER
#define LATER (microtin::defer_init)
#endif

template class microtin::Terrain<1000>;
template class microtin::Decoder<1000>;
template class microtin::Pack<4, 500>;
template class microtin::CompactPack<4, 500>;
template class microtin::Buckets<10>;
template class microtin::CompactTerrain<1000>;

microtin::Terrain<1000> terrain LATER;
microtin::Decoder<1000> decoder(microtin::defer_init);
microtin::Pack<4, 500> pack LATER;
microtin::CompactPack<4, 500> compact_pack LATER;
microtin::Buckets<10> buckets;
microtin::CompactTerrain<1000> compact;
