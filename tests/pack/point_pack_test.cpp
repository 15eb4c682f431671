// SPDX-License-Identifier: MIT
// Packs of points: no cracks, every point within its bound, the whole hull covered.
#include "encoder/pack/point_pack.hpp"

#include <doctest/doctest.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>

#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/pack/point_tiles.hpp"
#include "tests/support/border_walk.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/point_clouds.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

std::vector<uint8_t> pack_bytes(const PointCloud& cloud, const PackOptions& options) {
  const PointPack pack = encode_point_pack(cloud, options);
  return write_pack(pack.content, pack.streams);
}

// Vertices of tiles on a line of the grid, by their coordinate along it.
std::set<uint32_t> vertices_on(const SurfaceModel& model, bool north, uint32_t across) {
  std::set<uint32_t> on;
  for (const auto& v : model.vertices) {
    if (v[north ? 0 : 1] == across) on.insert(static_cast<uint32_t>(v[north ? 1 : 0]));
  }
  return on;
}

// Compares at vertices of a line, next to and between them, and at random.
void walk_line(const Tiles& tiles, const std::set<uint32_t>& vertices, bool north, uint32_t across,
               uint32_t end, BorderCount& count) {
  Random random(across);
  std::vector<int64_t> places;
  for (const uint32_t v : vertices) {
    for (const int64_t beside : {-256, -1, 0, 1, 100}) places.push_back(v * int64_t{256} + beside);
    for (int i = 0; i < 4; ++i) {
      const uint32_t span = std::min(1000u, end);
      places.push_back((int64_t{v} - random.below(span)) * 256 + random.below(256));
    }
    places.push_back(int64_t{random.below(end)} * 256 + random.below(256));
  }
  for (const int64_t place : places) {
    if (place < 0 || place > int64_t{end} * 256) continue;
    const int64_t line = int64_t{across} * 256;
    compare_at(tiles, north ? line : place, north ? place : line, count);
  }
}

BorderCount walk(const PackFile& pack, const Tiles& tiles) {
  const TileGrid& grid = pack.grid();
  const SurfaceModel model = model_of(pack);
  BorderCount count;
  for (uint32_t x = grid.width; x < grid.x_max; x += grid.width) {
    walk_line(tiles, vertices_on(model, true, x), true, x, grid.y_max, count);
  }
  for (uint32_t y = grid.height; y < grid.y_max; y += grid.height) {
    walk_line(tiles, vertices_on(model, false, y), false, y, grid.x_max, count);
  }
  return count;
}

// Places in triangles of any three points lie in the hull: how many of them nobody knows.
uint64_t gaps(const PackFile& pack, const Tiles& tiles, const PointCloud& cloud) {
  const TileGrid& grid = pack.grid();
  const auto places = places_on(cloud, pack.metadata().placement, grid.x_max, grid.y_max);
  Random random(places.size());
  const auto pick = [&] { return places[random.below(static_cast<uint32_t>(places.size()))]; };
  BorderCount count;
  uint64_t gaps = 0;
  for (int i = 0; i < 3000; ++i) {
    const GlobalPost a = pick(), b = pick(), c = pick();
    const int64_t x = (int64_t{a.x} + b.x + 2 * int64_t{c.x}) * 64;
    const int64_t y = (int64_t{a.y} + b.y + 2 * int64_t{c.y}) * 64;
    if (!compare_at(tiles, x, y, count)) ++gaps;
  }
  CHECK(count.differ == 0);
  return gaps;
}

void check_point_pack(const PointCloud& cloud, const PackOptions& options) {
  const PackFile pack(pack_bytes(cloud, options));
  CHECK(pack.header().most_vertices <= options.max_vertices);
  const Tiles tiles(pack);
  const BorderCount count = walk(pack, tiles);
  CHECK(count.differ == 0);
  CHECK(count.one_sided == 0);
  if (pack.entries().size() > 1) CHECK(count.both > 0);
  CHECK(gaps(pack, tiles, cloud) == 0);
  const Verification found = verify(pack, cloud, options.lattice.max_error);
  CHECK(found.posts == cloud.points.size());
  CHECK(found.covered == cloud.points.size());
  CHECK(found.within_bound);
  MESSAGE(tile_columns(pack.grid())
          << " x " << tile_rows(pack.grid()) << " tiles, " << pack.bytes() << " bytes, "
          << count.places << " places on borders, " << count.both << " in two tiles");
}

// Nothing if it is not here.
std::optional<PointCloud> read_cloud(const std::string& name) {
  const std::string path = (data_folder() / (name + ".xyz.gz")).string();
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: " << name << " is not here");
    return std::nullopt;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
      popen(("gzip -dc '" + path + "'").c_str(), "r"), pclose);
  std::string text;
  char block[65536];
  while (const size_t size = std::fread(block, 1, sizeof block, pipe.get())) {
    text.append(block, size);
  }
  return import_points(name, text);
}

}  // namespace

