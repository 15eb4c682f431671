// SPDX-License-Identifier: MIT
// The autopilots' adapters, beside what the tiles say in floating point.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "encoder/export/autopilot.hpp"
#include "encoder/files/input.hpp"
#include "tests/firmware/adapters_report.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {
namespace {

std::string printed;

Bytes degree_pack() {
  const std::string text = read_file(golden("degree.mtp"));
  return {text.begin(), text.end()};
}

// Metres at a place in 1e-7 degrees, by the tiles.
std::optional<double> truth(const PackFile& pack, double latitude, double longitude) {
  const Placement& p = pack.metadata().placement;
  const auto lattice = [](const Axis& axis, double value) {
    return std::llround((value * 1e-7 - offset_of(axis)) / step_of(axis) * 256);
  };
  const int64_t x = lattice(p.x, longitude), y = lattice(p.y, latitude);
  const auto height = expected_height(pack, x, y);
  if (!height) return std::nullopt;
  return offset_of(p.z) + step_of(p.z) * *height / 65536;
}

// A device with everything there that a flight of this size wants.
struct Loaded {
  Card card{degree_pack()};
  AdapterSlots device{50, 300};
  PackFile pack{degree_pack()};

  template <class Ask, class Adapter>
  void load(Adapter& adapter, const Ask& ask) {
    for (int i = 0; i < 200 && (ask(), microtin_spots_is_pending(&adapter.spots)); ++i) {
      microtin_status status = MICROTIN_STATUS_NEED_INPUT;
      while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
        status = microtin_spots_load(&adapter.spots, 100, Card::read, &card);
      }
    }
  }
};

}  // namespace

TEST_CASE("adapters: a flight is what devices print") {
  Card card{degree_pack()};
  const AdapterSlots device(5, 300);
  printed.clear();
  const auto put = [](char c) { printed += c; };
  CHECK(AdaptersReport(put, device.pack, Card::read, &card).run() == 0);
  // MICROTIN_WRITE_GOLDEN=1 writes it anew, for a pack that packs.sh has made.
  if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr)
    write_file(golden("degree.report"), {printed.begin(), printed.end()});
  CHECK(printed == read_file(golden("degree.report")));
}

TEST_CASE("adapters: INAV's height and look ahead are those of the tiles") {
  Loaded here;
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  float height = -7;
  CHECK(!microtin_inav_height(&inav, 433300000, 72300000, &height));
  CHECK(height == -7);
  microtin_inav_look look{};
  for (int i = 0; i < 40; ++i) {
    const int32_t latitude = 433100000 + i * 18000, longitude = 72150000 + i * 15000;
    const float bearing = static_cast<float>(i) * 9;
    bool known = false;
    here.load(inav, [&] {
      known = microtin_inav_lookahead(&inav, latitude, longitude, bearing, 600, 0.1F, 0.4F, &look);
    });
    REQUIRE(known);
    REQUIRE(microtin_inav_height(&inav, latitude, longitude, &height));
    const auto base = truth(here.pack, latitude, longitude);
    REQUIRE(base);
    CHECK(std::abs(*base - static_cast<double>(height)) < 0.05);
    const double turn = bearing * 0.017453292519943295, north = 30 * std::cos(turn),
                 east = 30 * std::sin(turn);
    double needed = 0, deficit = 0, y = latitude, x = longitude;
    int missed = 0;
    for (int step = 1; step <= 20; ++step) {
      const double up = north * 89.83204953368922;
      x += east * 89.83204953368922 / std::cos((y + up / 2) * 1e-7 * 0.017453292519943295);
      y += up;
      const auto there = truth(here.pack, y, x);
      missed += there ? 0 : 1;
      if (!there) continue;
      needed = std::max(needed, *there - *base - 3.0 * step);
      deficit = std::max(deficit, *there - *base - 12.0 * step);
    }
    CHECK(look.samples_total == 20);
    CHECK(look.samples_missed == missed);
    CHECK(std::abs(needed - static_cast<double>(look.climb_needed_m)) < 0.5);
    CHECK(std::abs(deficit - static_cast<double>(look.escape_deficit_m)) < 0.5);
  }
  CHECK(microtin_inav_lookahead(&inav, 433300000, 72300000, 0, 1e9F, 0, 0, &look));
  CHECK(look.samples_total == 64);
  const float none = std::nanf("");
  look.samples_total = 7;
  CHECK(!microtin_inav_lookahead(&inav, 433300000, 72300000, none, 600, 0, 0, &look));
  CHECK(look.samples_total == 7);
  CHECK(microtin_inav_lookahead(&inav, 433300000, 72300000, 0, none, none, none, &look));
  CHECK(look.samples_total == 0);
}

