// SPDX-License-Identifier: MIT
// Every number and note that the commands say of a product, for every kind of product. A field
// without a row fails.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/join.hpp"
#include "tests/support/products.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
using namespace microtin::tests::products;

namespace {

// The names of `info --json`, without notes.
Names info_names(bool is_pack) {
  const Names xyz = {"x", "y", "z"};
  Names names = {"kind",
                 "vertices",
                 "bytes",
                 "workspace_bytes_16",
                 "workspace_bytes_32",
                 "extent.west",
                 "extent.south",
                 "extent.east",
                 "extent.north",
                 "size.x",
                 "size.y",
                 "heights.lowest",
                 "heights.highest",
                 "units.horizontal",
                 "units.vertical"};
  names = united(names, kErrors);
  names = united(names, with_prefix("steps.", xyz));
  names = united(names, with_prefix("offsets.", xyz));
  names = united(names, axes("axes.", xyz));
  if (!is_pack) {
    return united(names, {"stream_version", "compact_bytes", "triangles", "void_triangles",
                          "bits_per_vertex", "phases", "max_degree", "coding"});
  }
  return united(names, {"pack_version", "columns", "rows", "tile_width", "tile_height", "x_max",
                        "y_max", "max_tile_vertices", "max_compact_bytes", "device_memory",
                        "workspace_bytes_4_compact_tiles", "tiles"});
}

// The names of `verify --json`.
Names verify_names(bool is_raster) {
  Names names = united(kErrors, {"covered", "uncovered", "max_below", "max_above"});
  if (!is_raster) return united(names, {"points"});
  return united(names, {"posts", "voids", "voids_answered"});
}

// Compares a text with one in which names in braces stand for numbers.
void expect_text(const std::string& text, const std::string& wanted, const Fields& truth) {
  size_t at = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] != '{') {
      REQUIRE_MESSAGE(text.substr(at, 1) == wanted.substr(i, 1),
                      (text.substr(0, at) + " <--> " + wanted.substr(i)));
      ++at;
      continue;
    }
    const std::string name = wanted.substr(i + 1, wanted.find('}', i) - i - 1);
    const size_t end = std::min(text.find_first_not_of("-+.e0123456789", at), text.size());
    const std::string number = text.substr(at, end - at);
    const std::string& real = truth.at(name);
    CHECK_MESSAGE((real == kAny || is_same(number, real)), join({name, ": ", number}));
    at = end;
    i += name.size() + 1;
  }
  CHECK(text.substr(at) == "");
}

// What encode and merge say, but for warnings.
std::string report_text(const Product& product, const Made& made) {
  const Fields& truth = made.truth().fields();
  const auto moved = [&](const std::string& name) -> std::string {
    return truth.at(name) == "0" ? ", exact" : ", values move by up to {" + name + "}";
  };
  const bool is_moved = made.truth().moves_points();
  std::string text = product.is_raster ? "source: {posts} posts" : "source: {points} points";
  if (!made.terrain().voids.empty()) text += ", {voids} void posts";
  if (made.notes().count("water_level") != 0)
    text += ", {water} of the posts were void and are water";
  if (made.notes().count("classes") != 0)
    text += ", taken: class 2 (200), 5 (200); left out: class 7 (1)";
  text += '\n';
  if (!product.is_raster || !product.is_pack) {
    text += "step of x and y: {xy_step}" + std::string(product.is_raster ? " (in posts)" : "") +
            (is_moved ? moved("xy_displacement") : ", exact") + '\n';
  }
  const std::string z =
      "step of z: {z_step}" + (product.is_pack ? "" : moved("z_displacement")) + '\n';
  const std::string merged =
      made.notes().count("duplicates") == 0
          ? ""
          : "merged: {merged} shared a place with another; the highest stands for all there\n";
  std::string below = "below the source: at most {max_below}, above: at most {max_above}\n";
  if (product.is_raster) {
    below +=
        "everywhere, from the bilinear surface of the posts: at most {everywhere.max_below} below, "
        "at most {everywhere.max_above} above\n";
  }
  const std::string truly =
      !is_moved
          ? ""
          : "... where the points truly lie: at most "
            "{true_places.max_error}, rms {true_places.rms_error}, "
            "mean {true_places.mean_error} (the bound holds there, too); below "
            "the points: at most {true_places.max_below}, above: at most {true_places.max_above}\n";
  text += product.is_pack
              ? merged + z +
                    "pack: {columns} x {rows} tiles of {tile_width} x {tile_height} steps, "
                    "{vertices} vertices, at most {max_tile_vertices} in a tile, {bytes} bytes\n"
              : z + merged +
                    "stream: {vertices} vertices, {bytes} bytes, {bits_per_vertex} bits/vertex\n";
  text +=
      "error: at most {max_error}, rms {rms_error}, mean {mean_error} (requested: at most "
      "{bound})\n";
  text += product.is_pack ? below + truly : truly + below;
  if (product.is_merged) return text.substr(text.find('\n') + 1);
  return text + "units: x and y " + truth.at("units.horizontal") + ", z " +
         truth.at("units.vertical") + "\n";
}

}  // namespace

TEST_CASE("reports: every field of info is true of every kind of product" * kSlow) {
  for_each_product([](const Product& product, const Made& made) {
    Fields said = fields_of(made.info());
    const nlohmann::json tiles = nlohmann::json::parse(made.info())["tiles"];
    if (product.is_pack) said["tiles"] = std::to_string(tiles.size());
    expect("info", said, made.truth().fields(), united(info_names(product.is_pack), made.notes()));
  });
}

TEST_CASE("reports: every field of verify is true of every kind of product" * kSlow) {
  for_each_product([](const Product& product, const Made& made) {
    Names names = verify_names(product.is_raster);
    if (made.truth().moves_points()) {
      names =
          united(names, with_prefix("true_places.", united(kErrors, {"max_below", "max_above"})));
    }
    for (const char* name : {"classes"}) {
      if (made.notes().count(name) != 0) names.insert(name);
    }
    if (made.notes().count("water_level") != 0) names.insert("water_moved");
    const Fields said = fields_of(made.verify());
    if (product.is_raster) {  // everywhere_test.cpp compares these with samples
      names = united(names, with_prefix("everywhere.", {"max_below", "max_above"}));
      for (const char* name : {"everywhere.max_below", "everywhere.max_above"}) {
        made.truth().fields()[name] = kAny;
      }
      CHECK(std::stod(said.at("everywhere.max_below")) >= std::stod(said.at("max_below")));
    }
    expect("verify", said, made.truth().fields(), names);
  });
}

TEST_CASE("reports: encode and merge print true numbers for every kind of product" * kSlow) {
  for_each_product([](const Product& product, const Made& made) {
    std::istringstream lines(made.text());
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      if (line.find("warning: ") != 0) text += line + '\n';
    }
    made.truth().fields()["water"] = std::to_string(20);
    made.truth().fields()["merged"] = "1";
    expect_text(text, report_text(product, made), made.truth().fields());
  });
}
