// SPDX-License-Identifier: MIT
#include "tests/bench/grids/flight.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/export/scene.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"
#include "encoder/pack/file.hpp"
#include "tests/bench/device/flight.hpp"
#include "tests/bench/device/grid_file.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

constexpr uint32_t kSpacing = 100;  // metres between the grid's posts

Terrain read_terrain(const std::string& path) {
  const Source source = import_terrain(path);
  const auto* raster = std::get_if<Raster>(&source);
  if (raster == nullptr) throw Error(path + ": is not a raster");
  Terrain terrain{
      path, *raster, {}, step_of(raster->x), step_of(raster->y), std::pow(10, -raster->decimals)};
  if (raster->reference.horizontal_unit == Unit::kDegree) {
    const double middle = offset_of(raster->y) + raster->height / 2.0 * terrain.row_metres;
    const Degree degree = degree_at(middle);
    terrain.column_metres *= degree.x;
    terrain.row_metres *= degree.y;
  }
  return terrain;
}

double height_at(const Terrain& terrain, Post post) {
  const auto place =
      static_cast<size_t>(post.y) * terrain.raster.width + static_cast<size_t>(post.x);
  return static_cast<double>(terrain.raster.heights[place]) * terrain.z_metres;
}

struct Log {
  std::map<std::string, uint32_t> numbers;
  std::vector<double> heights;  // metres
};

Log read_log(const std::string& path) {
  std::ifstream file(path);
  Log log;
  for (std::string line; std::getline(file, line);) {
    const size_t blank = line.rfind(' ');
    if (blank == std::string::npos) throw Error(std::string(path).append(": ").append(line));
    const std::string name = line.substr(0, blank), number = line.substr(blank + 1);
    if (name == "height") {
      log.heights.push_back(std::stod(number) / 10);
    } else {
      log.numbers[name] = static_cast<uint32_t>(std::stoul(number));
    }
  }
  return log;
}

