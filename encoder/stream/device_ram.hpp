// SPDX-License-Identifier: MIT
// How much RAM a terrain takes on a device that decodes it, and the other way round.
#ifndef MICROTIN_ENCODER_STREAM_DEVICE_RAM_HPP
#define MICROTIN_ENCODER_STREAM_DEVICE_RAM_HPP

#include <cstdint>

#include "encoder/layers.hpp"

namespace microtin::stream {

// Bytes of mesh and decoder together, in a build with 16-bit numbers as far as these reach, in one
// with 32-bit numbers beyond.
uint64_t device_ram(uint32_t vertices);

// The most vertices whose device_ram is within `bytes`: 0, or from 3 on.
uint32_t most_vertices(uint64_t bytes);

}  // namespace microtin::stream

#endif
