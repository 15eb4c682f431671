// SPDX-License-Identifier: MIT
// Packs, damaged and forged, on storage that fails, read in sectors or not: a service ends within
// its bounds, answers come from tiles that a host accepts alone, and are the host's. The fuzzer
// chooses segments, sectors and faults by the last bytes of its input.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/stream/header.hpp"
#include "fuzz/support/expect.hpp"
#include "fuzz/support/pack_slots.hpp"
#include "fuzz/support/repair.hpp"
#include "tests/support/limited_segment.hpp"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 120;

// Makes the checks of streams, entries and header right again, as far as lengths allow.
void repair_pack(uint8_t* bytes, size_t size) {
  if (size < kPackFixedBytes) return;
  std::memcpy(bytes, kPackMagic, sizeof kPackMagic);
  bytes[4] = kPackVersion;
  PackHeader header;
  const microtin_status legal = read_pack_header(bytes, &header);
  const size_t index = pack_index_start(header);
  if (size < index) return;
  write_check(bytes, 0, index - kCheckBytes);
  if (legal != MICROTIN_STATUS_OK) return;
  const uint64_t tiles = uint64_t{tile_columns(header.grid)} * tile_rows(header.grid);
  for (uint32_t tile = 0; tile < tiles; ++tile) {
    const uint64_t at = pack_entry_start(header, tile);
    if (at + kPackEntryBytes > size) return;
    uint8_t* const entry_bytes = bytes + at;
    PackEntry entry;
    read_pack_entry(entry_bytes, header, &entry);
    if (entry.size != 0 && entry.offset <= size && entry.size <= size - entry.offset) {
      uint8_t* const stream = bytes + entry.offset;
      repair(stream, entry.size);
      write_u32(entry_bytes + 8, stream_hash(kStreamHash, stream, entry.size));
    }
    write_u32(entry_bytes + kPackEntryBytes - kCheckBytes,
              pack_entry_check(header.identity, tile, entry_bytes));
  }
}

// Storage that gives few bytes, or none, as the fuzzer says.
struct Card {
  const uint8_t* bytes;
  size_t size;
  FuzzedDataProvider& faults;
  uint32_t sector = 0;  // that no read leaves; 0: there are none
  uint32_t reads = 0;

  static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
    Card& card = *static_cast<Card*>(context);
    EXPECT(size != 0 && size <= 128);
    EXPECT(card.sector == 0 || offset / card.sector == (offset + size - 1) / card.sector);
    ++card.reads;
    const uint8_t fault = card.faults.ConsumeIntegral<uint8_t>();  // 0 when there are no more
    if (fault % 8 == 1) return -1 - fault;
    if (offset >= card.size) return 0;
    const size_t most = fault % 8 == 2 ? 1 + fault / 8 : size;
    const size_t taken = std::min({size, most, card.size - static_cast<size_t>(offset)});
    std::memcpy(buffer, card.bytes + offset, taken);
    return static_cast<int32_t>(taken);
  }
};

int64_t coordinate(FuzzedDataProvider& asked, uint32_t most) {
  const int64_t all = static_cast<int64_t>(most) * 256;
  const int64_t any = asked.ConsumeIntegralInRange<int64_t>(-300, std::min<int64_t>(all, 1 << 23));
  return asked.ConsumeBool() ? any : any / 256 * 256;
}

// A tile by the host's reader. What devices take although its chunks are broken, which they do not
// look at, is cut off behind its last section.
std::optional<DecodedTerrain> host_tile(const PackFile& file, uint32_t number) {
  try {
    return file.tile(number);
  } catch (const Error& error) {
    if (std::string(error.what()).find("they are no chunks") == std::string::npos) throw;
  }
  std::vector<uint8_t> stream = file.stream(number);
  const microtin_stream_info info = microtin::stream::read_header(stream).info;
  std::vector<uint64_t> mesh_space(info.mesh_bytes / 8 + 1),
      decoder_space(info.decoder_bytes / 8 + 1);
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
  microtin_mesh_init(mesh_space.data(), mesh_space.size() * 8, &mesh);
  microtin_decoder_init(decoder_space.data(), decoder_space.size() * 8, mesh, &decoder);
  size_t used = 0;
  EXPECT(microtin_decoder_feed(decoder, stream.data(), stream.size(), &used, 0) ==
         MICROTIN_STATUS_OK);
  stream.resize(used);
  return DecodedTerrain(stream);
}

