// SPDX-License-Identifier: MIT
// The recorded flights that devices are compared with are what a host answers; and what a card is
// asked for.
#include <doctest/doctest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "decoder/examples/flight.h"
#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/slow.hpp"

extern "C" void put_char(char) {}  // the device's, of which only the flight is wanted here

namespace microtin::tests {
namespace {

// The tiles of a pack, each decoded whole. Those that are damaged have no say.
class HostPack {
 public:
  explicit HostPack(const std::string& path) : pack_(open_file(path)) {
    for (uint32_t tile = 0; tile < pack_.entries().size(); ++tile) {
      try {
        tiles_[tile] = pack_.tile(tile);
      } catch (const Error&) {
        bad_.push_back(tile);
      }
    }
  }

  microtin_pack_info info() const {
    microtin_pack_info info{};
    info.x_max = pack_.grid().x_max;
    info.y_max = pack_.grid().y_max;
    return info;
  }
  const std::vector<uint32_t>& bad() const { return bad_; }

  // As a report has it.
  std::string answer(int64_t x, int64_t y) const {
    std::string without = "void";
    for (uint32_t tile = 0; tile < pack_.entries().size(); ++tile) {
      const TileBox box = tile_box(pack_.grid(), tile);
      const int64_t lx = x - int64_t{box.x} * 256, ly = y - int64_t{box.y} * 256;
      if (lx < 0 || ly < 0 || x > int64_t{box.x_end} * 256 || y > int64_t{box.y_end} * 256)
        continue;
      const auto found = tiles_.find(tile);
      if (found == tiles_.end()) {
        without = "bad";
        continue;
      }
      uint32_t hint = 0;
      int32_t height = 0;
      if (found->second && microtin_mesh_height_at(found->second->mesh(), static_cast<int32_t>(lx),
                                                   static_cast<int32_t>(ly), &hint, &height, 0,
                                                   0) == MICROTIN_QUERY_OK) {
        return std::to_string(height);
      }
    }
    return without;
  }

 private:
  PackFile pack_;
  std::map<uint32_t, std::optional<DecodedTerrain>> tiles_;
  std::vector<uint32_t> bad_;
};

std::string report_of(const HostPack& pack) {
  std::string report;
  const microtin_pack_info info = pack.info();
  for (int32_t i = 0; i < FLIGHT_PLACES; ++i) {
    const microtin_segment segment = flight_segment(i, &info);
    report += pack.answer(segment.x, segment.y) + (i % 10 == 9 ? "\n" : " ");
  }
  return report;
}

// A number that the example card.c prints of itself.
int64_t fact(const std::string& facts, const std::string& name) {
  const size_t at = facts.find(name + ": ");
  REQUIRE(at != std::string::npos);
  return std::stoll(facts.substr(at + name.size() + 2));
}

// Reads whole sectors, of which one is kept.
struct SectorCard {
  static constexpr uint64_t kSector = 512;
  Bytes bytes;
  uint64_t kept = ~uint64_t{0};
  uint64_t sectors = 0, asked = 0, most_sectors = 0;

  static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
    SectorCard& card = *static_cast<SectorCard*>(context);
    if (offset >= card.bytes.size()) return 0;
    const size_t count = std::min(size, card.bytes.size() - static_cast<size_t>(offset));
    const uint64_t first = offset / kSector, last = (offset + count - 1) / kSector;
    for (uint64_t sector = first; sector <= last; ++sector) {
      if (sector != card.kept) ++card.sectors;
      card.kept = sector;
    }
    card.most_sectors = std::max(card.most_sectors, last - first + 1);
    card.asked += count;
    std::memcpy(buffer, card.bytes.data() + offset, count);
    return static_cast<int32_t>(count);
  }
};

}  // namespace

TEST_CASE("card: recorded flights have the host's heights") {
  // MICROTIN_WRITE_GOLDEN=1 writes them anew, for packs that packs.sh has made.
  for (const std::string name : {"card", "tiles", "kept"}) {
    const HostPack pack(golden(name + ".mtp"));
    CHECK(pack.bad().size() == (name == "card" ? 1 : 0));
    const std::string report = report_of(pack);
    if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr)
      write_file(golden(name + ".report"), {report.begin(), report.end()});
    CHECK(report == read_file(golden(name + ".report")));
    CHECK((report.find("bad") != std::string::npos) == (name == "card"));
  }
}

TEST_CASE("card: sectors are at most twice the bytes requested, and the damaged tile is reported") {
  const std::string facts = read_file(golden("../../../decoder/examples/card.txt"));
  CHECK(fact(facts, "bytes of sectors read") <= 2 * fact(facts, "bytes asked for"));
  CHECK(fact(facts, "turns without a card") > 0);
  CHECK(facts.find("damaged: tile " + std::to_string(HostPack(golden("card.mtp")).bad()[0]) +
                   "\n") != std::string::npos);
}

