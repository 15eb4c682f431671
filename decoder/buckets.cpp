// SPDX-License-Identifier: MIT
// Buckets: for each part of a terrain's box a triangle near it.
#include "decoder/state.hpp"
#include "decoder/walk.hpp"

// The box is divided into side x side buckets of equal size, row by row from the south-west.
struct microtin_buckets {
  uint16_t west, south, width, height;  // of the vertices' box, in lattice steps
  uint32_t x_scale, y_scale;            // buckets per lattice step, 16 fractional bits: < 2^27
  uint32_t side;
};

static_assert(sizeof(microtin_buckets) <= MICROTIN_BUCKETS_BYTES(0), "see MICROTIN_BUCKETS_BYTES");

namespace microtin {
namespace {

constexpr uint32_t kMostSide = 1024;

Index* triangles_of(microtin_buckets* buckets) {
  return reinterpret_cast<Index*>(buckets + 1);
}

uint32_t side_of(size_t size) {
  uint32_t side = 0;
  while (side < kMostSide && MICROTIN_BUCKETS_BYTES(side + 1) <= size) ++side;
  return side;
}

// Lattice steps that an extent covers, both ends counted.
uint32_t steps_of(uint16_t extent) {
  return static_cast<uint32_t>(extent) + 1u;
}

void measure(microtin_buckets& buckets, const Mesh& mesh) {
  uint16_t west = kLatticeMax, south = kLatticeMax, east = 0, north = 0;
  for (Index v = 0; v < mesh.vertices; ++v) {
    const Point p = point_of(mesh, v);
    if (p.x < west) west = p.x;
    if (p.x > east) east = p.x;
    if (p.y < south) south = p.y;
    if (p.y > north) north = p.y;
  }
  buckets.west = west;
  buckets.south = south;
  buckets.width = static_cast<uint16_t>(east - west);
  buckets.height = static_cast<uint16_t>(north - south);
  buckets.x_scale = (buckets.side << 16) / steps_of(buckets.width);
  buckets.y_scale = (buckets.side << 16) / steps_of(buckets.height);
}

// The middle of bucket i along an axis, with 8 fractional bits, in whole steps.
int32_t middle(uint32_t i, uint32_t side, uint16_t start, uint16_t extent) {
  const uint32_t steps = (2 * i + 1) * steps_of(extent) / (2 * side);  // the product is below 2^27
  return static_cast<int32_t>((start + steps) * 256);
}

// To and fro, so that each walk starts next to where it ends.
void fill(microtin_buckets* buckets, const microtin_mesh& mesh) {
  const uint32_t side = buckets->side, triangles = mesh.mesh.triangles;
  Index t = 0;
  for (uint32_t row = 0; row < side; ++row) {
    const int32_t y = middle(row, side, buckets->south, buckets->height);
    for (uint32_t i = 0; i < side; ++i) {
      const uint32_t column = row % 2 == 0 ? i : side - 1 - i;
      const int32_t x = middle(column, side, buckets->west, buckets->width);
      if (triangles != 0) walk_to(mesh, FinePoint{x, y}, triangles, &t);
      triangles_of(buckets)[row * side + column] = t;
    }
  }
}

// The number along an axis of the bucket that holds a coordinate, or of the one nearest to it.
uint32_t bucket_of(int32_t fine, uint16_t start, uint16_t extent, uint32_t scale) {
  const int32_t steps = (fine < 0 ? 0 : fine >> 8) - start;
  if (steps < 0) return 0;
  return ((steps < extent ? static_cast<uint32_t>(steps) : extent) * scale) >> 16;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_buckets_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                      microtin_buckets** buckets) {
  if (workspace == nullptr || mesh == nullptr || buckets == nullptr)
    return MICROTIN_STATUS_ARGUMENT;
  *buckets = nullptr;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0)
    return MICROTIN_STATUS_MISALIGNED;
  const uint32_t side = side_of(size);
  if (side == 0) return MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
  microtin_buckets& b = *static_cast<microtin_buckets*>(workspace);
  b.side = side;
  measure(b, mesh->mesh);
  fill(&b, *mesh);
  *buckets = &b;
  return MICROTIN_STATUS_OK;
}

uint32_t microtin_buckets_hint(const microtin_buckets* buckets, int32_t x, int32_t y) {
  const microtin_buckets& b = *buckets;
  const uint32_t column = bucket_of(x, b.west, b.width, b.x_scale);
  const uint32_t row = bucket_of(y, b.south, b.height, b.y_scale);
  return reinterpret_cast<const Index*>(buckets + 1)[row * b.side + column];
}
