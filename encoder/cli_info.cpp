#include "encoder/cli_commands.hpp"
#include "encoder/cli_pack.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/encode.hpp"
#include "encoder/error_context.hpp"
#include "encoder/pack_file.hpp"

namespace microtin {
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
  constexpr uint32_t kMost16 = 10923;
  if (vertices > kMost16) return "null";
  return json(MICROTIN_MESH_BYTES_FOR(vertices, 16) + MICROTIN_DECODER_BYTES_FOR(vertices, 16));
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

// "2,9", or "0-6,8-255".
std::string list_of(const ClassSet& classes) {
  std::string text;
  for (size_t first = 0; first < classes.size(); ++first) {
    if (!classes[first]) continue;
    size_t last = first;
    while (last + 1 < classes.size() && classes[last + 1]) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(first);
    if (last != first) text += "-" + std::to_string(last);
    first = last;
  }
  return text;
}

std::string_view name_of(DuplicateRule rule) {
  switch (rule) {
    case DuplicateRule::kUnknown:
      return "unknown";
    case DuplicateRule::kMiddle:
      return "middle of lowest and highest";
    case DuplicateRule::kLowest:
      return "lowest";
    case DuplicateRule::kHighest:
      return "highest";
    case DuplicateRule::kMean:
      return "mean";
    case DuplicateRule::kMedian:
      return "median";
  }
  return "unknown";
}

}  // namespace

void add_placement(JsonObject& report, const Metadata& metadata) {
  const Placement& p = metadata.placement;
  report.emplace_back("steps", of_axes(p, [](const Axis& a) { return json(step_of(a)); }));
  report.emplace_back("offsets", of_axes(p, [](const Axis& a) { return json(offset_of(a)); }));
  report.emplace_back("placement", of_axes(p, exact_axis));
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
  add_text("wkt", metadata.wkt);
  add_text("source", metadata.source);
  add_text("date", metadata.date);
  add_text("lineage", metadata.lineage);
  if (metadata.water_level) report.emplace_back("water_level", number(*metadata.water_level));
  if (metadata.grid) report.emplace_back("grid", of_grid(*metadata.grid));
  if (metadata.classes) report.emplace_back("classes", json(list_of(*metadata.classes)));
  if (metadata.duplicates != DuplicateRule::kUnknown) {
    report.emplace_back("duplicates", json(name_of(metadata.duplicates)));
  }
  if (metadata.true_places) {
    JsonObject accuracy;
    add_accuracy(accuracy, metadata.true_places);
    report.emplace_back("true_places", json(accuracy));
  }
}

void add_accuracy(JsonObject& report, const std::optional<Accuracy>& accuracy) {
  const bool bounded = accuracy && accuracy->bound;
  report.emplace_back("bound", bounded ? number(*accuracy->bound) : "null");
  report.emplace_back("max_error", accuracy ? number(accuracy->max_error) : "null");
  report.emplace_back("rms_error", accuracy ? number(accuracy->rms_error) : "null");
  report.emplace_back("mean_error", accuracy ? number(accuracy->mean_error) : "null");
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
                       {"decoding", json(name_of(header.contract.decoding))},
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
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) {
    run_info_pack(*pack, json);
    return;
  }
  const std::vector<uint8_t> stream = read_stream(input);
  print(about(input, [&] { return report_of(stream); }), json);
}

}  // namespace microtin
