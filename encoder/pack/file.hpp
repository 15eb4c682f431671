// SPDX-License-Identifier: MIT
// Packs as bytes (format-pack.md), on the host.
#ifndef MICROTIN_ENCODER_PACK_FILE_HPP
#define MICROTIN_ENCODER_PACK_FILE_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/terrain/metadata.hpp"
#include "shared/pack_format.hpp"

namespace microtin::pack {

// A pack but for its streams.
struct PackContent {
  TileGrid grid;
  Metadata metadata;  // its accuracy is that of all tiles
  std::vector<TileSummary> tiles;
};

// A pack before its tiles are encoded.
PackContent content_of(const PackPlan& plan, Metadata metadata);

// What all tiles together keep; posts on borders count in each tile.
Verification measured(const PackContent& pack);

// What comes before the streams: header and index. Throws Error if notes or streams are too long.
std::vector<uint8_t> write_pack_head(PackContent pack);

// The header alone.
std::vector<uint8_t> write_pack_header(const PackContent& pack);

// Bytes that any tile takes in compact form at most; 0 if that is not known of all.
uint64_t most_compact_bytes(const std::vector<TileSummary>& tiles, uint32_t most_vertices);

// What such a header says behind its fixed part. Throws Error if that breaks a rule.
Metadata read_placement_and_notes(const PackHeader& header, const uint8_t* bytes);

// A whole pack; the tiles say where their streams are.
std::vector<uint8_t> write_pack(const PackContent& pack, const std::vector<uint8_t>& streams);

// Whether bytes begin as those of a pack do.
bool is_pack(const ByteSource& bytes);

// An entry of the index, and its bounds of the tile's heights.
struct IndexEntry : PackEntry {
  int16_t lowest, highest;
};

// A tile that cannot be used, or is not as the header and the index state.
struct TileFault {
  uint32_t tile;
  bool is_unsupported;  // the tile is of a later version
  std::string text;     // names the tile
};

class PackFile {
 public:
  // When the index is read: whole at once, or with each tile the tile's entry alone, and
  // `entries` is empty.
  enum class Index : uint8_t { kNow, kLater };
  PackFile(std::unique_ptr<ByteSource> bytes, Index index);

  // Reads header and index; streams when they are requested. Throws Error if they are damaged or
  // break a rule.
  explicit PackFile(std::unique_ptr<ByteSource> bytes) : PackFile(std::move(bytes), Index::kNow) {}
  explicit PackFile(std::vector<uint8_t> bytes) : PackFile(bytes_in_memory(std::move(bytes))) {}

  const TileGrid& grid() const { return header_.grid; }
  const PackHeader& header() const { return header_; }
  const Metadata& metadata() const { return metadata_; }
  const std::vector<IndexEntry>& entries() const { return entries_; }  // by tile
  uint64_t bytes() const { return bytes_->size(); }
  uint32_t tiles() const { return tile_columns(header_.grid) * tile_rows(header_.grid); }

  // The entry of a tile. Throws Error naming the tile if it is damaged or breaks a rule.
  IndexEntry entry_of(uint32_t tile) const;

  // A tile's stream as it is stored; empty without terrain. Throws Error as above.
  std::vector<uint8_t> stream(uint32_t tile) const;

  // Vertices of all tiles, those on borders once for each, as the header states; counted_vertices()
  // if it does not.
  uint64_t vertices() const;

  // Vertices of all tiles, counted: the header of each stream is read, and decoding takes no more.
  // Throws Error naming a tile whose header is damaged.
  uint64_t counted_vertices() const;

  // Vertices of a tile, as its stream's header states. Throws Error naming the tile if that is
  // damaged.
  uint32_t vertices(uint32_t number) const;

  // The margins of a tile, as its stream's header states them; not stated without terrain. Throws
  // Error as above.
  Margins margins(uint32_t number) const;

  // A tile, decoded; nothing if it has no terrain. Throws Error naming the tile if it is damaged,
  // not the one in the index, of a later version, or leaves its box.
  std::optional<DecodedTerrain> tile(uint32_t number) const;

  // Throws Error if the file ends before its index does. Then the header can state more tiles than
  // anybody could look at.
  void expect_index() const;

  // Decodes all tiles: those that cannot be used or break a bound, in order. Also damaged entries
  // of the index count, if it is read later.
  std::vector<TileFault> faults() const;

  // Throws Error as for faults(): names those that are unsupported, and those that are bad for
  // another reason. Throws Error as expect_sums, too.
  void expect_as_stated() const;

  // Throws Error if the sums are wrong that the header states.
  void expect_sums() const;

 private:
  void read_header();
  void read_index();
  IndexEntry entry_at(uint32_t tile, const uint8_t* at) const;
  std::vector<uint8_t> stream_of(const PackEntry& entry) const;
  microtin_status start_of(uint32_t number, const std::vector<uint8_t>& stream) const;
  bool is_unsupported(uint32_t number) const;
  void expect_bounds(uint32_t number, DecodedTerrain& tile) const;

  std::unique_ptr<ByteSource> bytes_;
  PackHeader header_{};
  Metadata metadata_;
  std::vector<IndexEntry> entries_;
};

}  // namespace microtin::pack

#endif
