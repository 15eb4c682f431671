// SPDX-License-Identifier: MIT
// Packs: no cracks, every post within its bound, voids kept, whatever the tiles.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "encoder/base/error.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/terrain/fractal.hpp"
#include "microtin/compact.h"
#include "tests/support/border_walk.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

PackFile pack_of(const Raster& raster, const PackOptions& options) {
  return PackFile(write_pack(encode_pack(raster, options)));
}

void check_pack(const Raster& raster, const PackOptions& options) {
  const PackFile pack = pack_of(raster, options);
  CHECK(pack.header().most_vertices <= options.max_vertices);
  const BorderCount count = walk_borders(pack, raster);
  CHECK(count.differ == 0);
  CHECK(count.wrong_posts == 0);
  if (pack.entries().size() > 1) CHECK(count.both > 0);
  const Verification found = verify(pack, raster, options.lattice.max_error);
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
  CHECK(found.voids_answered == 0);
  MESSAGE(tile_columns(pack.grid())
          << " x " << tile_rows(pack.grid()) << " tiles, " << pack.bytes() << " bytes, "
          << count.places << " places on borders, " << count.both << " in two tiles");
}

}  // namespace

TEST_CASE("packs have no cracks, and voids stay voids, on borders too" * kSlow) {
  for (const VoidKind& kind : void_kinds()) {
    CAPTURE(kind.name);
    const Raster raster = rough_raster(61, 53, kind.at);
    check_pack(raster, pack_options(2, 100));
    check_pack(raster, pack_options(4, 40));
  }
}

TEST_CASE("packs: a tile with a few vertices too many is searched longer, and fits") {
  const std::vector<int16_t> heights = fractal_heights(129, 4);
  const Raster raster = raster_of(129, {heights.begin(), heights.end()});
  PackOptions options = pack_options(5, 10000);
  options.simplify.search = Search::kNormal;
  options.tile_size = 64;
  const uint32_t usual = pack_of(raster, options).header().most_vertices;
  options.max_vertices = usual - 1;
  check_pack(raster, options);
  options.max_vertices = usual / 2;
  CHECK_THROWS_AS(pack_of(raster, options), TileTooLarge);
}

TEST_CASE("packs: heights at voids along borders stay, and missing ones are found" * kSlow) {
  const Raster full = rough_raster(61, 53);
  PackOptions options = pack_options(2, 600);
  options.tile_size = 20;
  const std::vector<VoidKind> kinds = {
      {"a row on a border", [](int, int y) { return y == 20; }},
      {"a part of it", [](int x, int y) { return y == 20 && x > 4 && x < 31; }},
      {"one post", [](int x, int y) { return x == 30 && y == 20; }},
      {"a corner of four tiles", [](int x, int y) { return x == 20 && y == 40; }},
      {"a column on a border", [](int x, int) { return x == 40; }},
      {"rows beside a border", [](int, int y) { return y == 19 || y == 21; }},
      {"the row south of it", [](int, int y) { return y == 39; }},
      {"all but a border's row", [](int x, int y) { return x < 21 && y > 20 && y < 41; }},
      {"the first row", [](int, int y) { return y == 0; }},
      {"the last row", [](int, int y) { return y == 52; }},
      {"the last column", [](int x, int) { return x == 60; }}};
  for (const VoidKind& kind : kinds) {
    CAPTURE(kind.name);
    const Raster lacking = rough_raster(61, 53, kind.at);
    const uint64_t voids = static_cast<uint64_t>(
        std::count(lacking.heights.begin(), lacking.heights.end(), kVoidHeight));
    check_pack(lacking, options);
    const PackFile pack = pack_of(lacking, options);
    const Verification kept = verify(pack, lacking, options.lattice.max_error);
    CHECK(kept.voids == voids);
    CHECK(kept.covered == 61 * 53 - voids);
    const Verification missed = verify(pack, full, std::nullopt);
    CHECK(missed.voids == 0);
    CHECK(missed.uncovered == voids);
    CHECK(missed.covered == 61 * 53 - voids);
  }
}

TEST_CASE("packs without a bound keep every post") {
  PackOptions options{{}, {}, 400, 0};
  const Raster raster = rough_raster(50, 70);
  const PackFile pack = pack_of(raster, options);
  CHECK(pack.header().most_vertices <= 400);
  CHECK(pack.grid().width >= 17);
  CHECK(walk_borders(pack, raster).differ == 0);
  const Verification found = verify(pack, raster, Decimal{0, 0});
  CHECK(found.covered == 3500);
  CHECK(found.within_bound);
}

