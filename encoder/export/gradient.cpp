// SPDX-License-Identifier: MIT
#include "encoder/export/gradient.hpp"

#include <array>

#include "encoder/terrain/exact_query.hpp"

namespace microtin::exporting {
namespace {

// The triangle whose centre lies farthest east, and of those with the same x farthest north.
class BestTriangle {
 public:
  // The corners are those of a tile that begins at (x, y).
  void look_at(const std::array<Vertex, 3>& v, int64_t x, int64_t y) {
    const Centre centre = {3 * x + v[0].x + v[1].x + v[2].x, 3 * y + v[0].y + v[1].y + v[2].y};
    if (best_ && centre <= centre_) return;
    centre_ = centre;
    const int64_t bx = v[1].x - v[0].x, by = v[1].y - v[0].y, bz = v[1].z - v[0].z,
                  cx = v[2].x - v[0].x, cy = v[2].y - v[0].y, cz = v[2].z - v[0].z;
    const auto whole = static_cast<double>(bx * cy - cx * by);
    best_ = LatticeGradient{static_cast<double>(bz * cy - cz * by) / whole,
                            static_cast<double>(bx * cz - cx * bz) / whole};
  }

  const std::optional<LatticeGradient>& gradient() const { return best_; }

 private:
  using Centre = std::array<int64_t, 2>;  // three times

  Centre centre_{};
  std::optional<LatticeGradient> best_;
};

}  // namespace

std::optional<LatticeGradient> gradient_at(const SampledSurface& surface, const RealPlace& place,
                                           GradientSearch& search) {
  if (surface.height_at(place).kind != MICROTIN_QUERY_OK) return std::nullopt;
  const TileGrid& grid = surface.tiles;
  const TileSpan columns = tiles_with(place.x, place.x_part, grid.width, tile_columns(grid));
  const TileSpan rows = tiles_with(place.y, place.y_part, grid.height, tile_rows(grid));
  BestTriangle best;
  for (uint32_t row = rows.first; row <= rows.last; ++row) {
    for (uint32_t column = columns.first; column <= columns.last; ++column) {
      const uint32_t tile = row * tile_columns(grid) + column;
      const microtin_mesh* const mesh = surface.mesh_of(tile).mesh;
      if (mesh == nullptr) continue;
      if (mesh != search.mesh) search = {mesh, 0};
      const TileBox box = tile_box(grid, tile);
      RealPlace local = place;
      local.x -= box.x;
      local.y -= box.y;
      if (exact_answer(mesh, local, 0, &search.hint).kind != MICROTIN_QUERY_OK) continue;
      for (const std::array<Vertex, 3>& corners : triangles_at(mesh, local, search.hint)) {
        best.look_at(corners, box.x, box.y);
      }
    }
  }
  return best.gradient();
}

}  // namespace microtin::exporting
