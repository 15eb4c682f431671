// SPDX-License-Identifier: MIT
// Breaklines on the lattice: lines along which a surface has edges, and the chains of lattice
// positions that stand for them.
#ifndef MICROTIN_ENCODER_TERRAIN_BREAKLINES_HPP
#define MICROTIN_ENCODER_TERRAIN_BREAKLINES_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::terrain {

// How far a chain is from its line at most, and a line from its chain, in lattice steps. The middle
// of a lattice cell is 0.7072 steps from its corners.
constexpr double kMostShift = 0.71;

// A position of a line, in lattice steps, and its height in z steps.
struct LinePlace {
  double x, y, z;
};

// The part of a line that lies over the terrain.
class LatticeLine {
 public:
  // At least two places, no two neighbours of which have the same x and y.
  LatticeLine(std::vector<LinePlace> places, bool has_heights, uint32_t number);

  const std::vector<LinePlace>& places() const { return places_; }
  bool has_heights() const { return has_heights_; }
  uint32_t number() const { return number_; }  // of the line in its file, from 0 on
  double length() const { return along_.back(); }

  // How much of the line lies before a place of it, in lattice steps.
  double along(std::size_t place) const { return along_[place]; }

  // The place up to which so much of the line lies.
  LinePlace at(double along) const;

  // Where between two lengths the line is nearest to a place.
  double foot(LinePlace wanted, double from, double to) const;

  // The places strictly between two lengths: first .. last - 1.
  struct Range {
    std::size_t first, last;
  };
  Range between(double from, double to) const;

 private:
  std::size_t segment_at(double along) const;

  std::vector<LinePlace> places_;
  std::vector<double> along_;
  bool has_heights_;
  uint32_t number_;
};

double distance(LinePlace a, LinePlace b);

inline LinePlace place_of(Point p) {
  return {double{0} + p.x, double{0} + p.y, 0};
}

// Where on the segment from a to b a place is nearest: 0 at a, 1 at b.
double share_of(LinePlace p, LinePlace a, LinePlace b);

// The lattice step nearest to a coordinate, halves up; it may be off the lattice.
inline double nearest_step(double coordinate) {
  return std::floor(coordinate + 0.5);
}

// The lattice position nearest to a place, halves up.
Point nearest_position(LinePlace place);

// Which parts of lines count: over the convex hull of the samples, and in no cell of posts with a
// void corner. Parts are cut off to a quarter of a step.
struct LineGround {
  std::vector<Point> hull;              // counter-clockwise
  std::vector<Point> voids;             // in lexicographic order
  double x_spacing = 1, y_spacing = 1;  // of posts, in lattice steps
};

LineGround line_ground_of(const Survey& survey, double x_spacing, double y_spacing);
LineGround line_ground_of(const Source& source, const Placement& lattice);

// A whole line on the lattice, over the terrain or not.
struct LinePath {
  std::vector<LinePlace> places;  // no two neighbours have the same x and y
  bool has_heights;
  uint32_t number;  // of the line in its file, from 0 on
};

// Throws Error if the line has two heights at one place.
LinePath path_of(const RealLine& line, uint32_t number, const Placement& lattice);

// Adds the parts of a line that count.
void add_parts(const LineGround& ground, const LinePath& path, std::vector<LatticeLine>& lines);

// Throws Error: no line is where the terrain is.
[[noreturn]] void refuse_lines_elsewhere();

// Takes lines to a lattice, without the parts that lie elsewhere. Throws Error as path_of does, and
// if all of them do.
std::vector<LatticeLine> lines_over(const LineGround& ground, const std::vector<RealLine>& lines,
                                    const Placement& lattice);

// The heights that the bound leaves a surface on a line, in z steps: middle - radius .. middle +
// radius above the line.
struct LineRoom {
  double middle = 0, radius = 0;
};
LineRoom room_of(Decimal max_error, bool never_below, double z_step);

// A lattice position that stands for a place of the line.
struct LineVertex {
  Point place;
  double along;  // of the line's nearest place
};

struct Chain {
  LatticeLine line;
  std::vector<LineVertex> vertices;
};

// The place of a line between two vertices of its chain that is farthest out of what may be
// simplified: from their edge in plan, or by half the room in height. Nothing if none is.
std::optional<std::size_t> worst_between(const LatticeLine& line, LineVertex a, LineVertex b,
                                         LineRoom room);

// A vertex of a chain at a lattice position near the line, at the nearest place between two
// lengths.
LineVertex chain_vertex(const LatticeLine& line, Point place, double from, double to);

// Which lattice positions may be vertices of chains; empty: all.
using PositionTest = std::function<bool(Point)>;

// A place of a line at which its chain has this vertex.
struct LineStop {
  LinePlace place;
  Point vertex;
};

// Lines as chains, with the vertices of stops, one where two lines cross, and as few others as are
// within the room. Where a position may not be a vertex, another at the line stands for it, or
// none.
std::vector<Chain> chains_of(std::vector<LatticeLine> lines, LineRoom room,
                             const std::vector<LineStop>& stops, const PositionTest& may_stand);

// A sample that a line needs as a vertex: at its height, or at the surface's.
struct Pin {
  Point place;
  std::optional<double> height;  // of the line, in z steps
  uint32_t line;
};

// The heights of a line with heights at the places for which a vertex of its chain stands: at
// `along`, at the place nearest to the vertex, and at those that moved there. Else none.
std::vector<double> heights_at(const LatticeLine& line, LinePlace vertex, double along);

// The pins of a vertex of a chain, and of the places of its line that moved to it.
void add_pins(const LatticeLine& line, const LineVertex& vertex, std::vector<Pin>& pins);

// Makes samples of pins, where there are none, and fixes them; their limits become those of the
// line, too: half of the room, so that simplification has the other half. Throws Error where no z
// step keeps both the limits of the terrain and the line's.
void pin(Survey& survey, std::vector<Pin> pins, LineRoom room, const Placement& lattice);

// Adds samples for vertices that have none, with room around their heights.
void add_missing_samples(Survey& survey, const Tin& tin, LineRoom room);

// A position as text, "x 480.5, y 12".
std::string place_text(LinePlace place, const Placement& lattice);

}  // namespace microtin::terrain

#endif
