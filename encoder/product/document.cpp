// SPDX-License-Identifier: MIT
// Reads a stream or a pack, so that nobody else needs to know which of them it is.
#include "encoder/product/document.hpp"

#include <memory>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/export/system.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/product/phases.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {
namespace {

DecodedStream decoded(const std::string& name, std::vector<uint8_t> bytes) {
  DecodedTerrain terrain = with_file_context(name, [&] { return DecodedTerrain(bytes); });
  return {std::move(bytes), std::move(terrain)};
}

std::variant<PackFile, DecodedStream> content_of(const std::string& name,
                                                 std::unique_ptr<ByteSource> bytes) {
  refuse_shard(name, *bytes);
  if (!is_pack(*bytes)) {
    return decoded(name,
                   with_file_context(name, [&] { return bytes_at(*bytes, 0, bytes->size()); }));
  }
  return with_file_context(name, [&] { return PackFile(std::move(bytes)); });
}

std::variant<PackFile, DecodedStream> content_of(const std::string& path) {
  if (is_regular_file(path)) return content_of(path, open_file(path));
  return read_stream(path);
}

bool has_classes(const std::string& path) {
  const std::string first = path.empty() ? path : files_in(path)[0];
  const std::string suffix = suffix_of(first);
  return suffix == ".las" || suffix == ".laz";
}

// Keeps the points that the document stands for.
void thin(PointCloud& cloud, const Metadata& metadata) {
  auto thin = thinned(cloud, metadata.placement, metadata.duplicates);
  if (thin) cloud = std::move(*thin);
}

std::variant<Source, OpenSource> source_for(const Document& document, const std::string& path,
                                            Preparation preparation) {
  const Metadata metadata = document.metadata();
  if (metadata.bounds) {
    preparation.max_error = metadata.bounds->unscaled;
  } else if (metadata.accuracy) {
    preparation.max_error = metadata.accuracy->bound;
  }
  if (!preparation.classes && has_classes(path)) preparation.classes = metadata.classes;
  if (document.pack() != nullptr) {
    OpenSource source = prepared_source(path, preparation);
    if (auto* const cloud = std::get_if<PointCloud>(&source)) thin(*cloud, metadata);
    return source;
  }
  Source source = prepared_terrain(path, preparation);
  if (auto* const cloud = std::get_if<PointCloud>(&source)) thin(*cloud, metadata);
  return source;
}

}  // namespace

DecodedStream read_stream(const std::string& path) {
  const std::string text = read_file(path);
  std::vector<uint8_t> bytes(text.begin(), text.end());
  const std::unique_ptr<ByteSource> source = bytes_in_memory(bytes);
  refuse_shard(path, *source);
  if (is_pack(*source)) {
    throw Error(path +
                ": is a pack, which cannot stand for a stream or come from a pipe; name a file");
  }
  return decoded(path, std::move(bytes));
}

Document::Document(const std::string& path) : path_(path), content_(content_of(path)) {}

Document::Document(const std::string& name, std::unique_ptr<ByteSource> bytes)
    : path_(name), content_(content_of(name, std::move(bytes))) {}

Metadata Document::metadata() const {
  if (pack() != nullptr) return pack()->metadata();
  return with_file_context(path_, [&] { return read_header(stream()->bytes).metadata; });
}

uint64_t Document::bytes() const {
  return pack() != nullptr ? pack()->bytes() : stream()->bytes.size();
}

uint64_t Document::vertices() const {
  return pack() != nullptr ? pack()->vertices()
                           : microtin_mesh_vertex_count(stream()->terrain.mesh());
}

uint64_t Document::counted_vertices() const {
  if (pack() == nullptr) return vertices();
  return with_file_context(path_, [&] { return pack()->counted_vertices(); });
}

uint64_t Document::tiles() const {
  return pack() != nullptr ? pack()->entries().size() : 0;
}

std::optional<DecodedTerrain> Document::tile(uint32_t number) const {
  return with_file_context(path_, [&] { return pack()->tile(number); });
}

SurfaceModel Document::model(uint64_t most_vertices) const {
  const uint64_t vertices = counted_vertices();
  if (vertices > most_vertices) {
    throw Error(path_ + ": its tiles have " + std::to_string(vertices) + " vertices; more than " +
                std::to_string(most_vertices) + " are not read at once: read tile by tile");
  }
  return with_units(with_file_context(path_, [&] {
    return pack() != nullptr ? model_of(*pack()) : model_of(stream()->terrain.mesh());
  }));
}

