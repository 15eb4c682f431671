// SPDX-License-Identifier: MIT
// Writes and reads a pack's header and index, and checks each tile that is read.
#include "encoder/pack/file.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/progress.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::pack {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kTileHeaderMost = 64;  // a tile's has no notes

uint64_t to_unsigned(int16_t value) {
  return static_cast<uint16_t>(value);
}

Bytes write_entry(const TileSummary& tile, uint64_t offset) {
  Bytes entry;
  if (tile.bytes == 0) return Bytes(kPackEntryBytes - kCheckBytes);
  if (tile.bytes >> 24 != 0 || offset >> 40 != 0) throw Error("the pack grows too large");
  append_number(entry, offset, 5);
  append_number(entry, tile.bytes, 3);
  append_number(entry, tile.stream_hash, 4);
  return entry;
}

// That any tile takes in compact form at most; 0 if that is not known of all.
uint64_t compact_bytes(const std::vector<TileSummary>& tiles, uint32_t most_vertices) {
  uint64_t most = 0;
  for (const TileSummary& tile : tiles) {
    if (tile.bytes == 0) continue;
    if (!tile.compact) return 0;
    most = std::max(most, bytes_of(*tile.compact, index_bits(most_vertices)));
  }
  return most;
}

void expect(bool legal) {
  if (!legal) throw Error(describe(MICROTIN_STATUS_MALFORMED));
}

void expect_done(microtin_status status) {
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
}

void check_box(const microtin_mesh* mesh, const TileBox& box) {
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const Vertex p = vertex_of(mesh, v);
    expect(p.x <= box.x_end - box.x && p.y <= box.y_end - box.y);
  }
}

}  // namespace

PackContent content_of(const PackPlan& plan, Metadata metadata) {
  metadata.placement = plan.tiled.lattice.placement;
  const LatticeOptions& lattice = plan.options.lattice;
  metadata.accuracy = Accuracy{lattice.max_error, {}, {}, {}};
  metadata.side = side_of(lattice.max_error, lattice.never_below);
  metadata.grid = posts_of(plan.tiled.raster.frame());
  return {plan.tiled.grid, std::move(metadata), {}};
}

Verification measured(const PackContent& pack) {
  std::vector<Verification> parts;
  parts.reserve(pack.tiles.size());
  for (const TileSummary& tile : pack.tiles) parts.push_back(tile.measured);
  return combine(parts);
}

Bytes write_pack_header(const PackContent& pack) {
  const Bytes placement = write_placement(pack.metadata.placement);
  const Bytes notes = write_notes(pack.metadata);
  int16_t lowest = INT16_MAX, highest = INT16_MIN;
  uint32_t most = 0;
  uint64_t all = 0;
  for (const TileSummary& tile : pack.tiles) {
    if (tile.bytes == 0) continue;
    lowest = std::min(lowest, tile.lowest);
    highest = std::max(highest, tile.highest);
    most = std::max(most, tile.vertices);
    all += tile.vertices;
  }
  Bytes header(kPackMagic, kPackMagic + sizeof kPackMagic);
  append_number(header, kPackVersion, 2);
  append_number(header, placement.size(), 2);
  append_number(header, notes.size(), 2);
  append_number(header, pack.grid.width, 2);
  append_number(header, pack.grid.height, 2);
  append_number(header, to_unsigned(lowest), 2);
  append_number(header, to_unsigned(highest), 2);
  append_number(header, 0, 2);
  append_number(header, pack.grid.x_max, 4);
  append_number(header, pack.grid.y_max, 4);
  append_number(header, most, 4);
  append_number(header, compact_bytes(pack.tiles, most), 4);
  append_number(header, std::min<uint64_t>(all, UINT32_MAX), 4);
  header.insert(header.end(), placement.begin(), placement.end());
  header.insert(header.end(), notes.begin(), notes.end());
  append_check(header, 0);
  return header;
}