TEST_CASE("adapters: a pack across 180 degrees has heights at both names of a longitude") {
  Raster raster = rough_raster(41, 41);
  raster.x = {179 * 20, 1, 20};  // 179 to 181 degrees
  raster.y = {0, 1, 20};
  const Bytes bytes = pack_bytes(raster);
  const PackFile pack(bytes);
  Card card{bytes};
  AdapterSlots device(50, 300);
  microtin_spots spots;
  microtin_spots_init(&spots, device.pack);
  const auto ask = [&](int32_t longitude) {
    int32_t height = INT32_MIN;
    for (int i = 0; i < 200; ++i) {
      const microtin_spot at{9100000, longitude};
      if (microtin_spots_ask(&spots, at, &height) != 0) break;
      microtin_spots_load(&spots, 1000, Card::read, &card);
    }
    return height;
  };
  const auto height = truth(pack, 9100000, 1805000000);
  REQUIRE(height);
  CHECK(std::abs(*height * 1000 - ask(1805000000)) < 2);
  CHECK(ask(-1795000000) == ask(1805000000));
  CHECK(ask(1795000000) != INT32_MIN);
  CHECK(ask(-1785000000) == INT32_MIN);
  CHECK(ask(5000000) == INT32_MIN);
}

TEST_CASE("adapters: a position outside requests no tile, a position that is not loaded does") {
  Loaded here;
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  float height = 0;
  here.load(inav, [] {});
  CHECK(!microtin_inav_height(&inav, 433300000, -72300000, &height));
  CHECK(!microtin_inav_height(&inav, INT32_MAX, INT32_MIN, &height));
  CHECK(!microtin_spots_is_pending(&inav.spots));
  CHECK(!microtin_inav_height(&inav, 433900000, 72900000, &height));
  CHECK(microtin_spots_is_pending(&inav.spots));
  here.card.is_pulled = true;
  microtin_inav_load(&inav, 50, Card::read, &here.card);  // asks for input, or has done so
  CHECK(microtin_inav_load(&inav, 50, Card::read, &here.card) == MICROTIN_STATUS_IO);
  CHECK(microtin_spots_is_pending(&inav.spots));
  here.card.is_pulled = false;
  here.load(inav, [&] { microtin_inav_height(&inav, 433900000, 72900000, &height); });
  CHECK(microtin_inav_height(&inav, 433900000, 72900000, &height));
}

