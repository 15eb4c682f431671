// SPDX-License-Identifier: MIT
// The table in encoder/docs/rules.md: each rule with each reader, behind the command line, the
// library and C. A reader without a row fails.
#include <doctest/doctest.h>
#include <zlib.h>

#include <array>
#include <functional>
#include <optional>
#include <set>

#include "encoder/files/input.hpp"
#include "encoder/import/import.hpp"
#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/binary_file.hpp"
#include "tests/support/laz_file.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
using microtin::encoder::SourceTerrain;

namespace {

const std::vector<std::string> kRules = {"no data", "commas",     "ranges",   "skew",
                                         "units",   "duplicates", "sidecars", "depths"};
const std::string kArrayOfPosts = "array of posts", kArrayOfPoints = "array of points";

struct RuleCell {
  std::string rule, reader;
  std::string bytes;     // of the file; empty: the rule does not apply
  std::string outcome;   // part of the message, or why the rule does not apply
  uint64_t samples = 0;  // of the terrain; 0: it is refused
  std::string units = "metre:metre";
  std::string system = {};                    // the .prj next to it
  std::function<SourceTerrain()> array = {};  // instead of a file
  std::optional<double> highest = {};         // of the heights, for which the bound is 0.001, not 1
};

using Rows = std::vector<std::array<std::string, 3>>;

std::string joined(const Rows& rows, const std::string& before, const std::string& between) {
  std::string text;
  for (const auto& [x, y, z] : rows) {
    text += before;
    text += x;
    text += between;
    text += y;
    text += between;
    text += z;
    text += '\n';
  }
  return text;
}

std::string las(const Rows& rows) {
  BinaryFile file;
  file.put(0, std::string("LASF")).put(24, uint8_t{1}).put(25, uint8_t{2});
  file.put(94, uint16_t{227}).put(96, uint32_t{227}).put(105, uint16_t{20});
  file.put(107, static_cast<uint32_t>(rows.size()));
  for (size_t axis = 0; axis < 3; ++axis) file.put(131 + 8 * axis, 1.0).put(155 + 8 * axis, 0.0);
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) file.put(227 + 20 * i + 4 * k, std::stoi(rows[i][k]));
    file.put(227 + 20 * i + 15, uint8_t{2}).put(227 + 20 * i + 19, '\0');
  }
  return file.bytes();
}

