#include "encoder/cli_pack.hpp"

#include <sstream>

#include "encoder/error.hpp"
#include "encoder/error_context.hpp"
#include "encoder/import.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"
#include "encoder/point_pack.hpp"
#include "encoder/tile_plan.hpp"
#include "encoder/voids.hpp"

namespace microtin {
namespace {

uint32_t tile_vertices(const EncodeRequest& request) {
  if (request.tile_vertices != 0) return request.tile_vertices;
  if (request.device_ram == 0) throw Error("a pack needs --tile-vertices or --device-ram");
  const uint32_t vertices = vertices_for_ram(request.device_ram);
  if (vertices < kFewestTileVertices) {
    throw Error("--device-ram " + std::to_string(request.device_ram) + " is too few for a pack");
  }
  return vertices;
}

// A pack, and what there is to tell of the places of its source.
struct Made {
  EncodedPack pack;
  std::string places;
};

Made encode_points(const PointCloud& cloud, const PackOptions& options) {
  PointPack made = encode_point_pack(cloud, options);
  std::string places = "source: " + std::to_string(cloud.points.size()) + " points";
  if (!cloud.selection.empty()) places += ", " + cloud.selection;
  places += "\nstep of x and y: " + to_string(made.xy_step) + moved(made.xy_displacement) + "\n";
  return {std::move(made.pack), places + merged(made.merged)};
}

Made encode(const Source& source, const EncodeRequest& request) {
  if (request.max_vertices != 0 || request.max_bytes != 0) {
    throw Error("packs are made with --max-error or of all posts");
  }
  EncodeRequest tile = request;
  tile.device_ram = 0;  // it limits tiles, by their number of vertices
  const PackOptions options{request.lattice, simplify_options(tile, {}), tile_vertices(request)};
  if (const auto* cloud = std::get_if<PointCloud>(&source)) return encode_points(*cloud, options);
  if (request.lattice.xy_step) throw Error("packs keep the places of posts: no --xy-step");
  return {encode_pack(std::get<Raster>(source), options), ""};
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
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
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

std::string in_units(uint32_t error, const Axis& z) {
  return json(error / 256.0 * static_cast<double>(z.numerator) /
              static_cast<double>(z.denominator));
}

JsonObject tile_report(const PackFile& pack, uint32_t number) {
  const TileBox box = tile_box(pack.grid(), number);
  const PackEntry& entry = pack.entries()[number];
  const Axis& z = pack.metadata().placement.z;
  return {{"tile", json(number)},
          {"x", json(box.x)},
          {"y", json(box.y)},
          {"bytes", json(entry.size)},
          {"vertices", json(entry.vertices)},
          {"lowest", json(entry.lowest)},
          {"highest", json(entry.highest)},
          {"max_error", in_units(entry.max_error, z)},
          {"rms_error", in_units(entry.root_mean_square, z)}};
}

// A line for each tile, under a line of names.
std::string table(const std::vector<JsonObject>& tiles) {
  std::string text;
  for (const auto& entry : tiles[0]) text += entry.first + '\t';
  for (const JsonObject& tile : tiles) {
    text += '\n';
    for (const auto& entry : tile) text += entry.second + '\t';
  }
  return text + '\n';
}

std::string array(const std::vector<JsonObject>& tiles) {
  std::string text;
  for (const JsonObject& tile : tiles) text += (text.empty() ? "[" : ", ") + json(tile);
  return text + "]";
}

}  // namespace

void run_encode_pack(const EncodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  OutputFile out(request.output);
  Source source = import_terrain(request.input);
  fill_voids(source, request.fill_voids);
  const auto [made, bytes] = about(request.input, [&] {
    const Made all = encode(source, request);
    const EncodedPack& encoded = all.pack;
    Metadata metadata = metadata_of(request, source, encoded.placement);
    metadata.accuracy =
        Accuracy{request.lattice.max_error, encoded.measured.max_error, encoded.measured.rms_error};
    return std::pair(all, write_pack(encoded, metadata));
  });
  const PackFile written(bytes);
  const Verification found = verify(written, source, request.lattice.max_error);
  if (!found.within_bound || found.uncovered != 0 || found.voids_answered != 0) {
    throw Error("internal error: the pack does not keep what was asked for");
  }
  deliver(out, request.output, bytes,
          made.places + report(made.pack, bytes.size(), request.lattice.max_error));
}

void run_info_pack(const std::string& input, const std::vector<uint8_t>& bytes, bool as_json) {
  const PackFile pack = about(input, [&] { return PackFile(bytes); });
  std::vector<JsonObject> tiles;
  uint64_t vertices = 0;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    tiles.push_back(tile_report(pack, number));
    vertices += pack.entries()[number].vertices;
  }
  const TileGrid& grid = pack.grid();
  JsonObject report = {{"pack_version", json(kPackVersion)},
                       {"columns", json(tile_columns(grid))},
                       {"rows", json(tile_rows(grid))},
                       {"tile_width", json(grid.width)},
                       {"tile_height", json(grid.height)},
                       {"x_max", json(grid.x_max)},
                       {"y_max", json(grid.y_max)},
                       {"vertices", json(vertices)},
                       {"most_vertices", json(pack.header().most_vertices)},
                       {"lowest", json(pack.header().lowest)},
                       {"highest", json(pack.header().highest)},
                       {"bytes", json(bytes.size())}};
  add_placement(report, pack.metadata());
  add_notes(report, pack.metadata());
  add_accuracy(report, pack.metadata().accuracy);
  if (as_json) report.emplace_back("tiles", array(tiles));
  print(report, as_json);
  if (as_json) return;
  OutputFile out("-");
  out.write(table(tiles));
  out.commit();
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
