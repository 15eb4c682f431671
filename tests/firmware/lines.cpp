// SPDX-License-Identifier: MIT
// Decodes a stream in flash and the marks of edges behind it, both in small pieces, and prints each
// triangle with a marked edge.
#include "microtin/edge_marks.h"
#include "microtin/microtin.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.h"

namespace {

constexpr uint32_t kCapacity = 250;

// Feeds the stream's bytes from `at` on to feed(bytes, size, &used); returns the last status.
template <class Feed>
microtin_status feed_pieces(size_t& at, const Feed& feed) {
  uint8_t piece[23];
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while ((status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) &&
         at < stream_size()) {
    size_t size = 0;
    for (; size < sizeof piece && at + size < stream_size(); ++size) {
      piece[size] = stream_byte(at + size);
    }
    size_t used = 0;
    status = feed(piece, size, &used);
    at += used;
  }
  return status;
}

void print_triangle(const microtin_edge_marks* marks, uint32_t t) {
  uint32_t classes[3];
  for (uint32_t i = 0; i < 3; ++i) classes[i] = microtin_edge_marks_class(marks, t, i);
  if ((classes[0] | classes[1] | classes[2]) == 0) return;
  microtin::print(put_char, t);
  for (const uint32_t one : classes) {
    put_char(' ');
    microtin::print(put_char, one);
  }
  put_char('\n');
}

}  // namespace

int firmware_main() {
  static microtin::Terrain<kCapacity> terrain;
  static microtin::Decoder<kCapacity> decoder(terrain);
  alignas(MICROTIN_ALIGNMENT) static uint8_t memory[MICROTIN_EDGE_MARKS_BYTES(kCapacity)];
  size_t at = 0;
  const microtin_status decoded =
      feed_pieces(at, [](const uint8_t* bytes, size_t size, size_t* used) {
        return decoder.feed(bytes, size, used);
      });
  microtin_edge_marks* marks = nullptr;
  if (decoded != MICROTIN_STATUS_OK ||
      microtin_edge_marks_init(memory, sizeof memory, terrain.mesh(), &marks) !=
          MICROTIN_STATUS_OK) {
    return 1;
  }
  feed_pieces(at, [marks](const uint8_t* bytes, size_t size, size_t* used) {
    return microtin_edge_marks_feed(marks, bytes, size, used, 3);
  });
  const microtin_status status = microtin_edge_marks_finish(marks);
  microtin::print(put_char, "status ");
  microtin::print(put_char, static_cast<uint32_t>(status));
  microtin::print(put_char, "\nedges ");
  microtin::print(put_char, microtin_edge_marks_count(marks));
  put_char('\n');
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(terrain.mesh()); ++t) {
    print_triangle(marks, t);
  }
  return status == MICROTIN_STATUS_OK ? 0 : 1;
}
