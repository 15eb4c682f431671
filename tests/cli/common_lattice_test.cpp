// SPDX-License-Identifier: MIT
// Cells of different grids in one terrain: bands of latitude, half steps, files that overlap.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "microtin/surface.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using encoder::Surface;

constexpr double kBound = 6;

// A cell with columns and rows of its own, as .asc: the centres of its posts begin at (x, y), and
// steps are parts of a degree.
struct Cell {
  double x, y;
  int columns, rows, x_parts, y_parts;

  double east(int column) const { return x + column / double(x_parts); }
  double north(int row) const { return y + row / double(y_parts); }
};

double height_at(double x, double y) {
  return std::round(300 + 90 * std::sin(21 * x) * std::cos(17 * y) + 25 * std::sin(90 * y));
}

std::string text_of(const Cell& cell) {
  std::ostringstream text;
  text.precision(15);
  text << "ncols " << cell.columns << "\nnrows " << cell.rows << "\nxllcenter " << cell.x
       << "\nyllcenter " << cell.y << "\ndx " << 1.0 / cell.x_parts << "\ndy " << 1.0 / cell.y_parts
       << '\n';
  for (int row = cell.rows - 1; row >= 0; --row) {
    for (int column = 0; column < cell.columns; ++column) {
      text << height_at(cell.east(column), cell.north(row)) << ' ';
    }
    text << '\n';
  }
  return text.str();
}

// Encodes cells as a pack and a stream; compares each post, and the middle of each pair.
void check_cells(const Session& session, const std::vector<Cell>& cells) {
  std::string names;
  for (size_t i = 0; i < cells.size(); ++i) {
    const std::string name = "c" + std::to_string(i) + ".asc";
    session.write(name, text_of(cells[i]));
    names += " " + name;
  }
  const std::string units = names + " --units degree:metre";
  const std::string encode = "encode" + units + " --max-error 6 --fast -o ";
  for (const std::string output : {"t.mtp --tile-size 13", "t.mtp", "t.mtin"}) {
    CAPTURE(output);
    const std::string file = output.substr(0, output.find(' '));
    const Session::Result made = session.run(encode + output);
    REQUIRE_MESSAGE(made.code == 0, made.err);
    CHECK(session.run("verify " + (file + units)).code == 0);
    CHECK(session.run("check " + file).code == 0);
    const Surface surface = Surface::from_file(session.folder() + "/" + file);
    std::vector<double> x, y, wanted;
    for (const Cell& cell : cells) {
      for (int row = 0; row < cell.rows; ++row) {
        for (int column = 0; column < cell.columns; ++column) {
          x.push_back(cell.east(column));
          y.push_back(cell.north(row));
          wanted.push_back(height_at(x.back(), y.back()));
        }
      }
    }
    std::vector<double> found(x.size());
    surface.heights(x.size(), x.data(), y.data(), found.data());
    size_t wrong = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      if (!(std::abs(found[i] - wanted[i]) <= kBound + 1e-6)) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

// No place from west to east and south to north lacks a height.
void check_closed(const Session& session, double west, double south, double east, double north) {
  const Surface surface = Surface::from_file(session.folder() + "/t.mtp");
  std::vector<double> x, y;
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 400; ++j) {
      x.push_back(west + (east - west) * i / 400);
      y.push_back(south + (north - south) * j / 400);
    }
  }
  std::vector<double> heights(x.size());
  surface.heights(x.size(), x.data(), y.data(), heights.data());
  size_t missing = 0;
  for (const double height : heights) {
    if (std::isnan(height)) ++missing;
  }
  CHECK(missing == 0);
}

}  // namespace

TEST_CASE("mosaic: bands of latitude with different columns are one terrain, none resampled" *
          kSlow) {
  // As GLO-30: posts from the west and the north edge on, 1.5, 2, 3, 5 and 10 times as far apart.
  for (const int times_two : {3, 4, 6, 10, 20}) {
    CAPTURE(times_two);
    const int parts = 120 / times_two * 2 / 2;
    const Session session;
    check_cells(session, {{6, 49 + 1.0 / 60, 60, 60, 60, 60},
                          {7, 49 + 1.0 / 60, 60, 60, 60, 60},
                          {6, 50 + 1.0 / 60, parts, 60, parts, 60},
                          {7, 50 + 1.0 / 60, parts, 60, parts, 60}});
    check_closed(session, 6, 49.02, 7.8, 51);
  }
}

