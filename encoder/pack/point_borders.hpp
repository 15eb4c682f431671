// SPDX-License-Identifier: MIT
// The borders between the tiles of a pack of points (format-pack.md, section 3).
#ifndef MICROTIN_ENCODER_PACK_POINT_BORDERS_HPP
#define MICROTIN_ENCODER_PACK_POINT_BORDERS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/global_triangulation.hpp"
#include "encoder/pack/point_survey.hpp"

namespace microtin::pack {

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

}  // namespace microtin::pack

#endif