Bytes write_pack_head(PackContent pack) {
  const Verification all = measured(pack);
  if (pack.metadata.accuracy) {
    pack.metadata.accuracy->max_error = all.max_error;
    pack.metadata.accuracy->rms_error = all.rms_error;
    pack.metadata.accuracy->mean_error = all.mean_error;
    pack.metadata.at_samples = Distances{all.max_below, all.max_above};
  }
  Bytes head = write_pack_header(pack);
  const uint32_t header_check = read_u32(head.data() + head.size() - kCheckBytes);
  uint64_t offset = head.size() + pack.tiles.size() * kPackEntryBytes;
  for (std::size_t i = 0; i < pack.tiles.size(); ++i) {
    const Bytes entry = write_entry(pack.tiles[i], offset);
    head.insert(head.end(), entry.begin(), entry.end());
    append_number(head, pack_entry_check(header_check, static_cast<uint32_t>(i), entry.data()),
                  kCheckBytes);
    offset += pack.tiles[i].bytes;
  }
  return head;
}

Bytes write_pack(const PackContent& pack, const std::vector<Bytes>& streams) {
  Bytes file = write_pack_head(pack);
  for (const Bytes& stream : streams) file.insert(file.end(), stream.begin(), stream.end());
  return file;
}

bool is_pack(const ByteSource& bytes) {
  uint8_t identity[kPackIdentityBytes] = {};
  return bytes.read(0, identity, sizeof identity) == sizeof identity &&
         check_pack_identity(identity) != MICROTIN_STATUS_BAD_MAGIC;
}

Metadata read_placement_and_notes(const PackHeader& header, const uint8_t* bytes) {
  Metadata metadata;
  const uint8_t* const placement = bytes + kPackFixedBytes;
  if (header.placement_bytes != 0) {
    Axis axis[3];
    expect(read_pack_placement(placement, header, axis));
    metadata.placement = {axis[0], axis[1], axis[2]};
  }
  const uint8_t* const notes = placement + header.placement_bytes;
  read_notes(notes, notes + header.note_bytes, metadata);
  return metadata;
}

PackFile::PackFile(std::unique_ptr<ByteSource> bytes, Index index) : bytes_(std::move(bytes)) {
  read_header();
  if (index == Index::kNow) read_index();
}

void PackFile::read_header() {
  const Bytes fixed = bytes_at(*bytes_, 0, kPackFixedBytes);
  expect_done(check_pack_identity(fixed.data()));
  const bool legal = read_pack_header(fixed.data(), &header_);
  const uint32_t end = pack_index_start(header_);
  const Bytes header = bytes_at(*bytes_, 0, end);
  const uint8_t* const data = header.data();
  vertices_ = read_all_vertices(data);
  header_check_ = read_u32(data + end - kCheckBytes);
  if (crc32(0, data, end - kCheckBytes) != header_check_)
    throw Error(describe(MICROTIN_STATUS_CHECKSUM));
  expect(legal);
  metadata_ = read_placement_and_notes(header_, data);
}

void PackFile::read_index() {
  constexpr uint32_t kAtOnce = 1024;
  const uint64_t tiles = uint64_t{tile_columns(header_.grid)} * tile_rows(header_.grid);
  const uint64_t start = pack_index_start(header_);
  if ((bytes_->size() - start) / kPackEntryBytes < tiles)
    throw Error(describe(MICROTIN_STATUS_TRUNCATED));
  entries_.reserve(tiles);
  while (entries_.size() < tiles) {
    const uint64_t count = std::min<uint64_t>(tiles - entries_.size(), kAtOnce);
    const uint64_t offset = pack_entry_start(header_, static_cast<uint32_t>(entries_.size()));
    const Bytes bytes = bytes_at(*bytes_, offset, count * kPackEntryBytes);
    for (uint64_t i = 0; i < count; ++i) {
      entries_.push_back(
          entry_at(static_cast<uint32_t>(entries_.size()), bytes.data() + i * kPackEntryBytes));
    }
  }
}

