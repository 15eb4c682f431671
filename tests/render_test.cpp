// Pictures of terrains.
#include "encoder/render.hpp"

#include <doctest/doctest.h>

#include <array>
#include <memory>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"

#define STBI_ONLY_PNG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

using namespace microtin;

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

DecodedTerrain terrain(const std::vector<Vertex>& vertices) {
  return DecodedTerrain(encode(Tin{vertices, {}}, Metadata()));
}

}  // namespace

TEST_CASE("render: a picture shows the terrain and nothing around it") {
  const DecodedTerrain slope = terrain({{10, 10, 0}, {210, 10, 50}, {10, 110, 20}});
  const Picture picture(render_png(slope.mesh(), 100));
  CHECK(picture.width == 100);
  CHECK(picture.height == 50);
  CHECK(picture.at(2, 47)[3] == 255);
  CHECK(picture.at(97, 2)[3] == 0);
}

TEST_CASE("render: slopes towards the north-west are lighter than those away from it") {
  const DecodedTerrain ridge =
      terrain({{0, 0, 0}, {100, 0, 100}, {200, 0, 0}, {0, 200, 0}, {100, 200, 100}, {200, 200, 0}});
  const Picture picture(render_png(ridge.mesh(), 64));
  CHECK(picture.at(10, 32)[0] > picture.at(53, 32)[0] + 20);
}

TEST_CASE("render: level ground at the lowest height is water") {
  const DecodedTerrain sea = terrain({{0, 0, 5}, {100, 0, 5}, {0, 100, 5}});
  const std::array<int, 4> colour = Picture(render_png(sea.mesh(), 20)).at(3, 15);
  CHECK(colour[2] > colour[0]);
}

TEST_CASE("render: sizes out of range are refused") {
  const DecodedTerrain tower = terrain({{0, 0, 0}, {1, 0, 0}, {0, 60000, 0}});
  CHECK_THROWS_AS(render_png(tower.mesh(), 0), Error);
  CHECK_THROWS_AS(render_png(tower.mesh(), 100), Error);
}
