// SPDX-License-Identifier: MIT
// Meshes and lines in formats that other programs read.
#include "encoder/export/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/export/json.hpp"
#include "encoder/export/scene.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::exporting {

// Writes XYZ, OBJ and PLY line by line.

namespace {

void write_vertices(const SurfaceModel& model, Coordinates coordinates, const std::string& prefix,
                    OutputFile& out) {
  const Placement placement = coordinates == Coordinates::kReal ? model.placement : Placement();
  const CoordinateText x_text(placement.x), y_text(placement.y), z_text(placement.z);
  for (const auto& [x, y, z] : model.vertices) {
    out.write(prefix + x_text(x) + ' ' + y_text(y) + ' ' + z_text(z) + '\n');
  }
}

// One line for each triangle; the first vertex has number `first`.
void write_triangles(const SurfaceModel& model, const std::string& prefix, uint32_t first,
                     OutputFile& out) {
  for (const auto& corners : model.triangles) {
    std::string line = prefix;
    for (const uint32_t corner : corners) line += ' ' + std::to_string(corner + first);
    out.write(line + '\n');
  }
}

void write_ply_header(const SurfaceModel& model, Coordinates coordinates, OutputFile& out) {
  const bool is_placed = coordinates == Coordinates::kReal && !model.system.empty();
  out.write("ply\nformat ascii 1.0\n" +
            (is_placed ? "comment crs: " + model.system + '\n' : std::string()) +
            "element vertex " + std::to_string(model.vertices.size()) +
            "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
            std::to_string(model.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n");
}

}  // namespace

MeshFormat mesh_format_of(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (path == "-" || suffix == ".xyz") return MeshFormat::kXyz;
  if (suffix == ".obj") return MeshFormat::kObj;
  if (suffix == ".ply") return MeshFormat::kPly;
  if (suffix == ".glb") return MeshFormat::kGlb;
  throw Error(path +
              ": not a kind of file that is written (.xyz, .obj, .ply, .glb, .asc, .geojson, .dat, "
              ".ter); gdal_translate and ogr2ogr with the driver MTIN write others");
}

uint64_t most_mesh_bytes(const SampledSurface& surface, uint64_t vertices, MeshFormat format,
                         Coordinates coordinates) {
  constexpr uint64_t kHead = 65536 + 4096;  // a ply's has a text of the header
  const uint64_t triangles = format == MeshFormat::kXyz ? 0 : 2 * vertices;
  if (format == MeshFormat::kGlb) return kHead + glb_bytes(vertices, triangles);
  const Placement placement = coordinates == Coordinates::kReal ? surface.placement : Placement();
  const size_t vertex = std::string("v   \n").size() +
                        CoordinateText(placement.x).longest(surface.x_min, surface.x_max) +
                        CoordinateText(placement.y).longest(surface.y_min, surface.y_max) +
                        CoordinateText(placement.z).longest(surface.lowest, surface.highest);
  const size_t triangle = std::string("f   \n").size() + 3 * std::to_string(vertices).size();
  return kHead + vertices * vertex + triangles * triangle;
}

void export_model(const SurfaceModel& model, MeshFormat format, Coordinates coordinates,
                  OutputFile& out) {
  switch (format) {
    case MeshFormat::kXyz:
      write_vertices(model, coordinates, "", out);
      break;
    case MeshFormat::kObj:
      write_vertices(model, coordinates, "v ", out);
      write_triangles(model, "f", 1, out);
      break;
    case MeshFormat::kPly:
      write_ply_header(model, coordinates, out);
      write_vertices(model, coordinates, "", out);
      write_triangles(model, "3", 0, out);
      break;
    case MeshFormat::kGlb:
      export_glb(model, coordinates, out);
      break;
  }
}

// Puts vertices, normals and triangles into one glTF file, centred and in metres.

namespace {

// The length of a unit; of one without a fixed length as if it were a metre.
double length_of(Unit unit) {
  return metres_per(unit).value_or(1);
}

double real(const Axis& axis, double number) {
  return (static_cast<double>(axis.offset) + static_cast<double>(axis.numerator) * number) /
         static_cast<double>(axis.denominator);
}

// What glTF wants of a surface.
class Scene {
 public:
  Scene(const SurfaceModel& model, Coordinates coordinates) : model_(model) {
    const bool is_real = coordinates == Coordinates::kReal;
    const Placement placement = is_real ? model.placement : Placement();
    const Unit horizontal_unit = is_real ? model.horizontal_unit : Unit::kUnknown;
    const Unit vertical_unit = is_real ? model.vertical_unit : Unit::kUnknown;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto less = [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; };
      const auto [low, high] =
          std::minmax_element(model.vertices.begin(), model.vertices.end(), less);
      low_[axis] = (*low)[axis];
      high_[axis] = (*high)[axis];
    }
    const double y = real(placement.y, middle(1));
    origin_ = {real(placement.x, middle(0)), y, real(placement.z, middle(2))};
    const double metres = length_of(horizontal_unit);
    const Degree unit = horizontal_unit == Unit::kDegree ? degree_at(y) : Degree{metres, metres};
    scale_ = {unit.x * step_of(placement.x), unit.y * step_of(placement.y),
              length_of(vertical_unit) * step_of(placement.z)};
    find_normals();
  }

  Vector origin() const { return origin_; }

  // Metres from the origin.
  std::array<float, 3> position(size_t vertex) const { return upright(place(vertex)); }
  std::array<float, 3> normal(size_t vertex) const { return upright(normals_[vertex]); }

  // Linear red, green and blue, and full opacity, in 255ths.
  std::array<uint8_t, 4> colour(size_t vertex) const {
    const double range = std::max<double>(1, static_cast<double>(high_[2] - low_[2]));
    const Colour c = tint(static_cast<double>(model_.vertices[vertex][2] - low_[2]) / range);
    const auto linear = [](double s) {
      const double l = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
      return static_cast<uint8_t>(std::lround(255 * l));
    };
    return {linear(c.r), linear(c.g), linear(c.b), 255};
  }

 private:
  double middle(size_t axis) const {
    return (static_cast<double>(low_[axis]) + static_cast<double>(high_[axis])) / 2;
  }

  // From z up to y up: east, up, south.
  static std::array<float, 3> upright(Vector v) {
    return {static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)};
  }

  Vector place(size_t vertex) const {
    const auto& [x, y, z] = model_.vertices[vertex];
    return {(static_cast<double>(x) - middle(0)) * scale_.x,
            (static_cast<double>(y) - middle(1)) * scale_.y,
            (static_cast<double>(z) - middle(2)) * scale_.z};
  }

  void find_normals() {
    normals_.assign(model_.vertices.size(), {0, 0, 0});
    for (const auto& [a, b, c] : model_.triangles) {
      const Vector normal = cross_product(place(b) - place(a), place(c) - place(a));
      for (const uint32_t v : {a, b, c}) normals_[v] = normals_[v] + normal;
    }
    for (Vector& normal : normals_) normal = normal.z > 0 ? normalised(normal) : Vector{0, 0, 1};
  }

  const SurfaceModel& model_;
  std::array<int64_t, 3> low_{}, high_{};
  Vector origin_{}, scale_{};
  std::vector<Vector> normals_;
};

std::string array(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return "[" + text + "]";
}

std::string triple(const std::array<float, 3>& v) {
  return array({json(double{v[0]}), json(double{v[1]}), json(double{v[2]})});
}

constexpr uint64_t kPositionBytes = 12, kNormalBytes = 12, kColourBytes = 4, kTriangleBytes = 12;

std::string describe(const SurfaceModel& model, const Scene& scene) {
  constexpr int kFloat = 5126, kByte = 5121, kUint = 5125, kVertices = 34962, kIndices = 34963;
  const uint64_t vertices = model.vertices.size(), triangles = model.triangles.size();
  std::array<float, 3> low = scene.position(0), high = low;
  for (size_t v = 1; v < vertices; ++v) {
    const std::array<float, 3> position = scene.position(v);
    for (size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], position[i]);
      high[i] = std::max(high[i], position[i]);
    }
  }
  uint64_t end = 0;
  const auto view = [&end](uint64_t bytes, int target) {
    end += bytes;
    return json(JsonObject{{"buffer", "0"},
                           {"byteOffset", json(end - bytes)},
                           {"byteLength", json(bytes)},
                           {"target", json(target)}});
  };
  const auto accessor = [](int number, int type, uint64_t count, std::string_view shape) {
    return JsonObject{{"bufferView", json(number)},
                      {"componentType", json(type)},
                      {"count", json(count)},
                      {"type", json(shape)}};
  };
  JsonObject positions = accessor(0, kFloat, vertices, "VEC3");
  positions.emplace_back("min", triple(low));
  positions.emplace_back("max", triple(high));
  JsonObject colours = accessor(2, kByte, vertices, "VEC4");
  colours.emplace_back("normalized", "true");
  const Vector o = scene.origin();
  const std::string views =
      array({view(vertices * kPositionBytes, kVertices), view(vertices * kNormalBytes, kVertices),
             view(vertices * kColourBytes, kVertices), view(triangles * kTriangleBytes, kIndices)});
  const JsonObject asset = {
      {"version", json(std::string_view("2.0"))},
      {"generator", json(std::string_view("microtin"))},
      {"extras", json(JsonObject{{"origin", array({json(o.x), json(o.y), json(o.z)})}})}};
  return json(JsonObject{
      {"asset", json(asset)},
      {"scene", "0"},
      {"scenes", R"([{"nodes": [0]}])"},
      {"nodes", R"([{"mesh": 0, "name": "terrain"}])"},
      {"meshes", R"([{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}, )"
                 R"("indices": 3, "material": 0}]}])"},
      {"materials", R"([{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}, )"
                    R"("doubleSided": true}])"},
      {"accessors", array({json(positions), json(accessor(1, kFloat, vertices, "VEC3")),
                           json(colours), json(accessor(3, kUint, 3 * triangles, "SCALAR"))})},
      {"bufferViews", views},
      {"buffers", array({json(JsonObject{{"byteLength", json(end)}})})}});
}

