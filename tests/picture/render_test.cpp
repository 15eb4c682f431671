// SPDX-License-Identifier: MIT
// Pictures of terrains.
#include "encoder/picture/render.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "encoder/base/error.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/slow.hpp"

#define STBI_ONLY_PNG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

using namespace microtin;
using namespace microtin::tests;

namespace {

struct Picture {
  explicit Picture(const std::vector<uint8_t>& png)
      : pixels(stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height,
                                     nullptr, 4),
               stbi_image_free) {
    REQUIRE(pixels);
  }

  std::array<int, 4> at(int column, int row) const {
    const uint8_t* p = pixels.get() + 4 * (row * width + column);
    return {p[0], p[1], p[2], p[3]};
  }

  int width = 0, height = 0;
  std::unique_ptr<uint8_t, void (*)(void*)> pixels;
};

Portrait portrait(const std::vector<Vertex>& vertices, Metadata metadata = {}) {
  const std::vector<uint8_t> stream = encode(Tin{vertices, {}}, metadata);
  Portrait all;
  all.model = model_of(DecodedTerrain(stream).mesh());
  all.metadata = std::move(metadata);
  all.vertices = vertices.size();
  all.bytes = stream.size();
  return all;
}

// Where the map begins in a picture 200 pixels wide, and how wide it is.
constexpr int kLeft = 11, kTop = 30, kWidth = 178;

bool is_grey(const std::array<int, 4>& colour) {
  return std::abs(colour[0] - colour[2]) < 6;
}

bool is_blue(const std::array<int, 4>& colour) {
  return colour[2] > colour[0] + 40;
}

bool is_red(const std::array<int, 4>& colour) {
  return colour[0] > colour[2] + 40;
}

// How much pixels on both sides of borders between tiles differ, on the mean, in those of all
// neighbours: of a raster of 128 steps that is drawn without lines.
double border_contrast(const Portrait& portrait, uint32_t tile_size) {
  const Picture picture(render_png(portrait, 1046));
  constexpr int kFirst = 14, kSize = 1018;  // of the map
  const auto jump = [&](int column) {
    double sum = 0;
    for (int row = 60; row < kSize; ++row) {
      sum += std::abs(picture.at(column + 3, row)[0] - picture.at(column - 3, row)[0]);
    }
    return sum;
  };
  double inside = 0, across = 0;
  int borders = 0;
  for (int column = kFirst + 20; column < kFirst + kSize - 20; ++column) inside += jump(column);
  for (uint32_t border = tile_size; border < 128; border += tile_size, ++borders) {
    const int column = kFirst + static_cast<int>(kSize * border / 128);
    double most = 0;
    for (int near = -3; near <= 3; ++near) most = std::max(most, jump(column + near));
    across += most;
  }
  return across / borders / (inside / (kSize - 40));
}

}  // namespace

TEST_CASE("render: a picture shows the terrain, and hatches what is around it") {
  const Picture picture(render_png(portrait({{10, 10, 0}, {210, 10, 50}, {10, 110, 20}}), 200));
  CHECK(picture.width == 200);
  CHECK(picture.height > kTop + kWidth / 2 + 30);
  CHECK(!is_grey(picture.at(kLeft + 10, kTop + 60)));
  CHECK(is_grey(picture.at(kLeft + kWidth - 4, kTop + 3)));
  CHECK(picture.at(2, 2) == std::array<int, 4>{255, 255, 255, 255});
}

TEST_CASE("render: slopes towards the north-west are lighter than those away from it") {
  const Picture picture(render_png(
      portrait(
          {{0, 0, 0}, {100, 0, 100}, {200, 0, 0}, {0, 200, 0}, {100, 200, 100}, {200, 200, 0}}),
      200));
  CHECK(picture.at(kLeft + 40, kTop + 90)[0] > picture.at(kLeft + kWidth - 40, kTop + 90)[0] + 20);
}