TEST_CASE("pack: aligned reads lie in one sector, and give the same heights") {
  const EncodedPack encoded = encode_pack(rough_raster(121, 105), pack_options(3, 60));
  SectorCard cards[2] = {{write_pack(encoded)}, {write_pack(encoded)}};
  const MeshSlots loose(4), aligned(4);
  CHECK(microtin_pack_align_reads(aligned.pack, 512) == MICROTIN_STATUS_OK);
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const microtin_segment here = at(random.below(121), random.below(105));
    CHECK(microtin_pack_load_with(loose.pack, &here, SectorCard::read, cards, 0) ==
          MICROTIN_STATUS_OK);
    CHECK(microtin_pack_load_with(aligned.pack, &here, SectorCard::read, cards + 1, 0) ==
          MICROTIN_STATUS_OK);
    int32_t heights[2] = {0, 0};
    CHECK(loose.height_at(here.x, here.y, heights[0]) ==
          aligned.height_at(here.x, here.y, heights[1]));
    CHECK(heights[0] == heights[1]);
  }
  CHECK(cards[0].most_sectors == 2);
  CHECK(cards[1].most_sectors == 1);
  CHECK(cards[1].sectors <= cards[0].sectors);
}

TEST_CASE("pack: along a row, sectors of small and of large tiles" * kSlow) {
  for (const uint32_t width : {12u, 24u, 48u}) {
    constexpr uint32_t kTiles = 16;
    PackOptions options = pack_options(0, 2500);
    options.tile_size = width;
    const EncodedPack encoded = encode_pack(rough_raster(kTiles * width + 1, width + 1), options);
    REQUIRE(encoded.streams.size() == kTiles);
    SectorCard cards[2] = {{write_pack(encoded)}, {write_pack(encoded)}};
    const MeshSlots loose(4, 2500), aligned(4, 2500);
    CHECK(microtin_pack_align_reads(aligned.pack, 512) == MICROTIN_STATUS_OK);
    for (int32_t x = 4; x < static_cast<int32_t>(kTiles * width); x += 4) {
      const microtin_segment ahead = {(x - 4) * 256, 1280, x * 256, 1280};
      CHECK(loose.load_with(ahead, SectorCard::read, cards, 0) == MICROTIN_STATUS_OK);
      CHECK(aligned.load_with(ahead, SectorCard::read, cards + 1, 0) == MICROTIN_STATUS_OK);
    }
    // Every sector once, and for four tiles the index and the sector that was left for it.
    const uint64_t file = (cards[1].bytes.size() + 511) / 512;
    CHECK(cards[1].sectors <= file + kTiles / 4 * 2);
    if (width > 12) CHECK(cards[1].sectors * 512 <= 2 * cards[1].asked);
    CHECK(cards[1].asked == cards[0].asked);
    CHECK(cards[0].sectors >= file + kTiles);
  }
}

TEST_CASE(
    "pack: in any direction, sectors of streams of 1.2 KB are at most twice what was asked for" *
    kSlow) {
  constexpr int32_t kTiles = 5, kFlights = 8;
  for (const int32_t width : {16, 48}) {
    PackOptions options = pack_options(0, 2500);
    options.tile_size = static_cast<uint32_t>(width);
    const int32_t side = kTiles * width;
    const auto posts = static_cast<uint32_t>(side + 1);
    const EncodedPack encoded = encode_pack(rough_raster(posts, posts), options);
    const Bytes file = write_pack(encoded);
    const size_t stream = file.size() / encoded.streams.size() - kPackEntryBytes;
    double worst = 0;
    for (int32_t flight = 0; flight < kFlights; ++flight) {
      // From the southern border to the northern one, and from the western to the eastern, more or
      // less aslant.
      const int32_t drift = (flight / 2 * 2 + 1) * side / kFlights;
      SectorCard cards[2] = {{file}, {file}};
      const MeshSlots loose(4, 2500), aligned(4, 2500);
      CHECK(microtin_pack_align_reads(aligned.pack, 512) == MICROTIN_STATUS_OK);
      for (int32_t along = 0; along <= side; along += 2) {
        const int32_t across = drift * along / side;
        const microtin_segment here = flight % 2 != 0 ? at(along, across) : at(across, along);
        CHECK(loose.load_with(here, SectorCard::read, cards, 0) == MICROTIN_STATUS_OK);
        CHECK(aligned.load_with(here, SectorCard::read, cards + 1, 0) == MICROTIN_STATUS_OK);
      }
      worst = std::max(worst, 512.0 * static_cast<double>(cards[1].sectors) /
                                  static_cast<double>(cards[0].asked));
    }
    MESSAGE("streams of " << stream << " bytes: at most " << worst << " times what was asked for");
    if (width == 16) continue;
    REQUIRE(stream >= 1200);
    CHECK(worst <= 2);
  }
}

