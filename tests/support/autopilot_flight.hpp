// SPDX-License-Identifier: MIT
// The questions that ArduPilot's terrain library puts in flight, and how many of them are answered.
#ifndef MICROTIN_TESTS_SUPPORT_AUTOPILOT_FLIGHT_HPP
#define MICROTIN_TESTS_SUPPORT_AUTOPILOT_FLIGHT_HPP

#include <cstdint>

#include "decoder/adapters/spots.h"

namespace microtin::tests {

// Questions of one kind, and those with an answer.
struct Share {
  uint32_t questions = 0, answers = 0;

  void add(bool is_known) {
    ++questions;
    answers += is_known ? 1 : 0;
  }
  double percent() const { return questions == 0 ? 100 : 100.0 * answers / questions; }
};

struct FlightShares {
  Share own, home, surrounding, ahead;

  double percent_of_all() const {
    const Share all = {own.questions + home.questions + surrounding.questions + ahead.questions,
                       own.answers + home.answers + surrounding.answers + ahead.answers};
    return all.percent();
  }
};

// A straight flight at 25 m/s with ten updates a second, and five services after each. An update
// queries the own place, home, nine places around the own one, and the terrain ahead.
//
// Vehicle has: here(at), the position; height(at) and ahead(at, bearing), whether they are known;
// serve().
class AutopilotFlight {
 public:
  AutopilotFlight(microtin_spot from, microtin_spot to, uint32_t updates, float bearing)
      : from_(from), to_(to), updates_(updates), bearing_(bearing) {}

  // Home's share begins with its first answer.
  template <class Vehicle>
  FlightShares fly(Vehicle& vehicle) const {
    FlightShares shares;
    for (uint32_t i = 0; i < updates_; ++i) {
      update(vehicle, place(i), shares);
      for (int service = 0; service < 5; ++service) vehicle.serve();
    }
    return shares;
  }

 private:
  microtin_spot place(uint32_t i) const {
    const auto between = [&](int32_t a, int32_t b) {
      return static_cast<int32_t>(a + (int64_t{b} - a) * i / updates_);
    };
    return {between(from_.latitude, to_.latitude), between(from_.longitude, to_.longitude)};
  }

  template <class Vehicle>
  void update(Vehicle& vehicle, microtin_spot at, FlightShares& shares) const {
    vehicle.here(at);
    shares.own.add(vehicle.height(at));
    const bool is_home_known = vehicle.height(from_);
    if (is_home_known || shares.home.questions != 0) shares.home.add(is_home_known);
    // Seven tenths of a block of 28 x 32 posts every 100 m.
    for (int32_t i = 0; i < 9; ++i) {
      const int32_t north = (i / 3 - 1) * 1960000, east = (i % 3 - 1) * 2240000;
      shares.surrounding.add(vehicle.height(microtin_spot_beside(at, north, east)));
    }
    shares.ahead.add(vehicle.ahead(at, bearing_));
  }

  microtin_spot from_, to_;
  uint32_t updates_;
  float bearing_;
};

// 49 km over the cell of which this is the south-west corner, at 43 degrees north: from an eighth
// of its width and 5/8 of its height to the east-north-east.
inline AutopilotFlight flight_over_cell(microtin_spot corner) {
  const microtin_spot from = {corner.latitude + 6250000, corner.longitude + 1250000};
  return {from, {from.latitude + 2500000, from.longitude + 5000000}, 19600, 55.5F};
}

}  // namespace microtin::tests

#endif
