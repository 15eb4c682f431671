// SPDX-License-Identifier: MIT
// What terrains take on devices with numbers of any width: while they are decoded, and in compact
// form (format-compact.md).
#ifndef MICROTIN_ENCODER_STREAM_DEVICE_MEMORY_HPP
#define MICROTIN_ENCODER_STREAM_DEVICE_MEMORY_HPP

#include <cstdint>

#include "encoder/layers.hpp"
#include "encoder/stream/decoded_terrain.hpp"

namespace microtin::stream {

// Bytes of mesh and decoder together, in a build with 16-bit numbers as far as these reach, in one
// with 32-bit numbers beyond.
uint64_t device_ram(uint32_t vertices);

// The most vertices whose device_ram is within `bytes`: 0, or from 3 on.
uint32_t most_vertices(uint64_t bytes);

struct CompactForm {
  uint32_t vertices;
  uint32_t repeats;  // vertices taken twice
  bool is_narrow;
};

// The compact form of a terrain, which stays as it is. Takes 5 % of the time of decoding.
CompactForm measured_form(microtin_mesh* mesh);

// Makes it of the terrain, and looks whether that is the same terrain. The same on every device.
CompactForm compact_form(DecodedTerrain&& terrain);

// The width of numbers on a device that keeps terrains of this many vertices.
uint32_t index_bits(uint32_t vertices);

uint64_t bytes_of(const CompactForm& form, uint32_t bits);

// What macros promise for any terrain of this many vertices.
uint64_t promised_compact_bytes(uint32_t vertices, bool is_narrow, uint32_t bits);

// Whether a terrain takes no more than they promise for `most` vertices.
bool keeps_promise(const CompactForm& form, uint32_t most);

// Throws Error if a terrain takes more than they promise for its own vertices.
void expect_promised(const CompactForm& form);

}  // namespace microtin::stream

#endif
