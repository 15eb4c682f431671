// SPDX-License-Identifier: MIT
// By what rasters mark their voids, behind every door.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "encoder/import/import.hpp"
#include "encoder/import/raster.hpp"
#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "tests/support/imports.hpp"

using namespace microtin::tests;

namespace {

bool is_void_text(const std::string& no_data, const std::string& cell) {
  const std::string text = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value " +
                           no_data + "\n" + cell + " 5\n";
  const bool is_void = import_asc("grid", text).heights[0] == kVoidHeight;
  const auto reader = open_asc("grid", bytes_in_memory({text.begin(), text.end()}));
  CHECK((reader->read({0, 0, 2, 1}).heights[0] == kVoidHeight) == is_void);
  return is_void;
}

template <class Number>
bool is_void_number(double no_data, Number cell) {
  const std::array<Number, 4> cells = {cell, 1, 2, 3};
  const auto posts =
      microtin::encoder::raster_from_cells(2, 2, cells.data(), {0, 1, 0, 2, 0, -1}, no_data);
  return posts.heights[2] == microtin::encoder::kNoData;
}

}  // namespace

TEST_CASE("no data: texts of floats, whatever digits they were written to") {
  CHECK(is_void_text("-9999.99", "-9999.990234375"));
  CHECK(is_void_text("-9999.990234375", "-9999.99"));
  CHECK(is_void_text("-9999.99", "-9999.9902"));
  CHECK(is_void_text("-9999", "-9999.000"));
  CHECK(is_void_text("-9999.99", "-9999.9899999999998"));
  CHECK(is_void_text("1e-2", "0.00999999977648258"));
  CHECK_FALSE(is_void_text("-9999.99", "-9999.98"));
  CHECK_FALSE(is_void_text("-9999.99", "-9999.9901"));  // no float's digits
  CHECK_FALSE(is_void_text("-9999", "-9999.0004"));
  CHECK_FALSE(is_void_text("16777216", "16777217"));
  CHECK_FALSE(is_void_text("123456789012345678", "123456789012345679"));
  CHECK_FALSE(is_void_text("1.1754943508222875e-38", "0"));
  CHECK_FALSE(is_void_text("1e-400", "1"));
}

TEST_CASE("no data: spellings of what no height can be") {
  for (const char* const lowest :
       {"-3.4e38", "-3.40282e+38", "-3.4028235e+38", "-3.4028234663852886e+38",
        "-340282346638528860000000000000000000000.000"}) {
    for (const char* const cell : {"-3.40282346638529e+38", "-3.402823e+38", "-3.4E+38"}) {
      CHECK(is_void_text(lowest, cell));
      CHECK_THROWS_AS(is_void_text(lowest, std::string(cell).substr(1)), Error);  // above 0
    }
    CHECK(is_void_number(std::stod(lowest), -3.402823466e38F));
    CHECK(is_void_number(std::stod(lowest), -3.402823466e38));
    CHECK_THROWS_AS(is_void_text(lowest, "-1e38"), Error);
    CHECK_THROWS_AS(is_void_text(lowest, "-1e300"), Error);
  }
  CHECK(is_void_text("-1.79769313486232e+308", "-1.7976931348623157e+308"));
  CHECK(is_void_text("-1.79769313486232e+308", "-1.797693e+308"));
  CHECK(is_void_text("inf", "+Infinity"));
  CHECK_THROWS_AS(is_void_text("-inf", "inf"), Error);
  CHECK_THROWS_AS(is_void_text("-9999", "-3.4e38"), Error);
}

TEST_CASE("no data: arrays are compared in the type of their cells") {
  CHECK(is_void_number(-9999.99, -9999.99F));
  CHECK(is_void_number(-9999.99, -9999.99));
  CHECK(is_void_number(-9999.99, static_cast<double>(-9999.99F)));  // widened
  CHECK(is_void_number(0.1, 0.1F));
  CHECK_FALSE(is_void_number(-9999.99, -9999.98F));
  CHECK_FALSE(is_void_number(-9999.99, std::nextafter(-9999.99, 0.0)));
  CHECK_FALSE(is_void_number(-9999.0001, -9999.0));
  CHECK(is_void_number(-INFINITY, -INFINITY));
  CHECK(is_void_number(std::nan(""), std::nan("")));
  CHECK(is_void_number(7, std::nan("")));
  CHECK_FALSE(is_void_number(std::nan(""), 7.0));
}

TEST_CASE("no data: the C face hands the value on") {
  const double heights[] = {7, 1, 2, 3}, no_data = 7;
  const float floats[] = {0.1F, 1, 2, 3};
  const double no_float = 0.1;
  for (const bool has_floats : {false, true}) {
    microtin_raster_data raster = {};
    raster.size = sizeof raster;
    raster.columns = raster.rows = 2;
    raster.heights = has_floats ? nullptr : heights;
    raster.float_heights = floats;
    raster.no_data = has_floats ? &no_float : &no_data;
    raster.transform[1] = 1;
    raster.transform[5] = -1;
    microtin_source* terrain = nullptr;
    REQUIRE(microtin_source_from_raster(&raster, &terrain) == MICROTIN_STATUS_OK);
    microtin_options options = {};
    options.size = sizeof options;
    uint8_t* bytes = nullptr;
    uint64_t size = 0;
    microtin_report report{};
    report.size = sizeof report;
    REQUIRE(microtin_encode_stream(terrain, &options, &bytes, &size, &report) ==
            MICROTIN_STATUS_OK);
    CHECK(report.samples == 3);
    microtin_bytes_free(bytes);
    microtin_source_free(terrain);
  }
}
