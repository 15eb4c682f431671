// SPDX-License-Identifier: MIT
// Compares a pack with points: each is asked of the tiles that hold it.
#include <algorithm>

#include "encoder/base/parallel.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/point_survey.hpp"
#include "encoder/pack/tile_contents.hpp"
#include "encoder/terrain/visit_log.hpp"

namespace microtin::pack {
namespace {

bool answers(const microtin_mesh* mesh, const TileBox& box, GlobalPost place, uint32_t* hint) {
  int32_t height = 0;
  return microtin_mesh_height_at(mesh, static_cast<int32_t>(place.x - box.x) * 256,
                                 static_cast<int32_t>(place.y - box.y) * 256, hint, &height, 0,
                                 0) == MICROTIN_QUERY_OK;
}

}  // namespace

Verification verify(const PackFile& pack, const PointCloud& cloud,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  const TileGrid& grid = pack.grid();
  const Placement& placement = pack.metadata().placement;
  const std::vector<GlobalPost> places = places_on(cloud, placement, grid.x_max, grid.y_max);
  const TileContents points(grid, places);
  std::vector<Verification> parts(pack.entries().size());
  std::vector<VisitLog> visits(parts.size());
  std::vector<std::vector<uint32_t>> covered(parts.size());
  for_each_parallel(parts.size(), [&](std::size_t i) {
    const auto number = static_cast<uint32_t>(i);
    const std::vector<uint32_t> here = points.of_tile(number);
    if (here.empty()) return;
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (!tile) return;
    const TileBox box = tile_box(grid, number);
    parts[i] = verify(tile->mesh(), placement_from(placement, {box.x, box.y}), part_of(cloud, here),
                      bound, visit ? visits[i].recorder(box.x, box.y) : PostVisitor());
    uint32_t hint = 0;
    for (const uint32_t point : here) {
      if (answers(tile->mesh(), box, places[point], &hint)) covered[i].push_back(point);
    }
  });
  for (const VisitLog& log : visits) log.tell(visit);
  std::vector<bool> is_covered(places.size());
  for (const auto& numbers : covered) {
    for (const uint32_t point : numbers) is_covered[point] = true;
  }
  Verification all = combine(parts);
  all.posts = places.size();
  all.covered = static_cast<uint64_t>(std::count(is_covered.begin(), is_covered.end(), true));
  all.uncovered = all.posts - all.covered;
  return all;
}

}  // namespace microtin::pack
