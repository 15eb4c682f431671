// SPDX-License-Identifier: MIT
// Every number and note that the library says of a product in C++ and C, for every kind of product.
// A member without a row fails.
#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "tests/support/products.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
using namespace microtin::tests::products;

namespace {

constexpr const char* kCHeader = "encoder/include/microtin/encoder.h";
constexpr const char* kCppHeader = "encoder/include/microtin/encoder.hpp";
constexpr const char* kSurface = "encoder/include/microtin/surface.hpp";

std::string in_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

// As `Made` encodes the product with texts for notes.
library::Options library_options(const Product& product) {
  library::Options options;
  options.max_error = "1.9";
  options.max_degree = 12;
  options.coding = library::Coding::kDense;
  options.date = "2026-11";
  options.source_name = "a \"survey\"";
  options.lineage = "thinned twice";
  options.attribution = "by the \"survey\"";
  options.license = "CC-BY-4.0";
  options.valid = "2024-01/..";
  options.epoch = "2020.5";
  options.source_accuracy = "LE90 4";
  if (product.is_raster) return options;
  options.units = ":us-foot";
  options.duplicates = library::Duplicates::kHighest;
  if (product.is_pack) options.xy_step = "0.003";
  return options;
}

library::Report report_in_cpp(const Product& product, const Made& made) {
  const auto terrain = library::SourceTerrain::from_file(made.source_path());
  if (!product.is_pack) {
    return encode_stream(terrain, library_options(product)).report;
  }
  library::Options options = library_options(product);
  options.tile_vertices = 60;
  return encode_pack(terrain, options, made.path());
}

microtin_report report_in_c(const Product& product, const Made& made) {
  microtin_options options{};
  options.size = sizeof options;
  options.max_error = "1.9";
  options.max_degree = 12;
  options.coding = MICROTIN_CODING_DENSE;
  options.date = "2026-11";
  options.source_name = "a \"survey\"";
  options.lineage = "thinned twice";
  options.attribution = "by the \"survey\"";
  options.license = "CC-BY-4.0";
  options.valid = "2024-01/..";
  options.epoch = "2020.5";
  options.source_accuracy = "LE90 4";
  if (!product.is_raster) {
    options.units = ":us-foot";
    options.duplicates = MICROTIN_DUPLICATES_HIGHEST;
  }
  if (!product.is_raster && product.is_pack) options.xy_step = "0.003";
  if (product.is_pack) options.tile_vertices = 60;
  microtin_source* terrain = nullptr;
  REQUIRE(microtin_source_from_file(made.source_path().c_str(), &terrain) == MICROTIN_STATUS_OK);
  microtin_report report{};
  report.size = sizeof report;
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  const microtin_status outcome =
      product.is_pack ? microtin_encode_pack(terrain, &options, made.path().c_str(), &report)
                      : microtin_encode_stream(terrain, &options, &bytes, &size, &report);
  CHECK(outcome == MICROTIN_STATUS_OK);
  microtin_bytes_free(bytes);
  microtin_source_free(terrain);
  return report;
}

// Both have the same names, but for warnings, which only C++ has.
template <class Report>
Fields common_fields(const Report& report) {
  return {{"samples", std::to_string(report.samples)},
          {"vertices", std::to_string(report.vertices)},
          {"bytes", std::to_string(report.bytes)},
          {"tiles", std::to_string(report.tiles)},
          {"bound", report.bound},
          {"max_error", report.max_error},
          {"rms_error", report.rms_error},
          {"mean_error", report.mean_error},
          {"max_below", report.max_below},
          {"max_above", report.max_above},
          {"max_below_everywhere", report.max_below_everywhere},
          {"max_above_everywhere", report.max_above_everywhere},
          {"max_error_at_points", report.max_error_at_points},
          {"max_below_at_points", report.max_below_at_points},
          {"least_bound", report.least_bound},
          {"largest_bound", report.largest_bound},
          {"max_bound_ratio", report.max_bound_ratio}};
}

// The warnings of the command line, but for the one that names a file.
std::string warnings(const Made& made) {
  std::istringstream lines(made.text());
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("warning: ") == 0 && line.find(".prj") == line.npos)
      text += line.substr(9) + '\n';
  }
  return text;
}