SurfaceModel Document::model_after(uint64_t bytes) const {
  if (pack() != nullptr) {
    throw Error(path_ + ": is a pack, and " + parameter("first_bytes") +
                " is for streams; leave it out");
  }
  return with_units(
      with_file_context(path_, [&] { return stream::model_after(stream()->bytes, bytes); }));
}

SurfaceModel Document::with_units(SurfaceModel model) const {
  const Metadata notes = metadata();
  model.horizontal_unit = notes.horizontal_unit;
  model.vertical_unit = notes.vertical_unit;
  model.system = system_line(notes);
  return model;
}

SampledSurface Document::sampled() const {
  SampledSurface surface = pack() != nullptr ? exporting::sampled(*pack())
                                             : exporting::sampled(stream()->terrain.mesh());
  surface.is_degrees = metadata().horizontal_unit == Unit::kDegree;
  surface.height_at = [this, height_at = std::move(surface.height_at)](const RealPlace& place) {
    return with_file_context(path_, [&] { return height_at(place); });
  };
  return surface;
}

void expect_water_level(const std::string& path, const std::optional<Decimal>& noted,
                        const std::optional<Decimal>& given) {
  if (!given || (noted && *noted == *given)) return;
  throw Error(path + ": its water level is " + (noted ? to_string(*noted) : "not noted") +
              ", not " + to_string(*given));
}

void expect_same_system(const Metadata& file, const Reference& terrain) {
  const auto differ = [](auto a, auto b) {
    return a != b && a != decltype(a){} && b != decltype(b){};
  };
  const auto expect_unit = [&](Unit of_file, Unit of_terrain) {
    if (!differ(of_file, of_terrain)) return;
    throw Error("the terrain has other units than the encoded file, " +
                std::string(name_of(of_terrain)) + " and " + std::string(name_of(of_file)) +
                "; set them with " + parameter("units"));
  };
  const auto expect_code = [&](uint32_t of_file, uint32_t of_terrain) {
    if (!differ(of_file, of_terrain)) return;
    throw Error("the terrain has another coordinate system than the encoded file, EPSG " +
                std::to_string(of_terrain) + " and " + std::to_string(of_file) + "; set it with " +
                parameter("epsg") + ", or encode the terrain again");
  };
  expect_unit(file.horizontal_unit, terrain.horizontal_unit);
  expect_unit(file.vertical_unit, terrain.vertical_unit);
  expect_code(file.horizontal_epsg, terrain.horizontal_epsg);
  expect_code(file.vertical_epsg, terrain.vertical_epsg);
}

Original::Original(const Document& document, const std::string& path,
                   const Preparation& preparation)
    : document_(document),
      water_level_(preparation.water_level),
      source_(source_for(document, path, preparation)) {
  const Reference& terrain = raster() != nullptr ? raster()->reference : cloud()->reference;
  with_file_context(path, [&] { expect_same_system(document.metadata(), terrain); });
}

const Raster* Original::raster() const {
  if (const auto* whole = std::get_if<Source>(&source_)) return std::get_if<Raster>(whole);
  const auto* reader = std::get_if<std::unique_ptr<RasterReader>>(&std::get<OpenSource>(source_));
  return reader != nullptr ? &(*reader)->frame() : nullptr;
}

const PointCloud* Original::cloud() const {
  return std::visit([](const auto& source) { return std::get_if<PointCloud>(&source); }, source_);
}

Promise Original::promise() const {
  const Metadata metadata = document_.metadata();
  expect_water_level(document_.path(), metadata.water_level, water_level_);
  if (metadata.bounds) return {metadata.bounds->max_error, metadata.bounds, metadata.water_level};
  if (!metadata.accuracy || !metadata.accuracy->bound) return {};
  return {metadata.accuracy->bound, std::nullopt, metadata.water_level};
}