// The height at a place by the host's reader; none where it knows none, or the tile is refused.
std::optional<int32_t> expected_height(const PackFile& file, uint32_t number, int64_t x,
                                       int64_t y) {
  const TileBox box = tile_box(file.grid(), number);
  try {
    const std::optional<DecodedTerrain> tile = host_tile(file, number);
    if (!tile) return std::nullopt;
    uint32_t hint = 0;
    int32_t height = 0;
    if (microtin_mesh_height_at(tile->mesh(), static_cast<int32_t>(x - int64_t{box.x} * 256),
                                static_cast<int32_t>(y - int64_t{box.y} * 256), &hint, &height, 0,
                                0) == MICROTIN_QUERY_OK) {
      return height;
    }
  } catch (const Error&) {
  }
  return std::nullopt;
}

// Every answer is that of one of the tiles at the place, as the host decodes them.
void check_height(const PackFile& file, const PackSlots& device, int64_t x, int64_t y) {
  uint32_t hint = 12345;
  int32_t height = 0;
  const microtin_query_result answer = device.height_at(x, y, &hint, &height);
  if (answer != MICROTIN_QUERY_OK) return;
  bool is_right = false;
  for (uint32_t number = 0; number < file.entries().size(); ++number) {
    const TileBox box = tile_box(file.grid(), number);
    if (x < int64_t{box.x} * 256 || x > int64_t{box.x_end} * 256 || y < int64_t{box.y} * 256 ||
        y > int64_t{box.y_end} * 256) {
      continue;
    }
    is_right = is_right || expected_height(file, number, x, y) == height;
  }
  EXPECT(is_right);
}

// Blocks hold what single answers and exact arithmetic say.
void check_fill(const PackSlots& device, const microtin_pack_info& info,
                const microtin_segment& segment) {
  const microtin_grid_spec block = {segment.x, segment.y, 300, -256, 3, 2, -9999};
  int16_t heights[6];
  if (device.sample_grid(block, heights) != MICROTIN_QUERY_OK) return;
  const Wide unit = Wide{65536} * static_cast<Wide>(info.z.denominator);
  uint32_t hint = 0;
  for (int i = 0; i < 6; ++i) {
    int32_t z = 0;
    EXPECT(device.height_at(block.x + i % 3 * block.dx, block.y + i / 3 * block.dy, &hint, &z) ==
           MICROTIN_QUERY_OK);
    const Wide real = static_cast<Wide>(info.z.numerator) * z + Wide{info.z.offset} * 65536;
    EXPECT(heights[i] == std::clamp<Wide>(round_divide(real, unit), INT16_MIN, INT16_MAX));
  }
}

void check_to_lattice(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit) {
  int64_t lattice = 0;
  if (microtin_pack_axis_to_lattice(&axis, most, value, per_unit, &lattice) != MICROTIN_STATUS_OK)
    return;
  const Wide parts =
      Wide{value} * static_cast<Wide>(axis.denominator) - Wide{axis.offset} * per_unit;
  EXPECT(lattice == round_divide(parts * 256, static_cast<Wide>(axis.numerator) * per_unit));
  EXPECT(lattice >= 0 && lattice <= int64_t{most} * 256);
}