TEST_CASE("adapters: ArduPilot's heights are corrected, within a bound, and blocks are filled") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  const int32_t latitude = 433300000, longitude = 72300000;
  float plain = 0, corrected = 0;
  here.load(terrain,
            [&] { microtin_ardupilot_height_amsl(&terrain, latitude, longitude, &plain, false); });
  const double ground = *truth(here.pack, latitude, longitude);
  CHECK(std::abs(ground - static_cast<double>(plain)) < 0.05);
  const auto difference = [&](double above, float most) {
    microtin_ardupilot_set_reference(&terrain, latitude, longitude,
                                     static_cast<int32_t>(std::lround((ground + above) * 100)),
                                     most);
    REQUIRE(microtin_ardupilot_height_amsl(&terrain, latitude, longitude, &corrected, true));
    return static_cast<double>(corrected) - static_cast<double>(plain);
  };
  CHECK(std::abs(difference(5, 30) - 5) < 0.1);
  CHECK(std::abs(difference(-12, 30) + 12) < 0.1);
  CHECK(std::abs(difference(80, 30) - 30) < 0.1);
  CHECK(std::abs(difference(-80, 30) + 30) < 0.1);
  CHECK(difference(5, 0) == 0);

  microtin_ardupilot_begin_block(&terrain, 433500000, 72500000, 30);
  uint16_t pending = 0, loaded = 0;
  bool is_full = false;
  here.load(terrain, [&] { is_full = microtin_ardupilot_fill_block(&terrain, 56); });
  CHECK(is_full);
  microtin_ardupilot_statistics(&terrain, &pending, &loaded);
  CHECK(pending == 0);
  CHECK(loaded == 56);
  // Beyond the pack groups stay missing, however often they are tried.
  microtin_ardupilot_begin_block(&terrain, 433990000, 73000000, 100);
  for (int i = 0; i < 300; ++i) {
    is_full = microtin_ardupilot_fill_block(&terrain, 3);
    microtin_spots_load(&terrain.spots, 500, Card::read, &here.card);
  }
  CHECK(!is_full);
  microtin_ardupilot_statistics(&terrain, &pending, &loaded);
  CHECK(pending + loaded == 56);
  CHECK(pending > 0);
}

TEST_CASE("adapters: a block has every post of the exported .DAT, also at the terrain's edges") {
  Raster raster = rough_raster(41, 41, [](int x, int y) { return x == 20 && y > 30; });
  for (const DegreeCell cell : {DegreeCell{43, 7}, {-67, -71}, {0, -1}, {61, 179}, {83, 12}}) {
    raster.x = {int64_t{cell.longitude} * 40, 1, 40};
    raster.y = {int64_t{cell.latitude} * 40, 1, 40};
    if (cell.longitude == 179) raster.x.offset -= 360 * 40;  // the pack's name of the cell
    const Bytes bytes = pack_bytes(raster);
    const PackFile pack(bytes);
    Card card{bytes};
    const AdapterSlots device(50, 300);
    microtin_ardupilot terrain;
    microtin_ardupilot_init(&terrain, device.pack, 100);
    for (const uint32_t spacing : {100u, 987u}) {
      if (spacing == 987 && cell.latitude == 83) continue;  // its last blocks are two degrees east
      SampledSurface surface = exporting::sampled(pack);
      surface.is_degrees = true;
      const AutopilotFile file =
          exporting::autopilot_file(surface, Autopilot::kArduPilot, cell, spacing);
      const exporting::AutopilotLayout layout(Autopilot::kArduPilot, cell, spacing);
      std::vector<uint8_t> block_bytes;
      uint32_t wrong = 0, there = 0;
      const uint32_t blocks = layout.block_rows() * layout.block_columns();
      for (uint32_t number = 0; number < blocks; number += spacing == 100 ? 23 : 1) {
        block_bytes.assign(file.bytes.begin() + 2048 * std::ptrdiff_t{number},
                           file.bytes.begin() + 2048 * (std::ptrdiff_t{number} + 1));
        const exporting::GeoPlace corner =
            layout.corner(number / layout.block_columns(), number % layout.block_columns());
        microtin_ardupilot_begin_block(&terrain, static_cast<int32_t>(corner.latitude),
                                       static_cast<int32_t>(corner.longitude),
                                       static_cast<uint16_t>(spacing));
        CHECK(terrain.block.corner.latitude == corner.latitude);
        CHECK(terrain.block.corner.longitude == corner.longitude);
        for (int i = 0; i < 300; ++i) {
          const bool is_full = microtin_ardupilot_fill_block(&terrain, 56);
          if (is_full || (i > 1 && !microtin_spots_is_pending(&terrain.spots))) break;
          microtin_spots_load(&terrain.spots, 1000, Card::read, &card);
        }
        const exporting::AutopilotBlock block(layout, number / layout.block_columns(),
                                              number % layout.block_columns(), block_bytes.data());
        if (block.groups() != terrain.block.bitmap) ++wrong;
        for (uint32_t post = 0; post < 28 * 32; ++post) {
          if (!exporting::AutopilotBlock::has_post(block.groups(), post / 32, post % 32)) continue;
          ++there;
          if (block.height(post / 32, post % 32) != terrain.block.height[post / 32][post % 32]) {
            ++wrong;
          }
        }
      }
      CAPTURE(cell.latitude);
      CAPTURE(spacing);
      CHECK(wrong == 0);
      CHECK(there > 6000);
    }
  }
}

