// SPDX-License-Identifier: MIT
// The autopilots' adapters, beside what the tiles say in floating point.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

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
  MeshSlots device{50, 300};
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
  const MeshSlots device(5, 300);
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
  MeshSlots device(50, 300);
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

TEST_CASE(
    "adapters: ArduPilot's heights are corrected, within a bound, and blocks are those of the "
    "tiles") {
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

  microtin_ardupilot_begin_block(&terrain, latitude, longitude, 30);
  uint16_t pending = 0, loaded = 0;
  bool is_full = false;
  here.load(terrain, [&] { is_full = microtin_ardupilot_fill_block(&terrain, 56); });
  CHECK(is_full);
  microtin_ardupilot_statistics(&terrain, &pending, &loaded);
  CHECK(pending == 0);
  CHECK(loaded == 56);
  for (int row = 0; row < 28; ++row) {
    for (int column = 0; column < 32; ++column) {
      const double up = row * 30 * 89.83204953368922,
                   scale = std::cos((latitude + up / 2) * 1e-7 * 0.017453292519943295);
      const auto height =
          truth(here.pack, latitude + up, longitude + column * 30 * 89.83204953368922 / scale);
      REQUIRE(height);
      CHECK(std::abs(*height - terrain.block.height[row][column]) < 1.5);
    }
  }
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

TEST_CASE("adapters: looks ahead count what is missing, over the date line and for any bearing") {
  Metadata metadata;
  metadata.placement.x = {-1800, 1, 10};
  metadata.placement.y = {-900, 1, 10};
  Card card{forged_pack(
      {3600, 1800, 3600, 1800},
      {forged_tile({{{0, 0, 0}, {3600, 0, 100}, {0, 1800, 50}, {3600, 1800, 150}}, {}})},
      metadata)};
  const MeshSlots device(1);
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
    const MeshSlots device(1);
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

TEST_CASE("adapters: the sine is within 10 of 65536") {
  for (int32_t angle = -40000; angle <= 80000; ++angle) {
    const double exact = 65536 * std::sin(angle * 0.00017453292519943295);
    CHECK(std::abs(microtin_sine(angle) - exact) < 10);
  }
}

}  // namespace microtin::tests