template <class Grid>
void add_grid(const Grid& grid, Fields& fields) {
  if (grid.columns == 0) return;
  fields["grid.columns"] = std::to_string(grid.columns);
  fields["grid.rows"] = std::to_string(grid.rows);
  add_axis("grid.x", grid.x, fields);
  add_axis("grid.y", grid.y, fields);
}

// What both call by the same names.
template <class SurfaceInfo>
Fields info_of(const SurfaceInfo& info) {
  Fields fields = {{"bytes", std::to_string(info.bytes)},
                   {"vertices", std::to_string(info.vertices)},
                   {"tile_columns", std::to_string(info.tile_columns)},
                   {"tile_rows", std::to_string(info.tile_rows)},
                   {"kind", info.is_pack ? "pack" : "stream"},
                   {"heights.lowest", text_of(info.lowest)},
                   {"heights.highest", text_of(info.highest)},
                   {"horizontal_epsg", std::to_string(info.horizontal_epsg)},
                   {"vertical_epsg", std::to_string(info.vertical_epsg)},
                   {"wkt", info.wkt},
                   {"source_name", info.source_name},
                   {"date", info.date},
                   {"lineage", info.lineage},
                   {"attribution", info.attribution},
                   {"license", info.license},
                   {"valid", info.valid},
                   {"epoch", info.epoch},
                   {"source_accuracy", info.source_accuracy},
                   {"bound", info.bound},
                   {"max_error", info.max_error},
                   {"rms_error", info.rms_error},
                   {"mean_error", info.mean_error},
                   {"max_error_at_points", info.max_error_at_points},
                   {"surface", library::name_of(library::SurfaceKind(info.surface))},
                   {"side", library::name_of(library::BoundSide(info.side))},
                   {"max_below", info.max_below},
                   {"max_above", info.max_above},
                   {"max_below_everywhere", info.max_below_everywhere},
                   {"max_above_everywhere", info.max_above_everywhere},
                   {"least_bound", info.least_bound},
                   {"largest_bound", info.largest_bound},
                   {"max_bound_ratio", info.max_bound_ratio}};
  constexpr const char* kUnits[] = {"unknown", "metre", "degree", "foot", "US survey foot"};
  fields["units.horizontal"] = kUnits[static_cast<uint32_t>(info.horizontal_unit)];
  fields["units.vertical"] = kUnits[static_cast<uint32_t>(info.vertical_unit)];
  add_axis("axes.x", info.x, fields);
  add_axis("axes.y", info.y, fields);
  add_axis("axes.z", info.z, fields);
  return fields;
}

void add_extent(double west, double south, double east, double north, Fields& fields) {
  fields["extent.west"] = text_of(west);
  fields["extent.south"] = text_of(south);
  fields["extent.east"] = text_of(east);
  fields["extent.north"] = text_of(north);
}

Names names_of_facts(bool is_raster) {
  Names names = {"bytes",
                 "vertices",
                 "tile_columns",
                 "tile_rows",
                 "kind",
                 "heights.lowest",
                 "heights.highest",
                 "horizontal_epsg",
                 "vertical_epsg",
                 "wkt",
                 "source_name",
                 "date",
                 "lineage",
                 "attribution",
                 "license",
                 "valid",
                 "epoch",
                 "source_accuracy",
                 "max_error_at_points",
                 "surface",
                 "side",
                 "max_below",
                 "max_above",
                 "max_below_everywhere",
                 "max_above_everywhere",
                 "least_bound",
                 "largest_bound",
                 "max_bound_ratio",
                 "units.vertical",
                 "units.horizontal",
                 "extent.west",
                 "extent.south",
                 "extent.east",
                 "extent.north"};
  names = united(united(names, kErrors), axes("axes.", {"x", "y", "z"}));
  if (!is_raster) return names;
  return united(united(names, axes("grid.", {"x", "y"})), {"grid.columns", "grid.rows"});
}

}  // namespace