TEST_CASE("adapters: a block is that in which the place lies") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  const auto corner = [&](int32_t latitude, int32_t longitude) {
    microtin_ardupilot_begin_block(&terrain, latitude, longitude, 100);
    return terrain.block.corner;
  };
  const microtin_spot first = corner(430000000, 70000000);
  CHECK(first.latitude == 430000000);
  CHECK(first.longitude == 70000000);
  const microtin_spot within = corner(433300000, 72300000);
  CHECK(within.latitude <= 433300000);
  CHECK(within.latitude > 433300000 - 2400 * 90);
  CHECK(within.longitude <= 72300000);
  CHECK(within.longitude > 72300000 - 2800 * 124);
  // Rounded by firmware in single precision.
  const microtin_spot again = corner(within.latitude - 4, within.longitude + 3);
  CHECK(again.latitude == within.latitude);
  CHECK(again.longitude == within.longitude);
  CHECK(corner(-1, -1).latitude < 0);
  CHECK(corner(-900000000, -1800000000).longitude == -1800000000);
  // Off the globe: the nearest place on it.
  CHECK(corner(INT32_MIN, INT32_MIN).latitude == -900000000);
  CHECK(corner(INT32_MAX, INT32_MAX).latitude == 900000000);
}

TEST_CASE(
    "adapters: a block's posts are 1 km apart at most, whatever the firmware's parameter is") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 65535);
  for (const uint16_t spacing : {uint16_t{0}, uint16_t{1001}, uint16_t{65535}}) {
    microtin_ardupilot_begin_block(&terrain, 899999990, 1799999990, spacing);
    CHECK(terrain.block.posts.spacing == 1000);
    CHECK(terrain.block.corner.longitude >= 1790000000);
    CHECK(!microtin_ardupilot_fill_block(&terrain, 56));
  }
  microtin_ardupilot_begin_block(&terrain, 433300000, 72300000, 1000);
  CHECK(terrain.block.posts.spacing == 1000);
}

TEST_CASE("adapters: the scale of longitudes is that of single precision") {
  uint32_t wrong = 0;
  for (int64_t latitude = -1790000000; latitude <= 1790000000; latitude += 31247) {
    const double scale = exporting::longitude_scale(static_cast<double>(latitude) / 2);
    if (scale > 0.01 && microtin_posts_scale(latitude) != scale * (1 << 30)) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(microtin_posts_scale(1800000000) == 10737418);
}

TEST_CASE("adapters: looks ahead count what is missing, over the date line and for any bearing") {
  Metadata metadata;
  metadata.placement.x = {-1800, 1, 10};
  metadata.placement.y = {-900, 1, 10};
  Card card{forged_pack(
      {3600, 1800, 3600, 1800},
      {forged_tile({{{0, 0, 0}, {3600, 0, 100}, {0, 1800, 50}, {3600, 1800, 150}}, {}})},
      metadata)};
  const AdapterSlots device(1);
  microtin_inav inav;
  microtin_inav_init(&inav, device.pack);
  float height = 0;
  for (int i = 0; i < 100 && !microtin_inav_height(&inav, 0, 0, &height); ++i) {
    microtin_inav_load(&inav, 100, Card::read, &card);
  }
  microtin_inav_look look{};
  const auto missed = [&](int32_t latitude, int32_t longitude, float bearing) {
    REQUIRE(microtin_inav_lookahead(&inav, latitude, longitude, bearing, 300, 0, 0, &look));
    CHECK(look.samples_total == 10);
    return look.samples_missed;
  };
  CHECK(missed(0, 1799990000, 90) == 0);    // to the east, into the west
  CHECK(missed(0, -1799990000, 270) == 0);  // to the west, into the east
  CHECK(look.climb_needed_m > 90);
  CHECK(missed(0, -1799990000, -90) == 0);
  CHECK(look.climb_needed_m > 90);
  CHECK(missed(899989000, 0, 0) == 6);
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, device.pack, 30);
  microtin_ardupilot_load(&terrain, 100, Card::read, &card);
  microtin_ardupilot_lookahead(&terrain, 899989000, 0, 0, 300, 0);
  CHECK(terrain.missed == 6);
  microtin_ardupilot_lookahead(&terrain, 0, 0, 0, 300, 0);
  CHECK(terrain.missed == 0);
}

