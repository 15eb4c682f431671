// SPDX-License-Identifier: MIT
// Rasters that are read in rectangles are the same as those read whole.
#include "encoder/terrain/raster_reader.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/raster_scan.hpp"
#include "encoder/terrain/voids.hpp"
#include "tests/support/files.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

void check_same(const Raster& a, const Raster& b) {
  CHECK(a.width == b.width);
  CHECK(a.height == b.height);
  CHECK(a.decimals == b.decimals);
  CHECK(a.heights == b.heights);
  CHECK(a.x.offset == b.x.offset);
  CHECK(a.y.offset == b.y.offset);
  CHECK(a.y.denominator == b.y.denominator);
  CHECK(a.reference.horizontal_epsg == b.reference.horizontal_epsg);
}

// Compares some rectangles.
void check_rectangles(const RasterReader& reader, const Raster& whole) {
  Random random(whole.width);
  for (int i = 0; i < 50; ++i) {
    PostRectangle r{random.below(whole.width), random.below(whole.height), 0, 0};
    r.width = 1 + random.below(whole.width - r.x);
    r.height = 1 + random.below(whole.height - r.y);
    check_same(reader.read(r), crop(whole, r));
  }
}

// Words in lines of any length, some with decimals, some void.
std::string grid_text(uint32_t width, uint32_t height) {
  Random random(7);
  std::ostringstream text;
  text << "ncols " << width << "\nnrows " << height
       << "\nxllcorner 3\nyllcorner 5\ncellsize 0.5\nnodata_value -9999\n";
  for (uint32_t i = 0; i < width * height; ++i) {
    const uint32_t kind = random.below(20);
    if (kind == 0) {
      text << "-9999";
    } else {
      text << static_cast<int>(random.below(2000)) - 1000;
      if (kind < 5) text << '.' << random.below(1000) + 1;
    }
    text << (random.below(9) == 0 ? "\n" : random.below(9) == 0 ? "   " : " ");
  }
  return text.str();
}

std::unique_ptr<ByteSource> in_memory(const std::string& text) {
  return bytes_in_memory({text.begin(), text.end()});
}

std::string error_of(const std::string& text) {
  try {
    open_asc("grid", in_memory(text));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("raster reader: rectangles of an ASCII grid") {
  const std::string text = grid_text(73, 61);
  const Raster whole = import_asc("grid", text);
  CHECK(whole.decimals >= 3);
  check_rectangles(*open_asc("grid", in_memory(text)), whole);
}

TEST_CASE("raster reader: an ASCII grid is checked as a whole, line by line") {
  const std::string text = grid_text(30, 30);
  CHECK(error_of(text + " 7").find("the grid has more numbers than its 900 heights") !=
        std::string::npos);
  const std::string cut = text.substr(0, text.size() / 2);
  CHECK(error_of(cut).find("the grid ends after ") != std::string::npos);
  for (const std::string& wrong : {cut + " x ", text + " 7", cut}) {
    CHECK_THROWS_WITH_AS(import_asc("grid", wrong), error_of(wrong).c_str(), Error);
  }
}

TEST_CASE("raster reader: rectangles of an .hgt file of any size") {
  std::string bytes;
  Random random(3);
  for (int i = 0; i < 2 * 50 * 50; ++i) bytes += static_cast<char>(random.below(256));
  bytes[20] = '\x80';
  bytes[21] = 0;
  const Raster whole = import_hgt("S07W012.hgt", bytes);
  CHECK(whole.heights[49 * 50 + 10] == kVoidHeight);
  check_rectangles(*open_hgt("S07W012.hgt", in_memory(bytes)), whole);
  CHECK_THROWS_AS(open_hgt("S07W012.hgt", in_memory(bytes + "xx")), Error);
}

TEST_CASE("raster reader: small voids are filled alike in every rectangle") {
  for (const VoidKind& kind : void_kinds()) {
    for (const uint32_t largest : {1u, 30u, 500u}) {
      CAPTURE(kind.name);
      CAPTURE(largest);
      Raster whole = rough_raster(90, 80, kind.at);
      const auto filled = with_voids_filled(std::make_unique<RasterInMemory>(whole), largest);
      fill_voids(whole, largest);
      check_rectangles(*filled, whole);
      const RasterScan scanned = scan(*filled, {}, false, {});
      CHECK(scanned.mended.filled == whole.mended.filled);
      CHECK(scanned.voids == void_posts(whole));
      CHECK(scanned.posts + scanned.voids == whole.heights.size());
    }
  }
}

TEST_CASE("raster reader: files that cannot be read in pieces are reported") {
  const TemporaryFolder folder;
  write_file(folder / "points.xyz", {'1', ' ', '2', ' ', '3', '\n'});
  CHECK(std::get<PointCloud>(open_terrain(folder / "points.xyz")).points.size() == 1);
  CHECK_THROWS_WITH_AS(open_terrain("gone.asc"),
                       "gone.asc: cannot be read: No such file or directory", Error);
  std::filesystem::create_symlink("/dev/null", folder / "null.asc");
  CHECK_THROWS_WITH_AS(
      open_terrain(folder / "null.asc"),
      (folder / "null.asc: cannot be read in pieces; copy it into a regular file").c_str(), Error);
}

}  // namespace microtin::tests