// Writes numbers of 32 bits, low bytes first.
class WordWriter {
 public:
  explicit WordWriter(OutputFile& out) : out_(out) {}

  void write(uint64_t word) {
    std::array<char, 4> bytes{};
    for (size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(word >> 8 * i & 255);
    out_.write({bytes.data(), bytes.size()});
  }

  void write(const std::array<float, 3>& vector) {
    for (const float value : vector) {
      uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      write(bits);
    }
  }

 private:
  OutputFile& out_;
};

}  // namespace

uint64_t glb_bytes(uint64_t vertices, uint64_t triangles) {
  return vertices * (kPositionBytes + kNormalBytes + kColourBytes) + triangles * kTriangleBytes;
}

void export_glb(const SurfaceModel& model, Coordinates coordinates, OutputFile& out) {
  constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const uint64_t body = glb_bytes(model.vertices.size(), model.triangles.size());
  const Scene scene(model, coordinates);
  std::string head = describe(model, scene);
  head.resize((head.size() + 3) / 4 * 4, ' ');
  const uint64_t size = 12 + 8 + head.size() + 8 + body;
  if (size > std::numeric_limits<uint32_t>::max())
    throw Error("a .glb holds at most 4 GB; write a .ply file");
  WordWriter words(out);
  for (const uint64_t word :
       {uint64_t{kMagic}, uint64_t{kVersion}, size, head.size(), uint64_t{kJson}}) {
    words.write(word);
  }
  out.write(head);
  words.write(body);
  words.write(kBinary);
  for (size_t v = 0; v < model.vertices.size(); ++v) words.write(scene.position(v));
  for (size_t v = 0; v < model.vertices.size(); ++v) words.write(scene.normal(v));
  for (size_t v = 0; v < model.vertices.size(); ++v) {
    const std::array<uint8_t, 4> c = scene.colour(v);
    out.write({reinterpret_cast<const char*>(c.data()), c.size()});
  }
  for (const auto& corners : model.triangles) {
    for (const uint32_t corner : corners) words.write(corner);
  }
}

// Writes lines as GeoJSON.

void export_lines(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                  const Placement& placement, OutputFile& out) {
  const CoordinateText x_text(placement.x), y_text(placement.y), z_text(placement.z);
  out.write("{\"type\": \"FeatureCollection\", \"features\": [");
  const char* before = "\n";
  for (const MarkedLine& line : lines) {
    out.write(before + std::string("{\"type\": \"Feature\", \"properties\": {\"class\": ") +
              json(name_of(line.kind)) +
              "}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [");
    std::string places;
    for (const uint32_t v : line.vertices) {
      const Vertex vertex = vertex_of(mesh, v);
      places += (places.empty() ? "[" : ", [") + x_text(vertex.x) + ", " + y_text(vertex.y) + ", " +
                z_text(vertex.z) + ']';
    }
    out.write(places + "]}}");
    before = ",\n";
  }
  out.write("\n]}\n");
}

}  // namespace microtin::exporting