TEST_CASE("packs never below the source are not") {
  PackOptions options = pack_options(6, 150);
  options.lattice.never_below = true;
  const Raster raster = rough_raster(61, 53);
  const PackFile pack = pack_of(raster, options);
  CHECK(verify(pack, raster, options.lattice.max_error).max_below.mantissa == 0);
  CHECK(walk_borders(pack, raster).differ == 0);
}

TEST_CASE("a pack is the same however often it is made") {
  const Raster raster = rough_raster(61, 53, void_kinds()[4].at);
  const auto make = [&] { return write_pack(encode_pack(raster, pack_options(5, 120))); };
  CHECK(make() == make());
}

TEST_CASE("a pack joins to one surface, border vertices once, without gaps") {
  const Raster raster = rough_raster(61, 53);
  const PackFile pack = pack_of(raster, pack_options(5, 120));
  const SurfaceModel model = model_of(pack);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& corners : model.triangles) {
    for (size_t i = 0; i < 3; ++i) ++edges[{corners[i], corners[(i + 1) % 3]}];
  }
  // A closed disc: every edge once in each direction, but those of the outline; Euler's formula.
  uint32_t outline = 0;
  for (const auto& [edge, count] : edges) {
    CHECK(count == 1);
    if (edges.count({edge.second, edge.first}) != 0) continue;
    ++outline;
    const auto &a = model.vertices[edge.first], &b = model.vertices[edge.second];
    const bool on_side =
        (a[0] == b[0] && (a[0] == 0 || a[0] == 60)) || (a[1] == b[1] && (a[1] == 0 || a[1] == 52));
    CHECK(on_side);
  }
  CHECK(model.triangles.size() == 2 * model.vertices.size() - 2 - outline);
}

TEST_CASE("packs: posts that no triangle can hold are refused") {
  const Raster lonely = rough_raster(
      41, 41, [](int x, int y) { return (x > 15 || y > 15) && !(x == 33 && y == 35); });
  CHECK_THROWS_AS(encode_pack(lonely, pack_options(1, 90)), Error);
  CHECK_THROWS_AS(encode_pack(rough_raster(1, 41), pack_options(1, 90)), Error);
  CHECK_THROWS_AS(
      encode_pack(rough_raster(9, 9, [](int, int) { return true; }), pack_options(1, 90)), Error);
}

TEST_CASE("packs: streams state whether their tiles begin at odd positions") {
  PackOptions options = pack_options(5, 400);
  options.tile_size = 15;
  const EncodedPack pack = encode_pack(rough_raster(61, 53), options);
  uint32_t odd = 0;
  for (uint32_t tile = 0; tile < pack.streams.size(); ++tile) {
    const TileBox box = tile_box(pack.content.grid, tile);
    const Contract contract = read_header(pack.streams[tile]).contract;
    CHECK(contract.odd_origin_x == (box.x % 2 == 1));
    CHECK(contract.odd_origin_y == (box.y % 2 == 1));
    odd += contract.odd_origin_x ? 1 : 0;
  }
  CHECK(odd != 0);
}

TEST_CASE("packs: the search for the size of tiles reports its progress") {
  const Raster raster = rough_raster(121, 121);
  PackOptions options = pack_options(6, 150);
  std::vector<double> told;
  options.simplify.progress = Progress([&](double done) { told.push_back(done); });
  const PackPlan plan = plan_pack(RasterInMemory(raster), options);
  const auto counting = [&](double done) { return done > 0.06 && done < plan.planned; };
  CHECK(std::count_if(told.begin(), told.end(), counting) > 3);
}

TEST_CASE("packs: a later version, or a flag of one, is not called broken") {
  const std::vector<uint8_t> bytes =
      write_pack(encode_pack(rough_raster(31, 33), pack_options(6, 60)));
  const std::string unsupported = describe(MICROTIN_STATUS_UNSUPPORTED_VERSION);
  const auto check = [&](size_t at, uint8_t value, bool is_repaired, const std::string& message) {
    std::vector<uint8_t> changed = bytes;
    changed[at] = value;
    if (is_repaired) {
      const size_t end = pack_index_start(PackFile(bytes).header()) - kCheckBytes;
      put_number(changed, end, crc32(0, changed.data(), end), kCheckBytes);
    }
    CAPTURE(at);
    CHECK(is_pack(*bytes_in_memory(changed)));
    CHECK_THROWS_WITH_AS(PackFile{changed}, message.c_str(), Error);
  };
  for (const bool is_repaired : {false, true}) {
    check(4, 128, is_repaired, unsupported);
    for (const uint8_t flag : Bytes{16, 32, 64, 128}) check(5, flag, is_repaired, unsupported);
    check(4, 4, is_repaired,
          "a pack of version 4, and this program reads version 5: encode the terrain again");
  }
  for (const uint8_t flag : Bytes{1, 2, 4, 8}) {
    check(5, flag, true, unsupported);
    check(5, flag, false, describe(MICROTIN_STATUS_CHECKSUM));
  }
}