Verification Original::compare(const std::optional<Decimal>& bound, const Progress& progress,
                               const PostVisitor& visit) const {
  if (const auto* whole = std::get_if<Source>(&source_)) {
    const microtin_mesh* const mesh = document_.stream()->terrain.mesh();
    Verification found = verify(mesh, *whole, bound, visit);
    if (raster() != nullptr) {
      found.everywhere = measure_everywhere(mesh, document_.metadata().placement, *raster());
    }
    const std::vector<PhaseEnd> phases = document_.metadata().phases;
    if (!phases.empty()) {
      found.broken = broken_phases(phases, measure_phases(document_.stream()->bytes, *whole));
    }
    return found;
  }
  const PackFile& pack = *document_.pack();
  const auto& source = std::get<OpenSource>(source_);
  if (cloud() != nullptr) return verify(pack, *cloud(), bound, visit);
  return verify(pack, *std::get<std::unique_ptr<RasterReader>>(source), bound, progress, visit);
}

FoundBreaklines Original::breaklines(const BreaklineFile& file) const {
  const Metadata metadata = document_.metadata();
  const Placement& lattice = metadata.placement;
  const std::optional<Decimal> bound = promise().bound;
  std::optional<LineRoom> room;
  if (bound) {
    room = terrain::room_of(*bound, metadata.side == BoundSide::kNeverBelow,
                            exact::step_of(lattice.z));
  }
  if (const auto* const whole = std::get_if<Source>(&source_)) {
    const DecodedTerrain& decoded = document_.stream()->terrain;
    const std::vector<LatticeLine> lines =
        lines_over(terrain::line_ground_of(*whole, lattice), file.lines, lattice);
    FoundBreaklines found = find_breaklines(decoded.mesh(), lines, room, lattice);
    found.wrong_marks =
        compare_marks(decoded.mesh(), decoded.lines(), lines, file.classes, room, lattice);
    return found;
  }
  const auto* const raster =
      std::get_if<std::unique_ptr<RasterReader>>(&std::get<OpenSource>(source_));
  if (raster == nullptr) {
    throw Error(document_.path() + ": is a pack of points, which has no " +
                parameter("breaklines") + "; leave it out");
  }
  return with_file_context(document_.path(), [&] {
    return find_breaklines(*document_.pack(), **raster, file.lines, room);
  });
}

Original::Judgement Original::judge(const Progress& progress) const {
  const Promise promised = promise();
  const OwnBounds& own = raster() != nullptr ? raster()->bounds : cloud()->bounds;
  if (promised.bounds.has_value() != own.unscaled.has_value()) {
    throw Error(document_.path() +
                (promised.bounds ? ": has bounds of an error map or of obstacles; name them with "
                                 : ": has no bounds of an error map or of obstacles; leave out ") +
                parameter("error_map") + " or " + parameter("obstacles"));
  }
  const int decimals = raster() != nullptr ? raster()->decimals : cloud()->z_decimals;
  WaterGauge gauge(decimals, promised.water_level);
  const Verification found = with_file_context(document_.path(), [&] {
    if (document_.pack() != nullptr) {
      document_.pack()->expect_as_stated();
    } else {
      const DecodedStream& stream = *document_.stream();
      expect_as_stated(stream.bytes, stream.terrain.mesh());
    }
    return compare(promised.bound, progress,
                   promised.water_level ? gauge.visitor() : PostVisitor());
  });
  Judgement judgement{promised, found, gauge.moved(), std::nullopt, std::nullopt};
  const std::optional<Accuracy> noted = document_.metadata().true_places;
  if (cloud() == nullptr || !noted) return judgement;
  const SampledSurface surface = document_.sampled();
  judgement.true_bound = noted->bound && promised.bounds ? promised.bound : noted->bound;
  judgement.true_places =
      verify_at_true_places(surface.height_at, surface.placement, *cloud(), judgement.true_bound);
  return judgement;
}

OpenPack open_pack(const std::string& path) {
  std::unique_ptr<ByteSource> bytes = open_file(path);
  refuse_shard(path, *bytes);
  return with_file_context(path, [&] {
    if (!is_pack(*bytes)) throw Error("is not a pack; name a pack (.mtp)");
    const ByteSource& same = *bytes;
    PackFile file(std::move(bytes), PackFile::Index::kLater);
    file.expect_index();
    const uint32_t header_bytes = pack_index_start(file.header());
    return OpenPack{bytes_at(same, 0, header_bytes), std::move(file)};
  });
}

}  // namespace microtin::product
