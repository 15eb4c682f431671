// SPDX-License-Identifier: MIT
// Writes and reads a pack's header and index, and checks each tile that is read.
#include "encoder/pack/file.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::pack {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kTileHeaderMost = 64;  // a tile's has no notes

uint64_t to_unsigned(int16_t value) {
  return static_cast<uint16_t>(value);
}

Bytes write_entry(const TileSummary& tile) {
  Bytes entry;
  if (tile.bytes == 0) return Bytes(kPackEntryBytes - kCheckBytes);
  if (tile.bytes >> 24 != 0 || tile.offset >> 40 != 0)
    throw Error("the pack grows too large; make a pack of each part");
  append_number(entry, tile.offset, 5);
  append_number(entry, tile.bytes, 3);
  append_number(entry, tile.stream_hash, 4);
  append_number(entry, to_unsigned(tile.lowest), 2);
  append_number(entry, to_unsigned(tile.highest), 2);
  return entry;
}

void expect(bool legal) {
  if (!legal) throw Error(describe(MICROTIN_STATUS_MALFORMED));
}

void expect_done(microtin_status status) {
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
}

void expect_version(const Bytes& fixed) {
  const microtin_status known = check_pack_identity(fixed.data());
  const int version = fixed[4], ours = kPackVersion;
  if (known != MICROTIN_STATUS_UNSUPPORTED_VERSION || version >= ours) return expect_done(known);
  throw Error("a pack of version " + std::to_string(version) + ", and this program reads version " +
              std::to_string(ours) + ": encode the terrain again");
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
  metadata.bounds = stated_bounds(plan.tiled.raster.frame().bounds, lattice.max_error);
  return {plan.tiled.grid, std::move(metadata), {}};
}

Verification measured(const PackContent& pack) {
  std::vector<Verification> parts;
  parts.reserve(pack.tiles.size());
  for (const TileSummary& tile : pack.tiles) parts.push_back(tile.measured);
  return combine(parts);
}

namespace {

// What bounds all tiles with terrain.
struct Bounds {
  int16_t lowest = INT16_MAX, highest = INT16_MIN;
  uint32_t vertices = 0;
  uint32_t below = 0, above = 0;  // kNotStated if it is of any
  TileSums sums{0, 0};
};

Bounds bounds_of(const std::vector<TileSummary>& tiles) {
  Bounds all;
  for (const TileSummary& tile : tiles) {
    if (tile.bytes == 0) continue;
    all.lowest = std::min(all.lowest, tile.lowest);
    all.highest = std::max(all.highest, tile.highest);
    all.vertices = std::max(all.vertices, tile.vertices);
    all.below = std::max(all.below, tile.below);
    all.above = std::max(all.above, tile.above);
    all.sums.vertices += tile.vertices;
    ++all.sums.tiles;
  }
  if (all.sums.tiles == 0) all.below = all.above = kNotStated;
  return all;
}

// A number that packs of different headers or streams do not share but by chance.
uint32_t identity_of(const Bytes& fixed, const Bytes& placement, const Bytes& notes,
                     const std::vector<TileSummary>& tiles) {
  uint32_t check = 0;
  for (const Bytes& part : {fixed, placement, notes})
    check = crc32(check, part.data(), part.size());
  for (const TileSummary& tile : tiles) {
    const Bytes entry = write_entry(tile);
    check = crc32(check, entry.data(), entry.size());
  }
  return check;
}

Bytes write_fixed(const PackContent& pack, const Bytes& placement, const Bytes& notes) {
  const Bounds bounds = bounds_of(pack.tiles);
  Bytes header(kPackMagic, kPackMagic + sizeof kPackMagic);
  append_number(header, kPackVersion, 2);
  append_number(header, placement.size(), 2);
  append_number(header, notes.size(), 2);
  append_number(header, pack.grid.width, 2);
  append_number(header, pack.grid.height, 2);
  append_number(header, to_unsigned(bounds.lowest), 2);
  append_number(header, to_unsigned(bounds.highest), 2);
  append_number(header, 0, 2);
  append_number(header, pack.grid.x_max, 4);
  append_number(header, pack.grid.y_max, 4);
  append_number(header, bounds.vertices, 4);
  append_number(header, most_compact_bytes(pack.tiles, bounds.vertices), 4);
  append_number(header, identity_of(header, placement, notes, pack.tiles), 4);
  append_number(header, bounds.below + 1u, 4);  // not stated: 0
  append_number(header, bounds.above + 1u, 4);
  return header;
}

}  // namespace

uint64_t most_compact_bytes(const std::vector<TileSummary>& tiles, uint32_t most_vertices) {
  uint64_t most = 0;
  for (const TileSummary& tile : tiles) {
    if (tile.bytes == 0) continue;
    if (!tile.compact) return 0;
    most = std::max(most, bytes_of(*tile.compact, index_bits(most_vertices)));
  }
  return most;
}

