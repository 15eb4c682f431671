#include "encoder/pack_file.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "encoder/error.hpp"
#include "encoder/error_context.hpp"
#include "encoder/header.hpp"

namespace microtin {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kMostError = 65535;

// In 1/256 of a z step, rounded up.
uint32_t in_steps(Decimal error, const Axis& z) {
  const Wide steps = ceil_divide(Wide{error.mantissa} * 256 * static_cast<Wide>(z.denominator),
                                 static_cast<Wide>(z.numerator) * power_of_ten(error.decimals));
  return static_cast<uint32_t>(std::min<Wide>(steps, kMostError));
}

uint64_t to_unsigned(int16_t value) {
  return static_cast<uint16_t>(value);
}

Bytes write_header(const EncodedPack& pack, const Metadata& metadata) {
  const Bytes placement = write_placement(metadata.placement), notes = write_notes(metadata);
  int16_t lowest = INT16_MAX, highest = INT16_MIN;
  uint32_t most = 0;
  for (const EncodedTile& tile : pack.tiles) {
    if (tile.stream.empty()) continue;
    lowest = std::min(lowest, tile.lowest);
    highest = std::max(highest, tile.highest);
    most = std::max(most, tile.vertices);
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
  header.insert(header.end(), placement.begin(), placement.end());
  header.insert(header.end(), notes.begin(), notes.end());
  append_check(header, 0);
  return header;
}

Bytes write_entry(const EncodedTile& tile, uint64_t offset, const Axis& z) {
  Bytes entry;
  if (tile.stream.empty()) return Bytes(kPackEntryBytes - kCheckBytes);
  if (tile.stream.size() >> 24 != 0 || offset >> 40 != 0) throw Error("the pack grows too large");
  append_number(entry, offset, 5);
  append_number(entry, tile.stream.size(), 3);
  append_number(entry, tile.vertices, 4);
  append_number(entry, to_unsigned(tile.lowest), 2);
  append_number(entry, to_unsigned(tile.highest), 2);
  append_number(entry, in_steps(tile.measured.max_error, z), 2);
  append_number(entry, in_steps(tile.measured.rms_error, z), 2);
  append_number(entry, stream_hash(kStreamHash, tile.stream.data(), tile.stream.size()), 4);
  return entry;
}

void expect(bool legal) {
  if (!legal) throw Error(describe(MICROTIN_MALFORMED));
}

void expect_done(microtin_status status) {
  if (status != MICROTIN_DONE) throw Error(describe(status));
}

void check_box(const microtin_mesh* mesh, const TileBox& box) {
  for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
    Point p{};
    int16_t z = 0;
    microtin_vertex(mesh, v, &p.x, &p.y, &z);
    expect(p.x <= box.x_end - box.x && p.y <= box.y_end - box.y);
  }
}

}  // namespace

Bytes write_pack(const EncodedPack& pack, Metadata metadata) {
  metadata.placement = pack.placement;
  Bytes file = write_header(pack, metadata);
  const uint32_t header_check = read_u32(file.data() + file.size() - kCheckBytes);
  uint64_t offset = file.size() + pack.tiles.size() * kPackEntryBytes;
  for (std::size_t i = 0; i < pack.tiles.size(); ++i) {
    const Bytes entry = write_entry(pack.tiles[i], offset, pack.placement.z);
    file.insert(file.end(), entry.begin(), entry.end());
    append_number(file, pack_entry_check(header_check, static_cast<uint32_t>(i), entry.data()),
                  kCheckBytes);
    offset += pack.tiles[i].stream.size();
  }
  for (const EncodedTile& tile : pack.tiles) {
    file.insert(file.end(), tile.stream.begin(), tile.stream.end());
  }
  return file;
}

bool is_pack(const Bytes& bytes) {
  return bytes.size() > sizeof kPackMagic &&
         check_pack_identity(bytes.data()) != MICROTIN_BAD_MAGIC;
}

PackFile::PackFile(Bytes bytes) : bytes_(std::move(bytes)) {
  read_header();
  read_index();
}

void PackFile::read_header() {
  const uint8_t* const data = bytes_.data();
  if (bytes_.size() < kPackFixedBytes) throw Error(describe(MICROTIN_TRUNCATED));
  expect_done(check_pack_identity(data));
  const bool legal = read_pack_header(data, &header_);
  const uint32_t end = pack_index_start(header_);
  if (bytes_.size() < end) throw Error(describe(MICROTIN_TRUNCATED));
  if (crc32(0, data, end - kCheckBytes) != read_u32(data + end - kCheckBytes)) {
    throw Error(describe(MICROTIN_CHECKSUM));
  }
  expect(legal);
  if (header_.placement_bytes != 0) {
    Axis axis[3];
    expect(read_placement(data + kPackFixedBytes, header_.placement_bytes, axis));
    metadata_.placement = {axis[0], axis[1], axis[2]};
  }
  read_notes(data + kPackFixedBytes + header_.placement_bytes, data + end - kCheckBytes, metadata_);
}

void PackFile::read_index() {
  const uint32_t start = pack_index_start(header_);
  const uint32_t header_check = read_u32(bytes_.data() + start - kCheckBytes);
  const uint64_t tiles = uint64_t{tile_columns(header_.grid)} * tile_rows(header_.grid);
  if ((bytes_.size() - start) / kPackEntryBytes < tiles) throw Error(describe(MICROTIN_TRUNCATED));
  for (uint32_t tile = 0; tile < tiles; ++tile) {
    const uint8_t* const at = bytes_.data() + pack_entry_start(header_, tile);
    if (pack_entry_check(header_check, tile, at) != read_u32(at + kPackEntryBytes - kCheckBytes)) {
      throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_CHECKSUM));
    }
    PackEntry entry{};
    if (!read_pack_entry(at, header_, &entry)) {
      throw Error("tile " + std::to_string(tile) + ": " + describe(MICROTIN_MALFORMED));
    }
    entries_.push_back(entry);
  }
}

std::optional<DecodedTerrain> PackFile::tile(uint32_t number) const {
  const PackEntry& entry = entries_[number];
  if (entry.size == 0) return std::nullopt;
  return about("tile " + std::to_string(number), [&] {
    if (entry.offset > bytes_.size() || entry.size > bytes_.size() - entry.offset) {
      throw Error(describe(MICROTIN_TRUNCATED));
    }
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(entry.offset);
    const Bytes stream(begin, begin + entry.size);
    if (stream_hash(kStreamHash, stream.data(), stream.size()) != entry.stream_hash) {
      throw Error(describe(MICROTIN_CHECKSUM));
    }
    DecodedTerrain decoded(stream);
    expect(microtin_vertex_count(decoded.mesh()) == entry.vertices);
    check_box(decoded.mesh(), tile_box(header_.grid, number));
    return std::optional<DecodedTerrain>(std::move(decoded));
  });
}

}  // namespace microtin