bool remembers_bad_tile(const microtin_pack* pack) {
  uint32_t tile = 0, all = 0, why = MICROTIN_STATUS_OK;
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    if (microtin_pack_bad_tile(pack, i, &tile, &why) != MICROTIN_STATUS_OK) continue;
    ++all;
    EXPECT(why == MICROTIN_STATUS_CHECKSUM || why == MICROTIN_STATUS_MALFORMED ||
           why == MICROTIN_STATUS_TOO_BIG || why == MICROTIN_STATUS_TRUNCATED ||
           why == MICROTIN_STATUS_UNSUPPORTED_VERSION);
  }
  return all != 0;
}

// Boxes of tiles that one walk along a segment may look at (format-pack.md, 4.3); 0 before the
// header is read.
uint64_t boxes_of_walk(const microtin_pack* pack, const microtin_segment& segment) {
  microtin_pack_info info;
  if (microtin_pack_get_info(pack, &info) != MICROTIN_STATUS_OK) return 0;
  const auto tiles = [](int64_t from, int64_t to, uint32_t most, uint32_t tile_size) {
    const int64_t length = std::min<int64_t>(std::abs(to - from) / 256, most);
    return static_cast<uint64_t>(length) / tile_size + 2;
  };
  return 2 * (tiles(segment.x, segment.x_end, info.x_max, info.tile_width) +
              tiles(segment.y, segment.y_end, info.y_max, info.tile_height));
}

// Serves a segment to its end, with interrupts between the calls. A segment that touches thousands
// of bad tiles walks along them at each call: it is left when that has taken a second.
void serve(Card& card, const PackSlots& device, const microtin_segment& segment,
           uint32_t step_limit) {
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  microtin_pack_check check = {};  // whatever it finds, loading goes on
  microtin_pack_bounds bounds = {};
  uint64_t boxes = 0;
  for (uint32_t call = 0, failed = 0; failed < 3 && boxes < 4000000; ++call) {
    EXPECT(call < 200000);
    boxes += boxes_of_walk(device.pack, segment);
    if (call % 16 == 3) microtin_pack_check_segment(device.pack, &segment, &check);
    if (call % 16 == 9) microtin_pack_bounds_on_segment(device.pack, &segment, &bounds);
    const uint32_t reads = card.reads;
    status = device.load_with(segment, Card::read, &card, step_limit);
    if (status == MICROTIN_STATUS_IO) {
      EXPECT(card.reads != reads);
      continue;
    }
    EXPECT(step_limit == 0 || card.reads <= reads + 1);
    if (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
      failed += status == MICROTIN_STATUS_NEED_INPUT && step_limit == 0 ? 1u : 0u;
      if (card.reads == reads && status == MICROTIN_STATUS_NEED_INPUT) ++failed;
      if (card.reads > 20000) break;
      continue;
    }
    if (status == MICROTIN_STATUS_OK) break;
    if (status == MICROTIN_STATUS_BAD_TILES) EXPECT(remembers_bad_tile(device.pack));
    ++failed;
  }
  int32_t height = 0;
  uint32_t hint = 0;
  const microtin_query_result answer = device.height_at(segment.x, segment.y, &hint, &height);
  if (status == MICROTIN_STATUS_OK) EXPECT(answer != MICROTIN_QUERY_NOT_LOADED);
  microtin_segment_extremes extremes;
  const microtin_query_result on_segment = device.segment_extremes(segment, &extremes);
  if (status == MICROTIN_STATUS_OK) EXPECT(on_segment != MICROTIN_QUERY_NOT_LOADED);
}

// What a device says of a segment and of a block at its beginning.
struct Answers {
  microtin_query_result begin, on_segment, fill;
  int32_t height = 0;
  microtin_segment_extremes extremes;
  int16_t block[6] = {};

