// SPDX-License-Identifier: MIT
// Options that are set by name and text: each member of Options, its values, and what is refused.
#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "microtin/encoder.hpp"
#include "tests/support/members.hpp"

namespace microtin::tests {
namespace {

using encoder::Options;

struct Row {
  std::string name, text;
  std::function<bool(const Options&)> holds;
};

template <class Value>
Row row(const std::string& name, const std::string& text, Value Options::*member, Value value) {
  return {name, text, [=](const Options& options) { return options.*member == value; }};
}

std::vector<Row> rows_of_files() {
  using O = Options;
  const std::string words = "a, b";
  return {
      row("error_map", words, &O::error_map, words),
      row("area", words, &O::area, words),
      row("route", words, &O::route, words),
      row("route_width", "30", &O::route_width, std::string("30")),
      row("route_edge_error", "40", &O::route_edge_error, std::string("40")),
      row("breaklines", words, &O::breaklines, words),
      row("obstacles", words, &O::obstacles, words),
  };
}

std::vector<Row> rows() {
  using O = Options;
  using encoder::BoundAt;
  using encoder::Coding;
  using encoder::Duplicates;
  using encoder::SearchEffort;
  using encoder::SurfaceKind;
  const std::string words = "a, b";
  std::vector<Row> all = rows_of_files();
  const std::vector<Row> others = {
      row("max_error", "2.5", &O::max_error, std::string("2.5")),
      row("max_vertices", "4294967295", &O::max_vertices, UINT32_MAX),
      row("max_bytes", "0", &O::max_bytes, 0u),
      row("max_bytes", "77", &O::max_bytes, 77u),
      row("never_below", "true", &O::never_below, true),
      row("never_below", "false", &O::never_below, false),
      row("z_step", "0.1", &O::z_step, std::string("0.1")),
      row("xy_step", "", &O::xy_step, std::string()),
      row("bound_at", "points", &O::bound_at, BoundAt::kPoints),
      row("bound_at", "lattice", &O::bound_at, BoundAt::kLattice),
      row("bound_at", "everywhere", &O::bound_at, BoundAt::kEverywhere),
      row("duplicates", "middle", &O::duplicates, Duplicates::kMiddle),
      row("duplicates", "lowest", &O::duplicates, Duplicates::kLowest),
      row("duplicates", "highest", &O::duplicates, Duplicates::kHighest),
      row("duplicates", "mean", &O::duplicates, Duplicates::kMean),
      row("effort", "fast", &O::effort, SearchEffort::kFast),
      row("effort", "normal", &O::effort, SearchEffort::kNormal),
      row("effort", "best", &O::effort, SearchEffort::kBest),
      row("coding", "quick", &O::coding, Coding::kQuick),
      row("coding", "balanced", &O::coding, Coding::kBalanced),
      row("coding", "dense", &O::coding, Coding::kDense),
      row("max_degree", "7", &O::max_degree, 7u),
      row("tile_vertices", "100", &O::tile_vertices, 100u),
      row("tile_size", "9", &O::tile_size, 9u),
      row("units", "foot", &O::units, std::string("foot")),
      row("depths", "true", &O::depths, true),
      row("horizontal_epsg", "25832", &O::horizontal_epsg, 25832u),
      row("vertical_epsg", "7837", &O::vertical_epsg, 7837u),
      row("surface", "unknown", &O::surface, SurfaceKind::kUnknown),
      row("surface", "ground", &O::surface, SurfaceKind::kGround),
      row("surface", "top", &O::surface, SurfaceKind::kTop),
      row("surface", "bed", &O::surface, SurfaceKind::kBed),
      row("surface", "geoid", &O::surface, SurfaceKind::kGeoid),
      row("surface", "obstacles", &O::surface, SurfaceKind::kObstacles),
      row("source_name", words, &O::source_name, words),
      row("date", "2026", &O::date, std::string("2026")),
      row("lineage", words, &O::lineage, words),
      row("digest", "true", &O::digest, true),
      row("phases", "true", &O::phases, true),
      row("attribution", words, &O::attribution, words),
      row("license", words, &O::license, words),
      row("valid", "2024/..", &O::valid, std::string("2024/..")),
      row("epoch", "2020.5", &O::epoch, std::string("2020.5")),
      row("source_accuracy", "LE90 4", &O::source_accuracy, std::string("LE90 4")),
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

std::string error_of(const std::string& name, const std::string& text) {
  Options options;
  try {
    encoder::set_option(options, name, text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("options as text: each member of Options, and each of its values") {
  Names known;
  for (const Row& row : rows()) {
    CAPTURE(row.name);
    CAPTURE(row.text);
    known.insert(row.name);
    Options options;
    options.never_below = true;  // so that false makes a difference
    options.effort = encoder::SearchEffort::kBest;
    options.surface = encoder::SurfaceKind::kTop;
    encoder::set_option(options, row.name, row.text);
    CHECK(row.holds(options));
  }
  CHECK(text_of(members_of("encoder/include/microtin/encoder.hpp", "Options")) == text_of(known));
}

TEST_CASE("options as text: what is no option, and what is none of its values") {
  CHECK(error_of("max_eror", "1") == "there is no option max_eror");
  CHECK(error_of("area", "") == "area: '' is not allowed; use the name of a file");
  CHECK(error_of("effort", "Fast") == "effort: 'Fast' is not allowed; use fast, normal or best");
  CHECK(error_of("never_below", "1") == "never_below: '1' is not allowed; use true or false");
  for (const std::string text : {"", "-1", "1 ", "4294967296", "99999999999999999999", "1e3"}) {
    CHECK(error_of("max_bytes", text) ==
          "max_bytes: '" + text + "' is not allowed; use a whole number below 2^32");
  }
}

}  // namespace microtin::tests