TEST_CASE("point packs have no cracks, cover the hull and keep their bound" * kSlow) {
  for (const CloudKind& kind : cloud_kinds()) {
    CAPTURE(kind.name);
    check_point_pack(kind.cloud, point_options(5, 40));
    check_point_pack(kind.cloud, point_options(20, 24));
  }
}

TEST_CASE("point packs without a bound have every place of a point as a vertex" * kSlow) {
  for (const CloudKind& kind : cloud_kinds()) {
    CAPTURE(kind.name);
    const PackOptions options = point_options(0, 60);
    check_point_pack(kind.cloud, options);
    const PackFile pack(pack_bytes(kind.cloud, options));
    const TileGrid& grid = pack.grid();
    const SurfaceModel model = model_of(pack);
    std::set<std::pair<int64_t, int64_t>> vertices;
    for (const auto& v : model.vertices) vertices.insert({v[0], v[1]});
    for (const GlobalPost p :
         places_on(kind.cloud, pack.metadata().placement, grid.x_max, grid.y_max)) {
      CHECK(vertices.count({p.x, p.y}) == 1);
    }
    if (kind.name != "duplicates") {
      CHECK(verify(pack, kind.cloud, Decimal{0, 0}).within_bound);
    }
  }
}

TEST_CASE("packs of real points have no cracks and keep their bound" * kSlow) {
  const struct {
    const char* name;
    int64_t bound;  // hundredths; 0: none
    uint32_t vertices;
  } packs[] = {{"quebec_forest_ground", 20, 250},
               {"quebec_forest_ground", 0, 500},
               {"delft_ground", 10, 500},
               {"delft_ground", 0, 5000},
               {"delft_urban", 200, 250}};
  for (const auto& p : packs) {
    const std::optional<PointCloud> cloud = read_cloud(p.name);
    if (!cloud) continue;
    CAPTURE(std::string(p.name));
    PackOptions options = point_options(p.bound, p.vertices);
    if (p.bound != 0) options.lattice.max_error = Decimal{p.bound, 2};
    check_point_pack(*cloud, options);
  }
}

TEST_CASE("point packs never below the source are not") {
  for (const CloudKind& kind : cloud_kinds()) {
    CAPTURE(kind.name);
    PackOptions options = point_options(9, 60);
    options.lattice.never_below = true;
    const PackFile pack(pack_bytes(kind.cloud, options));
    CHECK(verify(pack, kind.cloud, options.lattice.max_error).max_below.mantissa == 0);
    CHECK(walk(pack, Tiles(pack)).differ == 0);
  }
}

TEST_CASE("a point pack of 2^31 steps" * kSlow) {
  const PointCloud cloud = long_cloud();
  PackOptions options = point_options(5, 40);
  options.simplify.search = Search::kGreedy;
  const PackFile pack(pack_bytes(cloud, options));
  CHECK(pack.grid().x_max == INT32_MAX);
  CHECK(tile_columns(pack.grid()) >= 32769);
  const Verification found = verify(pack, cloud, options.lattice.max_error);
  CHECK(found.covered == cloud.points.size());
  CHECK(found.within_bound);
  const Tiles tiles(pack);
  CHECK(gaps(pack, tiles, cloud) == 0);
  BorderCount count;
  Random random(4);
  for (uint32_t x = pack.grid().width; x < pack.grid().x_max; x += pack.grid().width) {
    for (int i = 0; i < 3; ++i) {
      compare_at(tiles, int64_t{x} * 256, random.below(pack.grid().y_max * 256), count);
    }
  }
  CHECK(count.both > 32769);
  CHECK(count.differ == 0);
}

TEST_CASE("a point pack depends neither on the order of points nor on the number of threads") {
  PointCloud cloud = cloud_kinds()[1].cloud;
  const PackOptions options = point_options(4, 50);
  const std::vector<uint8_t> bytes = pack_bytes(cloud, options);
  Random random(6);
  shuffle(cloud.points, random);
  cpu_set_t before, one;
  REQUIRE(sched_getaffinity(0, sizeof before, &before) == 0);
  CPU_ZERO(&one);
  for (size_t cpu = 0; CPU_COUNT(&one) == 0; ++cpu) {
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
  }
  REQUIRE(sched_setaffinity(0, sizeof one, &one) == 0);
  const std::vector<uint8_t> again = pack_bytes(cloud, options);
  REQUIRE(sched_setaffinity(0, sizeof before, &before) == 0);
  CHECK(again == bytes);
}