// Points as a reader's format has them.
std::string points(const std::string& reader, const Rows& rows) {
  if (reader == ".las") return las(rows);
  if (reader == ".laz") return compressed(las(rows));
  if (reader == ".obj") return joined(rows, "v ", " ");
  if (reader == ".csv") return joined(rows, "", ",");
  if (reader == ".txt") return joined(rows, "", ";");
  if (reader == ".xyz") return joined(rows, "", " ");
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(rows.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nend_header\n" +
         joined(rows, "", " ");
}

std::string grid(const std::string& south, const std::string& first) {
  return "ncols 2\nnrows 2\nxllcenter 7\nyllcenter " + south +
         "\ncellsize 1\nNODATA_value -9999.99\n" + first + " 2\n3 4\n";
}

// A tile of 2 x 2 posts, the first of them void.
std::string tile() {
  return {"\x80\0\0\1\0\2\0\3", 8};
}

std::string zipped(const std::string& bytes) {
  const auto check = static_cast<uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  const auto size = static_cast<uint32_t>(bytes.size());
  const std::string name = "N43E007.hgt";
  const auto length = static_cast<uint16_t>(name.size());
  BinaryFile file;
  file.put(0, std::string("PK\3\4")).put(14, check).put(18, size).put(22, size).put(26, length);
  file.put(30, name + bytes);
  const size_t list = file.bytes().size();
  file.put(list, std::string("PK\1\2")).put(list + 16, check).put(list + 20, size);
  file.put(list + 24, size).put(list + 28, length).put(list + 45, '\0').put(list + 46, name);
  const size_t end = file.bytes().size();
  file.put(end, std::string("PK\5\6")).put(end + 8, uint16_t{1}).put(end + 10, uint16_t{1});
  file.put(end + 12, static_cast<uint32_t>(end - list)).put(end + 16, static_cast<uint32_t>(list));
  return file.put(end + 21, '\0').bytes();
}

SourceTerrain posts(float first, const microtin::encoder::Transform& transform) {
  const std::array<float, 4> heights = {first, 2, 3, 4};
  return SourceTerrain(
      microtin::encoder::raster_from_cells(2, 2, heights.data(), transform, -9999.99));
}

SourceTerrain cloud(const Rows& rows) {
  std::vector<double> numbers;
  for (const auto& row : rows) {
    for (const std::string& number : row) numbers.push_back(std::stod(number));
  }
  return SourceTerrain(microtin::encoder::point_cloud_from_xyz(rows.size(), numbers.data()));
}

const std::string kDegreesWkt =
    R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
    R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";

// Heights from 1 to `highest`: centimetres, then depths.
void add_conversions(std::vector<RuleCell>& table, const std::string& reader,
                     const std::string& bytes, double highest, const std::string& xy,
                     const std::function<SourceTerrain()>& array = {}) {
  const uint64_t samples = static_cast<uint64_t>(highest);
  table.push_back({"units", reader, bytes, "", samples, xy + ":cm", "", array, highest / 100});
  const std::string metres = xy.empty() ? "" : xy + ":metre";
  table.push_back({"depths", reader, bytes, "", samples, metres, "", array, -1.0});
}

void add_rows_of_points(std::vector<RuleCell>& table, const std::string& reader) {
  const auto file = [&](const std::string& rule, const Rows& rows, const std::string& outcome) {
    table.push_back({rule, reader, points(reader, rows), outcome});
    if (reader != kArrayOfPoints) return;
    table.back().array = [rows] { return cloud(rows); };
  };
  const bool is_text = reader != ".las" && reader != ".laz" && reader != kArrayOfPoints;
  table.push_back({"no data", reader, "", "points that there are not are left out"});
  if (is_text) {
    file("commas", {{"5,00", "2,05", "3,05"}, {"9,00", "2,05", "3,05"}}, "written with a point");
  } else {
    table.push_back({"commas", reader, "", "binary numbers have none"});
  }
  file("ranges", {{"47", "158", "3"}, {"48", "158", "4"}, {"47", "159", "6"}},
       "point 1, at x 47, y 158: latitude 158 is beyond 90 degrees");
  table.back().units = "degree:metre";
  table.push_back({"skew", reader, "", "points are in no rows"});
  const Rows three = {{"0", "0", "1"}, {"9", "0", "2"}, {"0", "9", "3"}};
  const std::function<SourceTerrain()> array = [three] { return cloud(three); };
  add_conversions(table, reader, points(reader, three), 3, "metre",
                  reader == kArrayOfPoints ? array : std::function<SourceTerrain()>());
  file("duplicates", {{"0", "0", "0"}, {"9", "0", "0"}, {"0", "9", "0"}, {"9", "0", "9"}},
       "duplicates lowest");
  if (reader == ".xyz" || reader == ".csv" || reader == ".txt") {  // a grid by such a name
    table.push_back(
        {"sidecars", reader, grid("158", "1"), "latitude 158 is beyond", 0, ":metre", kDegreesWkt});
  } else {
    table.push_back({"sidecars", reader, "", "has its system within, or none"});
  }
}

void add_rows_of_rasters(std::vector<RuleCell>& table) {
  for (const std::string reader : {".hgt", ".zip"}) {
    const std::string bytes = reader == ".hgt" ? tile() : zipped(tile());
    table.push_back({"no data", reader, bytes, "", 3, ""});
    add_conversions(table, reader, bytes, 3, "");
    table.push_back({"commas", reader, "", "binary numbers have none"});
    table.push_back({"ranges", reader, "", "the name places it, and none is beyond the poles"});
    table.push_back({"skew", reader, "", "has none"});
    table.push_back({"duplicates", reader, "", "posts do not meet"});
    table.push_back({"sidecars", reader, "", "the format says the system"});
  }
  for (const std::string reader : {".asc", ".tif"}) {  // GDAL knows such a grid by any name
    table.push_back({"no data", reader, grid("0", "-9999.990234375"), "", 3});
    add_conversions(table, reader, grid("0", "1"), 4, "metre");
    table.push_back({"ranges", reader, grid("158", "1"), "latitude 158 is beyond 90 degrees", 0,
                     "degree:metre"});
    table.push_back({"duplicates", reader, "", "posts do not meet"});
    table.push_back(
        {"sidecars", reader, grid("158", "1"), "latitude 158 is beyond", 0, ":metre", kDegreesWkt});
  }
  table.push_back({"commas", ".asc", grid("0", "1,5"), "written with a point"});
  table.push_back({"skew", ".asc", "", "has none"});
  table.push_back({"commas", ".tif", "", "GDAL's own readers take them for points"});
  table.push_back({"skew", ".tif", "", "see \"gdal: skews that rounding leaves are none\""});
}

void add_rows_of_posts(std::vector<RuleCell>& table) {
  const auto add = [&](const std::string& rule, const std::string& outcome, uint64_t samples,
                       const std::string& units, const std::function<SourceTerrain()>& array) {
    table.push_back({rule, kArrayOfPosts, "", outcome, samples, units, "", array});
  };
  const std::string metres = "metre:metre";
  add("no data", "", 3, metres, [] { return posts(-9999.99F, {0, 1, 0, 0, 0, -1}); });
  add("commas", "binary numbers have none", 0, "", {});
  add("ranges", "latitude 157.5 is beyond 90", 0, "degree:metre", [] {
    return posts(1, {0, 1, 0, 159, 0, -1});
  });
  add("skew", "", 4, metres, [] { return posts(1, {0, 1, 1e-18, 0, -1e-18, -1}); });
  add("skew", "columns must run east", 0, metres, [] { return posts(1, {0, 1, 1e-6, 0, 0, -1}); });
  add_conversions(table, kArrayOfPosts, "", 4, "metre", [] {
    return posts(1, {0, 1, 0, 0, 0, -1});
  });
  add("duplicates", "posts do not meet", 0, "", {});
  add("sidecars", "the caller says the system", 0, "", {});
}

std::set<std::string> known_readers() {
  const std::string kinds = microtin::importing::terrain_kinds();
  const std::string list = kinds.substr(0, kinds.find(';'));
  std::set<std::string> readers = {kArrayOfPosts, kArrayOfPoints};
  for (size_t at = list.find('.'); at != list.npos; at = list.find('.', at + 1)) {
    readers.insert(list.substr(at, list.find_first_of(", ", at) - at));
  }
  return readers;
}

std::vector<RuleCell> table_of_rules() {
  std::vector<RuleCell> table;
  for (const char* const reader : {".xyz", ".csv", ".txt", ".las", ".laz", ".ply", ".obj"}) {
    add_rows_of_points(table, reader);
  }
  add_rows_of_points(table, kArrayOfPoints);
  add_rows_of_rasters(table);
  add_rows_of_posts(table);
  return table;
}

void check(const RuleCell& cell, uint64_t samples, const std::string& message) {
  CHECK(samples == cell.samples);
  CHECK_MESSAGE(contains(message, cell.outcome), message);
}

const char* bound_of(const RuleCell& cell) {
  return cell.highest ? "0.001" : "1";
}

bool is_of_depths(const RuleCell& cell) {
  return cell.rule == "depths";
}

void check_highest(const RuleCell& cell, const std::string& path) {
  if (!cell.highest) return;
  const double highest = microtin::encoder::Surface::from_file(path).info().highest;
  CHECK(highest == doctest::Approx(*cell.highest).epsilon(0.01));
}

// Behind the library's doors, in C++ and in C.
void check_library(const RuleCell& cell, const std::function<SourceTerrain()>& make) {
  const Session session;
  microtin::encoder::Options options;
  options.units = cell.units;
  options.depths = is_of_depths(cell);
  options.max_error = bound_of(cell);
  try {
    const microtin::encoder::Stream stream = encode_stream(make(), options);
    check(cell, stream.report.samples, "");
    session.write("a.mtin", {stream.bytes.begin(), stream.bytes.end()});
    check_highest(cell, session.folder() + "/a.mtin");
  } catch (const std::runtime_error& refused) {
    check(cell, 0, refused.what());
  }
}

void check_c(const RuleCell& cell, const Session& session, const std::string& path) {
  microtin_source* terrain = nullptr;
  microtin_options options = {};
  options.size = sizeof options;
  options.max_error = bound_of(cell);
  options.units = cell.units.c_str();
  options.depths = is_of_depths(cell) ? 1 : 0;
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  microtin_report report = {};
  report.size = sizeof report;
  const bool done =
      microtin_source_from_file(path.c_str(), &terrain) == MICROTIN_STATUS_OK &&
      microtin_encode_stream(terrain, &options, &bytes, &size, &report) == MICROTIN_STATUS_OK;
  check(cell, done ? report.samples : 0, done ? "" : microtin_last_error());
  if (done) {
    session.write("c.mtin", {reinterpret_cast<const char*>(bytes), static_cast<size_t>(size)});
    check_highest(cell, session.folder() + "/c.mtin");
  }
  microtin_bytes_free(bytes);
  microtin_source_free(terrain);
}

void check_file(const RuleCell& cell) {
  const Session session;
  const std::string name = "N43E007" + cell.reader;
  session.write(name, cell.bytes);
  if (!cell.system.empty()) session.write("N43E007.prj", cell.system);
  const std::string path = session.folder() + '/' + name;
  check_library(cell, [&] { return SourceTerrain::from_file(path); });
  check_c(cell, session, path);
  std::string words = "encode " + name + " -o out.mtin --max-error ";
  words += bound_of(cell);
  if (!cell.units.empty()) words += " --units " + cell.units;
  if (is_of_depths(cell)) words += " --depths";
  if (cell.samples == 0) {
    CHECK(contains(session.failure(words), cell.outcome));
    return;
  }
  CHECK(contains(session.run(words).out, "source: " + std::to_string(cell.samples) + " po"));
  check_highest(cell, session.folder() + "/out.mtin");
}

// The line of a table in a document that begins with `first`.
std::string line_of(const std::string& document, const std::string& first) {
  const size_t at = document.find("\n| " + first + " |");
  return at == document.npos ? "" : document.substr(at + 1, document.find('\n', at + 1) - at);
}

}  // namespace