TEST_CASE("reports: every field of the library's is true of every kind of product" * kSlow) {
  for (const Product& product : kProducts) {
    if (product.is_merged) continue;
    CAPTURE(product.file);
    const Made made(product, Notes::kText);
    const Fields& truth = made.truth().fields();
    const library::Report cpp = report_in_cpp(product, made);
    expect("C++", common_fields(cpp), truth,
           without(members_of(kCppHeader, "Report"), {"warnings"}));
    CHECK(in_lines(cpp.warnings) == warnings(made));
    const microtin_report c = report_in_c(product, made);
    expect("C", common_fields(c), truth,
           without(members_of(kCHeader, "microtin_report"), {"size"}));
    CHECK(microtin_last_warnings() == warnings(made));
  }
}

TEST_CASE("reports: every member of the info is true of every kind of product, in C++ and C" *
          kSlow) {
  for_each_product([](const Product& product, const Made& made) {
    Fields truth = made.truth().fields();
    truth.insert({{"horizontal_epsg", "0"},
                  {"vertical_epsg", "0"},
                  {"wkt", ""},
                  {"surface", "unknown"},
                  {"source_accuracy", "LE90 4"}});
    const auto surface = library::Surface::from_file(made.path());
    Fields cpp = info_of(surface.info());
    add_grid(surface.info().source, cpp);
    const library::Box& box = surface.info().box;
    add_extent(box.west, box.south, box.east, box.north, cpp);
    expect("C++", cpp, truth, names_of_facts(product.is_raster));
    microtin_surface* in_c = nullptr;
    REQUIRE(microtin_surface_from_file(made.path().c_str(), &in_c) == MICROTIN_STATUS_OK);
    microtin_surface_info info{};
    info.size = sizeof info;
    microtin_surface_get_info(in_c, &info);
    Fields c = info_of(info);
    microtin_grid grid{};
    grid.size = sizeof grid;
    CHECK((microtin_surface_grid(in_c, nullptr, &grid) == MICROTIN_STATUS_OK) == product.is_raster);
    add_grid(grid, c);
    add_extent(info.west, info.south, info.east, info.north, c);
    expect("C", c, truth, names_of_facts(product.is_raster));
    microtin_surface_free(in_c);
  });
}

TEST_CASE("reports: no member of the info is without a row") {
  const Names both = {"bytes",
                      "vertices",
                      "tile_columns",
                      "tile_rows",
                      "is_pack",
                      "lowest",
                      "highest",
                      "x",
                      "y",
                      "z",
                      "horizontal_unit",
                      "vertical_unit",
                      "horizontal_epsg",
                      "vertical_epsg",
                      "wkt",
                      "source_name",
                      "date",
                      "lineage",
                      "attribution",
                      "license",
                      "valid",
                      "epoch",
                      "source_accuracy",
                      "bound",
                      "max_error",
                      "rms_error",
                      "mean_error",
                      "max_error_at_points",
                      "surface",
                      "side",
                      "max_below",
                      "max_above",
                      "max_below_everywhere",
                      "max_above_everywhere",
                      "least_bound",
                      "largest_bound",
                      "max_bound_ratio"};
  // tests/product/phases_test.cpp
  const Names of_streams = {"digest", "phases"};
  CHECK(text_of(members_of(kSurface, "SurfaceInfo")) ==
        text_of(united(united(both, of_streams), {"box", "source"})));
  CHECK(text_of(members_of(kCHeader, "microtin_surface_info")) ==
        text_of(united(united(both, of_streams),
                       {"size", "west", "south", "east", "north", "phase_count"})));
}