TEST_CASE("adapters: a look ahead near a pole goes far beyond the date line") {
  const auto missed = [](int64_t west, int32_t longitude, float bearing) {
    Metadata metadata;
    metadata.placement.x = {west, 1, 10};
    metadata.placement.y = {-900, 1, 10};
    Card card{forged_pack(
        {1900, 1800, 1900, 1800},
        {forged_tile({{{0, 0, 0}, {1900, 0, 0}, {0, 1800, 0}, {1900, 1800, 0}}, {}})}, metadata)};
    const AdapterSlots device(1);
    microtin_ardupilot terrain;
    microtin_ardupilot_init(&terrain, device.pack, 100);
    float height = 0;
    for (int i = 0;
         i < 100 && !microtin_ardupilot_height_amsl(&terrain, 895000000, longitude, &height, false);
         ++i) {
      microtin_ardupilot_load(&terrain, 100, Card::read, &card);
    }
    microtin_ardupilot_lookahead(&terrain, 895000000, longitude, bearing, 100000, 0);  // 90 degrees
    return terrain.missed;
  };
  CHECK(missed(1700, 1790000000, 90) == 0);     // a pack from 170 to 360 degrees
  CHECK(missed(-3600, -1790000000, 270) == 0);  // from -360 to -170
}

TEST_CASE("adapters: a request reaches as far as a look ahead, and ends with its pack") {
  Loaded here;
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  here.load(inav, [] {});
  microtin_inav_look look{};
  CHECK(!microtin_inav_lookahead(&inav, 433300000, 72300000, 45, 1500, 0, 0, &look));
  const microtin_request& ahead = inav.spots.requests.request[MICROTIN_PRIORITY_AHEAD];
  REQUIRE(ahead.is_set);
  CHECK(ahead.segment.x_end > ahead.segment.x);
  CHECK(ahead.segment.y_end > ahead.segment.y);
  microtin_pack_reset(here.device.pack);
  microtin_inav_init(&inav, here.device.pack);
  CHECK(!ahead.is_set);

  microtin_ardupilot terrain;
  const auto begin = [&] {
    microtin_pack_reset(here.device.pack);
    microtin_ardupilot_init(&terrain, here.device.pack, 100);
    float height = 0;
    here.load(terrain, [&] {
      microtin_ardupilot_height_amsl(&terrain, 433300000, 72300000, &height, false);
    });
    return height;
  };
  const float plain = begin();
  float corrected = 0;
  microtin_ardupilot_set_reference(&terrain, 433300000, 72300000,
                                   static_cast<int32_t>(plain * 100) + 1000, 30);
  REQUIRE(microtin_ardupilot_height_amsl(&terrain, 433300000, 72300000, &corrected, true));
  CHECK(corrected > plain + 5);
  begin();
  REQUIRE(microtin_ardupilot_height_amsl(&terrain, 433300000, 72300000, &corrected, true));
  CHECK(corrected == plain);
}

