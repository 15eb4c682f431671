// SPDX-License-Identifier: MIT
// A cloud of points in tiles: a triangulation of all its points; the cloud on the lattice of the
// pack, which is wider than that of a stream; the borders between tiles (format-pack.md, section
// 3); and each tile. The triangulation and the borders have sources of their own.
#ifndef MICROTIN_ENCODER_PACK_POINT_TILES_HPP
#define MICROTIN_ENCODER_PACK_POINT_TILES_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/terrain/lay_out.hpp"

namespace microtin::pack {

// Built once, to be looked at. Exact; where several points lie on an empty circle, the places alone
// decide which diagonals there are. About 80 bytes a point, O(n log n).
class GlobalTriangulation {
 public:
  // Vertex i is points[i]; coordinates below 2^31, no place twice. Throws Error if all points lie
  // on one line.
  explicit GlobalTriangulation(std::vector<GlobalPost> points);

  // Calls visit(a, b) once for every edge between two vertices.
  template <class Visit>
  void visit_edges(const Visit& visit) const {
    for (uint32_t h = 0; h < origin_.size(); ++h) {
      const uint32_t a = origin_[h], b = origin_[next(h)];
      if (h < twin_[h] && a != infinity() && b != infinity()) visit(a, b);
    }
  }

 private:
  static uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static uint32_t previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  uint32_t infinity() const { return static_cast<uint32_t>(points_.size()); }

  void start(uint32_t a, uint32_t b, uint32_t c);
  void add_triangle(uint32_t a, uint32_t b, uint32_t c);
  void pair(uint32_t g, uint32_t h);
  uint32_t infinite_edge(uint32_t triangle) const;
  uint32_t locate(GlobalPost p, uint32_t triangle) const;
  bool conflicts(uint32_t triangle, GlobalPost p) const;
  void find_cavity(uint32_t v, uint32_t triangle);
  void fill_cavity(uint32_t v);

  std::vector<GlobalPost> points_;
  std::vector<uint32_t> origin_, twin_;  // of half-edges, three for each triangle

  // For the insertion in hand.
  std::vector<uint32_t> seen_by_;      // by triangle: the last vertex that it was in conflict with
  std::vector<uint32_t> cavity_;       // triangles
  std::vector<uint32_t> starting_at_;  // by vertex: the new half-edge along the border
  struct Side {
    uint32_t from, to, outside;
  };
  std::vector<Side> sides_;
};

// As a Sample, anywhere in the pack.
struct GlobalSample {
  GlobalPost place;
  int32_t height, lowest, highest;
};

struct PointSurvey {
  Lattice lattice;
  uint32_t x_max, y_max;              // of the samples
  std::vector<GlobalSample> samples;  // distinct places, in lexicographic order
  Decimal xy_step, z_step;
  Decimal xy_displacement;  // as in Laid
  uint64_t merged = 0;
};

// Lays the cloud out as lay_out does, but on choose_pack_lattice. Throws Error as these do; places
// where the bound cannot be kept are counted within 2^16 x 2^16 places. O(n log n).
PointSurvey survey_points(const PointCloud& cloud, const LatticeOptions& options);

std::vector<GlobalPost> places_of(const std::vector<GlobalSample>& samples);

// A place that no pack has.
constexpr GlobalPost kNowhere{UINT32_MAX, UINT32_MAX};

// Where the points of a cloud lie on a lattice so placed; kNowhere beyond the largest x and y.
std::vector<GlobalPost> places_on(const PointCloud& cloud, const Placement& lattice, uint32_t x_max,
                                  uint32_t y_max);

// The placement of a part of the lattice whose places count from there. Throws Error if no axis can
// say that.
Placement placement_from(const Placement& whole, GlobalPost first);

// The points with these numbers.
PointCloud part_of(const PointCloud& cloud, const std::vector<uint32_t>& points);

// The height of a line's crossing with an edge of the triangulation, or of a sample on the line.
struct Crossing {
  int64_t at;      // along the line, 16 fractional bits, rounded down
  int32_t height;  // 16 fractional bits
  const GlobalSample* sample = nullptr;
};

// The surface of the triangulation along a line from side to side of the pack.
class Profile {
 public:
  void add_sample(uint32_t at, const GlobalSample& sample);
  // numerator / denominator is where along the line.
  void add_crossing(Wide numerator, Wide denominator, int32_t height);
  void sort();

