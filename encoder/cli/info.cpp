// SPDX-License-Identifier: MIT
// The command info: what a stream or a pack says of itself.
#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/files/output.hpp"
#include "encoder/product/document.hpp"
#include "encoder/stream/device_memory.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/verify/everywhere.hpp"
#include "microtin/compact_pack.h"
#include "microtin/surface.hpp"

namespace microtin::cli {
namespace {

uint32_t count_triangles(const microtin_mesh* mesh, microtin_triangle_kind kind) {
  uint32_t count = 0;
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    uint32_t corners[3];
    if (microtin_mesh_triangle(mesh, t, corners) == kind) ++count;
  }
  return count;
}

std::string workspace_bytes_16(uint32_t vertices) {
  if (vertices > MICROTIN_MAX_VERTICES_FOR(16)) return "null";
  return json(MICROTIN_MESH_BYTES_FOR(vertices, 16) + MICROTIN_DECODER_BYTES_FOR(vertices, 16));
}

// What a device needs to keep four tiles, which a place can touch at once.
void add_device_memory(JsonObject& report, uint32_t most_vertices) {
  constexpr unsigned long kSlots = 4;
  const uint32_t capacity = std::max<uint32_t>(most_vertices, 3);
  const bool narrow = capacity <= MICROTIN_MAX_VERTICES_FOR(16);
  report.emplace_back("device_memory", json("MICROTIN_PACK_BYTES(" + std::to_string(kSlots) + ", " +
                                            std::to_string(capacity) + ")"));
  report.emplace_back("workspace_bytes_16",
                      narrow ? json(MICROTIN_PACK_BYTES_FOR(kSlots, capacity, 16)) : "null");
  report.emplace_back("workspace_bytes_32", json(MICROTIN_PACK_BYTES_FOR(kSlots, capacity, 32)));
}

// The memory of a device that decodes one tile and keeps four, in compact form.
uint64_t workspace_bytes_4_compact_tiles(const PackHeader& header) {
  const uint64_t most = header.most_vertices, bytes = header.compact_bytes;
  return most <= MICROTIN_MAX_VERTICES_FOR(16)
             ? MICROTIN_COMPACT_PACK_BYTES_FOR(4, most, bytes, 16)
             : MICROTIN_COMPACT_PACK_BYTES_FOR(4, most, bytes, 32);
}

std::string exact_axis(const Axis& axis) {
  return json(JsonObject{{"offset", json(axis.offset)},
                         {"numerator", json(axis.numerator)},
                         {"denominator", json(axis.denominator)}});
}

template <class Value>
std::string of_axes(const Placement& p, const Value& value) {
  return json(JsonObject{{"x", value(p.x)}, {"y", value(p.y)}, {"z", value(p.z)}});
}

std::string of_grid(const PostGrid& grid) {
  return json(JsonObject{{"columns", json(grid.columns)},
                         {"rows", json(grid.rows)},
                         {"x", exact_axis(grid.x)},
                         {"y", exact_axis(grid.y)}});
}

void add_accuracy(JsonObject& report, const std::optional<Accuracy>& accuracy) {
  const bool bounded = accuracy && accuracy->bound;
  report.emplace_back("bound", bounded ? number(*accuracy->bound) : "null");
  report.emplace_back("max_error", accuracy ? number(accuracy->max_error) : "null");
  report.emplace_back("rms_error", accuracy ? number(accuracy->rms_error) : "null");
  report.emplace_back("mean_error", accuracy ? number(accuracy->mean_error) : "null");
}

// What of the lattice a terrain takes.
struct LatticeBox {
  int64_t x_min, y_min, x_max, y_max;
  int64_t lowest, highest;
};

// Where it lies and how large it is, in the terrain's units.
void add_extent(JsonObject& report, const LatticeBox& box, const Placement& p) {
  const double west = encoder::coordinate(p.x, box.x_min),
               east = encoder::coordinate(p.x, box.x_max);
  const double south = encoder::coordinate(p.y, box.y_min),
               north = encoder::coordinate(p.y, box.y_max);
  report.emplace_back("extent", json(JsonObject{{"west", json(west)},
                                                {"south", json(south)},
                                                {"east", json(east)},
                                                {"north", json(north)}}));
  report.emplace_back("size",
                      json(JsonObject{{"x", json(east - west)}, {"y", json(north - south)}}));
  report.emplace_back("heights",
                      json(JsonObject{{"lowest", json(encoder::coordinate(p.z, box.lowest))},
                                      {"highest", json(encoder::coordinate(p.z, box.highest))}}));
}

LatticeBox box_of(const microtin_mesh* mesh) {
  const Vertex first = vertex_of(mesh, 0);
  LatticeBox box{first.x, first.y, first.x, first.y, first.z, first.z};
  for (uint32_t v = 1; v < microtin_mesh_vertex_count(mesh); ++v) {
    const Vertex vertex = vertex_of(mesh, v);
    box = {std::min<int64_t>(box.x_min, vertex.x),  std::min<int64_t>(box.y_min, vertex.y),
           std::max<int64_t>(box.x_max, vertex.x),  std::max<int64_t>(box.y_max, vertex.y),
           std::min<int64_t>(box.lowest, vertex.z), std::max<int64_t>(box.highest, vertex.z)};
  }
  return box;
}

void add_placement(JsonObject& report, const Metadata& metadata) {
  const Placement& p = metadata.placement;
  report.emplace_back("steps", of_axes(p, [](const Axis& a) { return json(step_of(a)); }));
  report.emplace_back("offsets", of_axes(p, [](const Axis& a) { return json(offset_of(a)); }));
  report.emplace_back("axes", of_axes(p, exact_axis));
}

std::string array(const std::vector<JsonObject>& objects) {
  std::string text;
  for (const JsonObject& one : objects) text += (text.empty() ? "[" : ", ") + json(one);
  return text + "]";
}

// Where other streams and packs are in the same file.
void add_places(JsonObject& report, const std::vector<FilePlace>& places) {
  std::vector<JsonObject> all;
  all.reserve(places.size());
  for (const FilePlace& place : places) {
    all.push_back({{"kind", json(name_of(place.kind))},
                   {"from", json(name_of(place.base))},
                   {"offset", json(place.offset)},
                   {"bytes", json(place.size)}});
  }
  if (!all.empty()) report.emplace_back("places", array(all));
}

void add_source_notes(JsonObject& report, const SourceNotes& notes) {
  const auto add_text = [&report](const char* name, const std::string& text) {
    if (!text.empty()) report.emplace_back(name, json(text));
  };
  add_text("source_name", notes.source);
  add_text("date", notes.date);
  add_text("lineage", notes.lineage);
  add_text("attribution", notes.attribution);
  add_text("license", notes.license);
  add_text("valid", notes.valid);
  if (notes.epoch) report.emplace_back("epoch", number(*notes.epoch));
  if (notes.source_accuracy) {
    report.emplace_back("source_accuracy",
                        json(JsonObject{{"kind", json(name_of(notes.source_accuracy->kind))},
                                        {"value", number(notes.source_accuracy->value)}}));
  }
}

void add_notes(JsonObject& report, const Metadata& metadata) {
  report.emplace_back(
      "units", json(JsonObject{{"horizontal", json(exact::name_of(metadata.horizontal_unit))},
                               {"vertical", json(exact::name_of(metadata.vertical_unit))}}));
  const auto add_known = [&report](const char* name, uint32_t code) {
    if (code != 0) report.emplace_back(name, json(code));
  };
  add_known("horizontal_epsg", metadata.horizontal_epsg);
  add_known("vertical_epsg", metadata.vertical_epsg);
  if (!metadata.wkt.empty()) report.emplace_back("wkt", json(metadata.wkt));
  add_source_notes(report, metadata);
  if (metadata.surface != SurfaceKind::kUnknown) {
    report.emplace_back("surface", json(name_of(metadata.surface)));
  }
  if (metadata.side != BoundSide::kNotStated) {
    report.emplace_back("side", json(name_of(metadata.side)));
  }
  if (metadata.at_samples) report.emplace_back("at_samples", json_of(*metadata.at_samples));
  const auto everywhere = stated_everywhere(metadata.everywhere, metadata.placement.z);
  if (everywhere) report.emplace_back("everywhere", json_of(*everywhere));
  if (metadata.bounds) report.emplace_back("bounds", json_of(*metadata.bounds));
  if (metadata.water_level) report.emplace_back("water_level", number(*metadata.water_level));
  if (metadata.grid) report.emplace_back("grid", of_grid(*metadata.grid));
  if (metadata.classes) report.emplace_back("classes", json(list_of(*metadata.classes)));
  if (metadata.duplicates != DuplicateRule::kUnknown) {
    report.emplace_back("duplicates", json(text_of(metadata.duplicates)));
  }
  if (metadata.true_places) {
    JsonObject accuracy;
    add_accuracy(accuracy, metadata.true_places);
    report.emplace_back("true_places", json(accuracy));
  }
  add_places(report, metadata.places);
}

// Bytes of the terrain in compact form, with the smallest index width that fits.
uint64_t compact_bytes(DecodedTerrain& terrain) {
  const CompactForm form = measured_form(terrain.mesh());
  return bytes_of(form, index_bits(form.vertices));
}

// The lines that marked edges make.
void add_lines(JsonObject& report, const DecodedTerrain& terrain) {
  if (terrain.marked_edges() == 0) return;
  const std::vector<MarkedLine> lines = terrain.lines();
  const stream::LineCounts counts = stream::count_by_class(lines);
  JsonObject classes;
  for (std::size_t number = 1; number < counts.size(); ++number) {
    if (counts[number] == 0) continue;
    classes.emplace_back(name_of(static_cast<LineClass>(number)), json(counts[number]));
  }
  report.emplace_back("lines", json(JsonObject{{"lines", json(lines.size())},
                                               {"edges", json(terrain.marked_edges())},
                                               {"bytes", json(terrain.mark_bytes())},
                                               {"classes", json(classes)}}));
}

JsonObject report_of(DecodedStream& stream) {
  const Header header = read_header(stream.bytes);
  DecodedTerrain& terrain = stream.terrain;
  const size_t bytes = stream.bytes.size();
  const uint32_t vertices = header.info.vertices;
  const uint32_t voids = count_triangles(terrain.mesh(), MICROTIN_TRIANGLE_VOID);
  const uint32_t triangles = count_triangles(terrain.mesh(), MICROTIN_TRIANGLE_REAL) + voids;
  JsonObject report = {{"kind", json(std::string_view("stream"))},
                       {"stream_version", json(header.info.version)},
                       {"vertices", json(vertices)},
                       {"triangles", json(triangles)},
                       {"void_triangles", json(voids)},
                       {"bytes", json(bytes)},
                       {"bits_per_vertex", json(bits_per_vertex(bytes, vertices))},
                       {"phases", json(terrain.phases())},
                       {"max_degree", json(header.info.max_degree)},
                       {"coding", json(stream::name_of(header.contract.coding))},
                       {"compact_bytes", json(compact_bytes(terrain))},
                       {"workspace_bytes_16", workspace_bytes_16(vertices)},
                       {"workspace_bytes_32", json(MICROTIN_MESH_BYTES_FOR(vertices, 32) +
                                                   MICROTIN_DECODER_BYTES_FOR(vertices, 32))}};
  add_extent(report, box_of(terrain.mesh()), header.metadata.placement);
  add_placement(report, header.metadata);
  add_notes(report, header.metadata);
  add_lines(report, terrain);
  if (header.metadata.digest)
    report.emplace_back("digest", json(hexadecimal(*header.metadata.digest)));
  add_accuracy(report, header.metadata.accuracy);
  return report;
}

// A line for each object, under a line of names; columns end on the right.
std::string table(const std::vector<JsonObject>& objects) {
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& entry : objects[0]) lines[0].push_back(entry.first);
  std::vector<std::size_t> widths(lines[0].size());
  for (const JsonObject& one : objects) {
    lines.emplace_back();
    for (const auto& entry : one) lines.back().push_back(entry.second);
  }
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += std::string(widths[i] - line[i].size() + (i == 0 ? 0 : 2), ' ') + line[i];
    }
    text += '\n';
  }
  return text;
}