TEST_CASE("render: only triangles wholly at the noted level are water") {
  const std::vector<Vertex> flat = {{0, 0, 5}, {100, 0, 5}, {0, 100, 5}, {100, 100, 9}};
  const auto colour = [&](std::optional<Decimal> level, int column, int row) {
    Metadata metadata;
    metadata.water_level = level;
    metadata.placement.z = {-10, 5, 10};  // half units, from -1 on
    return Picture(render_png(portrait(flat, metadata), 200)).at(kLeft + column, kTop + row);
  };
  CHECK(!is_blue(colour(std::nullopt, 5, 150)));
  CHECK(is_blue(colour(Decimal{15, 1}, 5, 150)));
  CHECK(!is_blue(colour(Decimal{15, 1}, 160, 20)));
  CHECK(!is_blue(colour(Decimal{2, 0}, 5, 150)));
  CHECK(!is_blue(colour(Decimal{16, 1}, 5, 150)));  // no step of the lattice
}

TEST_CASE("render: errors are blue where the terrain is too low, red where too high") {
  const Portrait flat = portrait({{0, 0, 5}, {100, 0, 5}, {0, 100, 5}, {100, 100, 5}});
  const Comparison comparison{{50, 50}, [](const PostVisitor& visit) {
                                visit(10, 90, 0, -3);
                                visit(90, 90, 0, 2);
                                visit(90, 10, 0, 0);
                                Verification found;
                                found.max_error = {3, 0};
                                return found;
                              }};
  const Picture picture(render_png(flat, 200, &comparison));
  const int map = picture.height / 2 + 15;  // the second one, below
  CHECK(is_blue(picture.at(kLeft + 10, map + 10)));
  CHECK(is_red(picture.at(kLeft + kWidth - 10, map + 10)));
  CHECK(is_grey(picture.at(kLeft + kWidth - 10, map + kWidth - 20)));
  CHECK(is_grey(picture.at(kLeft + 10, map + kWidth - 20)));
  const Picture wide(render_png(flat, 900, &comparison));
  CHECK(wide.height < 600);  // beside
}

TEST_CASE("render: the map of errors has coordinates, too") {
  Portrait flat = portrait({{0, 0, 5}, {100, 0, 5}, {0, 100, 5}, {100, 100, 5}});
  const Comparison comparison{{50, 50}, [](const PostVisitor& visit) {
                                visit(50, 50, 0, 0);
                                return Verification();
                              }};
  const auto inked_below = [&](const Picture& picture) {  // where numbers left of that map are
    int inked = 0;
    for (int row = picture.height / 2 + 15; row < picture.height - 60; ++row) {
      for (int column = 0; column < 20; ++column) inked += picture.at(column, row)[0] < 128;
    }
    return inked;
  };
  flat.coordinates = true;
  const Picture above(render_png(flat, 400)), both(render_png(flat, 400, &comparison));
  CHECK(inked_below(both) > 30);
  // Numbers and ticks above the second map need room below the first.
  CHECK(both.height > 2 * (above.height - 42) + 10);
  const Picture beside(render_png(flat, 900, &comparison));
  int ticks = 0;
  for (int column = 460; column < 890; ++column) ticks += beside.at(column, 44)[0] < 128;
  CHECK(ticks > 2);
}

TEST_CASE("render: heights below zero are sea with that palette") {
  Portrait shore = portrait({{0, 0, -50}, {100, 0, 50}, {0, 100, -50}, {100, 100, 50}});
  CHECK(!is_blue(Picture(render_png(shore, 200)).at(kLeft + 20, kTop + 90)));
  shore.palette = PaletteKind::kSea;
  const Picture picture(render_png(shore, 200));
  CHECK(is_blue(picture.at(kLeft + 20, kTop + 90)));
  CHECK(!is_blue(picture.at(kLeft + kWidth - 60, kTop + 90)));
  const Palette deep(PaletteKind::kSea, -4000, -100);
  CHECK(deep.at(0).b > deep.at(0).r);
  CHECK(deep.at(1).b > deep.at(1).r);
  CHECK(deep.at(1).r > deep.at(0).r);
}

