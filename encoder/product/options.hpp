// SPDX-License-Identifier: MIT
// What an encoding is to keep, and what follows from that for its parts.
#ifndef MICROTIN_ENCODER_PRODUCT_OPTIONS_HPP
#define MICROTIN_ENCODER_PRODUCT_OPTIONS_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/terrain/metadata.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::product {

// The autopilot whose adapter (decoder/adapters) reads a pack.
enum class Adapter { kNone, kInav, kArduPilot };

// What an adapter needs besides its pack.
constexpr uint32_t kAdapterTiles = 9;     // for the places that ArduPilot queries in each update
constexpr uint64_t kAdapterBytes = 3072;  // of RAM: microtin_inav or microtin_ardupilot

struct EncodeOptions {
  LatticeOptions lattice;
  uint32_t max_vertices = 0;   // 0: as many as it takes
  uint32_t max_bytes = 0;      // 0: as many as it takes; else the bound is looked for
  uint32_t tile_vertices = 0;  // of a pack: at most this many in a tile; 0: as device_ram
                               // allows or, without it, the usual number
  uint32_t tile_size = 0;      // of a pack of posts; 0: to be chosen
  uint64_t device_ram = 0;     // 0: unlimited
  Adapter adapter = Adapter::kNone;
  std::string resume;         // of packs of rasters: keeps finished tiles; empty: none does
  bool few_vertices = false;  // with a bound: rather than few bytes
  Search search = Search::kNormal;
  Effort effort;
  std::optional<Reference> reference;  // in place of the terrain's own, settled
  SurfaceKind surface = SurfaceKind::kUnknown;
  bool digest = false, phases = false;  // of streams: notes that are measured
  SourceNotes notes;  // what they state comes before what the terrain's file states
};

// What the header will say of a terrain whose file says this, but for its place and the accuracy.
// Throws Error as completed does, and if the places of a terrain in degrees are none on Earth.
Metadata metadata_of(const EncodeOptions& options, const Raster& frame);
Metadata metadata_of(const EncodeOptions& options, const PointCloud& cloud);

// What a header says, and in its place what the options say of the source.
Metadata noted(Metadata metadata, const EncodeOptions& options);

// The options for a source whose posts have bounds of their own: max_error is that for which they
// hold as they are, unless it is set. Throws Error if the options contradict.
EncodeOptions mapped(EncodeOptions options, const OwnBounds& bounds);

// Makes options those of a terrain that is raised to obstacles: nowhere below it, between posts,
// too, and of their kind. Throws Error without a bound.
void imply_obstacles(EncodeOptions& options);

// Throws Error if the bound is to hold between posts, and there are none.
void refuse_everywhere_of_points(const EncodeOptions& options);

// Throws Error if an option is set that packs do not have.
void refuse_options_of_streams(const EncodeOptions& options);

// The vertices that a stream may have, 0 for as many as it takes. A device's RAM limits them, too;
// with a bound it can only refuse.
uint32_t vertex_limit(const EncodeOptions& options);

// Tiles are encoded side by side, each by one thread; a stream has them all.
SimplifyOptions simplify_options(const EncodeOptions& options, std::size_t threads,
                                 const Progress& progress);

}  // namespace microtin::product

#endif