  bool is_empty() const { return crossings_.empty(); }
  const std::vector<Crossing>& crossings() const { return crossings_; }  // once sorted, along it

  // The places along the line from where it enters the hull to where it leaves, rounded outwards.
  uint32_t first() const { return first_; }
  uint32_t last() const { return last_; }
  bool holds(uint32_t place) const { return !is_empty() && first_ <= place && place <= last_; }

  // The crossing there; if there is none, one with the height between its neighbours, or of the
  // nearest. Must be sorted and not empty.
  Crossing at(uint32_t place) const;

 private:
  std::vector<Crossing> crossings_;
  uint32_t first_ = UINT32_MAX, last_ = 0;
};

// How far a border may be from the profile, in steps with 16 fractional bits.
struct BorderTolerance {
  int64_t below, above;
  bool keep_samples;  // those on borders are vertices, at their heights
};

// The bound or, where that is smaller, what a whole step takes. Without a bound the median of the
// differences of height along edges of the triangulation: what is not known between points.
BorderTolerance choose_tolerance(const PointSurvey& survey,
                                 const GlobalTriangulation& triangulation,
                                 const LatticeOptions& options);

class PointBorders {
 public:
  // Simplifies all of them, on all processors. The survey must outlive this.
  PointBorders(const PointSurvey& survey, const GlobalTriangulation& triangulation,
               const TileGrid& grid, const BorderTolerance& tolerance);

  // The vertices that a tile shares with others.
  SharedVertices of_tile(uint32_t tile) const;

 private:
  struct BorderVertex {
    uint16_t at;  // from the piece's first corner
    int16_t height;
  };
  using Piece = std::vector<BorderVertex>;  // from corner to corner

  // All lines of one direction between the sides of the pack.
  struct Lines {
    bool go_north;
    uint32_t spacing, length, piece_length;
    std::vector<Profile> profiles;
    std::vector<std::vector<Piece>> pieces;  // by line

    uint32_t across(GlobalPost p) const { return go_north ? p.x : p.y; }
    uint32_t along(GlobalPost p) const { return go_north ? p.y : p.x; }
    GlobalPost post(std::size_t line, uint32_t at) const;
  };

  void add_samples(Lines& lines) const;
  void cross_edge(Lines& lines, const GlobalSample& from, const GlobalSample& to) const;
  void simplify(Lines& lines) const;
  Piece simplify_piece(const Lines& lines, std::size_t line, uint32_t begin) const;
  std::optional<Crossing> corner(GlobalPost post) const;
  LinePost line_post(const Crossing& crossing, uint32_t at) const;

  const PointSurvey& survey_;
  TileGrid grid_;
  BorderTolerance tolerance_;
  Lines north_, east_;
};

// Numbers of things by the tiles that hold their places, in each of them, in order. Things whose
// place lies outside the pack are in none.
class TileContents {
 public:
  TileContents(const TileGrid& grid, const std::vector<GlobalPost>& places);

  std::vector<uint32_t> of_tile(uint32_t tile) const {
    return {numbers_.begin() + start_[tile], numbers_.begin() + start_[std::size_t{tile} + 1]};
  }
  uint32_t size_of(uint32_t tile) const {
    return static_cast<uint32_t>(start_[std::size_t{tile} + 1] - start_[tile]);
  }

 private:
  std::vector<uint32_t> numbers_;
  std::vector<std::ptrdiff_t> start_;  // by tile, and one more
};

// A cloud that is cut into tiles.
struct TiledCloud {
  const PointCloud& cloud;
  const PointSurvey& survey;
  const GlobalTriangulation& triangulation;  // of the places of the samples
  LatticeOptions lattice;
  SimplifyOptions simplify;
  BorderTolerance tolerance;
  TileGrid grid;
};

class PointTiles {
 public:
  // Both must outlive this.
  PointTiles(const TiledCloud& tiled, const PointBorders& borders);

  // The samples inside a tile and, as fixed ones, the vertices that it shares.
  Survey survey_of(uint32_t tile) const;

  // The vertices that it takes with such options, 0 if it has no terrain.
  uint32_t vertices_of(uint32_t tile, const SimplifyOptions& options) const;

  // Encodes it, given the numbers of the points that lie in it. Throws Error if the decoded stream
  // does not meet the options.
  EncodedTile encode(uint32_t tile, const std::vector<uint32_t>& points) const;

 private:
  const TiledCloud& tiled_;
  const PointBorders& borders_;
  TileContents samples_;
};

}  // namespace microtin::pack

#endif
