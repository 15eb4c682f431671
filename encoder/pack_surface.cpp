#include "encoder/pack_surface.hpp"

#include <map>
#include <string>

#include "encoder/borders.hpp"
#include "encoder/error.hpp"
#include "encoder/lattice_map.hpp"
#include "encoder/point_pack.hpp"

namespace microtin {
namespace {

// Collects the tiles' vertices, those on borders once.
class Joining {
 public:
  explicit Joining(const TileGrid& grid) : grid_(grid) {}

  void add(const TileBox& box, const SurfaceModel& tile) {
    std::vector<uint32_t> number;
    for (const auto& [x, y, z] : tile.vertices) {
      number.push_back(
          number_of({box.x + static_cast<uint32_t>(x), box.y + static_cast<uint32_t>(y)}, z));
    }
    for (const auto& [a, b, c] : tile.triangles) {
      all_.triangles.push_back({number[a], number[b], number[c]});
    }
  }

  SurfaceModel take() { return std::move(all_); }

 private:
  uint32_t number_of(GlobalPost place, int64_t z) {
    const auto next = static_cast<uint32_t>(all_.vertices.size());
    if (place.x % grid_.width == 0 || place.y % grid_.height == 0) {
      const auto [found, is_new] = shared_.emplace(place, next);
      if (!is_new) {
        if (all_.vertices[found->second][2] != z) {
          throw Error("two tiles differ in the height at x " + std::to_string(place.x) + ", y " +
                      std::to_string(place.y));
        }
        return found->second;
      }
    }
    all_.vertices.push_back({place.x, place.y, z});
    return next;
  }

  TileGrid grid_;
  SurfaceModel all_;
  std::map<GlobalPost, uint32_t> shared_;
};

// The raster, if its posts are the places of the pack.
const Raster& posts_of(const Source& source, const PackFile& pack) {
  const auto* raster = std::get_if<Raster>(&source);
  const auto is_same = [](const Axis& a, const Axis& b) {
    const LatticeMap map = map_between(a, b);
    return map.shift == 0 && map.scale == map.step;
  };
  const Placement& placement = pack.metadata().placement;
  if (raster == nullptr || raster->width != pack.grid().x_max + 1 ||
      raster->height != pack.grid().y_max + 1 || !is_same(raster->x, placement.x) ||
      !is_same(raster->y, placement.y)) {
    throw Error("the terrain is not a raster with the posts of the pack");
  }
  return *raster;
}

}  // namespace

SurfaceModel model_of(const PackFile& pack) {
  Joining joining(pack.grid());
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (tile) joining.add(tile_box(pack.grid(), number), model_of(tile->mesh()));
  }
  SurfaceModel model = joining.take();
  model.placement = pack.metadata().placement;
  return model;
}

Verification verify(const PackFile& pack, const Source& source,
                    const std::optional<Decimal>& bound) {
  if (const auto* cloud = std::get_if<PointCloud>(&source)) return verify(pack, *cloud, bound);
  const Raster& raster = posts_of(source, pack);
  std::vector<Verification> parts;
  std::map<GlobalPost, std::size_t> uncovered;  // by how many tiles
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const TileBox box = tile_box(pack.grid(), number);
    const Raster part = crop(raster, box);
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    const microtin_mesh* const mesh = tile ? tile->mesh() : nullptr;
    const Placement placement{part.x, part.y, pack.metadata().placement.z};
    if (tile) parts.push_back(verify(mesh, placement, part, bound));
    if (tile && parts.back().uncovered == 0) continue;
    for (const GlobalPost post : uncovered_posts(mesh, part, box)) ++uncovered[post];
  }
  Verification all = combine(parts);
  all.uncovered = 0;
  for (const auto& [post, tiles] : uncovered) {
    if (tiles == tiles_at(pack.grid(), post).size()) ++all.uncovered;
  }
  all.posts = all.voids = 0;
  for (const int64_t height : raster.heights) ++(height == kVoidHeight ? all.voids : all.posts);
  all.covered = all.posts - all.uncovered;
  return all;
}

}  // namespace microtin