TEST_CASE("mosaic: bands whose posts are at centres of cells share no column" * kSlow) {
  const Session session;
  check_cells(session, {{6 + 0.5 / 60, 49 + 0.5 / 60, 60, 60, 60, 60},
                        {6 + 0.5 / 40, 50 + 0.5 / 60, 40, 60, 40, 60},
                        {6 + 0.5 / 30, 51 + 0.5 / 60, 30, 60, 30, 60}});
  check_closed(session, 6.02, 49.01, 6.98, 51.99);
}

TEST_CASE("mosaic: posts half a step off are kept where they lie, and this is said" * kSlow) {
  const Session session;
  check_cells(session, {{6, 49, 41, 41, 40, 40}, {6 + 0.5 / 40, 50 + 0.5 / 40, 40, 40, 40, 40}});
  check_closed(session, 6.02, 49, 6.98, 50.98);
  const std::string options = " --units degree:metre --max-error 6 --fast -o t.mtin";
  const Session::Result made = session.run("encode c0.asc c1.asc" + options);
  CHECK(contains(made.out + made.err,
                 "warning: c1.asc: its posts lie off those of c0.asc, by 1/2 of a cell in x and "
                 "1/2 in y; each is kept where it lies"));
  CHECK(contains(made.out,
                 "their posts share a lattice of 0.0125 x 0.0125, on which they are up "
                 "to 0.025 x 0.025 apart"));
  session.write("c1.asc", text_of({6.004, 50.004, 40, 40, 40, 40}));
  CHECK(contains(session.failure("encode c0.asc c1.asc" + options),
                 "c1.asc: its posts lie between those of c0.asc: bring all onto one grid with "
                 "gdalwarp -tr -tap"));
}

TEST_CASE("mosaic: a finer grid that overlaps a coarser one" * kSlow) {
  const Session session;
  check_cells(session, {{6, 49, 31, 31, 30, 30}, {6.5, 49.5, 91, 61, 90, 90}});
  check_closed(session, 6, 49, 7, 50);
}

TEST_CASE("mosaic: a void of one grid is not one where another has posts around") {
  const Session session;
  std::string coarse = "ncols 5\nnrows 5\nxllcenter 0\nyllcenter 0\ncellsize 2\nnodata_value -9\n";
  for (int i = 0; i < 25; ++i) coarse += i == 12 ? "-9 " : "5 ";
  std::string fine = "ncols 5\nnrows 5\nxllcenter 1\nyllcenter 1\ncellsize 2\nnodata_value -9\n";
  for (int i = 0; i < 25; ++i) fine += "5 ";
  session.write("a.asc", coarse);
  session.write("b.asc", fine);
  REQUIRE(session.run("encode a.asc -o a.mtin --units metre").code == 0);
  CHECK(session.run("height a.mtin 4 4").out == "void\n");
  for (const std::string order : {"a.asc b.asc", "b.asc a.asc"}) {
    REQUIRE(session.run("encode " + order + " -o t.mtin --units metre").code == 0);
    CHECK(session.run("height t.mtin 4 4").out == "5\n");
  }
}

TEST_CASE("mosaic: half an .hgt cell's columns next to a whole one" * kSlow) {
  const Session session;
  const auto cell = [](int columns) {
    std::string bytes;
    for (int i = 0; i < 1201 * columns; ++i) {
      const int z = 40 + (i / columns) / 31 + (i % columns) * 1200 / (columns - 1) / 45;
      bytes += {static_cast<char>(z / 256), static_cast<char>(z % 256)};
    }
    return bytes;
  };
  session.write("N49E006.hgt", cell(1201));
  session.write("N50E006.hgt", cell(601));
  const std::string cells = "N49E006.hgt N50E006.hgt";
  const Session::Result made = session.run("encode " + cells + " --max-error 3 --fast -o t.mtp");
  REQUIRE(made.code == 0);
  CHECK(contains(made.out, "source: 2163601 posts, 2 files"));
  CHECK(session.run("verify t.mtp " + cells).code == 0);
  const Session::Result updated = session.run("update t.mtp " + cells + " --fast -o u.mtp");
  CHECK(contains(updated.err + updated.out, "kept: 1 of 1 tiles"));
}

}  // namespace microtin::tests
