// SPDX-License-Identifier: MIT
// Takes apart what is requested.
#include "encoder/product/options.hpp"

#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/stream/device_memory.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::product {
namespace {

Metadata metadata_for(const EncodeOptions& options, const Reference& file) {
  const Reference reference = completed(options.reference ? *options.reference : file);
  Metadata metadata;
  metadata.horizontal_unit = reference.horizontal_unit;
  metadata.vertical_unit = reference.vertical_unit;
  metadata.horizontal_epsg = reference.horizontal_epsg;
  metadata.vertical_epsg = reference.vertical_epsg;
  if (metadata.horizontal_epsg == 0) metadata.wkt = reference.wkt;
  static_cast<SourceNotes&>(metadata) = reference.notes;
  metadata.water_level = options.lattice.water_level;
  return noted(std::move(metadata), options);
}

template <class Terrain>
Metadata checked_metadata(const EncodeOptions& options, const Terrain& terrain) {
  Metadata metadata = metadata_for(options, terrain.reference);
  if (metadata.horizontal_unit == Unit::kDegree) expect_on_earth(terrain);
  return metadata;
}

}  // namespace

Metadata noted(Metadata metadata, const EncodeOptions& options) {
  if (options.surface != SurfaceKind::kUnknown) metadata.surface = options.surface;
  static_cast<SourceNotes&>(metadata) = preferred(options.notes, metadata);
  return metadata;
}

Metadata metadata_of(const EncodeOptions& options, const Raster& frame) {
  return checked_metadata(options, frame);
}

Metadata metadata_of(const EncodeOptions& options, const PointCloud& cloud) {
  return checked_metadata(options, cloud);
}

EncodeOptions mapped(EncodeOptions options, const OwnBounds& bounds) {
  if (bounds.unscaled && !options.lattice.max_error) options.lattice.max_error = bounds.unscaled;
  return options;
}

void imply_obstacles(EncodeOptions& options) {
  if (!options.lattice.max_error) {
    throw Error(parameter("obstacles") + " needs " + parameter("max_error"));
  }
  options.lattice.never_below = true;
  options.lattice.bound_at = BoundScope::kEverywhere;
  if (options.surface == SurfaceKind::kUnknown) options.surface = SurfaceKind::kObstacles;
}

void refuse_everywhere_of_points(const EncodeOptions& options) {
  if (options.lattice.bound_at != BoundScope::kEverywhere) return;
  throw Error(parameter("bound_at") +
              " everywhere is for rasters, and these are points; leave it out");
}

void refuse_options_of_streams(const EncodeOptions& options) {
  if (options.max_vertices != 0 || options.max_bytes != 0) {
    throw Error(parameter("max_vertices") + " and " + parameter("max_bytes") +
                " are for streams; for a pack use " + parameter("max_error") + ", or no bound");
  }
  if (options.digest || options.phases) {
    throw Error(parameter(options.digest ? "digest" : "phases") +
                " is an option of streams; leave it out");
  }
}

uint32_t vertex_limit(const EncodeOptions& options) {
  if (options.device_ram == 0 || options.lattice.max_error) return options.max_vertices;
  const uint32_t fitting = most_vertices(options.device_ram);
  return options.max_vertices == 0 ? fitting : std::min(options.max_vertices, fitting);
}

SimplifyOptions simplify_options(const EncodeOptions& options, std::size_t threads,
                                 const Progress& progress) {
  SimplifyOptions simplify;
  simplify.threads = threads;
  simplify.bounded = options.lattice.max_error.has_value();
  simplify.max_vertices = vertex_limit(options);
  simplify.search = options.search;
  simplify.effort = options.effort;
  simplify.few_vertices = options.few_vertices;
  simplify.progress = progress;
  return simplify;
}

}  // namespace microtin::product