TEST_CASE("render: posts between the places of the lattice leave no gaps in the error map") {
  const Portrait flat = portrait({{0, 0, 5}, {40, 0, 5}, {0, 40, 5}, {40, 40, 5}});
  // Steps of the lattice for a post: places are rounded, so that some are further apart.
  for (const double cell : {0.3, 1.0, 1.4, 2.5, 4.0}) {
    const Comparison comparison{{cell, cell}, [cell](const PostVisitor& visit) {
                                  const auto posts = static_cast<int>(40 / cell);
                                  for (int y = 0; y <= posts; ++y) {
                                    for (int x = 0; x <= posts; ++x) {
                                      visit(std::lround(x * cell), std::lround(y * cell), 0, 1);
                                    }
                                  }
                                  Verification found;
                                  found.max_error = {1, 0};
                                  return found;
                                }};
    for (const uint32_t width : {200u, 333u}) {
      const Picture picture(render_png(flat, width, &comparison));
      int gaps = 0;
      for (int row = 0; row < picture.width - 30; ++row) {
        for (int column = 0; column < picture.width - 30; ++column) {
          gaps += !is_red(picture.at(kLeft + 2 + column, picture.height / 2 + 18 + row));
        }
      }
      CHECK_MESSAGE(gaps == 0, cell);
    }
  }
}

TEST_CASE("render: small voids in snow are darker than snow and than no error") {
  Portrait snow = portrait({{0, 0, 0},
                            {0, 100, 500},
                            {60, 100, 500},
                            {60, 0, 500},
                            {100, 100, 500},
                            {100, 0, 500},
                            {80, 50, 500},
                            {81, 50, 500},
                            {80, 51, 500}});
  auto& triangles = snow.model.triangles;
  const auto is_void = [&](const std::array<uint32_t, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](uint32_t v) {
      const auto& at = snow.model.vertices[v];
      return at[0] >= 80 && at[0] <= 81 && at[1] >= 50 && at[1] <= 51;
    });
  };
  const size_t before = triangles.size();
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), is_void), triangles.end());
  CHECK(triangles.size() + 1 == before);
  snow.mesh = false;
  const Picture picture(render_png(snow, 1000));
  const int left = 13 + 974 * 80 / 100, top = picture.height - 47 - 13 - 974 * 51 / 100;
  int darkest = 255;
  for (int row = -9; row < 19; ++row) {
    for (int column = 1; column < 8; ++column) {
      darkest = std::min(darkest, picture.at(left + column, top + row)[0]);
    }
  }
  CHECK(darkest < 190);
  CHECK(picture.at(left - 40, top)[0] > 225);
}

TEST_CASE("render: the sea's colours show its heights also without land") {
  const Palette deep(PaletteKind::kSea, -52.7, -51.1);
  CHECK(deep.at(1).r > deep.at(0.5).r + 0.1);
  CHECK(deep.at(0.5).r > deep.at(0).r + 0.1);
}

TEST_CASE("render: a plain at zero has one colour, however its heights are rounded") {
  const Palette shore(PaletteKind::kSea, -18, 2070);
  for (const double rounding : {-1e-15, 0.0, 1e-15}) {
    const Colour plain = shore.at(18.0 / 2088 * (1 + rounding));
    CHECK_MESSAGE(plain.g > plain.b, rounding);
  }
  CHECK(shore.at(17.9 / 2088).b > shore.at(17.9 / 2088).g);
}

// Tiles share their borders' vertices, and these the light of both sides: without that the contrast
// is 3 and more. Borders that are fitted to noise alone are somewhat rougher than the rest.
TEST_CASE("render: the shading does not jump at borders of tiles" * kSlow) {
  Random random(17);
  const auto noise = [&](int64_t most) {
    return static_cast<int64_t>(random.below(static_cast<uint32_t>(2 * most + 1))) - most;
  };
  for (const int64_t bound : {20, 600}) {  // smooth ground, and noise that borders follow alone
    Raster raster;
    raster.width = raster.height = 129;
    for (int y = 0; y < 129; ++y) {
      for (int x = 0; x < 129; ++x) {
        raster.heights.push_back(std::lround(4000 * (std::sin(x * 0.07) + std::cos(y * 0.06))) +
                                 (bound > 20 ? noise(bound) : 0));
      }
    }
    PackOptions options = pack_options(bound, 400);
    options.tile_size = 32;
    const PackFile pack(write_pack(encode_pack(raster, options)));
    REQUIRE(tile_columns(pack.grid()) > 2);
    Portrait all;
    all.model = pack::model_of(pack);
    all.metadata = pack.metadata();
    all.mesh = false;
    const double contrast = border_contrast(all, pack.grid().width);
    CHECK_MESSAGE(contrast < 2, "bound " << bound << ": " << contrast);
  }
}

