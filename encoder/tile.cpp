#include "encoder/tile.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"
#include "shared/predicates.hpp"

namespace microtin {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error("internal error: a decoded tile " + what);
}

// Only other tiles may cover what this one does not.
void check_bounds(const TiledRaster& tiled, const TileBox& box, const Sides& sides,
                  const EncodedTile& tile) {
  const Verification& measured = tile.measured;
  const bool too_low = tiled.options.never_below && measured.max_below.mantissa != 0;
  const bool is_shared =
      std::all_of(tile.uncovered.begin(), tile.uncovered.end(), [&](GlobalPost p) {
        return sides.shares(
            {static_cast<uint16_t>(p.x - box.x), static_cast<uint16_t>(p.y - box.y)});
      });
  if (!measured.within_bound || too_low || measured.voids_answered != 0 || !is_shared) {
    fail("does not keep what was asked for");
  }
}

}  // namespace

bool form_triangle(const std::vector<Sample>& samples) {
  return !samples.empty() && std::any_of(samples.begin(), samples.end(), [&](const Sample& s) {
    return orient2d(samples.front().place, samples.back().place, s.place) != 0;
  });
}

void check_shared(const microtin_mesh* mesh, const Sides& sides, const SharedVertices& shared) {
  std::size_t found = 0;
  for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
    Point p{};
    int16_t z = 0;
    microtin_vertex(mesh, v, &p.x, &p.y, &z);
    if (!sides.shares(p)) continue;
    const auto vertex = shared.find(p);
    if (vertex == shared.end() || vertex->second != z)
      fail("has another border than its neighbour");
    ++found;
  }
  if (found != shared.size()) fail("lacks a vertex of its border");
}

void add_heights(const Tin& tin, EncodedTile& tile) {
  const auto lower = [](const Vertex& a, const Vertex& b) { return a.z < b.z; };
  const auto [low, high] = std::minmax_element(tin.vertices.begin(), tin.vertices.end(), lower);
  tile.vertices = static_cast<uint32_t>(tin.vertices.size());
  tile.lowest = low->z;
  tile.highest = high->z;
}

std::vector<GlobalPost> uncovered_posts(const microtin_mesh* mesh, const Raster& part,
                                        const TileBox& box) {
  std::vector<GlobalPost> posts;
  uint32_t hint = 0;
  for_each_post(part, [&](int64_t x, int64_t y, int64_t z) {
    int32_t height = 0;
    const bool covered =
        mesh != nullptr && z != kVoidHeight &&
        microtin_height_at(mesh, static_cast<int32_t>(x * 256), static_cast<int32_t>(y * 256), 0,
                           &hint, &height) == MICROTIN_HEIGHT;
    if (z == kVoidHeight || covered) return;
    posts.push_back({box.x + static_cast<uint32_t>(x), box.y + static_cast<uint32_t>(y)});
  });
  return posts;
}

Survey survey_of_tile(const TiledRaster& tiled, uint32_t tile, const SharedVertices& shared) {
  const TileBox box = tile_box(tiled.grid, tile);
  const Sides sides(tiled.grid, box);
  const Survey all = survey_of(tiled, crop(tiled.raster, box));
  Survey survey;
  survey.voids = all.voids;
  survey.samples.reserve(all.samples.size());
  for (const Sample& sample : all.samples) {
    if (!sides.shares(sample.place)) {
      survey.samples.push_back(sample);
      continue;
    }
    const auto vertex = shared.find(sample.place);
    if (vertex == shared.end()) continue;
    const int32_t height = vertex->second * 65536;
    survey.samples.push_back({sample.place, height, height, height});
    survey.fixed.push_back(sample.place);
  }
  return survey;
}

bool has_terrain(const TiledRaster& tiled, uint32_t tile, const Survey& survey) {
  if (form_triangle(survey.samples)) return true;
  if (survey.samples.size() == survey.fixed.size()) return false;
  const TileBox box = tile_box(tiled.grid, tile);
  throw Error("the tile from column " + std::to_string(box.x) + ", row " + std::to_string(box.y) +
              " has only " + std::to_string(survey.samples.size()) +
              " heights, which form no triangle; another --tile-vertices may help");
}

EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SharedVertices& shared,
                        const SimplifyOptions& options) {
  const TileBox box = tile_box(tiled.grid, tile);
  const Sides sides(tiled.grid, box);
  const Raster part = crop(tiled.raster, box);
  const Survey survey = survey_of_tile(tiled, tile, shared);
  EncodedTile encoded;
  if (!has_terrain(tiled, tile, survey)) {
    encoded.uncovered = uncovered_posts(nullptr, part, box);
    return encoded;
  }
  const Tin tin = simplify(survey, options);
  auto [stream, decoded] = encode_and_decode(tin, Metadata(), options.effort);
  encoded.stream = std::move(stream);
  add_heights(tin, encoded);
  check_shared(decoded.mesh(), sides, shared);
  encoded.measured = verify(decoded.mesh(), {part.x, part.y, tiled.lattice.placement.z}, part,
                            tiled.options.max_error);
  if (encoded.measured.uncovered != 0) {
    encoded.uncovered = uncovered_posts(decoded.mesh(), part, box);
  }
  check_bounds(tiled, box, sides, encoded);
  return encoded;
}

}  // namespace microtin
