// SPDX-License-Identifier: MIT
// Flies over a pack in flash, its tiles kept as meshes or, with MICROTIN_FLIGHT_COMPACT, in compact
// form: instructions of service and queries, bytes read, RAM, heights. Then flies with requests,
// and measures the longest service for several step limits.
#include "microtin/compact_pack.hpp"
#include "microtin/requests.h"
#include "tests/bench/device/flight.hpp"
#include "tests/bench/device/flight_log.hpp"
#include "tests/bench/device/instruction_counter.hpp"
#include "tests/firmware/linked_stream.hpp"

namespace {

using namespace microtin;

constexpr uint32_t kSlots = 4, kCapacity = 500, kStepLimit = 50;

#ifdef MICROTIN_FLIGHT_COMPACT
// Tiles are less than 256 posts wide.
typedef CompactPack<kSlots, kCapacity, MICROTIN_COMPACT_NARROW_BYTES(kCapacity)> Tiles;
#else
typedef Pack<kSlots, kCapacity> Tiles;
#endif

// Flash as a card: it counts what is read.
int32_t read_card(void* bytes_read, uint64_t offset, uint8_t* buffer, size_t size) {
  for (size_t i = 0; i < size; ++i) buffer[i] = stream_begin[static_cast<size_t>(offset) + i];
  *static_cast<uint32_t*>(bytes_read) += static_cast<uint32_t>(size);
  return static_cast<int32_t>(size);
}

microtin_segment segment(Post from, Post to) {
  return {from.x * 256, from.y * 256, to.x * 256, to.y * 256};
}

int32_t decimetres(int32_t height, const microtin_axis& z) {
  const int64_t denominator = static_cast<int64_t>(z.denominator) * 65536;
  return static_cast<int32_t>(10 * (z.offset * 65536 + static_cast<int64_t>(z.numerator) * height) /
                              denominator);
}

struct Measured {
  Costs service, height, highest;
  uint32_t bytes_read = 0;
};

// Calls the service until the segment has its tiles.
bool serve(Tiles& pack, const microtin_segment& c, const InstructionCounter& instructions,
           Measured& measured) {
  for (uint32_t call = 0; call < 10000; ++call) {
    const uint32_t before = instructions.count();
    const microtin_status status = pack.load_with(c, read_card, &measured.bytes_read, kStepLimit);
    measured.service.add(instructions.count() - before);
    if (status == MICROTIN_STATUS_OK) return true;
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT) return false;
  }
  return false;
}

bool fly(Tiles& pack, const Flight& flight, Measured& measured) {
  const InstructionCounter instructions;
  microtin_pack_info info;
  pack.get_info(&info);
  uint32_t hint = 0;
  for (int32_t i = 0; i < flight.posts(); ++i) {
    const microtin_segment c = segment(flight.post(i), flight.ahead(i));
    if (!serve(pack, c, instructions, measured)) return false;
    int32_t height = 0;
    uint32_t before = instructions.count();
    if (pack.height_at(c.x, c.y, &hint, &height) != MICROTIN_QUERY_OK) return false;
    measured.height.add(instructions.count() - before);
    log_height(decimetres(height, info.z));
    if (i % Flight::kAhead != 0) continue;
    before = instructions.count();
    microtin_segment_extremes extremes;
    if (pack.segment_extremes(c, &extremes) != MICROTIN_QUERY_OK) return false;
    measured.highest.add(instructions.count() - before);
  }
  return true;
}

// A block such as ArduPilot keeps, from the tiles that are there.
uint32_t cost_of_block(const Tiles& pack, Post at) {
  static int16_t heights[28 * 32];
  const microtin_grid_spec block = {at.x * 256, at.y * 256, 256, 256, 28, 32, INT16_MIN};
  const InstructionCounter instructions;
  const uint32_t before = instructions.count();
  pack.sample_grid(block, heights);
  return instructions.count() - before;
}

// The most instructions of one service of requests: the place below and the way ahead, from the
// header to the last post.
uint32_t longest_service(microtin_pack* pack, const Flight& flight, uint32_t step_limit) {
  const InstructionCounter instructions;
  microtin_requests requests;
  microtin_requests_init(&requests, pack);
  Costs costs;
  uint32_t bytes_read = 0;
  for (int32_t i = 0; i < flight.posts(); i += Flight::kAhead) {
    const microtin_segment here = segment(flight.post(i), flight.post(i)),
                           ahead = segment(flight.post(i), flight.ahead(i));
    microtin_requests_add(&requests, &here, MICROTIN_PRIORITY_HERE);
    microtin_requests_add(&requests, &ahead, MICROTIN_PRIORITY_AHEAD);
    do {
      const uint32_t before = instructions.count();
#ifdef MICROTIN_FLIGHT_COMPACT
      microtin_requests_load_compact(&requests, read_card, &bytes_read, step_limit);
#else
      microtin_requests_load(&requests, read_card, &bytes_read, step_limit);
#endif
      costs.add(instructions.count() - before);
    } while (microtin_requests_pending(&requests) != 0);
  }
  return costs.most;
}

uint32_t longest_service(const Flight& flight, uint32_t step_limit) {
  static uint64_t space[sizeof(Tiles) / sizeof(uint64_t)];
  microtin_pack* pack = nullptr;
#ifdef MICROTIN_FLIGHT_COMPACT
  microtin_compact_pack_init(space, sizeof space, kSlots, kCapacity,
                             MICROTIN_COMPACT_NARROW_BYTES(kCapacity), &pack);
#else
  microtin_pack_init(space, sizeof space, kSlots, kCapacity, &pack);
#endif
  return pack == nullptr ? 0 : longest_service(pack, flight, step_limit);
}

}  // namespace

int firmware_main() {
  static Tiles pack;
  Measured measured;
  const microtin_segment corner = {0, 0, 0, 0};
  microtin_pack_info info;
  pack.load_with(corner, read_card, &measured.bytes_read, 0);
  if (pack.get_info(&info) != MICROTIN_STATUS_OK) return 1;
  measured.bytes_read = 0;
  const Flight flight(info.x_max, info.y_max);
  if (!fly(pack, flight, measured)) return 1;
  log("RAM", sizeof pack);
  log("bytes read", measured.bytes_read);
  log("service all", static_cast<uint32_t>(measured.service.all));
  log("service most", measured.service.most);
  log("height mean", measured.height.mean());
  log("height most", measured.height.most);
  log("highest mean", measured.highest.mean());
  log("highest most", measured.highest.most);
  log("block", cost_of_block(pack, flight.post(flight.posts() - 28)));
  log("service 1", longest_service(flight, 1));
  log("service 5", longest_service(flight, 5));
  log("service 20", longest_service(flight, 20));
  log("service 200", longest_service(flight, 200));
  return 0;
}