TEST_CASE("render: triangles are drawn on the right, or not at all") {
  Portrait flat = portrait({{0, 0, 5}, {100, 0, 5}, {0, 100, 5}, {100, 100, 5}, {90, 50, 5}});
  const Picture with(render_png(flat, 200));
  flat.mesh = false;
  const Picture without(render_png(flat, 200));
  const int column = kLeft + kWidth * 90 / 100, row = kTop + kWidth / 2;
  CHECK(with.at(column, row)[0] < without.at(column, row)[0] - 20);
  CHECK(without.at(column, row) == without.at(kLeft + 20, row));
}

TEST_CASE("render: a world file has the position of the map's pixels") {
  Metadata metadata;
  metadata.placement = {{1000, 2, 1}, {5000, 2, 1}, {0, 1, 1}};
  const Portrait square = portrait({{0, 0, 0}, {178, 0, 0}, {0, 178, 0}, {178, 178, 0}}, metadata);
  // A pixel is a step of 2; the map's upper left corner is 1000, 5356.
  const std::string x = std::to_string(1000 - 2 * kLeft + 1),
                    y = std::to_string(5356 + 2 * kTop - 1);
  CHECK(world_file(square, 200, false) == "2\n0\n0\n-2\n" + x + "\n" + y + "\n");
}

TEST_CASE("render: any shape and width" * kSlow) {
  const std::vector<std::vector<Vertex>> shapes = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                   {{0, 0, 0}, {1, 0, 0}, {0, 60000, 0}},
                                                   {{0, 0, -32768}, {60000, 0, 0}, {0, 1, 32767}}};
  for (const auto& shape : shapes) {
    for (const uint32_t width : {kNarrowest, 333u, 1500u}) {
      const Comparison comparison{{1, 1}, [](const PostVisitor& visit) {
                                    visit(0, 0, 0, 0);
                                    return Verification();
                                  }};
      Portrait full = portrait(shape);
      full.coordinates = full.north_arrow = full.contours = true;
      full.title = "Title";
      CHECK(Picture(render_png(full, width, &comparison)).width == static_cast<int>(width));
      CHECK(Picture(render_png(portrait(shape), width)).width == static_cast<int>(width));
      CHECK(Picture(render_png(portrait(shape), width, &comparison)).width ==
            static_cast<int>(width));
    }
  }
}

TEST_CASE("render: sizes out of range are refused") {
  const Portrait triangle = portrait({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const uint32_t width : {0u, kNarrowest - 1, kWidest + 1}) {
    CHECK_THROWS_WITH_AS(render_png(triangle, width), "a picture is 200 to 8192 pixels wide",
                         Error);
  }
  CHECK_THROWS_WITH_AS(render_png(Portrait(), 200),
                       "there is nothing to draw; the terrain needs a triangle", Error);
  Portrait titled = triangle;
  titled.title = "a\xE2\x82\xAC";
  CHECK_THROWS_WITH_AS(render_png(titled, 200),
                       "the title has \"\xE2\x82\xAC\", which cannot be drawn; use Latin letters "
                       "with Western accents, digits and common signs",
                       Error);
}

TEST_CASE("render: a page contains the file, a file that is too large is an error with its size") {
  const Portrait triangle = portrait({{0, 0, 0}, {20, 0, 5}, {0, 20, 9}});
  const auto page = [&](const std::string& file) {
    try {
      return render_page(triangle, "a < b", file, {1, 2, 3});
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  if (viewer_page().empty()) {
    CHECK(page("abc").find("without the page that shows terrains: " +
                           std::string(viewer_absence())) != std::string::npos);
    return;
  }
  CHECK(page("terrain").find(">dGVycmFpbg==<") != std::string::npos);
  CHECK(page("terrain").find("<title>a &#60; b</title>") != std::string::npos);
  CHECK(page(std::string(kLargestPage + 1, 'a')) ==
        "it has 100000001 bytes; a page holds at most 100000000");
}
