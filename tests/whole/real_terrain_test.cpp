// SPDX-License-Identifier: MIT
// Real terrain, where it lies next to the repository, all the way: laid out, simplified, encoded,
// decoded, and verified at every post.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "encoder/fit/simplify.hpp"
#include "encoder/import/import.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/verify/verify.hpp"
#include "tests/support/border_walk.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

namespace fs = std::filesystem;

bool is_here(const fs::path& path) {
  const bool here = !data_folder().empty() && fs::exists(path);
  if (!here) MESSAGE("skipped: " << path.filename().string() << " is not here");
  return here;
}

// The centre 513 x 513 posts, or all in a direction that has fewer, of gzipped little-endian int16
// rows from the north.
Raster read_centre(const fs::path& path, uint32_t width, uint32_t height) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
      popen(("gzip -dc '" + path.string() + "'").c_str(), "r"), pclose);
  std::vector<uint8_t> bytes(2 * size_t{width} * height);
  REQUIRE(std::fread(bytes.data(), 1, bytes.size(), pipe.get()) == bytes.size());
  Raster raster;
  raster.width = std::min(width, 513u);
  raster.height = std::min(height, 513u);
  const size_t west = (width - raster.width) / 2, north = (height - raster.height) / 2;
  for (size_t row = raster.height; row-- > 0;) {
    for (size_t column = 0; column < raster.width; ++column) {
      const size_t at = 2 * ((north + row) * width + west + column);
      const auto z = static_cast<int16_t>(bytes[at] | bytes[at + 1] << 8);
      raster.heights.push_back(z == -32768 ? kVoidHeight : z);
    }
  }
  return raster;
}

void check_round_trip(const Source& source, std::optional<Decimal> bound) {
  LatticeOptions options;
  options.max_error = bound;
  const Laid laid = lay_out(source, options);
  const Tin tin =
      simplify(laid.survey, {bound.has_value(), 0, Search::kNormal, false, true, 1, {}, {}});
  Metadata metadata;
  metadata.placement = laid.placement;
  const std::vector<uint8_t> stream = encode(tin, metadata);
  const DecodedTerrain decoded(stream);
  const Verification found = verify(decoded.mesh(), source, bound);
  MESSAGE(found.posts << " posts, " << found.voids << " voids: " << tin.vertices.size()
                      << " vertices, " << stream.size() << " bytes, error "
                      << to_string(found.max_error));
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
  CHECK(found.voids_answered == 0);
  if (bound) CHECK(tin.vertices.size() < found.posts);
}

}  // namespace

TEST_CASE("real rasters keep their bound at every post, voids stay voids" * kSlow) {
  const struct {
    const char* name;
    uint32_t width, height;
  } rasters[] = {{"scottish_borders", 769, 769}, {"sthelens", 327, 468}, {"andorra", 1025, 1025}};
  for (const auto& r : rasters) {
    const fs::path path = data_folder() / (r.name + std::string(".hgt16.gz"));
    if (!is_here(path)) continue;
    CAPTURE(std::string(r.name));
    check_round_trip(read_centre(path, r.width, r.height), Decimal{10, 0});
  }
}

TEST_CASE("packs of real rasters have no cracks and keep their bound" * kSlow) {
  const struct {
    const char* name;
    uint32_t width, height, vertices;
  } rasters[] = {{"scottish_borders", 769, 769, 1000}, {"sthelens", 327, 468, 250}};
  for (const auto& r : rasters) {
    const fs::path path = data_folder() / (r.name + std::string(".hgt16.gz"));
    if (!is_here(path)) continue;
    CAPTURE(std::string(r.name));
    const Raster raster = read_centre(path, r.width, r.height);
    PackOptions options{{}, {}, r.vertices, 0};
    options.lattice.max_error = Decimal{10, 0};
    options.simplify = {true, 0, Search::kFast, false, true, 1, {}, {}};
    const PackFile pack(write_pack(encode_pack(raster, options)));
    const BorderCount count = walk_borders(pack, raster);
    const Verification found = verify(pack, raster, options.lattice.max_error);
    MESSAGE(pack.entries().size() << " tiles, " << pack.bytes() << " bytes, " << count.both
                                  << " places in two tiles");
    CHECK(count.both > 1000);
    CHECK(count.differ == 0);
    CHECK(count.wrong_posts == 0);
    CHECK(found.within_bound);
    CHECK(found.uncovered == 0);
    CHECK(found.voids_answered == 0);
  }
}

TEST_CASE("real files come back exactly, and within a bound" * kSlow) {
  for (const char* name :
       {"srtm_rmnp.asc", "bijou5m.asc", "hugo.asc", "quebec_forest_ground.xyz"}) {
    const fs::path path = data_folder() / "formats" / name;
    if (!is_here(path)) continue;
    CAPTURE(std::string(name));
    const Source source = import_terrain(path.string());
    check_round_trip(source, std::nullopt);
    check_round_trip(source, Decimal{5, 1});
  }
}

}  // namespace microtin::tests
