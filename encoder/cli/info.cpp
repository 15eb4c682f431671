// The command info: what a stream or a pack says of itself.
#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/pack.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/pack/file.hpp"

namespace microtin::cli {
namespace {

std::string_view name_of(Unit unit) {
  switch (unit) {
    case Unit::kUnknown:
      return "unknown";
    case Unit::kMetre:
      return "metre";
    case Unit::kDegree:
      return "degree";
    case Unit::kFoot:
      return "foot";
    case Unit::kUsSurveyFoot:
      return "US survey foot";
  }
  return "unknown";
}

uint32_t count_triangles(const microtin_mesh* mesh, microtin_triangle_kind kind) {
  uint32_t count = 0;
  for (uint32_t t = 0; t < microtin_triangle_count(mesh); ++t) {
    uint32_t corners[3];
    if (microtin_triangle(mesh, t, corners) == kind) ++count;
  }
  return count;
}

std::string workspace_bytes_16(uint32_t vertices) {
  if (vertices > MICROTIN_MAX_VERTICES_FOR(16)) return "null";
  return json(MICROTIN_MESH_BYTES_FOR(vertices, 16) + MICROTIN_DECODER_BYTES_FOR(vertices, 16));
}

template <class Value>
std::string of_axes(const Placement& p, const Value& value) {
  return json(JsonObject{{"x", value(p.x)}, {"y", value(p.y)}, {"z", value(p.z)}});
}

}  // namespace

void add_placement(JsonObject& report, const Metadata& metadata) {
  const auto exact = [](const Axis& axis) {
    return json(JsonObject{{"offset", json(axis.offset)},
                           {"numerator", json(axis.numerator)},
                           {"denominator", json(axis.denominator)}});
  };
  const Placement& p = metadata.placement;
  report.emplace_back("steps", of_axes(p, [](const Axis& a) { return json(step_of(a)); }));
  report.emplace_back("offsets", of_axes(p, [](const Axis& a) { return json(offset_of(a)); }));
  report.emplace_back("placement", of_axes(p, exact));
}

void add_notes(JsonObject& report, const Metadata& metadata) {
  report.emplace_back("units",
                      json(JsonObject{{"horizontal", json(name_of(metadata.horizontal_unit))},
                                      {"vertical", json(name_of(metadata.vertical_unit))}}));
  const auto add_known = [&report](const char* name, uint32_t code) {
    if (code != 0) report.emplace_back(name, json(code));
  };
  add_known("horizontal_epsg", metadata.horizontal_epsg);
  add_known("vertical_epsg", metadata.vertical_epsg);
  const auto add_text = [&report](const char* name, const std::string& text) {
    if (!text.empty()) report.emplace_back(name, json(text));
  };
  add_text("source", metadata.source);
  add_text("date", metadata.date);
  add_text("lineage", metadata.lineage);
  if (metadata.water_level) report.emplace_back("water_level", number(*metadata.water_level));
}

void add_accuracy(JsonObject& report, const std::optional<Accuracy>& accuracy) {
  const bool bounded = accuracy && accuracy->bound;
  report.emplace_back("bound", bounded ? number(*accuracy->bound) : "null");
  report.emplace_back("max_error", accuracy ? number(accuracy->max_error) : "null");
  report.emplace_back("rms_error", accuracy ? number(accuracy->rms_error) : "null");
}

namespace {

JsonObject report_of(const std::vector<uint8_t>& stream) {
  const Header header = read_header(stream);
  const DecodedTerrain terrain(stream);
  const uint32_t vertices = header.info.vertices;
  const uint32_t voids = count_triangles(terrain.mesh(), MICROTIN_VOID);
  const uint32_t triangles = count_triangles(terrain.mesh(), MICROTIN_REAL) + voids;
  JsonObject report = {{"format_version", json(header.info.version)},
                       {"vertices", json(vertices)},
                       {"triangles", json(triangles)},
                       {"void_triangles", json(voids)},
                       {"bytes", json(stream.size())},
                       {"bits_per_vertex", json(bits_per_vertex(stream.size(), vertices))},
                       {"phases", json(terrain.phases())},
                       {"degree", json(header.info.degree)},
                       {"levels", json(header.info.levels)},
                       {"workspace_bytes_16", workspace_bytes_16(vertices)},
                       {"workspace_bytes_32", json(MICROTIN_MESH_BYTES_FOR(vertices, 32) +
                                                   MICROTIN_DECODER_BYTES_FOR(vertices, 32))}};
  add_placement(report, header.metadata);
  add_notes(report, header.metadata);
  add_accuracy(report, header.metadata.accuracy);
  return report;
}

}  // namespace

void run_info(const std::string& input, bool json) {
  refuse_overwriting({input}, "-");
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) {
    run_info_pack(*pack, json);
    return;
  }
  const std::vector<uint8_t> stream = read_stream(input);
  print(text_of(with_file_context(input, [&] { return report_of(stream); }), json));
}

}  // namespace microtin::cli