TEST_CASE("a device reads packs of points: heights, and the highest on a segment") {
  for (const CloudKind& kind : cloud_kinds()) {
    CAPTURE(kind.name);
    Card card{pack_bytes(kind.cloud, point_options(5, 60))};
    const PackFile pack(card.bytes);
    const SurfaceModel model = model_of(pack);
    const uint32_t x_max = pack.grid().x_max, y_max = pack.grid().y_max;
    const auto places = places_on(kind.cloud, pack.metadata().placement, x_max, y_max);
    const MeshSlots device(120);
    Random random(5);
    for (int i = 0; i < 40; ++i) {
      const GlobalPost p = places[random.below(static_cast<uint32_t>(places.size()))];
      const int64_t x = i % 3 == 0 ? random.below(x_max) : p.x, y = p.y;
      microtin_segment c{x * 256, y * 256, x * 256, y * 256};
      REQUIRE(device.load(card, c) == MICROTIN_STATUS_OK);
      int32_t height = 0;
      const microtin_query_result answer = device.height_at(c.x, c.y, height);
      const std::optional<int32_t> expected = expected_height(pack, c.x, c.y);
      CHECK(answer == (expected ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID));
      if (expected) CHECK(height == *expected);
      if (i % 3 != 0) CHECK(answer == MICROTIN_QUERY_OK);
      // To some point nearby, so over the hull: nothing is missing on the way.
      for (const GlobalPost q : places) {
        const int64_t dx = int64_t{q.x} - p.x, dy = int64_t{q.y} - p.y;
        const int64_t reach = 3 * pack.grid().width;
        if (i % 3 == 0 || std::abs(dx) > std::min<int64_t>(reach, 65000) ||
            std::abs(dy) > std::min<int64_t>(reach, 65000) || random.below(4) != 0) {
          continue;
        }
        c = {int64_t{p.x} * 256, int64_t{p.y} * 256, int64_t{q.x} * 256, int64_t{q.y} * 256};
        if (device.load(card, c) != MICROTIN_STATUS_OK) break;  // more tiles than slots
        int32_t highest = 0, begin = 0, end = 0;
        CHECK(device.highest_on(c, &highest) == MICROTIN_QUERY_OK);
        REQUIRE(device.height_at(c.x, c.y, begin) == MICROTIN_QUERY_OK);
        REQUIRE(device.height_at(c.x_end, c.y_end, end) == MICROTIN_QUERY_OK);
        const double exact = std::max({highest_on_edges(model, c) * 65536, begin * 1.0, end * 1.0});
        CHECK(std::abs(highest - exact) < 2);
        break;
      }
    }
  }
}

TEST_CASE("point packs: what cannot be is refused") {
  CloudMaker line(1), square(2);
  for (int64_t i = 0; i < 9; ++i) line.add(i, 3 * i);
  CHECK_THROWS_WITH_AS(pack_bytes(line.take(), point_options(1, 90)),
                       "all points lie on one line: there is no triangle", Error);
  square.scatter(50, 0, 0, 2000000000, 2000000000);
  const PointCloud wide = square.take();
  CHECK_THROWS_WITH_AS(pack_bytes(wide, point_options(1, 90)),
                       "xy_step 1 is too fine: the pack needs more than 1048576 tiles of at most "
                       "65535 steps; use 5000 or more",
                       Error);
  PackOptions fine = point_options(1, 90);
  fine.lattice.xy_step = Decimal{1, 1};
  CHECK_THROWS_WITH_AS(pack_bytes(wide, fine),
                       "xy_step 0.1 is too fine: 31 bits do not hold the source's range in such "
                       "steps; use 1 or more",
                       Error);
  fine.lattice.xy_step = Decimal{5000, 0};
  check_point_pack(wide, fine);
}

TEST_CASE("point packs: crowds far apart are refused before all is empty tiles") {
  CloudMaker crowds(3);
  for (int64_t i = 0; i < 200; ++i) {
    crowds.add(2 * (i % 20), 3 * (i / 20));
    crowds.add(30000 + 2 * (i % 20), 30000 + 3 * (i / 20));
  }
  try {
    pack_bytes(crowds.take(), point_options(1, 40));
    FAIL("is not refused");
  } catch (const Error& error) {
    CHECK_MESSAGE(
        std::string(error.what()).find("encode each cluster as its own pack") != std::string::npos,
        error.what());
  }
}

TEST_CASE("a point outside a pack is not covered") {
  PointCloud cloud = cloud_kinds()[0].cloud;
  const PackFile pack(pack_bytes(cloud, point_options(5, 40)));
  const auto count = cloud.points.size();
  cloud.points.push_back({5000, 5000, 0});
  cloud.points.push_back({-1, 0, 0});
  const Verification found = verify(pack, cloud, Decimal{5, 0});
  CHECK(found.covered == count);
  CHECK(found.uncovered == 2);
  cloud.points[0].z += 20;
  CHECK(!verify(pack, cloud, Decimal{5, 0}).within_bound);
}

}  // namespace microtin::tests
