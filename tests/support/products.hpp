// SPDX-License-Identifier: MIT
// A product of every kind: a stream or a pack, of posts or of points, and a pack from shards; and
// what is true of it, measured by the heights of the file that was written.
#ifndef MICROTIN_TESTS_SUPPORT_PRODUCTS_HPP
#define MICROTIN_TESTS_SUPPORT_PRODUCTS_HPP

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "microtin/pack.h"
#include "microtin/surface.hpp"
#include "tests/support/join.hpp"
#include "tests/support/members.hpp"
#include "tests/support/session.hpp"

namespace microtin::tests::products {

namespace library = microtin::encoder;

// Values by their names, nested ones as "extent.west".
using Fields = std::map<std::string, std::string>;

constexpr const char* kAny = "any";  // is there, and is checked elsewhere

inline std::string text_of(double number) {
  std::ostringstream text;
  text.precision(12);
  text << number;
  return text.str();
}

inline bool is_same(const std::string& a, const std::string& b) {
  char* end = nullptr;
  const double number = std::strtod(a.c_str(), &end);
  const bool is_number = !a.empty() && *end == 0;
  const double other = std::strtod(b.c_str(), &end);
  if (!is_number || b.empty() || *end != 0) return a == b;
  return std::abs(number - other) <= 1e-4 + 1e-5 * std::abs(other);
}

// The door says of all the names what is true, and nothing of others.
inline void expect(const std::string& door, const Fields& said, const Fields& truth,
                   const Names& names) {
  CAPTURE(door);
  Names found;
  for (const auto& field : said) found.insert(field.first);
  CHECK(microtin::tests::text_of(found) == microtin::tests::text_of(names));
  for (const std::string& name : names) {
    if (said.count(name) == 0) continue;
    REQUIRE_MESSAGE(truth.count(name) != 0, ("no row for " + name));
    const std::string &value = said.at(name), &real = truth.at(name);
    CHECK_MESSAGE((real == kAny || is_same(value, real)),
                  join({name, ": ", value, ", not ", real}));
  }
}

// The members of objects within objects are named by their path, "units.vertical".
inline Fields fields_of(const std::string& text) {
  Fields fields;
  std::vector<std::pair<std::string, nlohmann::json>> open = {{"", nlohmann::json::parse(text)}};
  while (!open.empty()) {
    const auto [name, json] = std::move(open.back());
    open.pop_back();
    if (!json.is_object()) {
      fields[name] = json.is_string() ? json.get<std::string>() : json.dump();
      continue;
    }
    const std::string before = name.empty() ? name : name + '.';
    for (const auto& member : json.items()) {
      open.emplace_back(before + member.key(), member.value());
    }
  }
  return fields;
}

struct Sample {
  double x, y, z;
};

// What a terrain is made of, as text files and as numbers.
struct Terrain {
  std::string file;
  std::vector<Sample> samples, voids;
  bool is_raster = false;
};

constexpr int kColumns = 40, kRows = 30;

inline double hill(double x, double y) {
  return 60 + 25 * std::sin(x * 0.31) * std::cos(y * 0.23) + std::fmod(7 * x + 3 * y, 3);
}

inline double rounded(double number) {
  return static_cast<double>(std::lround(10 * number)) / 10;
}

// Cells of 2 around (500, 700); voids in the south-east.
inline Terrain grid(const Session& session, const std::string& file) {
  Terrain terrain{file, {}, {}, true};
  std::string text =
      "ncols 40\nnrows 30\nxllcenter 500\nyllcenter 700\ncellsize 2\nnodata_value -9\n";
  for (int row = kRows - 1; row >= 0; --row) {
    for (int column = 0; column < kColumns; ++column) {
      const double z = rounded(hill(column, row));
      const bool is_void = row < 4 && column > 34;
      (is_void ? terrain.voids : terrain.samples)
          .push_back({500.0 + 2 * column, 700.0 + 2 * row, z});
      text += (is_void ? "-9" : text_of(z)) + (column < kColumns - 1 ? ' ' : '\n');
    }
  }
  session.write(file, text);
  return terrain;
}

// Thousandths over 200 units, which 16 bits do not hold.
inline Terrain cloud(const Session& session, const std::string& file) {
  Terrain terrain{file, {}, {}, false};
  std::string text;
  for (int i = 0; i < 400; ++i) {
    const int column = i % 20, row = i / 20;
    const double x = 10 * column + (i * 7919 % 4993) / 1000.0, y = 10 * row + (i * 97 % 8) / 1000.0;
    terrain.samples.push_back({x, y, rounded(hill(column, row))});
    char line[64];
    std::snprintf(line, sizeof line, "%.3f %.3f %.1f\n", x, y, terrain.samples.back().z);
    text += line;
  }
  session.write(file, text);
  return terrain;
}

inline void append(std::string& bytes, int64_t number, int width) {
  for (int i = 0; i < width; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
}

// The points of cloud() as LAS 1.2, of classes 2 and 5, and a point of class 7 far away.
inline Terrain scan(const Session& session, const std::string& file) {
  Terrain terrain = cloud(session, "same.xyz");
  terrain.file = file;
  std::string las(227, '\0');
  las.replace(0, 4, "LASF");
  las[24] = 1;
  las[25] = 2;
  las[94] = las[96] = '\xE3';
  las[105] = 20;
  las[107] = '\x91';  // 401
  las[108] = 1;
  const double scale = 0.001;
  for (const size_t axis : {0u, 1u, 2u}) std::memcpy(&las[131 + 8 * axis], &scale, 8);
  for (size_t i = 0; i <= 400; ++i) {
    const Sample& sample = terrain.samples[i % 400];
    for (const double value : {sample.x, sample.y, sample.z}) {
      append(las, std::lround(1000 * value) + (i == 400 ? 100 : 0), 4);
    }
    append(las, 0, 3);
    append(las, i == 400 ? 7 : i % 2 == 0 ? 2 : 5, 1);
    append(las, 0, 4);
  }
  session.write(file, las);
  return terrain;
}

// --- What is true --------------------------------------------------------------------------------

struct Errors {
  double most = 0, below = 0, over = 0, squares = 0, sum = 0, count = 0;

  void add(double above, double weight) {
    most = std::max(most, std::abs(above));
    below = std::max(below, -above);
    over = std::max(over, above);
    squares += weight * above * above;
    sum += weight * above;
    count += weight;
  }

  void tell(const std::string& prefix, Fields& truth) const {
    truth[prefix + "max_error"] = text_of(most);
    truth[prefix + "max_below"] = text_of(below);
    truth[prefix + "max_above"] = text_of(over);
    truth[prefix + "rms_error"] = text_of(std::sqrt(squares / count));
    truth[prefix + "mean_error"] = text_of(sum / count);
  }
};

inline void add_axis(const std::string& name, const microtin_axis& axis, Fields& truth) {
  truth[name + ".offset"] = std::to_string(axis.offset);
  truth[name + ".numerator"] = std::to_string(axis.numerator);
  truth[name + ".denominator"] = std::to_string(axis.denominator);
}

class Truth {
 public:
  Truth(const Session& session, const std::string& product, const Terrain& terrain)
      : surface_(library::Surface::from_file(session.folder() + "/" + product)),
        facts_(surface_.info()) {
    add_mesh();
    add_lattice();
    add_errors(terrain);
    truth_["bytes"] = std::to_string(session.read(product).size());
    truth_["bits_per_vertex"] =
        text_of(8.0 * static_cast<double>(session.read(product).size()) / vertices_);
    truth_["samples"] = truth_["posts"] = truth_["points"] = truth_["covered"] =
        std::to_string(terrain.samples.size());
    truth_["voids"] = std::to_string(terrain.voids.size());
    truth_["uncovered"] = truth_["voids_answered"] = truth_["water_moved"] = "0";
    if (!terrain.is_raster) return;
    truth_["grid.columns"] = "40";
    truth_["grid.rows"] = "30";
    add_axis("grid.x", {500, 2, 1}, truth_);
    add_axis("grid.y", {700, 2, 1}, truth_);
  }

  Fields& fields() { return truth_; }
  bool moves_points() const { return moves_points_; }

 private:
  void add_mesh() {
    uint64_t vertices = 0, most = 0;
    double lowest = 1e9, highest = -1e9, west = 1e9, south = 1e9, east = -1e9, north = -1e9;
    nlohmann::json tiles = nlohmann::json::array();
    for (uint32_t row = 0; row < facts_.tile_rows; ++row) {
      for (uint32_t column = 0; column < facts_.tile_columns; ++column) {
        const library::Mesh mesh = surface_.tile(column, row);
        vertices += mesh.vertices.size();
        most = std::max<uint64_t>(most, mesh.vertices.size());
        triangles_ += mesh.triangles.size();
        for (const auto& [vx, vy, vz] : mesh.vertices) {
          lowest = std::min(lowest, vz);
          highest = std::max(highest, vz);
          west = std::min(west, vx);
          east = std::max(east, vx);
          south = std::min(south, vy);
          north = std::max(north, vy);
        }
      }
    }
    vertices_ = static_cast<double>(vertices);
    const uint32_t n = static_cast<uint32_t>(facts_.is_pack ? most : vertices);
    truth_["vertices"] = std::to_string(vertices);
    truth_["max_tile_vertices"] = std::to_string(most);
    truth_["triangles"] = truth_["void_triangles"] = kAny;
    truth_["heights.lowest"] = text_of(lowest);
    truth_["heights.highest"] = text_of(highest);
    truth_["extent.west"] = text_of(west);
    truth_["extent.south"] = text_of(south);
    truth_["extent.east"] = text_of(east);
    truth_["extent.north"] = text_of(north);
    truth_["size.x"] = text_of(east - west);
    truth_["size.y"] = text_of(north - south);
    const auto bytes = [&](unsigned long width) {
      return facts_.is_pack
                 ? MICROTIN_PACK_BYTES_FOR(4, n, width)
                 : MICROTIN_MESH_BYTES_FOR(n, width) + MICROTIN_DECODER_BYTES_FOR(n, width);
    };
    truth_["workspace_bytes_16"] = std::to_string(bytes(16));
    truth_["workspace_bytes_32"] = std::to_string(bytes(32));
    truth_["device_memory"] = "MICROTIN_PACK_BYTES(4, " + std::to_string(n) + ")";
    truth_["workspace_bytes_4_compact_tiles"] = truth_["compact_bytes"] =
        truth_["max_compact_bytes"] = kAny;  // by verify
    truth_["kind"] = facts_.is_pack ? "pack" : "stream";
    truth_["stream_version"] = "6";
    truth_["pack_version"] = "5";
    truth_["phases"] = kAny;
    truth_["max_degree"] = "12";
    truth_["coding"] = "dense";
    truth_["columns"] = truth_["tile_columns"] = std::to_string(facts_.tile_columns);
    truth_["rows"] = truth_["tile_rows"] = std::to_string(facts_.tile_rows);
    truth_["tiles"] = std::to_string(facts_.is_pack ? facts_.tile_columns * facts_.tile_rows : 0);
  }

  void add_lattice() {
    for (const auto& [name, axis] :
         {std::pair("x", facts_.x), std::pair("y", facts_.y), std::pair("z", facts_.z)}) {
      const std::string end = std::string(".") + name;
      add_axis("axes" + end, axis, truth_);
      truth_["steps" + end] = text_of(library::coordinate(axis, 1) - library::coordinate(axis, 0));
      truth_["offsets" + end] = text_of(library::coordinate(axis, 0));
    }
    const library::Box tile = surface_.tile_box(0, 0);
    const auto steps = [](double length, const microtin_axis& axis) {
      return std::to_string(
          std::lround(length / (library::coordinate(axis, 1) - library::coordinate(axis, 0))));
    };
    truth_["tile_width"] = steps(tile.east - tile.west, facts_.x);
    truth_["tile_height"] = steps(tile.north - tile.south, facts_.y);
    truth_["x_max"] = steps(facts_.box.east - facts_.box.west, facts_.x);
    truth_["y_max"] = steps(facts_.box.north - facts_.box.south, facts_.y);
  }

  double height_at(double x, double y) const {
    double z = 0;
    surface_.heights(1, &x, &y, &z);
    return z;
  }

  static double nearest(const microtin_axis& axis, double value) {
    const double step = library::coordinate(axis, 1) - library::coordinate(axis, 0);
    return library::coordinate(axis, std::lround((value - library::coordinate(axis, 0)) / step));
  }

  // How many tiles hold a place: their posts on borders count in each.
  double tiles_at(double x, double y) const {
    double count = 0;
    for (uint32_t row = 0; row < facts_.tile_rows; ++row) {
      for (uint32_t column = 0; column < facts_.tile_columns; ++column) {
        const library::Box box = surface_.tile_box(column, row);
        if (x >= box.west && x <= box.east && y >= box.south && y <= box.north) ++count;
      }
    }
    return count;
  }

  void add_errors(const Terrain& terrain) {
    Errors on_lattice, weighted, truly;
    double moved = 0, raised = 0;
    for (const Sample& sample : terrain.samples) {
      const double x = nearest(facts_.x, sample.x), y = nearest(facts_.y, sample.y);
      const double above = height_at(x, y) - sample.z;
      on_lattice.add(above, 1);
      weighted.add(above, tiles_at(x, y));
      const double there = height_at(sample.x, sample.y);  // none outside the hull
      truly.add(std::isnan(there) ? above : there - sample.z, 1);
      moved = std::max({moved, std::abs(x - sample.x), std::abs(y - sample.y)});
      raised = std::max(raised, std::abs(nearest(facts_.z, sample.z) - sample.z));
    }
    moves_points_ = moved > 1e-6;
    on_lattice.tell("once.", truth_);
    weighted.tell("", truth_);
    truth_["max_below_everywhere"] = truth_["max_above_everywhere"] = terrain.is_raster ? kAny : "";
    truth_["at_samples.max_below"] = truth_["max_below"];
    truth_["at_samples.max_above"] = truth_["max_above"];
    truly.tell("true_places.", truth_);
    truth_["xy_step"] = terrain.is_raster ? "1" : truth_["steps.x"];
    truth_["z_step"] = truth_["steps.z"];
    truth_["xy_displacement"] = text_of(moved);
    truth_["z_displacement"] = text_of(raised);
    truth_["max_error_at_points"] = moves_points_ ? truth_["true_places.max_error"] : "";
    truth_["max_below_at_points"] = moves_points_ ? truth_["true_places.max_below"] : "";
    truth_["least_bound"] = truth_["largest_bound"] = truth_["max_bound_ratio"] = "";  // no map
    truth_["bound"] = truth_["true_places.bound"] = "1.9";
  }

  library::Surface surface_;
  library::SurfaceInfo facts_;
  Fields truth_;
  double vertices_ = 0;
  uint64_t triangles_ = 0;
  bool moves_points_ = false;
};

// --- Products ------------------------------------------------------------------------------------

inline Names with_prefix(const std::string& prefix, const Names& names) {
  Names all;
  for (const std::string& name : names) all.insert(prefix + name);
  return all;
}

inline const Names kAxis = {"offset", "numerator", "denominator"};
inline const Names kErrors = {"bound", "max_error", "rms_error", "mean_error"};

inline Names axes(const std::string& prefix, const Names& names) {
  Names all;
  for (const std::string& name : names) {
    all = united(all, with_prefix(prefix + name + '.', kAxis));
  }
  return all;
}

enum class Notes { kCodes, kText };

// A product, with what it must say.
struct Product {
  std::string file, flags;
  bool is_raster, is_pack, is_merged;
};

inline const std::vector<Product> kProducts = {
    {"stream of posts.mtin", "", true, false, false},
    {"pack of posts.mtp", "--tile-vertices 60", true, true, false},
    {"pack from shards.mtp", "--tile-vertices 60", true, true, true},
    {"stream of points.mtin", "", false, false, false},
    {"pack of points.mtp", "--tile-vertices 60", false, true, false},
};

constexpr const char* kSystem = R"(LOCAL_CS["site",UNIT["Foot",0.3048]])";

class Made {
 public:
  Made(const Product& product, Notes notes) : product_(product), notes_(notes) {
    terrain_ = write_terrain();
    const std::string words =
        " " + terrain_.file +
        " --max-error 1.9 --max-degree 12 --coding dense --date 2026-11 "
        "--source-name 'a \"survey\"' --lineage 'thinned twice' "
        "--attribution 'by the \"survey\"' --license CC-BY-4.0 --valid 2024-01/.. "
        "--epoch 2020.5 --source-accuracy 'LE90 4' " +
        product.flags + flags();
    text_ = product.is_merged ? merge(words) : run("encode" + words + " -o '" + product.file + "'");
    truth_ = std::make_unique<Truth>(session_, product.file, terrain_);
    const bool is_above = truth_->fields()["max_below"] == "0";
    CHECK(is_above == (notes == Notes::kCodes));  // else one error passes for another
    add_notes();
  }

  std::string run(const std::string& words) const {
    const Session::Result result = session_.run(words);
    CHECK_MESSAGE(result.code == 0, (words + result.err));
    return result.out;
  }

  std::string info() const { return run("info --json '" + product_.file + "'"); }
  // Classes are those that the product notes.
  std::string verify() const {
    const std::string words = "verify --json '" + product_.file + "' " + terrain_.file;
    return run(words + (product_.is_raster ? preparation() : ""));
  }

  const std::string& text() const { return text_; }
  const Names& notes() const { return names_; }
  const Terrain& terrain() const { return terrain_; }
  Truth& truth() const { return *truth_; }
  std::string path() const { return session_.folder() + "/" + product_.file; }
  std::string source_path() const { return session_.folder() + "/" + terrain_.file; }

 private:
  Terrain write_terrain() const {
    if (!product_.is_raster && notes_ == Notes::kCodes) return scan(session_, "t.las");
    if (!product_.is_raster) {
      Terrain terrain = cloud(session_, "t.xyz");
      const Sample& first = terrain.samples[21];
      char line[64];
      std::snprintf(line, sizeof line, "%.3f %.3f %.1f\n", first.x, first.y, first.z - 30);
      session_.write("t.xyz", session_.read("t.xyz") + line);
      return terrain;
    }
    Terrain terrain = grid(session_, "t.asc");
    if (notes_ == Notes::kText) {
      session_.write("t.prj", kSystem);
      return terrain;
    }
    for (const Sample& sample : terrain.voids)
      terrain.samples.push_back({sample.x, sample.y, 44.5});
    terrain.voids.clear();
    return terrain;
  }

  std::string preparation() const {
    if (notes_ == Notes::kText) return "";
    return product_.is_raster ? " --water-level 44.5" : " --classes 2,5";
  }

  std::string flags() const {
    if (notes_ == Notes::kCodes)
      return preparation() + " --epsg 25832:7837 --never-below --surface ground";
    if (product_.is_raster) return "";
    return " --units :us-foot --duplicates highest" +
           std::string(product_.is_pack ? " --xy-step 0.003" : "");
  }

  std::string merge(const std::string& words) const {
    std::istringstream plan(run("plan --shards 2" + words));
    std::string files;
    for (std::string line; std::getline(plan, line);) {
      const std::string shard = "shard" + std::to_string(files.size());
      run(join({"encode", words, " ", line, " -o ", shard}));
      files += " " + shard;
    }
    return run("merge" + files + " -o '" + product_.file + "'");
  }

  void add(const std::string& name, const std::string& value) {
    truth_->fields()[name] = value;
    names_.insert(name);
  }

  void add_notes() {
    add("source_name", "a \"survey\"");
    add("date", "2026-11");
    add("lineage", "thinned twice");
    add("attribution", "by the \"survey\"");
    add("license", "CC-BY-4.0");
    add("valid", "2024-01/..");
    add("epoch", "2020.5");
    add("source_accuracy.kind", "LE90");
    add("source_accuracy.value", "4");
    Fields& truth = truth_->fields();
    add("at_samples.max_below", truth["max_below"]);
    add("at_samples.max_above", truth["max_above"]);
    add("side", notes_ == Notes::kCodes ? "never_below" : "both");
    if (notes_ == Notes::kCodes) add("surface", "ground");
    const bool codes = notes_ == Notes::kCodes, raster = product_.is_raster;
    truth["units.horizontal"] = codes ? "metre" : raster ? "foot" : "unknown";
    truth["units.vertical"] = codes ? "metre" : raster ? "foot" : "US survey foot";
    if (codes) add("horizontal_epsg", "25832");
    if (codes) add("vertical_epsg", "7837");
    if (codes && raster) add("water_level", "44.5");
    if (codes && !raster) add("classes", "2,5");
    if (!codes && raster) add("wkt", kSystem);
    if (!codes && !raster) add("duplicates", "highest");
    if (raster) {  // promises_test.cpp compares these with verify
      add("everywhere.max_below", kAny);
      add("everywhere.max_above", kAny);
      names_ = united(names_, united(axes("grid.", {"x", "y"}), {"grid.columns", "grid.rows"}));
    }
    if (truth_->moves_points()) names_ = united(names_, with_prefix("true_places.", kErrors));
  }

  Session session_;
  Product product_;
  Notes notes_;
  Terrain terrain_;
  std::string text_;
  std::unique_ptr<Truth> truth_;
  Names names_;
};

template <class Visit>
inline void for_each_product(const Visit& visit) {
  for (const Product& product : kProducts) {
    for (const Notes notes : {Notes::kCodes, Notes::kText}) {
      CAPTURE(product.file);
      CAPTURE(static_cast<int>(notes));
      visit(product, Made(product, notes));
    }
  }
}

}  // namespace microtin::tests::products

#endif