// What the header states of the phases; bytes from the beginning of the file.
std::vector<JsonObject> phase_table(const DecodedStream& stream) {
  const Header header = read_header(stream.bytes);
  std::vector<JsonObject> phases;
  for (const PhaseEnd& end : header.metadata.phases) {
    phases.push_back({{"vertices", json(end.vertices)},
                      {"bytes", json(header.info.header_bytes + end.bytes)},
                      {"max_error", end.max_error ? number(*end.max_error) : "null"}});
  }
  return phases;
}

std::string text_of_stream(DecodedStream& stream, bool as_json) {
  const std::vector<JsonObject> phases = phase_table(stream);
  JsonObject report = report_of(stream);
  if (phases.empty()) return text_of(report, as_json);
  if (as_json) report.emplace_back("phase_table", array(phases));
  return text_of(report, as_json) + (as_json ? "" : table(phases));
}

// What the tile's chunk states of its posts' own bounds. Decodes the tile.
void add_bounds_of_tile(JsonObject& report, const PackFile& pack, uint32_t number) {
  const std::optional<DecodedTerrain> tile = pack.tile(number);
  const std::optional<BoundSpan> span = tile ? tile->bounds() : std::nullopt;
  report.emplace_back("least_bound", span ? cli::number(span->least) : "null");
  report.emplace_back("largest_bound", span ? cli::number(span->largest) : "null");
  report.emplace_back("unbounded", span ? json(span->unbounded) : "null");
  report.emplace_back("max_ratio", span ? cli::number(span->ratio) : "null");
}

