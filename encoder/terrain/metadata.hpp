// SPDX-License-Identifier: MIT
// What a header states about a terrain: where it lies, in which units, and how good it is.
#ifndef MICROTIN_ENCODER_TERRAIN_METADATA_HPP
#define MICROTIN_ENCODER_TERRAIN_METADATA_HPP

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/own_bounds.hpp"
#include "encoder/terrain/source_notes.hpp"
#include "shared/format.hpp"

namespace microtin::terrain {

// The largest distances of a surface below and above another, in the source's unit, rounded up to 9
// decimals.
struct Distances {
  Decimal below, above;
};

// Distances everywhere, from the bilinear surface of a raster's posts, as headers state them: in
// sixteenths of a z step.
struct Margins {
  uint32_t below = kNotStated, above = kNotStated;
};

inline bool is_stated(const Margins& margins) {
  return margins.below != kNotStated && margins.above != kNotStated;
}

// What the heights of a source are. The numbers are those of the note.
enum class SurfaceKind : uint8_t {
  kUnknown = 0,
  kGround = 1,
  kTop = 2,  // with vegetation and buildings
  kBed = 3,  // of the sea or of a lake
  kGeoid = 4,
  kObstacles = 5  // an envelope: no obstacle is above
};

// Where the surface may be, as far as the bound. The numbers are those of the note.
enum class BoundSide : uint8_t { kNotStated = 0, kBoth = 1, kNeverBelow = 2, kNeverAbove = 3 };

inline BoundSide side_of(const std::optional<Decimal>& bound, bool never_below) {
  if (!bound) return BoundSide::kNotStated;
  return never_below ? BoundSide::kNeverBelow : BoundSide::kBoth;
}

// Heights in the source's unit.
struct Accuracy {
  std::optional<Decimal> bound;  // requested
  Decimal max_error;             // measured at every sample of the source
  Decimal rms_error;
  Decimal mean_error;  // above 0: the terrain is too high
};

// Bounds that posts have of their own, and how to find them in a map of them again.
struct StatedBounds {
  BoundSpan span;     // of all samples
  Decimal max_error;  // where the map states nothing
  Decimal unscaled;   // bounds are those of the map times max_error / unscaled
};

// What a header states of them, but for the span, if there are any.
inline std::optional<StatedBounds> stated_bounds(const OwnBounds& own,
                                                 const std::optional<Decimal>& max_error) {
  if (!own.unscaled || !max_error) return std::nullopt;
  return StatedBounds{{}, *max_error, *own.unscaled};
}

// The bound that all samples keep: the largest of their own ones, if all have one.
inline std::optional<Decimal> bound_of_all(const std::optional<Decimal>& max_error,
                                           const std::optional<BoundSpan>& span) {
  if (!span) return max_error;
  return span->unbounded == 0 ? std::optional(span->largest) : std::nullopt;
}

// The posts of a raster, or the centres of its cells. Row 0 is the southernmost.
struct PostGrid {
  uint32_t columns, rows;  // at least 1
  Axis x, y;               // from a post's column and row to where it lies
};

// Classes of points in a LAS file.
using ClassSet = std::bitset<256>;

// Which height stands for points that share a place of the lattice.
enum class DuplicateRule : uint8_t {
  kUnknown = 0,
  kMiddle = 1,  // of the lowest and the highest
  kLowest = 2,
  kHighest = 3,
  kMean = 4,
  kMedian = 5
};

// What the tiles of a pack have together; vertices on borders count once for each of their tiles.
struct TileSums {
  uint64_t vertices, tiles;  // tiles with terrain
};

// A terrain at the end of a section of its stream, which completes a phase or the first few.
struct PhaseEnd {
  uint32_t vertices;
  uint64_t bytes;                    // of all sections so far
  std::optional<Decimal> max_error;  // at the samples of the source that the surface covers then
};

// What another stream or pack in the same file is. The numbers are those of the note.
enum class PlaceKind : uint8_t {
  kUnknown = 0,
  kOverview = 1,  // the terrain with fewer vertices
  kObstacles = 2,
  kGeoid = 3,
  kErrors = 4  // heights are errors of the terrain
};

// What a place's offset counts from. The numbers are those of the note.
enum class PlaceBase : uint8_t {
  kUnknown = 0,
  kStart = 1,  // the first byte of what has the note, forwards
  kEnd = 2     // the end of the file, backwards
};

// Where another stream or pack is in the same file.
struct FilePlace {
  PlaceKind kind;
  PlaceBase base;
  uint64_t offset, size;
};

// All texts together have at most 65535 bytes.
struct Metadata : SourceNotes {
  Placement placement;
  Unit horizontal_unit = Unit::kUnknown;
  Unit vertical_unit = Unit::kUnknown;
  uint32_t horizontal_epsg = 0;  // 0: not stated
  uint32_t vertical_epsg = 0;
  std::string wkt;                      // of the horizontal system, where it has no code
  std::optional<Decimal> water_level;   // surfaces at this very height are water
  std::optional<Accuracy> accuracy;     // with each sample at its nearest lattice place
  std::optional<Accuracy> true_places;  // with each point where it truly lies
  SurfaceKind surface = SurfaceKind::kUnknown;
  BoundSide side = BoundSide::kNotStated;
  std::optional<Distances> at_samples;  // with each sample at its nearest lattice place
  Margins everywhere;                   // in a header's fixed part, not a note
  std::optional<StatedBounds> bounds;   // if samples have bounds of their own
  std::optional<PostGrid> grid;         // of the source, if it is a raster
  std::optional<ClassSet> classes;      // of points that were taken
  DuplicateRule duplicates = DuplicateRule::kUnknown;
  std::optional<TileSums> sums;    // in packs alone
  std::optional<uint64_t> digest;  // of the decoded mesh; in streams alone
  std::vector<PhaseEnd> phases;    // in streams alone
  std::vector<FilePlace> places;
};

}  // namespace microtin::terrain

#endif