Errors errors_along(const Flight& flight, const Terrain& terrain, const Log& log) {
  if (log.heights.size() != static_cast<size_t>(flight.posts())) {
    throw Error("the device did not end its flight");
  }
  Errors errors;
  for (int32_t i = 0; i < flight.posts(); ++i) {
    const double error =
        std::abs(log.heights[static_cast<size_t>(i)] - height_at(terrain, flight.post(i)));
    errors.largest = std::max(errors.largest, error);
    errors.rms += error * error / flight.posts();
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

std::string metres(const Errors& errors) {
  return number(errors.largest, 1) + ", " + number(errors.rms, 2);
}

Errors errors_of(const std::string& pack) {
  const std::string bytes = read_file(pack);
  const PackFile file({bytes.begin(), bytes.end()});
  const std::optional<Accuracy>& accuracy = file.metadata().accuracy;
  if (!accuracy) throw Error(pack + ": does not say how good it is");
  return {std::stod(to_string(accuracy->max_error)), std::stod(to_string(accuracy->rms_error))};
}

void print_heights(const Flight& flight, const Terrain& terrain, const Log& pack, const Log& grid) {
  print_head("Heights on the way, m", {"post", "source", "pack", "grid"});
  for (int32_t i = 0; i < flight.posts(); i += flight.posts() / 8) {
    const auto at = static_cast<size_t>(i);
    print_row({number(i, 0), number(height_at(terrain, flight.post(i)), 1),
               number(pack.heights[at], 1), number(grid.heights[at], 1)});
  }
}

}  // namespace

void write_grid(const std::string& terrain_path, const std::string& grid_path) {
  const Terrain terrain = read_terrain(terrain_path);
  const Grid grid(terrain, kSpacing, 1);
  const double width = (terrain.raster.width - 1) * terrain.column_metres,
               height = (terrain.raster.height - 1) * terrain.row_metres;
  const auto blocks = [](double length, uint32_t own) {
    return static_cast<uint32_t>(length / kSpacing) / own + 1;
  };
  const auto millimetres = [](double length) {
    return static_cast<uint32_t>(std::lround(1000 * length));
  };
  const GridFile head = {blocks(width, GridFile::kOwnColumns),
                         blocks(height, GridFile::kOwnRows),
                         kSpacing * 1000,
                         terrain.raster.width - 1,
                         terrain.raster.height - 1,
                         millimetres(terrain.column_metres),
                         millimetres(terrain.row_metres)};
  std::vector<char> bytes(GridFile::kHeaderBytes);
  std::copy_n(reinterpret_cast<const char*>(&head), sizeof head, bytes.data());
  for (uint32_t block = 0; block < head.block_columns * head.block_rows; ++block) {
    const size_t begin = bytes.size();
    for (uint32_t i = 0; i < GridFile::kBlockRows * GridFile::kBlockColumns; ++i) {
      const uint32_t row =
          block / head.block_columns * GridFile::kOwnRows + i / GridFile::kBlockColumns;
      const uint32_t column =
          block % head.block_columns * GridFile::kOwnColumns + i % GridFile::kBlockColumns;
      const double z = grid.height_at(std::min<double>(column * kSpacing, width),
                                      std::min<double>(row * kSpacing, height));
      const auto rounded = static_cast<int16_t>(std::isnan(z) ? INT16_MIN : std::lround(z));
      bytes.push_back(static_cast<char>(rounded & 255));
      bytes.push_back(static_cast<char>(rounded >> 8 & 255));
    }
    bytes.resize(begin + GridFile::kBlockBytes);
  }
  OutputFile out(grid_path);
  out.write({bytes.data(), bytes.size()});
  out.commit();
}

void print_flight(const FlightFiles& files) {
  const Terrain terrain = read_terrain(files.terrain);
  const Log pack = read_log(files.pack_log), compact = read_log(files.compact_log),
            grid = read_log(files.grid_log);
  const Flight flight(terrain.raster.width - 1, terrain.raster.height - 1);
  const double kilometres =
      flight.posts() * std::hypot(terrain.column_metres, terrain.row_metres / 2) / 1000;
  const auto per = [](double amount, double of) { return number(amount / of, 0); };
  const auto row = [&](const std::string& what, const std::string& key, double of = 1) {
    const auto cell = [&](const Log& log) {
      const auto found = log.numbers.find(key);
      return found == log.numbers.end() ? std::string("-") : per(found->second, of);
    };
    print_row({what, cell(pack), cell(compact), cell(grid)});
  };
  const auto bytes = [](const std::string& path) {
    return static_cast<double>(std::filesystem::file_size(path));
  };
  const double pack_bytes = bytes(files.pack), grid_bytes = bytes(files.grid);
  print_head("A flight of " + number(kilometres, 1) + " km on a Cortex-M4, " +
                 std::to_string(flight.posts()) + " heights asked for",
             {"", "microtin, meshes", "... compact", "grid, 100 m"});
  print_row({"bytes", number(pack_bytes, 0), number(pack_bytes, 0), number(grid_bytes, 0)});
  print_row({"bytes per square kilometre", per(pack_bytes, terrain.square_kilometres()),
             per(pack_bytes, terrain.square_kilometres()),
             per(grid_bytes, terrain.square_kilometres())});
  print_row({"error at all posts: largest, rms, m", metres(errors_of(files.pack)),
             metres(errors_of(files.pack)),
             metres(errors_of(Grid(terrain, kSpacing, 1), terrain))});
  print_row({"error on the way: largest, rms, m", metres(errors_along(flight, terrain, pack)),
             metres(errors_along(flight, terrain, compact)),
             metres(errors_along(flight, terrain, grid))});
  row("RAM, bytes", "RAM");
  row("read from the card, bytes per km", "bytes read", kilometres);
  row("reading and decoding, instructions per km", "service all", kilometres);
  row("... longest call", "service most");
  for (const char* steps : {"1", "5", "20", "200"}) {
    row(std::string("longest service of requests, instructions; work units: ") + steps,
        std::string("service ") + steps);
  }
  row("a height, instructions: mean", "height mean");
  row("... most", "height most");
  row("extremes on 32 posts ahead, instructions: mean", "highest mean");
  row("... most", "highest most");
  row("a block of 28 x 32 heights, instructions", "block");
  print_heights(flight, terrain, pack, grid);
}

}  // namespace microtin::bench
