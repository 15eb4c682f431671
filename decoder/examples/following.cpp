// SPDX-License-Identifier: MIT
// Following the terrain: in each cycle a vehicle looks at the heights ahead of it and aims above
// the highest, with bounded work per cycle.
#include "microtin/microtin.hpp"
#include "print.h"
#include "terrain.h"  // microtin embed hills.mtin -o terrain.h

namespace {

constexpr int32_t kStep = 65536;         // of height
constexpr int32_t kClearance = 20;       // steps
constexpr int32_t kClimb = 8 * kStep;    // most change of height in a cycle
constexpr int32_t kSpeed = 3 * 256;      // lattice units in a cycle
constexpr int32_t kAhead = 16;           // cycles looked ahead
constexpr uint32_t kStepsPerCycle = 24;  // of all queries together

using Terrain = microtin::Terrain<TERRAIN_VERTICES>;
using Buckets = microtin::Buckets<32>;

struct Place {
  int32_t x, y;
};

// Heights ahead, asked for one after the other; a result may take several cycles.
class LookAhead {
 public:
  // The highest terrain seen in the last round, in 16 fractional bits.
  int32_t highest() const { return highest_; }

  // No earlier hint is near the first place: `hint` comes from buckets.
  LookAhead(const Terrain& terrain, uint32_t hint) : terrain_(terrain), hint_(hint) {}

  void look(Place vehicle) {
    for (uint32_t left = kStepsPerCycle; left >= kPiece; left -= kPiece) {
      const int32_t x = vehicle.x + next_ * kSpeed;
      int32_t height = 0;
      const microtin_query_result result =
          terrain_.height_at(x, vehicle.y, &hint_, &height, 0, kPiece);
      if (result == MICROTIN_QUERY_STEP_LIMIT) continue;  // goes on from the hint
      if (result == MICROTIN_QUERY_OK && (next_ == 0 || height > round_)) round_ = height;
      if (next_++ == kAhead) {
        highest_ = round_;
        next_ = 0;
      }
    }
  }

 private:
  static constexpr uint32_t kPiece = 3;  // steps of a query

  const Terrain& terrain_;
  uint32_t hint_;
  int32_t next_ = 0, round_ = 0, highest_ = 0;
};

bool decode(Terrain& terrain) {
  static microtin::Decoder<TERRAIN_VERTICES> decoder(terrain);
  size_t used = 0;
  return decoder.feed(terrain_stream, sizeof terrain_stream, &used) == MICROTIN_STATUS_OK;
}

void report(Place vehicle, int32_t height, int32_t altitude) {
  print("x ");
  print_number(vehicle.x / 256);
  print(" terrain ");
  print_number(height / kStep);
  print(" vehicle ");
  print_number(altitude / kStep);
  print("\n");
}

// Flies east; whether it was always above the terrain.
bool fly(const Terrain& terrain, const Buckets& buckets, Place vehicle) {
  uint32_t hint = buckets.hint(vehicle.x, vehicle.y);
  LookAhead ahead(terrain, hint);
  int32_t altitude = 300 * kStep;
  bool above = true;
  for (int32_t cycle = 0; cycle < 240; ++cycle, vehicle.x += kSpeed) {
    ahead.look(vehicle);
    const int32_t wanted = ahead.highest() + kClearance * kStep - altitude;
    altitude += wanted > kClimb ? kClimb : wanted < -kClimb ? -kClimb : wanted;
    int32_t height = 0;
    above = above && terrain.height_at(vehicle.x, vehicle.y, &hint, &height) == MICROTIN_QUERY_OK &&
            altitude > height;
    if (cycle % 24 == 0) report(vehicle, height, altitude);
  }
  return above;
}

}  // namespace

int firmware_main() {
  static Terrain terrain;
  if (!decode(terrain)) return 1;
  static Buckets buckets;
  if (buckets.build(terrain.mesh()) != MICROTIN_STATUS_OK) return 1;
  const bool above = fly(terrain, buckets, Place{100 * 256, 500 * 256});
  print(above ? "always above the terrain\n" : "hit the terrain\n");
  return above ? 0 : 1;
}