JsonObject tile_report(const PackFile& pack, uint32_t number) {
  const TileBox box = tile_box(pack.grid(), number);
  JsonObject report = {{"tile", json(number)},
                       {"x", json(box.x)},
                       {"y", json(box.y)},
                       {"bytes", json(pack.entries()[number].size)},
                       {"vertices", json(pack.vertices(number))}};
  if (pack.metadata().bounds) add_bounds_of_tile(report, pack, number);
  if (!pack.metadata().grid) return report;  // of points
  const auto stated = stated_everywhere(pack.margins(number), pack.metadata().placement.z);
  report.emplace_back("max_below_everywhere", stated ? cli::number(stated->below) : "null");
  report.emplace_back("max_above_everywhere", stated ? cli::number(stated->above) : "null");
  return report;
}

JsonObject report_of(const PackFile& pack) {
  const TileGrid& grid = pack.grid();
  const uint32_t compact = pack.header().compact_bytes;
  JsonObject report = {
      {"kind", json(std::string_view("pack"))},
      {"pack_version", json(kPackVersion)},
      {"columns", json(tile_columns(grid))},
      {"rows", json(tile_rows(grid))},
      {"tile_width", json(grid.width)},
      {"tile_height", json(grid.height)},
      {"x_max", json(grid.x_max)},
      {"y_max", json(grid.y_max)},
      {"vertices", json(pack.vertices())},
      {"max_tile_vertices", json(pack.header().most_vertices)},
      {"max_compact_bytes", compact != 0 ? json(compact) : "null"},
      {"workspace_bytes_4_compact_tiles",
       compact != 0 ? json(workspace_bytes_4_compact_tiles(pack.header())) : "null"},
      {"bytes", json(pack.bytes())}};
  const PackHeader& header = pack.header();
  add_extent(report, {0, 0, grid.x_max, grid.y_max, header.lowest, header.highest},
             pack.metadata().placement);
  add_device_memory(report, header.most_vertices);
  add_placement(report, pack.metadata());
  add_notes(report, pack.metadata());
  add_accuracy(report, pack.metadata().accuracy);
  return report;
}

std::string text_of_pack(const PackFile& pack, bool as_json) {
  std::vector<JsonObject> tiles;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    tiles.push_back(tile_report(pack, number));
  }
  JsonObject report = report_of(pack);
  if (as_json) report.emplace_back("tiles", array(tiles));
  return text_of(report, as_json) + (as_json ? "" : table(tiles));
}

void run_info(const std::string& input, bool json) {
  refuse_overwriting({input}, "-");
  Document document(input);
  if (document.pack() != nullptr) {
    print(with_file_context(input, [&] { return text_of_pack(*document.pack(), json); }));
  } else {
    print(with_file_context(input, [&] { return text_of_stream(*document.stream(), json); }));
  }
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  add_look(app, action, "info", "Print what a stream or a pack contains", run_info);
}

}  // namespace microtin::cli
