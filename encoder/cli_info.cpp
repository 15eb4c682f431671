#include "encoder/cli_commands.hpp"
#include "encoder/cli_pack.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/pack_file.hpp"

namespace microtin {
namespace {

Report decimal_or_null(const std::optional<Decimal>& value) {
  return value ? Report(number(*value)) : Report();
}

double step_of(const Axis& axis) {
  return static_cast<double>(axis.numerator) / static_cast<double>(axis.denominator);
}

double offset_of(const Axis& axis) {
  return static_cast<double>(axis.offset) / static_cast<double>(axis.denominator);
}

const char* name_of(Unit unit) {
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

Report workspace_bytes_16(uint32_t vertices) {
  constexpr uint32_t kMost16 = 10923;
  if (vertices > kMost16) return {};
  return MICROTIN_MESH_BYTES_FOR(vertices, 16) + MICROTIN_DECODER_BYTES_FOR(vertices, 16);
}

}  // namespace

void add_placement(Report& report, const Metadata& metadata) {
  const Placement& p = metadata.placement;
  report["steps"] = {{"x", step_of(p.x)}, {"y", step_of(p.y)}, {"z", step_of(p.z)}};
  report["offsets"] = {{"x", offset_of(p.x)}, {"y", offset_of(p.y)}, {"z", offset_of(p.z)}};
  const auto exact = [](const Axis& axis) {
    return Report{
        {"offset", axis.offset}, {"numerator", axis.numerator}, {"denominator", axis.denominator}};
  };
  report["placement"] = {{"x", exact(p.x)}, {"y", exact(p.y)}, {"z", exact(p.z)}};
  report["units"] = {{"horizontal", name_of(metadata.horizontal_unit)},
                     {"vertical", name_of(metadata.vertical_unit)}};
  if (metadata.horizontal_epsg != 0) report["horizontal_epsg"] = metadata.horizontal_epsg;
  if (metadata.vertical_epsg != 0) report["vertical_epsg"] = metadata.vertical_epsg;
  if (!metadata.source.empty()) report["source"] = metadata.source;
}

void add_accuracy(Report& report, const std::optional<Accuracy>& accuracy) {
  report["bound"] = decimal_or_null(accuracy ? accuracy->bound : std::nullopt);
  report["max_error"] = accuracy ? Report(number(accuracy->max_error)) : Report();
  report["rms_error"] = accuracy ? Report(number(accuracy->rms_error)) : Report();
}

void run_info(const std::string& input, bool json) {
  const std::vector<uint8_t> stream = read_stream(input);
  if (is_pack(stream)) {
    run_info_pack(input, stream, json);
    return;
  }
  const Report report = about(input, [&] {
    const Header header = read_header(stream);
    const DecodedTerrain terrain(stream);
    const uint32_t vertices = header.info.vertices;
    const uint32_t voids = count_triangles(terrain.mesh(), MICROTIN_VOID);
    Report r;
    r["format_version"] = header.info.version;
    r["vertices"] = vertices;
    r["triangles"] = count_triangles(terrain.mesh(), MICROTIN_REAL) + voids;
    r["void_triangles"] = voids;
    r["bytes"] = stream.size();
    r["bits_per_vertex"] = bits_per_vertex(stream.size(), vertices);
    r["phases"] = terrain.phases();
    r["degree"] = header.info.degree;
    r["levels"] = header.info.levels;
    r["workspace_bytes_16"] = workspace_bytes_16(vertices);
    r["workspace_bytes_32"] =
        MICROTIN_MESH_BYTES_FOR(vertices, 32) + MICROTIN_DECODER_BYTES_FOR(vertices, 32);
    add_placement(r, header.metadata);
    add_accuracy(r, header.metadata.accuracy);
    return r;
  });
  print(report, json);
}

}  // namespace microtin