TEST_CASE(
    "pack: of entries that were read together each is checked, and read again after a fault") {
  PackOptions options = pack_options(3, 400);
  options.tile_size = 12;
  Card card{write_pack(encode_pack(rough_raster(61, 53), options))};
  const PackFile pack(card.bytes);
  const size_t second = static_cast<size_t>(pack.entries()[0].offset) -
                        (pack.entries().size() - 1) * size_t{kPackEntryBytes};
  const MeshSlots device(4, 400);
  CHECK(microtin_pack_align_reads(device.pack, 512) == MICROTIN_STATUS_OK);
  card.bytes[second] ^= 1;
  CHECK(device.load(card, at(5, 5)) == MICROTIN_STATUS_OK);
  card.bytes[second] ^= 1;
  CHECK(device.load(card, at(17, 5)) == MICROTIN_STATUS_BAD_TILES);
  CHECK(device.load(card, at(30, 5)) == MICROTIN_STATUS_OK);
  microtin_pack_clear_bad_tiles(device.pack);
  CHECK(device.load(card, at(17, 5)) == MICROTIN_STATUS_OK);
}

// There are more bad tiles than are remembered, so this one is tried again.
TEST_CASE("pack: an entry that was misread together with others is not kept") {
  constexpr uint32_t kTiles = 12, kBad = MICROTIN_PACK_MAX_BAD_TILES, kMisread = kBad + 1;
  const ForgedTile flat = forged_tile({{{0, 0, 7}, {2, 0, 7}, {0, 2, 7}, {2, 2, 7}}, {}});
  Card card{forged_pack({2 * kTiles, 2, 2, 2}, std::vector<ForgedTile>(kTiles, flat))};
  const PackFile pack(card.bytes);
  for (uint32_t i = 0; i < kBad; ++i) card.bytes[pack.entries()[i].offset + 20] ^= 1;
  uint8_t& misread = card.bytes[pack_entry_start(pack.header(), kMisread)];
  const microtin_segment all = {0, 300, kTiles * 512, 300};
  const MeshSlots device(kTiles);
  CHECK(microtin_pack_align_reads(device.pack, 512) == MICROTIN_STATUS_OK);
  int32_t height = 0;
  misread ^= 1;
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(device.height_at(kMisread * 512 + 256, 300, height) == MICROTIN_QUERY_NOT_LOADED);
  misread ^= 1;
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(device.height_at(kMisread * 512 + 256, 300, height) == MICROTIN_QUERY_OK);
}

TEST_CASE_TEMPLATE("pack: tiles without terrain, of entries that are kept, end no service", Device,
                   MeshSlots, CompactSlots) {
  const ForgedTile flat = forged_tile({{{0, 0, 7}, {2, 0, 7}, {0, 2, 7}, {2, 2, 7}}, {}}), none;
  Card card{forged_pack({12, 2, 2, 2}, {flat, none, none, none, none, flat})};
  const microtin_segment all = {0, 300, 12 * 256, 300};
  for (const uint32_t steps : {0u, 1000u}) {
    const Device device(6);
    CHECK(microtin_pack_align_reads(device.pack, 512) == MICROTIN_STATUS_OK);
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
      status = device.load(card, all, steps);
    }
    CHECK(status == MICROTIN_STATUS_OK);
    int32_t height = 0;
    CHECK(device.height_at(11 * 256, 300, height) == MICROTIN_QUERY_OK);
    CHECK(device.height_at(7 * 256, 300, height) == MICROTIN_QUERY_VOID);
  }
}

TEST_CASE("pack: only powers of two align reads, and all of them do") {
  const Bytes bytes = write_pack(encode_pack(rough_raster(61, 53), pack_options(3, 60)));
  for (const uint32_t sector : {3u, 513u, 65536u, ~0u}) {
    CHECK(microtin_pack_align_reads(MeshSlots(4).pack, sector) == MICROTIN_STATUS_ARGUMENT);
  }
  CHECK(microtin_pack_align_reads(nullptr, 512) == MICROTIN_STATUS_ARGUMENT);
  for (uint32_t sector = 1; sector <= 32768; sector *= 2) {
    const MeshSlots device(4);
    Card card{bytes};
    CHECK(microtin_pack_align_reads(device.pack, sector) == MICROTIN_STATUS_OK);
    microtin_pack_reset(device.pack);  // keeps it
    CHECK(device.load(card, at(20, 20)) == MICROTIN_STATUS_OK);
    uint64_t offset = 0;
    uint8_t* buffer = nullptr;
    size_t size = 0;
    const microtin_segment other = at(60, 50);
    microtin_pack_load(device.pack, &other, 0);
    microtin_pack_next_read(device.pack, &offset, &buffer, &size);
    CHECK(offset / sector == (offset + size - 1) / sector);
    microtin_pack_complete_read(device.pack,
                                static_cast<int32_t>(size) + 1);  // more than was wanted
    CHECK(microtin_pack_load(device.pack, &other, 0) == MICROTIN_STATUS_IO);
  }
}

}  // namespace microtin::tests