PackEntry PackFile::entry_at(uint32_t tile, const uint8_t* at) const {
  if (pack_entry_check(header_check_, tile, at) != read_u32(at + kPackEntryBytes - kCheckBytes)) {
    throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_STATUS_CHECKSUM));
  }
  PackEntry entry{};
  if (!read_pack_entry(at, header_, &entry)) {
    throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_STATUS_MALFORMED));
  }
  return entry;
}

PackEntry PackFile::entry_of(uint32_t tile) const {
  if (!entries_.empty()) return entries_[tile];
  return entry_at(tile, bytes_at(*bytes_, pack_entry_start(header_, tile), kPackEntryBytes).data());
}

uint32_t PackFile::vertices(uint32_t number) const {
  const PackEntry entry = entry_of(number);
  if (entry.size == 0) return 0;
  return with_file_context("tile " + std::to_string(number), [&] {
    const Bytes start = bytes_at(*bytes_, entry.offset, std::min(entry.size, kTileHeaderMost));
    const microtin_stream_info info = stream::read_header(start).info;
    expect_room_for_vertices(info, entry.size);
    return info.vertices;
  });
}

Margins PackFile::margins(uint32_t number) const {
  const PackEntry entry = entry_of(number);
  if (entry.size == 0) return {};
  return with_file_context("tile " + std::to_string(number), [&] {
    const Bytes start = bytes_at(*bytes_, entry.offset, std::min(entry.size, kTileHeaderMost));
    return stream::read_header(start).metadata.everywhere;
  });
}

std::optional<DecodedTerrain> PackFile::tile(uint32_t number) const {
  const PackEntry entry = entry_of(number);
  if (entry.size == 0) return std::nullopt;
  return with_file_context("tile " + std::to_string(number), [&] {
    const Bytes stream = bytes_at(*bytes_, entry.offset, entry.size);
    if (stream_hash(kStreamHash, stream.data(), stream.size()) != entry.stream_hash) {
      throw Error(describe(MICROTIN_STATUS_CHECKSUM));
    }
    DecodedTerrain decoded(stream);
    const TileBox box = tile_box(header_.grid, number);
    expect(tile_vertices(stream.data(), stream.size(), header_, box) != 0);
    check_box(decoded.mesh(), box);
    return std::optional<DecodedTerrain>(std::move(decoded));
  });
}

void PackFile::expect_as_stated() const {
  expect_vertices();
  expect_compact_bytes();
}

uint64_t PackFile::counted_vertices() const {
  uint64_t all = 0;
  for (uint32_t number = 0; number < entries_.size(); ++number) all += vertices(number);
  return all;
}

void PackFile::expect_vertices() const {
  const uint64_t all = counted_vertices();
  if (std::min<uint64_t>(all, UINT32_MAX) == vertices_) return;
  throw Error("the header says that all tiles have " + std::to_string(vertices_) +
              " vertices; they have " + std::to_string(all));
}

void PackFile::expect_compact_bytes() const {
  if (header_.compact_bytes == 0) return;
  const uint32_t bits = index_bits(header_.most_vertices);
  std::vector<uint64_t> needed(entries_.size());
  for_each_parallel(needed.size(), [&](std::size_t i) {
    std::optional<DecodedTerrain> decoded = tile(static_cast<uint32_t>(i));
    if (decoded) needed[i] = bytes_of(measured_form(decoded->mesh()), bits);
  });
  const auto most = std::max_element(needed.begin(), needed.end());
  if (*most == header_.compact_bytes) return;
  throw Error("the header says that a tile takes at most " + std::to_string(header_.compact_bytes) +
              " bytes in compact form; tile " + std::to_string(most - needed.begin()) +
              " takes most, " + std::to_string(*most));
}

}  // namespace microtin::pack