TEST_CASE("packs: the source's grid and the mean error are noted") {
  const Raster raster = rough_raster(31, 33);
  const PackOptions options = pack_options(6, 60);
  const PackFile pack(write_pack(encode_pack(raster, options)));
  REQUIRE(pack.metadata().grid.has_value());
  CHECK(pack.metadata().grid->columns == 31);
  CHECK(pack.metadata().grid->rows == 33);
  REQUIRE(pack.metadata().accuracy.has_value());
  CHECK(pack.metadata().accuracy->mean_error.mantissa != 0);
}

TEST_CASE("packs: the header has the compact bytes of the largest tile") {
  for (const uint32_t width : {61u, 300u}) {  // narrow tiles, wide ones
    PackOptions options = pack_options(6, 2000);
    options.tile_size = width;
    const PackFile pack(write_pack(encode_pack(rough_raster(width + 1, 33), options)));
    uint32_t most = 0, all = 0;
    for (uint32_t number = 0; number < pack.entries().size(); ++number) {
      const CompactForm form = compact_form(*pack.tile(number));
      CHECK(form.is_narrow == (width < 256));
      CHECK(form.vertices == pack.vertices(number));
      all += form.vertices;
      most = std::max(most, static_cast<uint32_t>(bytes_of(form, 16)));
    }
    CHECK(most != 0);
    CHECK(pack.header().compact_bytes == most);
    CHECK(pack.vertices() == all);
    CHECK(most <= promised_compact_bytes(pack.header().most_vertices, width < 256, 16));
  }
}

TEST_CASE("packs: the header's compact bytes are compared with the tiles") {
  Bytes bytes = write_pack(encode_pack(rough_raster(61, 33), pack_options(6, 200)));
  const uint32_t needed = PackFile(bytes).header().compact_bytes;
  const auto say = [&](uint32_t stated) {
    put_number(bytes, 32, stated, 4);
    repair_checks(bytes);
    PackFile(bytes).expect_as_stated();
  };
  CHECK_NOTHROW(say(needed));
  CHECK_NOTHROW(say(0));  // nothing
  CHECK_NOTHROW(say(needed + 1));
  const std::string message = "takes " + std::to_string(needed) +
                              " bytes in compact form; the header says that a tile takes at most " +
                              std::to_string(needed - 1);
  CHECK_THROWS_WITH_AS(say(needed - 1), doctest::Contains(message.c_str()), Error);
}

TEST_CASE("a stream whose compact form exceeds the macros is not written") {
  const uint32_t promised = MICROTIN_COMPACT_REPEATS(100);
  CHECK_NOTHROW(expect_promised({100, promised, true}));
  CHECK_THROWS_AS(expect_promised({100, promised + 1, true}), Error);
  CHECK_THROWS_WITH_AS(expect_promised({100, promised + 1, false}),
                       doctest::Contains("or make a pack (.mtp)"), Error);
}

TEST_CASE("packs: the header's sums are compared with the tiles") {
  const Bytes good = write_pack(encode_pack(rough_raster(61, 33), pack_options(6, 200)));
  const PackFile pack(good);
  CHECK_NOTHROW(pack.expect_as_stated());
  REQUIRE(pack.metadata().sums.has_value());
  CHECK(pack.metadata().sums->vertices == pack.counted_vertices());
  CHECK(pack.metadata().sums->tiles == pack.entries().size());
  const auto [note, size] = note_in(good, MICROTIN_NOTE_SUMS);
  const auto with = [&](size_t at, uint8_t flipped) {
    Bytes changed = good;
    changed[at] ^= flipped;
    repair_checks(changed);
    return changed;
  };
  for (const auto& [at, message] : {std::pair(note + size - 2, "vertices in all tiles; there are"),
                                    std::pair(note + size - 1, "tiles with terrain; there are")}) {
    CHECK_THROWS_WITH_AS(PackFile(with(at, 1)).expect_as_stated(), doctest::Contains(message),
                         Error);
  }
  // Without the note they are counted.
  const PackFile without(with(note - 3, 128));
  CHECK(without.vertices() == pack.vertices());
  CHECK_NOTHROW(without.expect_as_stated());
}

