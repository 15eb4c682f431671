// SPDX-License-Identifier: MIT
// A terrain decoded on the host, by the shipped decoder, and as vertices and triangles.
#ifndef MICROTIN_ENCODER_STREAM_DECODED_TERRAIN_HPP
#define MICROTIN_ENCODER_STREAM_DECODED_TERRAIN_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/stream/edge_marks.hpp"
#include "encoder/terrain/metadata.hpp"
#include "microtin/microtin.h"

namespace microtin::stream {

// Most vertices beyond the seed for each byte behind the header: each takes two symbols at least,
// of which a byte holds fewer than 2842 (guarantees.md, proof of 21).
constexpr uint64_t kVerticesPerByte = 1421;

// Throws Error if a stream of this many bytes announces more, so that few bytes do not claim much
// memory.
void expect_room_for_vertices(const microtin_stream_info& info, uint64_t stream_bytes);

// Told of the type and the content of a chunk.
using ChunkVisitor = std::function<void(uint64_t type, const uint8_t* begin, const uint8_t* end)>;

// Throws Error unless the bytes from `at` to `end` are intact chunks, which are visited.
void expect_chunks(const uint8_t* at, const uint8_t* end, const ChunkVisitor& visit = {});

// Appends a chunk with the bounds that a tile's posts have of their own.
void append_chunk(const BoundSpan& bounds, std::vector<uint8_t>& stream);

// What becomes of marks of edges. Tiles of packs have none: their readers skip such a chunk, as
// devices do.
enum class MarkChunks : uint8_t { kRead, kSkip };

class DecodedTerrain {
 public:
  // Called with the mesh at the end of a section, and the bytes of all sections so far.
  using SectionVisitor = std::function<void(const microtin_mesh* mesh, uint64_t bytes)>;

  // Decodes a whole stream. Throws Error, saying what the decoder found, if it is not valid, if
  // what follows its last section is not chunks, or if marks that are read are malformed.
  explicit DecodedTerrain(const std::vector<uint8_t>& stream, const SectionVisitor& visit = {},
                          MarkChunks marks = MarkChunks::kRead);

  DecodedTerrain(DecodedTerrain&&) = default;
  DecodedTerrain& operator=(DecodedTerrain&&) = default;

  const microtin_mesh* mesh() const { return mesh_; }
  microtin_mesh* mesh() { return mesh_; }
  uint32_t phases() const { return phases_; }

  // What a chunk states of posts with bounds of their own, if there is one.
  const std::optional<BoundSpan>& bounds() const { return bounds_; }

  // How many edges have marks.
  uint32_t marked_edges() const { return marks_.edges(); }

  // Bytes of the chunk with marks, 0 if there is none.
  std::size_t mark_bytes() const { return mark_bytes_; }

  // The lines that the marked edges make.
  std::vector<MarkedLine> lines() const { return marks_.lines(mesh_); }

 private:
  std::vector<uint64_t> storage_;  // aligned to MICROTIN_ALIGNMENT; mesh_ points into it
  microtin_mesh* mesh_ = nullptr;
  uint32_t phases_ = 0;
  std::optional<BoundSpan> bounds_;
  EdgeMarks marks_;
  std::size_t mark_bytes_ = 0;
};

// A decoded terrain as vertices and triangles: what is exported, drawn and put together of tiles.

// A surface in global lattice coordinates. Triangles are counter-clockwise from above, without void
// ones.
struct SurfaceModel {
  Placement placement;
  Unit horizontal_unit = Unit::kUnknown, vertical_unit = Unit::kUnknown;
  std::string system;  // of coordinates, in one line; empty: not known
  std::vector<std::array<int64_t, 3>> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

// Vertices keep their numbers.
SurfaceModel model_of(const microtin_mesh* mesh);

// What a decoder has made of the first bytes of a stream. The last of them need not be covered by a
// checksum yet. Throws Error as decoding does.
SurfaceModel model_after(const std::vector<uint8_t>& stream, uint64_t bytes);

}  // namespace microtin::stream

#endif