TEST_CASE("rules: each holds with each reader, behind each door, or says why it does not apply") {
  std::set<std::pair<std::string, std::string>> seen;
  const std::set<std::string> readers = known_readers();
  for (const RuleCell& cell : table_of_rules()) {
    CAPTURE(cell.rule);
    CAPTURE(cell.reader);
    if (readers.count(cell.reader) == 0) continue;  // GDAL is not in this build
    seen.insert({cell.rule, cell.reader});
    if (cell.array) {
      check_library(cell, cell.array);
    } else if (cell.bytes.empty()) {
      CHECK(!cell.outcome.empty());
    } else {
      check_file(cell);
    }
  }
  const std::string manual = microtin::files::read_file(golden("../../../encoder/docs/rules.md"));
  for (const std::string& reader : readers) {
    const bool is_told = reader[0] != '.' || contains(line_of(manual, "rule"), '`' + reader + '`');
    CHECK_MESSAGE(is_told, reader << " is not in the document's table");
  }
  for (const std::string& rule : kRules) {
    CHECK_MESSAGE(!line_of(manual, rule).empty(), rule << " is not in the document's table");
    for (const std::string& reader : readers) {
      CHECK_MESSAGE(seen.count({rule, reader}) == 1, rule << " has no row for " << reader);
    }
  }
}
