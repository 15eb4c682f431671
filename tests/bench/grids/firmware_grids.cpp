// SPDX-License-Identifier: MIT
#include "tests/bench/grids/firmware_grids.hpp"

#include <algorithm>

#include "encoder/stream/encode.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/verify/verify.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

// Bits on the card for one post, also where that is all in memory.
struct Style {
  const char* name;
  double spacing, step, bits_per_post;
};
// Blocks of 2,048 bytes hold 28 x 32 posts, of which 24 x 28 are their own.
constexpr double kArduPilotBits = 2048 * 8 / (24.0 * 28.0);
constexpr Style kStyles[] = {{"ArduPilot-style, 100 m", 100, 1, kArduPilotBits},
                             {"ArduPilot-style, 30 m", 30, 1, kArduPilotBits},
                             {"INAV-style, 10 bits of 2 m, 30 m", 30, 2, 10}};

struct Mesh {
  size_t bytes, ram;
  Errors errors;
};

// A mesh within `bound` metres.
Mesh mesh_within(const Terrain& terrain, double bound) {
  LatticeOptions options;
  options.max_error = parse_decimal(number(bound, 2));
  options.z_step = parse_decimal(number(std::max(0.8 * bound, terrain.z_metres), 2));
  const Model model = simplified(terrain.raster, options);
  const Encoding encoding = encode_and_decode(model.tin, model.metadata, {});
  const auto vertices = static_cast<unsigned long>(model.tin.vertices.size());
  const size_t ram = vertices <= MICROTIN_MAX_VERTICES_FOR(16)
                         ? MICROTIN_MESH_BYTES_FOR(vertices, 16)
                         : MICROTIN_MESH_BYTES_FOR(vertices, 32);
  const Verification found = verify(encoding.decoded.mesh(), terrain.raster, std::nullopt);
  const auto metres = [](const Decimal& value) { return std::stod(to_string(value)); };
  return {encoding.stream.size(), ram, {metres(found.max_error), metres(found.rms_error)}};
}

// The coarsest mesh found whose rms error is at most that: the bound follows it.
Mesh mesh_with_rms(const Terrain& terrain, double rms) {
  if (rms == 0) return mesh_within(terrain, 0);
  constexpr int kTrials = 3;
  double bound = 3 * rms;
  Mesh best{}, mesh{};
  for (int trial = 0; trial < kTrials || best.bytes == 0; ++trial) {
    mesh = mesh_within(terrain, bound);
    if (mesh.errors.rms <= rms && (best.bytes == 0 || mesh.bytes < best.bytes)) best = mesh;
    bound *= 0.99 * rms / mesh.errors.rms;
  }
  return best;
}

void print_surface(const Terrain& terrain, const std::string& name, double bytes, double ram,
                   const Errors& errors, double grid_bytes) {
  const double area = terrain.square_kilometres();
  print_row({terrain.name, name, number(bytes / area, 1), number(errors.largest, 1),
             number(errors.rms, 2), number(ram / area, 1), number(bytes / grid_bytes, 3),
             number(ram / grid_bytes, 2)});
}

void print_style(const Terrain& terrain, const Style& style) {
  const Errors errors = errors_of(Grid(terrain, style.spacing, style.step), terrain);
  const double posts = terrain.square_kilometres() * 1e6 / (style.spacing * style.spacing);
  const double bytes = posts * style.bits_per_post / 8;
  print_surface(terrain, style.name, bytes, bytes, errors, bytes);
  const auto print_mesh = [&](const char* name, const Mesh& mesh) {
    print_surface(terrain, name, static_cast<double>(mesh.bytes), static_cast<double>(mesh.ram),
                  mesh.errors, bytes);
  };
  print_mesh("... microtin, equal largest error", mesh_within(terrain, errors.largest));
  print_mesh("... microtin, equal rms error", mesh_with_rms(terrain, errors.rms));
}

}  // namespace

void print_firmware_grids() {
  const std::vector<Terrain> all = terrains();
  print_head("Against the grids of firmware, per square kilometre, errors at the source's posts",
             {"terrain", "surface", "bytes", "largest error, m", "rms error, m",
              "RAM for queries, bytes", "bytes / grid", "RAM / grid"});
  constexpr double kFinestCell = 20;  // metres: finer sources are not what these grids are for
  for (const Terrain& terrain : all) {
    if (terrain.column_metres < kFinestCell) continue;
    for (const Style& style : kStyles) print_style(terrain, style);
  }
}

}  // namespace microtin::bench