TEST_CASE("adapters: bearings wrap, and one that is not a number is refused") {
  Loaded here;
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  const auto needed = [&](float bearing) {
    microtin_inav_look look{};
    here.load(inav, [&] {
      microtin_inav_lookahead(&inav, 433300000, 72300000, bearing, 600, 0, 0, &look);
    });
    REQUIRE(look.samples_total == 20);
    return look.climb_needed_m;
  };
  CHECK(needed(37) != needed(0));
  for (const float turned : {397.0F, -323.0F, 3637.0F}) CHECK(needed(turned) == needed(37));

  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 30);
  microtin_ardupilot_load(&terrain, 100, Card::read, &here.card);
  const auto rise = [&](float bearing) {
    float height = 0;
    here.load(terrain, [&] {
      height = microtin_ardupilot_lookahead(&terrain, 433300000, 72300000, bearing, 600, 0);
    });
    return height;
  };
  CHECK(rise(37) > 0);
  for (const float turned : {397.0F, -323.0F, 3637.0F}) CHECK(rise(turned) == rise(37));
  CHECK(rise(std::nanf("")) == 0);
}

TEST_CASE("adapters: no block is pending before one is begun") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  uint16_t pending = 9, loaded = 9;
  microtin_ardupilot_statistics(&terrain, &pending, &loaded);
  CHECK(pending == 0);
  CHECK(loaded == 0);
  microtin_ardupilot_begin_block(&terrain, 433300000, 72300000, 100);
  microtin_ardupilot_statistics(&terrain, &pending, &loaded);
  CHECK(pending == 56);
  CHECK(loaded == 0);
}

TEST_CASE("adapters: the reference offset is cached, and limited again when its bound changes") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  const int32_t latitude = 433300000, longitude = 72300000;
  const double ground = *truth(here.pack, latitude, longitude);
  float offset = -7, plain = 0, corrected = 0;
  microtin_ardupilot_set_reference(&terrain, latitude, longitude,
                                   static_cast<int32_t>(std::lround((ground + 25) * 100)), 30);
  CHECK(!microtin_ardupilot_reference_offset(&terrain, &offset));
  CHECK(offset == -7);
  // Updates alone find it, far away too.
  here.load(terrain, [&] { microtin_ardupilot_set_position(&terrain, 433900000, 72900000); });
  microtin_pack_reset(here.device.pack);
  CHECK(microtin_ardupilot_reference_offset(&terrain, &offset));
  CHECK(std::abs(static_cast<double>(offset) - 25) < 0.1);
  microtin_ardupilot_set_offset_max(&terrain, 10);
  CHECK(microtin_ardupilot_reference_offset(&terrain, &offset));
  CHECK(offset == 10);
  microtin_ardupilot_set_offset_max(&terrain, 40);  // what was cut off stays so
  CHECK(microtin_ardupilot_reference_offset(&terrain, &offset));
  CHECK(offset == 10);
  here.load(terrain,
            [&] { microtin_ardupilot_height_amsl(&terrain, 433900000, 72900000, &plain, false); });
  REQUIRE(microtin_ardupilot_height_amsl(&terrain, 433900000, 72900000, &corrected, true));
  CHECK(corrected == plain + 10);
  microtin_ardupilot_set_offset_max(&terrain, 0);
  CHECK(!microtin_ardupilot_reference_offset(&terrain, &offset));
  REQUIRE(microtin_ardupilot_height_amsl(&terrain, 433900000, 72900000, &corrected, true));
  CHECK(corrected == plain);
  microtin_ardupilot_set_offset_max(&terrain, 40);
  here.load(terrain, [&] { microtin_ardupilot_reference_offset(&terrain, &offset); });
  CHECK(std::abs(static_cast<double>(offset) - 25) < 0.1);
}