TEST_CASE("packs: bounds of the index and of the header are compared with the tiles") {
  const Bytes good = write_pack(encode_pack(rough_raster(61, 33), pack_options(6, 200)));
  const PackFile pack(good);
  const auto index = static_cast<size_t>(pack_entry_start(pack.header(), 0));
  const IndexEntry entry = pack.entries()[0];
  const auto check = [&](size_t at, int height, const char* message) {
    Bytes changed = good;
    put_number(changed, at, static_cast<uint16_t>(height), 2);
    repair_checks(changed);
    if (message == nullptr) {
      CHECK_NOTHROW(PackFile(changed).expect_as_stated());
    } else {
      CHECK_THROWS_WITH_AS(PackFile(changed).expect_as_stated(), doctest::Contains(message), Error);
    }
  };
  check(index + 12, entry.lowest - 1, nullptr);
  check(index + 12, entry.lowest + 1, "tile 0: has heights");
  check(index + 14, entry.highest + 1, nullptr);
  check(index + 14, entry.highest - 1, "those of its entry");
  check(14, pack.header().lowest - 1, nullptr);
  check(14, pack.header().lowest + 1, "those of the header");
  check(16, pack.header().highest + 1, nullptr);
  check(16, pack.header().highest - 1, "those of the header");
}

TEST_CASE("packs: a tile that takes more in compact form than is promised is too large") {
  const uint32_t vertices = 100;
  TileSummary tile;
  CHECK(fits(tile, vertices));  // without terrain
  const uint32_t promised = MICROTIN_COMPACT_REPEATS(vertices);
  tile.compact = CompactForm{vertices, promised, true};
  CHECK(fits(tile, vertices));
  tile.compact->repeats = promised + 1;
  CHECK(!fits(tile, vertices));
  tile.compact->vertices = vertices - 20;  // within the memory of a slot for 100
  CHECK(fits(tile, vertices));
  const PackOptions options{{}, {}, 700, 0, 600};
  CHECK(most_vertices(options, {1000, 1000, 255, 255}) == 700);
  CHECK(most_vertices(options, {1000, 1000, 256, 10}) == 600);
  CHECK(most_vertices(options, {1000, 1000, 10, 256}) == 600);
  for (const uint32_t ram : {20000u, 65536u}) {
    for (const bool is_narrow : {false, true}) {
      const uint32_t most = vertices_for_ram(ram, is_narrow);
      CHECK(pack_ram(most, promised_compact_bytes(most, is_narrow, 16)) <= ram);
      CHECK(pack_ram(most + 1, promised_compact_bytes(most + 1, is_narrow, 16)) > ram);
    }
  }
}

TEST_CASE("packs: no larger tiles would fit, though the roughest does not grow as all do") {
  Raster raster = rough_raster(97, 97);
  for (uint32_t y = 0; y < raster.height; ++y) {  // rough in a corner alone
    for (uint32_t x = 0; x < raster.width; ++x) {
      if (x > 20 || y > 20) raster.heights[std::size_t{y} * raster.width + x] = 7;
    }
  }
  for (const uint32_t vertices : {120u, 160u, 240u}) {
    CAPTURE(vertices);
    PackOptions options = pack_options(4, vertices);
    const PackContent pack = encode_pack(raster, options).content;
    const uint32_t pieces = tile_columns(pack.grid);
    if (pieces == 1) continue;
    options.tile_size = (96 + pieces - 2) / (pieces - 1);
    CHECK_THROWS_AS(encode_pack(raster, options), TileTooLarge);
  }
}

TEST_CASE("packs: a changed byte is noticed") {
  const Raster raster = rough_raster(31, 33);
  const std::vector<uint8_t> bytes = write_pack(encode_pack(raster, pack_options(6, 60)));
  const auto read_all = [](const std::vector<uint8_t>& file) {
    const PackFile pack(file);
    model_of(pack);
  };
  CHECK_NOTHROW(read_all(bytes));
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::vector<uint8_t> changed = bytes;
    changed[i] ^= static_cast<uint8_t>(1u << i % 8);
    CAPTURE(i);
    CHECK_THROWS_AS(read_all(changed), Error);
    CHECK_THROWS_AS(read_all({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(i)}),
                    Error);
  }
}

}  // namespace microtin::tests
