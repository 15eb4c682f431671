// SPDX-License-Identifier: MIT
// Finds where lines meet the borders of tiles, in the coordinates of the pack.
#include "encoder/pack/tiled_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/terrain/raster_scan.hpp"

namespace microtin::pack {
namespace {

constexpr double kHalfStep = 0.5;  // steps: places nearer to a border than that move to it

// The straight line on which borders lie, across the whole pack.
struct BorderAxis {
  bool is_column;  // of posts: x is the same everywhere
  double position;

  double away(LinePlace p) const { return (is_column ? p.x : p.y) - position; }
  double along(LinePlace p) const { return is_column ? p.y : p.x; }
  LinePlace place(double away_from, double along_axis, double z) const {
    const double across = position + away_from;
    return is_column ? LinePlace{across, along_axis, z} : LinePlace{along_axis, across, z};
  }
};

// A place of a line that is a vertex of it, or half a step from the axis, or on the axis.
struct Knot {
  double along;
  LinePlace place;
  double away;
  bool is_vertex;
};

// A place of a line that needs a vertex, at a place of the axis.
struct BorderSite {
  double along;
  LinePlace place;
  double at;
};

// A part of a line within half a step of the axis.
struct Stretch {
  double from, to;
  std::vector<BorderSite> sites;
};

// Finds the stretches of a line along an axis.
class StretchSearch {
 public:
  StretchSearch(const LatticeLine& line, BorderAxis axis) : line_(line), axis_(axis) {}

  std::vector<Stretch> find() {
    const std::vector<LinePlace>& places = line_.places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (i != 0) cross(i - 1);
      take({line_.along(i), places[i], axis_.away(places[i]), true});
    }
    end();
    return std::move(found_);
  }

 private:
  // Takes the places of a segment between its ends that are on the axis or half a step from it.
  void cross(std::size_t i) {
    const LinePlace a = line_.places()[i], b = line_.places()[i + 1];
    const double from = axis_.away(a), to = axis_.away(b);
    double levels[] = {-kHalfStep, 0, kHalfStep};
    if (from > to) std::reverse(std::begin(levels), std::end(levels));
    for (const double level : levels) {
      if (level <= std::min(from, to) || level >= std::max(from, to)) continue;
      const double share = (level - from) / (to - from);
      const double on_axis = axis_.along(a) + (axis_.along(b) - axis_.along(a)) * share;
      take({line_.along(i) + (line_.along(i + 1) - line_.along(i)) * share,
            axis_.place(level, on_axis, a.z + (b.z - a.z) * share), level, false});
    }
  }

  void take(const Knot& knot) {
    if (std::abs(knot.away) <= kHalfStep) {
      knots_.push_back(knot);
    } else {
      end();
    }
  }

  void end() {
    Stretch stretch;
    for (const Knot& knot : knots_) {
      if (!needs_vertex(knot)) continue;
      stretch.sites.push_back({knot.along, knot.place, nearest_step(axis_.along(knot.place))});
    }
    if (!stretch.sites.empty()) {
      stretch.from = knots_.front().along;
      stretch.to = knots_.back().along;
      found_.push_back(std::move(stretch));
    }
    knots_.clear();
  }

  // A line that goes straight through needs a vertex only where it crosses: the next position on
  // either side is next to that. One that stays half a step away needs them where its own vertices
  // move to the axis, as those at halves move up.
  bool needs_vertex(const Knot& knot) const {
    if (goes_through()) return knot.away == 0;
    const auto stays = [&](double level) {
      return std::all_of(knots_.begin(), knots_.end(),
                         [&](const Knot& one) { return one.away == level; });
    };
    if (stays(kHalfStep)) return false;
    return !stays(-kHalfStep) || knot.is_vertex;
  }

  bool goes_through() const {
    if (knots_.size() != 3 || knots_[1].away != 0) return false;
    if (knots_[0].away + knots_[2].away != 0 || knots_[0].away == 0) return false;
    const auto moves = [&](const Knot& knot) {
      return std::abs(axis_.along(knot.place) - axis_.along(knots_[1].place));
    };
    return moves(knots_[0]) <= kHalfStep && moves(knots_[2]) <= kHalfStep;
  }

  const LatticeLine& line_;
  BorderAxis axis_;
  std::vector<Knot> knots_;  // of the stretch that is being found
  std::vector<Stretch> found_;
};

// Collects what the lines along one axis need of a border that lies on it, or ends at it.
class PinsOnBorder {
 public:
  explicit PinsOnBorder(const TileBox& border) : border_(border) {}