TEST_CASE(
    "adapters: INAV's terrain is healthy while both heights are known and the card is there") {
  Loaded here;
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  CHECK(!microtin_inav_is_healthy(&inav, 0));
  microtin_inav_set_home(&inav, 433300000, 72300000);
  const auto update = [&](int32_t latitude, uint32_t now) {
    microtin_inav_set_position(&inav, latitude, 72500000);
    return microtin_inav_is_healthy(&inav, now);
  };
  here.load(inav, [&] { update(433500000, 1000); });
  CHECK(update(433500000, 1020));
  // Outside the pack the last height serves for half a second; the clock may wrap.
  CHECK(update(400000000, 1520));
  CHECK(!update(400000000, 1521));
  CHECK(!update(400000000, 1020));
  CHECK(update(433500000, 0xFFFFFF00u));
  CHECK(update(400000000, 0xF0u));
  CHECK(!update(400000000, 0xF5u));
  // A card that fails, and comes back.
  here.card.is_pulled = true;
  const auto serve = [&] {
    for (int i = 0; i < 20; ++i) {
      float height = 0;
      microtin_inav_height(&inav, 433900000, 72900000, &height);
      microtin_inav_load(&inav, 50, Card::read, &here.card);
    }
  };
  serve();
  CHECK(!update(433500000, 2000));
  here.card.is_pulled = false;
  serve();
  CHECK(update(433500000, 2020));
}

TEST_CASE("adapters: a leg of a mission is loaded on request, and checked before take-off") {
  Loaded here;
  microtin_ardupilot terrain;
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  const auto check = [&](microtin_spot from, microtin_spot to) {
    microtin_pack_check found{};
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (int i = 0; i < 10000 && status == MICROTIN_STATUS_NEED_INPUT; ++i) {
      status = microtin_ardupilot_check(&terrain, from.latitude, from.longitude, to.latitude,
                                        to.longitude, &found, Card::read, &here.card);
    }
    return status;
  };
  const microtin_spot from{433100000, 72150000}, to{433900000, 72900000};
  CHECK(!microtin_ardupilot_request(&terrain, 433100000, 72150000, 433900000, 72900000));
  CHECK(check(from, to) == MICROTIN_STATUS_OK);
  CHECK(check(from, {400000000, 72900000}) == MICROTIN_STATUS_OUT_OF_RANGE);
  float height = 0;
  CHECK(!microtin_ardupilot_height_amsl(&terrain, 433500000, 72525000, &height, false));
  microtin_ardupilot_init(&terrain, here.device.pack, 100);
  microtin_ardupilot_load(&terrain, 50, Card::read, &here.card);
  CHECK(microtin_ardupilot_request(&terrain, 433100000, 72150000, 433900000, 72900000));
  here.load(terrain, [] {});
  for (int32_t i = 0; i <= 10; ++i) {
    CHECK(microtin_ardupilot_height_amsl(&terrain, 433100000 + i * 80000, 72150000 + i * 75000,
                                         &height, false));
  }
  here.card.bytes[here.card.bytes.size() - 10] ^= 1u;  // in the last tile
  microtin_pack_reset(here.device.pack);
  microtin_inav inav;
  microtin_inav_init(&inav, here.device.pack);
  microtin_pack_check found{};
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT) {
    status = microtin_inav_check(&inav, 433100000, 72150000, 434020000, 73020000, &found,
                                 Card::read, &here.card);
  }
  CHECK(status == MICROTIN_STATUS_BAD_TILES);
  CHECK(found.bad == 1);
  here.card.is_pulled = true;
  microtin_pack_reset(here.device.pack);
  microtin_inav_init(&inav, here.device.pack);
  while (status != MICROTIN_STATUS_IO) {
    status = microtin_inav_check(&inav, 433100000, 72150000, 434020000, 73020000, &found,
                                 Card::read, &here.card);
    REQUIRE((status == MICROTIN_STATUS_IO || status == MICROTIN_STATUS_NEED_INPUT));
  }
  CHECK(!microtin_inav_request(&inav, 433100000, 72150000, 434020000, 73020000));
}

TEST_CASE("adapters: the sine is within 10 of 65536") {
  for (int32_t angle = -40000; angle <= 80000; ++angle) {
    const double exact = 65536 * std::sin(angle * 0.00017453292519943295);
    CHECK(std::abs(microtin_sine(angle) - exact) < 10);
  }
}

}  // namespace microtin::tests
