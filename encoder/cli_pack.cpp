#include "encoder/cli_pack.hpp"

#include <sstream>

#include "encoder/error.hpp"
#include "encoder/error_context.hpp"
#include "encoder/import.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"
#include "encoder/voids.hpp"

namespace microtin {
namespace {

EncodedPack encode(const Source& source, const EncodeRequest& request) {
  const auto* raster = std::get_if<Raster>(&source);
  if (raster == nullptr) throw Error("packs are made of rasters; these are points");
  if (request.lattice.xy_step) throw Error("packs keep the places of posts: no --xy-step");
  return encode_pack(*raster, {request.lattice, simplify_options(request), request.tile_vertices});
}

std::string report(const EncodedPack& pack, std::size_t bytes,
                   const std::optional<Decimal>& bound) {
  const Verification& measured = pack.measured;
  uint64_t vertices = 0;
  uint32_t most = 0, without = 0;
  for (const EncodedTile& tile : pack.tiles) {
    vertices += tile.vertices;
    most = std::max(most, tile.vertices);
    if (tile.stream.empty()) ++without;
  }
  std::ostringstream text;
  text << "step of z: " << to_string(pack.z_step) << "\npack: " << tile_columns(pack.grid) << " x "
       << tile_rows(pack.grid) << " tiles of " << pack.grid.width << " x " << pack.grid.height
       << " steps";
  if (without != 0) text << ", " << without << " without terrain";
  text << ", " << vertices << " vertices, at most " << most << " in a tile, " << bytes
       << " bytes\nerror: at most " << to_string(measured.max_error) << ", rms "
       << to_string(measured.rms_error);
  if (bound) text << " (asked for: at most " << to_string(*bound) << ")";
  text << "\nbelow the source: at most " << to_string(measured.max_below) << '\n';
  return text.str();
}

double in_units(uint32_t error, const Axis& z) {
  return error / 256.0 * static_cast<double>(z.numerator) / static_cast<double>(z.denominator);
}

Report tile_report(const PackFile& pack, uint32_t number) {
  const TileBox box = tile_box(pack.grid(), number);
  const PackEntry& entry = pack.entries()[number];
  const Axis& z = pack.metadata().placement.z;
  Report tile;
  tile["tile"] = number;
  tile["x"] = box.x;
  tile["y"] = box.y;
  tile["bytes"] = entry.size;
  tile["vertices"] = entry.vertices;
  tile["lowest"] = entry.lowest;
  tile["highest"] = entry.highest;
  tile["max_error"] = in_units(entry.max_error, z);
  tile["rms_error"] = in_units(entry.root_mean_square, z);
  return tile;
}

// A line for each tile, under a line of names.
std::string table(const Report& tiles) {
  std::ostringstream text;
  for (const auto& [name, value] : tiles[0].items()) text << name << '\t';
  for (const Report& tile : tiles) {
    text << '\n';
    for (const auto& [name, value] : tile.items()) text << value.dump() << '\t';
  }
  text << '\n';
  return text.str();
}

}  // namespace

void run_encode_pack(const EncodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  OutputFile out(request.output);
  Source source = import_terrain(request.input);
  fill_voids(source, request.fill_voids);
  const auto [pack, bytes] = about(request.input, [&] {
    const EncodedPack encoded = encode(source, request);
    Metadata metadata = metadata_of(request, source, encoded.placement);
    metadata.accuracy =
        Accuracy{request.lattice.max_error, encoded.measured.max_error, encoded.measured.rms_error};
    return std::pair(encoded, write_pack(encoded, metadata));
  });
  const PackFile written(bytes);
  const Verification found = verify(written, source, request.lattice.max_error);
  if (!found.within_bound || found.uncovered != 0 || found.voids_answered != 0) {
    throw Error("internal error: the pack does not keep what was asked for");
  }
  out.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  out.commit();
  std::FILE* const terminal = request.output == "-" ? stderr : stdout;
  std::fputs(report(pack, bytes.size(), request.lattice.max_error).c_str(), terminal);
}

void run_info_pack(const std::string& input, const std::vector<uint8_t>& bytes, bool json) {
  const PackFile pack = about(input, [&] { return PackFile(bytes); });
  Report report, tiles;
  uint64_t vertices = 0;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    tiles.push_back(tile_report(pack, number));
    vertices += pack.entries()[number].vertices;
  }
  const TileGrid& grid = pack.grid();
  report["pack_version"] = kPackVersion;
  report["columns"] = tile_columns(grid);
  report["rows"] = tile_rows(grid);
  report["tile_width"] = grid.width;
  report["tile_height"] = grid.height;
  report["x_max"] = grid.x_max;
  report["y_max"] = grid.y_max;
  report["vertices"] = vertices;
  report["most_vertices"] = pack.header().most_vertices;
  report["lowest"] = pack.header().lowest;
  report["highest"] = pack.header().highest;
  report["bytes"] = bytes.size();
  add_placement(report, pack.metadata());
  add_accuracy(report, pack.metadata().accuracy);
  if (json) report["tiles"] = tiles;
  print(report, json);
  if (!json) std::fputs(table(tiles).c_str(), stdout);
}

void run_verify_pack(const VerifyRequest& request, const std::vector<uint8_t>& bytes) {
  Source source = import_terrain(request.source);
  fill_voids(source, request.fill_voids);
  const auto [bound, found] = about(request.input, [&] {
    const PackFile pack(bytes);
    const std::optional<Accuracy>& accuracy = pack.metadata().accuracy;
    const std::optional<Decimal> promised = accuracy ? accuracy->bound : std::nullopt;
    return std::pair(promised, verify(pack, source, promised));
  });
  report_and_judge(request, bound, found);
}

}  // namespace microtin