  Answers(const PackSlots& device, const microtin_segment& segment) {
    uint32_t hint = 0;
    begin = device.height_at(segment.x, segment.y, &hint, &height);
    on_segment = device.segment_extremes(segment, &extremes);
    fill = device.sample_grid({segment.x, segment.y, 300, -256, 3, 2, -9999}, block);
  }
  // Blocks reach beyond the segment, to tiles that may be there or not.
  bool operator==(const Answers& other) const {
    const bool are_blocks = fill == MICROTIN_QUERY_OK && other.fill == MICROTIN_QUERY_OK;
    return begin == other.begin && on_segment == other.on_segment && height == other.height &&
           same(extremes, other.extremes) &&
           (!are_blocks || std::equal(block, block + 6, other.block));
  }
};

// A device that holds nothing finds all tiles of a segment whole that could be loaded.
void expect_whole(Card& card, const microtin_segment& segment) {
  const PackSlots device(1, kCapacity, 0);
  microtin_pack_check check = {};
  EXPECT(microtin_pack_check_with(device.pack, &segment, 0, &check, Card::read, &card) ==
         MICROTIN_STATUS_OK);
}

// Storage without faults: slots of both forms that hold a segment answer the same.
void check_forms(const uint8_t* data, size_t size, uint32_t slots,
                 const std::vector<microtin_segment>& segments) {
  const uint32_t room = 40 * kCapacity + 100;  // for any tile
  const PackSlots meshes(slots, kCapacity, 0), compact(slots, kCapacity, room);
  FuzzedDataProvider none(nullptr, 0);
  Card card{data, size, none};
  for (const microtin_segment& segment : segments) {
    const auto is_served = [&](const PackSlots& device) {
      return device.load_with(segment, Card::read, &card, 0) == MICROTIN_STATUS_OK;
    };
    if (!is_served(meshes) || !is_served(compact)) continue;
    EXPECT(Answers(meshes, segment) == Answers(compact, segment));
    expect_whole(card, segment);
  }
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 16 != 0) repair_pack(data, size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzedDataProvider asked(data, size);
  const uint32_t slots = asked.ConsumeIntegralInRange<uint32_t>(1, 5);
  const uint32_t most_bytes = static_cast<uint32_t>(MICROTIN_COMPACT_BYTES(kCapacity));
  const PackSlots device(
      slots, kCapacity,
      asked.ConsumeBool() ? asked.ConsumeIntegralInRange<uint32_t>(most_bytes / 4, most_bytes) : 0);
  const uint32_t step_limit = asked.ConsumeIntegralInRange<uint32_t>(0, 40);
  const uint32_t sector = asked.ConsumeBool() ? 1u << asked.ConsumeIntegralInRange(3, 9) : 0;
  EXPECT(microtin_pack_align_reads(device.pack, sector) == MICROTIN_STATUS_OK);
  std::optional<PackFile> file;
  try {
    file.emplace(std::vector<uint8_t>(data, data + size));
  } catch (const Error&) {
  }
  Card card{data, size, asked, sector};
  std::vector<microtin_segment> segments;
  for (int i = 0; i < 3; ++i) {
    microtin_pack_info info = {1000, 1000, 0, 0, 0, 0, 0, 0, 0, 0, {}, {}, {}};
    microtin_pack_get_info(device.pack, &info);
    const microtin_segment segment = {coordinate(asked, info.x_max), coordinate(asked, info.y_max),
                                      coordinate(asked, info.x_max), coordinate(asked, info.y_max)};
    segments.push_back(segment);
    if (asked.ConsumeBool()) microtin_pack_clear_bad_tiles(device.pack);
    serve(card, device, segment, step_limit);
    if (file) check_height(*file, device, segment.x, segment.y);
    if (microtin_pack_get_info(device.pack, &info) != MICROTIN_STATUS_OK) continue;
    check_fill(device, info, segment);
    const int64_t value = asked.ConsumeIntegral<int64_t>();
    check_to_lattice(info.x, info.x_max, value >> asked.ConsumeIntegralInRange(0, 63),
                     asked.ConsumeIntegral<uint32_t>());
  }
  if (asked.ConsumeBool()) check_forms(data, size, slots, segments);
  return 0;
}