Bytes write_pack_header(const PackContent& pack) {
  const Bytes placement = write_placement(pack.metadata.placement);
  Bytes notes = write_notes(pack.metadata);
  append_padding(notes, kPackFixedBytes + placement.size() + kCheckBytes, kPackAlignment);
  Bytes header = write_fixed(pack, placement, notes);
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
    if (pack.metadata.bounds && all.bounds) {
      pack.metadata.bounds->span = *all.bounds;
      pack.metadata.accuracy->bound = bound_of_all(pack.metadata.bounds->max_error, all.bounds);
    }
  }
  pack.metadata.sums = bounds_of(pack.tiles).sums;
  Bytes head = write_pack_header(pack);
  PackHeader header{};
  read_pack_header(head.data(), &header);
  for (std::size_t i = 0; i < pack.tiles.size(); ++i) {
    const Bytes entry = write_entry(pack.tiles[i]);
    head.insert(head.end(), entry.begin(), entry.end());
    append_number(head, pack_entry_check(header.identity, static_cast<uint32_t>(i), entry.data()),
                  kCheckBytes);
  }
  return head;
}

Bytes write_pack(const PackContent& pack, const Bytes& streams) {
  Bytes file = write_pack_head(pack);
  file.insert(file.end(), streams.begin(), streams.end());
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
  metadata.everywhere = {header.below, header.above};
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
  expect_version(fixed);
  const microtin_status legal = read_pack_header(fixed.data(), &header_);
  const uint32_t end = pack_index_start(header_);
  const Bytes header = bytes_at(*bytes_, 0, end);
  if (crc32(0, header.data(), end) != kCheckedCrc) throw Error(describe(MICROTIN_STATUS_CHECKSUM));
  expect_done(legal);
  metadata_ = read_placement_and_notes(header_, header.data());
}

void PackFile::expect_index() const {
  const uint64_t start = pack_index_start(header_);
  if ((bytes_->size() - start) / kPackEntryBytes < tiles())
    throw Error(describe(MICROTIN_STATUS_TRUNCATED));
}

void PackFile::read_index() {
  constexpr uint32_t kAtOnce = 1024;
  expect_index();
  entries_.reserve(tiles());
  while (entries_.size() < tiles()) {
    const uint64_t count = std::min<uint64_t>(tiles() - entries_.size(), kAtOnce);
    const uint64_t offset = pack_entry_start(header_, static_cast<uint32_t>(entries_.size()));
    const Bytes bytes = bytes_at(*bytes_, offset, count * kPackEntryBytes);
    for (uint64_t i = 0; i < count; ++i) {
      entries_.push_back(
          entry_at(static_cast<uint32_t>(entries_.size()), bytes.data() + i * kPackEntryBytes));
    }
  }
}

IndexEntry PackFile::entry_at(uint32_t tile, const uint8_t* at) const {
  if (pack_entry_check(header_.identity, tile, at) !=
      read_u32(at + kPackEntryBytes - kCheckBytes)) {
    throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_STATUS_CHECKSUM));
  }
  IndexEntry entry{};
  if (!read_pack_entry(at, header_, &entry)) {
    throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_STATUS_MALFORMED));
  }
  entry.lowest = entry_lowest(at);
  entry.highest = entry_highest(at);
  return entry;
}

IndexEntry PackFile::entry_of(uint32_t tile) const {
  if (!entries_.empty()) return entries_[tile];
  return entry_at(tile, bytes_at(*bytes_, pack_entry_start(header_, tile), kPackEntryBytes).data());
}

uint64_t PackFile::vertices() const {
  return metadata_.sums ? metadata_.sums->vertices : counted_vertices();
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

Bytes PackFile::stream_of(const PackEntry& entry) const {
  Bytes stream = bytes_at(*bytes_, entry.offset, entry.size);
  if (stream_hash(kStreamHash, stream.data(), stream.size()) != entry.stream_hash)
    throw Error(describe(MICROTIN_STATUS_CHECKSUM));
  return stream;
}

microtin_status PackFile::start_of(uint32_t number, const Bytes& stream) const {
  Contract contract{};
  return read_tile_header(stream.data(), stream.size(), header_, tile_box(header_.grid, number),
                          &contract);
}

std::optional<DecodedTerrain> PackFile::tile(uint32_t number) const {
  const PackEntry entry = entry_of(number);
  if (entry.size == 0) return std::nullopt;
  return with_file_context("tile " + std::to_string(number), [&] {
    const Bytes stream = stream_of(entry);
    expect_done(start_of(number, stream));
    DecodedTerrain decoded(stream, {}, stream::MarkChunks::kSkip);
    check_box(decoded.mesh(), tile_box(header_.grid, number));
    return std::optional<DecodedTerrain>(std::move(decoded));
  });
}

Bytes PackFile::stream(uint32_t tile) const {
  const PackEntry found = entry_of(tile);
  if (found.size == 0) return {};
  return with_file_context("tile " + std::to_string(tile), [&] { return stream_of(found); });
}

uint64_t PackFile::counted_vertices() const {
  uint64_t all = 0;
  for (uint32_t number = 0; number < tiles(); ++number) all += vertices(number);
  return all;
}

}  // namespace microtin::pack