  void add(const LatticeLine& line, BorderAxis axis) {
    for (const Stretch& stretch : StretchSearch(line, axis).find()) {
      std::vector<double> posts;
      for (const BorderSite& site : stretch.sites) posts.push_back(site.at);
      std::sort(posts.begin(), posts.end());
      posts.erase(std::unique(posts.begin(), posts.end()), posts.end());
      for (const double at : posts) pin(line, axis.place(0, at, 0), stretch, pins_.vertices);
      if (!line.has_heights()) continue;
      // Between its vertices, a border keeps the heights of the line, too.
      const auto [first, last] = on_border(axis);
      const auto begin = static_cast<int64_t>(std::max(posts.front(), first)),
                 end = static_cast<int64_t>(std::min(posts.back(), last));
      for (int64_t at = begin; at <= end; ++at) {
        pin(line, axis.place(0, static_cast<double>(at), 0), stretch, pins_.heights);
      }
    }
  }

  BorderPins take() { return std::move(pins_); }

 private:
  // The first and the last position on an axis that are on the border.
  std::pair<double, double> on_border(BorderAxis axis) const {
    return axis.is_column ? std::pair{double{0} + border_.y, double{0} + border_.y_end}
                          : std::pair{double{0} + border_.x, double{0} + border_.x_end};
  }

  void pin(const LatticeLine& line, LinePlace post, const Stretch& stretch,
           std::vector<Pin>& pins) const {
    const bool is_here = post.x >= border_.x && post.x <= border_.x_end && post.y >= border_.y &&
                         post.y <= border_.y_end;
    if (!is_here) return;
    const Point place{static_cast<uint16_t>(post.x - border_.x),
                      static_cast<uint16_t>(post.y - border_.y)};
    if (!line.has_heights()) pins.push_back({place, std::nullopt, line.number()});
    const double along = line.foot(post, stretch.from, stretch.to);
    for (const double height : terrain::heights_at(line, post, along)) {
      pins.push_back({place, height, line.number()});
    }
  }

  TileBox border_;
  BorderPins pins_;
};

// The sides of a tile that others share.
std::vector<BorderAxis> shared_axes(const TileGrid& grid, const TileBox& box) {
  std::vector<BorderAxis> axes;
  if (box.x != 0) axes.push_back({true, double{0} + box.x});
  if (box.x_end != grid.x_max) axes.push_back({true, double{0} + box.x_end});
  if (box.y != 0) axes.push_back({false, double{0} + box.y});
  if (box.y_end != grid.y_max) axes.push_back({false, double{0} + box.y_end});
  return axes;
}

// Cuts a line at the sides of a tile that others share.
class TileCutter {
 public:
  TileCutter(const TileGrid& grid, const TileBox& box, LinesInTile& found)
      : grid_(grid), box_(box), found_(found) {}

  void cut(const LatticeLine& line) {
    std::vector<Breakpoint> points;
    for (std::size_t i = 0; i < line.places().size(); ++i) {
      points.push_back({line.along(i), line.places()[i]});
    }
    for (const BorderAxis& axis : shared_axes(grid_, box_)) {
      for (const Stretch& stretch : StretchSearch(line, axis).find()) {
        for (const BorderSite& site : stretch.sites) add_site(axis, site, points);
      }
    }
    std::stable_sort(points.begin(), points.end(),
                     [](const Breakpoint& a, const Breakpoint& b) { return a.along < b.along; });
    path_ = {{}, line.has_heights(), line.number()};
    for (std::size_t i = 1; i < points.size(); ++i) take(points[i - 1].place, points[i].place);
    end();
  }

 private:
  struct Breakpoint {
    double along;
    LinePlace place;
  };

  void add_site(BorderAxis axis, const BorderSite& site, std::vector<Breakpoint>& points) {
    points.push_back({site.along, site.place});
    const LinePlace vertex = axis.place(0, site.at, 0);
    if (!holds(site.place) || !holds(vertex)) return;
    found_.stops.push_back({inside(site.place), nearest_position(inside(vertex))});
  }

  // Whether a place is on the tile's side of all that it shares. Others are cut with the terrain.
  bool holds(LinePlace p) const {
    return (box_.x == 0 || p.x >= box_.x) && (box_.x_end == grid_.x_max || p.x <= box_.x_end) &&
           (box_.y == 0 || p.y >= box_.y) && (box_.y_end == grid_.y_max || p.y <= box_.y_end);
  }

  LinePlace inside(LinePlace p) const { return {p.x - box_.x, p.y - box_.y, p.z}; }

  void take(LinePlace from, LinePlace to) {
    if (!holds({(from.x + to.x) / 2, (from.y + to.y) / 2, 0})) {
      end();
      return;
    }
    if (path_.places.empty()) add(from);
    add(to);
  }

