// SPDX-License-Identifier: MIT
// How many questions of an autopilot the adapters answer in flight, and what they read for that.
#include "tests/support/autopilot_flight.hpp"

#include <doctest/doctest.h>

#include <optional>
#include <vector>

#include "decoder/adapters/ardupilot.h"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

constexpr microtin_spot kCorner = {430000000, 70000000};

// Updates until a tile of 500 vertices is there, with five services of 20 work units in each: two
// seconds. Making it compact takes half a second more.
#ifdef MICROTIN_ADAPTERS_COMPACT
constexpr int kUpdatesOfTile = 25;
#else
constexpr int kUpdatesOfTile = 20;
#endif

// More than a cell of one degree, in equal tiles of `side` arc steps of 1/1200 degree.
Bytes cell_pack(uint16_t side, uint32_t vertices) {
  Random random(40);
  Tin tin;
  for (const uint32_t x : {uint32_t{0}, uint32_t{side}}) {
    for (const uint32_t y : {uint32_t{0}, uint32_t{side}}) {
      tin.vertices.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(y), 0});
    }
  }
  for (uint32_t i = 1; tin.vertices.size() < vertices; ++i) {
    // Places that differ, spread over the tile.
    const uint32_t x = 1 + i * 37 % (side - 1u),
                   y = 1 + (i * 37 / (side - 1u) + i * 11) % (side - 1u);
    tin.vertices.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(y),
                            static_cast<int16_t>(random.below(2000))});
  }
  const uint32_t tiles = (1200u + side - 1) / side;
  Metadata metadata;
  metadata.placement.x = {7 * 1200, 1, 1200};
  metadata.placement.y = {43 * 1200, 1, 1200};
  return forged_pack({tiles * side, tiles * side, side, side},
                     std::vector<ForgedTile>(size_t{tiles} * tiles, forged_tile(tin)), metadata);
}

class Vehicle {
 public:
  Vehicle(const Bytes& pack, uint32_t slots, uint32_t capacity, uint32_t steps)
      : card_{pack}, device_(slots, capacity), steps_(steps) {
    microtin_ardupilot_init(&terrain, device_.pack, 100);
  }

  void here(microtin_spot at) {
    microtin_ardupilot_set_position(&terrain, at.latitude, at.longitude);
  }
  bool height(microtin_spot at) {
    float metres = 0;
    return microtin_ardupilot_height_amsl(&terrain, at.latitude, at.longitude, &metres, false);
  }
  bool ahead(microtin_spot at, float bearing) {
    microtin_ardupilot_lookahead(&terrain, at.latitude, at.longitude, bearing, 2000, 0.1F);
    return terrain.missed == 0;
  }
  void serve() { microtin_ardupilot_load(&terrain, steps_, Card::read, &card_); }
  uint32_t reads() const { return card_.reads; }

  microtin_ardupilot terrain;

 private:
  Card card_;
  AdapterSlots device_;
  uint32_t steps_;
};

}  // namespace

TEST_CASE("autopilot flight: four slots know the own place and home, with few reads") {
  Vehicle vehicle(cell_pack(64, 500), 4, 500, 20);
  const AutopilotFlight flight = flight_over_cell(kCorner);
  microtin_ardupilot_set_home(&vehicle.terrain, 436250000, 71250000);
  const FlightShares shares = flight.fly(vehicle);
  CHECK(shares.own.percent() >= 99);
  CHECK(shares.home.percent() == 100);
  CHECK(shares.home.questions > 19500);
  CHECK(vehicle.reads() <= 1000);
  CHECK(shares.surrounding.percent() > 90);
}

TEST_CASE("autopilot flight: nine slots, or sixteen small ones, answer all questions" * kSlow) {
  const AutopilotFlight flight = flight_over_cell(kCorner);
  for (const uint32_t steps : {20u, 200u}) {
    for (const bool is_small : {false, true}) {
      Vehicle vehicle(is_small ? cell_pack(28, 150) : cell_pack(64, 500), is_small ? 16 : 9,
                      is_small ? 150 : 500, steps);
      microtin_ardupilot_set_home(&vehicle.terrain, 436250000, 71250000);
      const FlightShares shares = flight.fly(vehicle);
      CHECK(shares.percent_of_all() >= 99.5);
      CHECK(vehicle.reads() <= 2000);
    }
  }
}

TEST_CASE("autopilot flight: a standing vehicle that asks far places knows its own") {
  Vehicle vehicle(cell_pack(64, 500), 4, 500, 20);
  const microtin_spot at = {434000000, 74000000};
  uint32_t unknown = 0, far = 0;
  for (int update = 0; update < 3000; ++update) {  // five minutes
    vehicle.here(at);
    if (!vehicle.height(at) && update >= kUpdatesOfTile) ++unknown;
    for (int32_t i = 0; i < 5; ++i) {
      if (vehicle.height({431000000 + i * 1500000, 78000000 - i * 900000})) ++far;
    }
    for (int service = 0; service < 5; ++service) vehicle.serve();
  }
  CHECK(unknown == 0);
  CHECK(far > 3000 * 2);  // three of five fit
}

}  // namespace microtin::tests
