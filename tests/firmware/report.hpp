// SPDX-License-Identifier: MIT
// Describes a decoded terrain in a few lines of text, the same on host and device.
#ifndef MICROTIN_TESTS_FIRMWARE_REPORT_HPP
#define MICROTIN_TESTS_FIRMWARE_REPORT_HPP

#include "microtin/compact.h"
#include "microtin/microtin.h"

namespace microtin {

typedef void (*PutChar)(char c);

inline void print(PutChar put, const char* text) {
  while (*text != '\0') put(*text++);
}

inline void print(PutChar put, uint32_t number) {
  char digits[10];
  int count = 0;
  do {
    digits[count++] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  while (count != 0) put(digits[--count]);
}

inline void print(PutChar put, int32_t number) {
  if (number < 0) put('-');
  const uint32_t bits = static_cast<uint32_t>(number);
  print(put, number < 0 ? 0u - bits : bits);
}

inline void print_hex(PutChar put, uint64_t number) {
  for (int shift = 60; shift >= 0; shift -= 4) put("0123456789abcdef"[(number >> shift) & 15]);
}

// Numbers that look random and are the same everywhere (Numerical Recipes' generator).
class ProbeNumbers {
 public:
  // In low .. high.
  int32_t between(int32_t low, int32_t high) {
    state_ = state_ * 1664525u + 1013904223u;
    const uint64_t count = static_cast<uint64_t>(static_cast<uint32_t>(high - low)) + 1;
    return low + static_cast<int32_t>((state_ * count) >> 32);
  }

 private:
  uint32_t state_ = 1;
};

// The smallest box around the vertices, with 8 fractional bits.
struct ProbeBox {
  int32_t west, south, east, north;
};

inline ProbeBox probe_box(const microtin_mesh* mesh) {
  uint16_t west = 65535, south = 65535, east = 0, north = 0;
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    uint16_t x, y;
    int16_t z;
    microtin_mesh_vertex(mesh, v, &x, &y, &z);
    if (x < west) west = x;
    if (y < south) south = y;
    if (x > east) east = x;
    if (y > north) north = y;
  }
  return ProbeBox{static_cast<int32_t>(west) * 256, static_cast<int32_t>(south) * 256,
                  static_cast<int32_t>(east) * 256, static_cast<int32_t>(north) * 256};
}

// Asks for the height at 64 places in the box: "x y height", or the number of the reason for none.
inline void report_probes(PutChar put, const microtin_mesh* mesh) {
  const ProbeBox box = probe_box(mesh);
  ProbeNumbers numbers;
  uint32_t hint = 0;
  for (int i = 0; i < 64; ++i) {
    const int32_t x = numbers.between(box.west, box.east);
    const int32_t y = numbers.between(box.south, box.north);
    int32_t height = 0;
    const microtin_query_result answer = microtin_mesh_height_at(mesh, x, y, &hint, &height, 0, 0);
    print(put, x);
    print(put, " ");
    print(put, y);
    if (answer == MICROTIN_QUERY_OK) {
      print(put, " ");
      print(put, height);
    } else {
      print(put, " none: ");
      print(put, static_cast<uint32_t>(answer));
    }
    print(put, "\n");
  }
}

// The whole report of a mesh, and of how decoding it ended.
inline void report(PutChar put, const microtin_mesh* mesh, microtin_status status) {
  print(put, "status ");
  print(put, static_cast<uint32_t>(status));
  print(put, "\nvertices ");
  print(put, microtin_mesh_vertex_count(mesh));
  print(put, "\ndigest ");
  print_hex(put, microtin_mesh_digest(mesh));
  print(put, "\n");
  if (status == MICROTIN_STATUS_OK) report_probes(put, mesh);
}

// A sum of the answers at 64 places, in their order.
template <class HeightAt>
uint32_t sum_of_probes(const ProbeBox& box, HeightAt height_at) {
  ProbeNumbers numbers;
  uint32_t hint = 0, sum = 0;
  for (int i = 0; i < 64; ++i) {
    const int32_t x = numbers.between(box.west, box.east);
    const int32_t y = numbers.between(box.south, box.north);
    int32_t height = 0;
    const microtin_query_result answer = height_at(x, y, &hint, &height);
    sum = sum * 31 + static_cast<uint32_t>(height) * 7 + static_cast<uint32_t>(answer);
  }
  return sum;
}

#ifndef MICROTIN_WITHOUT_SEGMENTS
inline microtin_query_result extremes_on(const microtin_mesh* mesh, const microtin_segment* c,
                                         microtin_segment_extremes* extremes) {
  return microtin_mesh_segment_extremes(mesh, c, nullptr, extremes, 0);
}
inline microtin_query_result extremes_on(const microtin_compact* compact, const microtin_segment* c,
                                         microtin_segment_extremes* extremes) {
  microtin_segment_state state = {};
  microtin_query_result answer;
  do {
    answer = microtin_compact_segment_extremes(compact, c, &state, extremes, 9);
  } while (answer == MICROTIN_QUERY_STEP_LIMIT);
  return answer;
}
inline microtin_query_result fill_from(const microtin_mesh* mesh, const microtin_grid_spec* b,
                                       int16_t* z) {
  return microtin_mesh_sample_grid(mesh, b, z);
}
inline microtin_query_result fill_from(const microtin_compact* compact, const microtin_grid_spec* b,
                                       int16_t* z) {
  return microtin_compact_sample_grid(compact, b, z);
}

// The sum on 8 segments through the box and in a grid of the places around.
template <class Form>
uint32_t sum_of_segments(const ProbeBox& box, const Form* form) {
  ProbeNumbers numbers;
  uint32_t sum = 0;
  for (int i = 0; i < 8; ++i) {
    const int32_t x = numbers.between(box.west, box.east);
    const int32_t y = numbers.between(box.south, box.north);
    const int32_t x_end = numbers.between(box.west, box.east);
    const microtin_segment segment = {x, y, x_end, numbers.between(box.south, box.north)};
    microtin_segment_extremes found;
    const microtin_query_result answer = extremes_on(form, &segment, &found);
    sum = sum * 31 + static_cast<uint32_t>(found.highest) * 7 + static_cast<uint32_t>(answer);
    sum = sum * 31 + static_cast<uint32_t>(found.lowest) * 7;
    sum = sum * 31 + static_cast<uint32_t>(found.highest_along) * 7;
    sum = sum * 31 + static_cast<uint32_t>(found.lowest_along);
  }
  const microtin_grid_spec block = {
      box.west - 256, box.south, (box.east - box.west) / 3, (box.north - box.south) / 3, 5, 4, -1};
  int16_t heights[20];
  sum = sum * 31 + static_cast<uint32_t>(fill_from(form, &block, heights));
  for (int i = 0; i < 20; ++i) sum = sum * 31 + static_cast<uint16_t>(heights[i]);
  return sum;
}
#else
template <class Form>
uint32_t sum_of_segments(const ProbeBox&, const Form*) {
  return 0;
}
#endif

// Makes the compact form of a mesh in its place, in calls of a few steps: whether it answers as the
// mesh did, or the mesh is too small for that or, by a few vertices, too large.
inline bool compact_agrees(microtin_mesh* mesh, size_t size, void* scratch, size_t scratch_size) {
  const ProbeBox box = probe_box(mesh);
  const uint64_t digest = microtin_mesh_digest(mesh);
  const uint32_t sum = sum_of_probes(box, [mesh](int32_t x, int32_t y, uint32_t* hint, int32_t* z) {
    return microtin_mesh_height_at(mesh, x, y, hint, z, 0, 0);
  });
  const uint32_t segments = sum_of_segments(box, mesh);
  microtin_compactor* compactor = 0;
  microtin_compact* compact = 0;
  microtin_status status =
      microtin_compactor_init(mesh, size, mesh, scratch, scratch_size, &compactor);
  if (status != MICROTIN_STATUS_OK) return false;
  do {
    status = microtin_compactor_run(compactor, &compact, 5);
  } while (status == MICROTIN_STATUS_STEP_LIMIT);
  const uint32_t n = microtin_mesh_vertex_count(mesh);
  if (status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL) return n < 100;
  if (status == MICROTIN_STATUS_TOO_BIG) return n + 10 > MICROTIN_MAX_VERTICES;
  return microtin_compact_digest(compact) == digest &&
         sum == sum_of_probes(box,
                              [compact](int32_t x, int32_t y, uint32_t* hint, int32_t* z) {
                                return microtin_compact_height_at(compact, x, y, hint, z, 0);
                              }) &&
         segments == sum_of_segments(box, compact);
}

}  // namespace microtin

#endif