  void add(LinePlace p) {
    const LinePlace place = inside(p);
    const bool is_new = path_.places.empty() || path_.places.back().x != place.x ||
                        path_.places.back().y != place.y;
    if (is_new) path_.places.push_back(place);
  }

  void end() {
    if (path_.places.size() > 1) found_.paths.push_back(path_);
    path_.places.clear();
  }

  TileGrid grid_;
  TileBox box_;
  LinesInTile& found_;
  LinePath path_;
};

uint64_t bits_of(double value) {
  uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

// Lines that move to the border lie within a step of it.
bool TiledLines::Extent::meets(const TileBox& box) const {
  return left - 1 <= box.x_end && right + 1 >= box.x && bottom - 1 <= box.y_end && top + 1 >= box.y;
}

TiledLines::Extent TiledLines::extent_of(const LatticeLine& line) {
  const LinePlace first = line.places().front();
  Extent extent{first.x, first.y, first.x, first.y};
  for (const LinePlace& p : line.places()) {
    extent = {std::min(extent.left, p.x), std::min(extent.bottom, p.y), std::max(extent.right, p.x),
              std::max(extent.top, p.y)};
  }
  return extent;
}

TiledLines::TiledLines(const std::vector<RealLine>& lines, const Placement& pack,
                       const TileBox& all) {
  bool is_near = false;
  for (std::size_t number = 0; number < lines.size(); ++number) {
    LinePath path = terrain::path_of(lines[number], static_cast<uint32_t>(number), pack);
    if (path.places.size() < 2) continue;
    LatticeLine line(std::move(path.places), path.has_heights, path.number);
    const Extent extent = extent_of(line);
    is_near = is_near || extent.meets(all);
    lines_.push_back({std::move(line), extent});
  }
  if (!is_near) terrain::refuse_lines_elsewhere();
}

BorderPins TiledLines::pins_on(const TileGrid& grid, const TileBox& border) const {
  const bool is_column = border.x == border.x_end;
  PinsOnBorder pins(border);
  for (const auto& [line, extent] : lines_) {
    if (!extent.meets(border)) continue;
    pins.add(line, {is_column, double{0} + (is_column ? border.x : border.y)});
    // The ends of borders are corners, whose vertices lines along the other axis need, too.
    const uint32_t ends[] = {is_column ? border.y : border.x,
                             is_column ? border.y_end : border.x_end};
    for (const uint32_t end : ends) {
      if (end != 0 && end != (is_column ? grid.y_max : grid.x_max)) {
        pins.add(line, {!is_column, double{0} + end});
      }
    }
  }
  return pins.take();
}

LinesInTile TiledLines::in_tile(const TileGrid& grid, const TileBox& box) const {
  LinesInTile found;
  for (const auto& [line, extent] : lines_) {
    if (extent.meets(box)) TileCutter(grid, box, found).cut(line);
  }
  return found;
}

uint64_t TiledLines::fingerprint() const {
  uint64_t sum = 0;
  for (const auto& [line, extent] : lines_) {
    sum = mixed(sum, line.has_heights() ? 1 : 0);
    for (const LinePlace& p : line.places()) {
      sum = mixed(mixed(mixed(sum, bits_of(p.x)), bits_of(p.y)), bits_of(p.z));
    }
  }
  return sum;
}

std::shared_ptr<const TiledLines> tiled_lines(const std::vector<RealLine>& lines,
                                              const Placement& pack, const Raster& frame) {
  if (lines.empty()) return nullptr;
  return std::make_shared<TiledLines>(lines, pack,
                                      TileBox{0, 0, frame.width - 1, frame.height - 1});
}

void expect_breaklines_possible(const LatticeOptions& options, const Raster& frame) {
  if (options.breaklines.empty()) return;
  const std::string name = parameter("breaklines");
  if (!options.max_error) throw Error(name + " needs a bound; use " + parameter("max_error"));
  if (options.bound_at == BoundScope::kEverywhere) {
    throw Error(name + " and " + parameter("bound_at") +
                " everywhere do not go together; leave one of them out");
  }
  if (is_sparse(frame)) {
    throw Error(name + " in a pack needs a raster with a post at every position; make a stream " +
                "(.mtin)");
  }
}

std::vector<LatticeLine> parts_of(const LinesInTile& lines, const Raster& posts) {
  std::vector<LatticeLine> parts;
  if (lines.paths.empty()) return parts;
  const Source source = posts;
  const LineGround ground = terrain::line_ground_of(source, terrain::placement_of(source));
  for (const LinePath& path : lines.paths) terrain::add_parts(ground, path, parts);
  return parts;
}

}  // namespace microtin::pack
