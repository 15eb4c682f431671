// SPDX-License-Identifier: MIT
// Splits the pieces of breaklines until each is an edge.
#include "encoder/fit/breaklines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/fit/decimation.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/stream/triangulation.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {
namespace {

constexpr int kMostRounds = 100;   // of splits and of posts that become vertices
constexpr int kRemovalRounds = 3;  // later ones only add vertices, so that they end
constexpr int kMostRemovals = 8;   // for a piece, in a round

// What lies in the way from a vertex to another: an edge, a vertex on the way, or the side that the
// way crosses first.
struct Way {
  bool is_edge = false;
  Index on = kInfinity;
  Index left = kInfinity, right = kInfinity;
};

int64_t scalar_product(Point origin, Point p, Point q) {
  return (int64_t{p.x} - origin.x) * (int64_t{q.x} - origin.x) +
         (int64_t{p.y} - origin.y) * (int64_t{q.y} - origin.y);
}

Way way_from(const Triangulation& triangulation, Index a, Index b) {
  const Mesh& mesh = triangulation.mesh();
  const Point from = point_of(mesh, a), to = point_of(mesh, b);
  const Index start = triangulation.edge_of(a);
  Way way;
  Index h = start;
  do {
    const Index p = mesh.origin[next_in_triangle(h)], q = mesh.origin[previous_in_triangle(h)];
    if (p == b) return {true};
    if (p != kInfinity) {
      const Point right = point_of(mesh, p);
      const int64_t side = orient2d(from, right, to);
      if (side == 0 && scalar_product(from, right, to) > 0) way.on = p;
      const bool is_between =
          side > 0 && q != kInfinity && orient2d(from, point_of(mesh, q), to) < 0;
      if (is_between) way = {false, kInfinity, q, p};
    }
    h = mesh.twin[previous_in_triangle(h)];
  } while (h != start);
  return way;
}

// Whether a vertex lies in the circle around a piece, or on it.
bool is_in_circle_around(Point v, Point a, Point b) {
  return scalar_product(v, a, b) <= 0;
}

int steps_between(Point a, Point b) {
  return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
}

double away_from(const LatticeLine& line, const LineVertex& vertex) {
  return terrain::distance(line.at(vertex.along), terrain::place_of(vertex.place));
}

class Conforming {
 public:
  Conforming(Laid& laid, Tin& tin) : laid_(laid), tin_(tin) {
    constexpr double kSplitsOfStep = 8, kSomeSplits = 64;
    for (const Chain& chain : laid.breaklines) {
      most_splits_ += kSomeSplits + kSplitsOfStep * chain.line.length();
      for (const LineVertex& vertex : chain.vertices) ++chains_at_[key(vertex.place)];
    }
  }

  BreaklineCost run() {
    const std::size_t before = tin_.vertices.size();
    add_absent_vertices();
    tin_ = mended(laid_.survey, tin_);
    bool is_tidy = false;
    for (int round = 0; round < kMostRounds; ++round) {
      if (round < kRemovalRounds) clear_ways();
      if (split_all()) {
        tin_ = mended(laid_.survey, tin_);
      } else if (is_tidy) {
        return cost(before);
      } else {
        with_surface([](Surface&, Decimation& decimation) { decimation.remove_vertices({}); });
        is_tidy = true;
      }
    }
    fail(laid_.breaklines[0].line.at(0));
  }

 private:
  using Numbers = std::unordered_map<uint32_t, Index>;

  static uint32_t key(Point p) { return (uint32_t{p.x} << 16) | p.y; }

  static Numbers numbers_of(const Tin& tin) {
    Numbers numbers;
    numbers.reserve(tin.vertices.size());
    for (std::size_t v = 0; v < tin.vertices.size(); ++v) {
      numbers[key({tin.vertices[v].x, tin.vertices[v].y})] = static_cast<Index>(v);
    }
    return numbers;
  }

  [[noreturn]] void fail(LinePlace place) const {
    throw Error(parameter("breaklines") + " do not become edges at " +
                terrain::place_text(place, laid_.placement) + "; use a smaller " +
                parameter("xy_step"));
  }

  void add_absent_vertices() {
    Numbers numbers = numbers_of(tin_);
    for (const Chain& chain : laid_.breaklines) {
      for (const LineVertex& vertex : chain.vertices) {
        if (numbers.count(key(vertex.place)) != 0) continue;
        numbers[key(vertex.place)] = static_cast<Index>(tin_.vertices.size());
        tin_.vertices.push_back({vertex.place.x, vertex.place.y, 0});
      }
    }
  }

  // Lets work(surface, decimation) remove vertices.
  template <class Work>
  void with_surface(const Work& work) {
    const PostIndex posts(places_of(laid_.survey.samples));
    const PostLimits limits(laid_.survey, ErrorModel{true}, posts);
    Surface surface(laid_.survey, ErrorModel{true}, posts, limits, tin_);
    Team alone(1);
    Decimation decimation(surface, alone);
    work(surface, decimation);
    tin_ = surface.tin();
  }

  // Removes vertices that keep pieces from being edges.
  void clear_ways() {
    const Numbers numbers = numbers_of(tin_);
    with_surface([&](const Surface& surface, Decimation& decimation) {
      for (const Chain& chain : laid_.breaklines) {
        for (std::size_t i = 0; i + 1 < chain.vertices.size(); ++i) {
          clear_way(surface, decimation, numbers.at(key(chain.vertices[i].place)),
                    numbers.at(key(chain.vertices[i + 1].place)));
        }
      }
    });
  }

  static void clear_way(const Surface& surface, Decimation& decimation, Index a, Index b) {
    const Point from = surface.place(a), to = surface.place(b);
    for (int i = 0; i < kMostRemovals; ++i) {
      const Way there = way_from(surface.triangulation(), a, b);
      if (there.is_edge || there.on != kInfinity) return;
      const Way back = way_from(surface.triangulation(), b, a);
      const auto is_removed = [&](Index v) {
        return v != kInfinity && !surface.is_fixed(v) &&
               is_in_circle_around(surface.place(v), from, to) && decimation.remove_vertex(v);
      };
      if (!is_removed(there.left) && !is_removed(there.right) && !is_removed(back.left) &&
          !is_removed(back.right)) {
        return;
      }
    }
  }

  // Splits pieces until all are edges, whatever becomes of the bounds. Says whether there was one.
  bool split_all() {
    numbers_ = numbers_of(tin_);
    Triangulation triangulation(places_of(tin_));
    std::vector<terrain::Pin> pins;
    bool is_split = true, has_split = false;
    while (is_split) {
      is_split = false;
      for (Chain& chain : laid_.breaklines) is_split |= split(triangulation, chain, pins);
      has_split |= is_split;
    }
    if (!has_split) return false;
    terrain::pin(laid_.survey, std::move(pins), laid_.line_room, laid_.placement);
    return true;
  }

  // Splits each piece that is not an edge once.
  bool split(Triangulation& triangulation, Chain& chain, std::vector<terrain::Pin>& pins) {
    std::vector<LineVertex> vertices;
    for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
      const LineVertex& vertex = chain.vertices[i];
      if (i != 0) {
        const auto middle = between(triangulation, chain.line, chain.vertices[i - 1], vertex);
        if (middle) {
          if (++splits_ > most_splits_) fail(chain.line.at(middle->along));
          add(triangulation, chain.vertices[i - 1], vertex, middle->place);
          terrain::add_pins(laid_, chain.line, *middle, pins);
          vertices.push_back(*middle);
        }
      }
      vertices.push_back(vertex);
    }
    const bool is_split = vertices.size() != chain.vertices.size();
    chain.vertices = std::move(vertices);
    return is_split;
  }

  // Makes a position a vertex, at a height between those of two others.
  void add(Triangulation& triangulation, const LineVertex& a, const LineVertex& b, Point place) {
    ++chains_at_[key(place)];
    if (numbers_.count(key(place)) != 0) return;
    const Index from = numbers_.at(key(a.place)), to = numbers_.at(key(b.place));
    const double share = terrain::share_of(terrain::place_of(place), terrain::place_of(a.place),
                                           terrain::place_of(b.place));
    const double low = tin_.vertices[from].z, high = tin_.vertices[to].z;
    const Index v = triangulation.insert(place, triangulation.edge_of(from));
    numbers_[key(place)] = v;
    tin_.vertices.push_back(
        {place.x, place.y, static_cast<int16_t>(std::lround(low + (high - low) * share))});
  }

  // The vertex that a piece needs between its ends; nothing if it is an edge.
  std::optional<LineVertex> between(const Triangulation& triangulation, const LatticeLine& line,
                                    const LineVertex& a, const LineVertex& b) const {
    const auto worst = terrain::worst_between(line, a, b, laid_.line_room);
    const auto at = [&](Point p) { return terrain::chain_vertex(line, p, a.along, b.along); };
    if (worst) {
      const Point place = terrain::nearest_position(line.places()[*worst]);
      if (may_stand(place)) return LineVertex{place, line.along(*worst)};
    }
    const Index from = numbers_.at(key(a.place)), to = numbers_.at(key(b.place));
    const Way there = way_from(triangulation, from, to);
    if (there.is_edge) return std::nullopt;
    const Mesh& mesh = triangulation.mesh();
    if (there.on != kInfinity) return at(point_of(mesh, there.on));
    if (steps_between(a.place, b.place) <= 1) return at(nearer_corner(line, a, b));
    const Way back = way_from(triangulation, to, from);
    double along = (a.along + b.along) / 2;
    for (const Index v : {there.left, there.right, back.left, back.right}) {
      if (v == kInfinity || !is_in_circle_around(point_of(mesh, v), a.place, b.place)) continue;
      along = split_near(line, a, b, point_of(mesh, v));
      break;
    }
    for (const double where : {along, (a.along + b.along) / 2}) {
      if (const auto vertex = splitting(line, a, b, where)) return vertex;
    }
    if (const auto vertex = stand_between(line, a, b, along)) return vertex;
    return nearest_between(line, a, b);
  }

  bool may_stand(Point place) const { return terrain::may_stand(laid_, place); }

  // The vertex at a place of the line, if that splits the piece.
  std::optional<LineVertex> splitting(const LatticeLine& line, const LineVertex& a,
                                      const LineVertex& b, double where) const {
    const Point place = terrain::nearest_position(line.at(where));
    if (place == a.place || place == b.place || !may_stand(place)) return std::nullopt;
    return LineVertex{place, where};
  }

  // Where not all positions may be vertices: the first one on the line from a length on, forwards
  // or backwards, that may be one.
  std::optional<LineVertex> stand_between(const LatticeLine& line, const LineVertex& a,
                                          const LineVertex& b, double from) const {
    constexpr double kStride = 0.25;
    if (!laid_.is_shared) return std::nullopt;
    const double low = std::min(a.along, b.along), high = std::max(a.along, b.along);
    const auto strides = static_cast<int64_t>((high - low) / kStride);
    for (int64_t i = 1; i <= strides; ++i) {
      const double away = static_cast<double>(i) * kStride;
      for (const double where : {from - away, from + away}) {
        if (where <= low || where >= high) continue;
        if (const auto vertex = splitting(line, a, b, where)) return vertex;
      }
    }
    return std::nullopt;
  }

  // Where to split a piece for a vertex near it: where that projects on the line or, at a vertex
  // that lines share, at a power of two of steps from there. Pieces that meet at a small angle then
  // have ends of one distance, which do not lie in each other's circles.
  double split_near(const LatticeLine& line, const LineVertex& a, const LineVertex& b,
                    Point v) const {
    const double low = std::min(a.along, b.along), high = std::max(a.along, b.along);
    const double foot = line.foot(terrain::place_of(v), low, high);
    if (chains_at(v) == 0) return foot;
    double step = 1;
    while (3 * step <= high - low) step *= 2;
    if (chains_at(a.place) > 1) return a.along + step;
    if (chains_at(b.place) > 1) return b.along - step;
    return foot;
  }

  std::size_t chains_at(Point p) const {
    const auto at = chains_at_.find(key(p));
    return at == chains_at_.end() ? 0 : at->second;
  }

  // Returns a corner of the other diagonal of a lattice cell: one is within kMostShift of the line.
  static Point nearer_corner(const LatticeLine& line, const LineVertex& a, const LineVertex& b) {
    const LineVertex first = terrain::chain_vertex(line, {a.place.x, b.place.y}, a.along, b.along);
    const LineVertex second = terrain::chain_vertex(line, {b.place.x, a.place.y}, a.along, b.along);
    return away_from(line, first) <= away_from(line, second) ? first.place : second.place;
  }

  // Returns the position nearest to the line in the box around a short piece.
  LineVertex nearest_between(const LatticeLine& line, const LineVertex& a,
                             const LineVertex& b) const {
    constexpr int kMostSteps = 64;
    if (steps_between(a.place, b.place) > kMostSteps) fail(line.at(a.along));
    std::optional<LineVertex> best;
    for (int x = std::min(a.place.x, b.place.x); x <= std::max(a.place.x, b.place.x); ++x) {
      for (int y = std::min(a.place.y, b.place.y); y <= std::max(a.place.y, b.place.y); ++y) {
        const Point place{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
        if (place == a.place || place == b.place || !may_stand(place)) continue;
        const LineVertex one = terrain::chain_vertex(line, place, a.along, b.along);
        if (!best || away_from(line, one) < away_from(line, *best)) best = one;
      }
    }
    if (!best) fail(line.at(a.along));
    return *best;
  }

  BreaklineCost cost(std::size_t before) const {
    BreaklineCost cost;
    std::vector<Point> places;
    for (const Chain& chain : laid_.breaklines) {
      for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
        places.push_back(chain.vertices[i].place);
        if (i == 0 || splits_ == 0) continue;
        if (steps_between(places.back(), chain.vertices[i - 1].place) <= 1) ++cost.unit_pieces;
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    cost.on_lines = static_cast<uint32_t>(places.size());
    cost.added = static_cast<int64_t>(tin_.vertices.size()) - static_cast<int64_t>(before);
    return cost;
  }

  Laid& laid_;
  Tin& tin_;
  Numbers numbers_;  // of the vertices, by place
  std::unordered_map<uint32_t, std::size_t> chains_at_;
  double splits_ = 0, most_splits_ = 0;
};

}  // namespace

BreaklineCost keep_breaklines(Laid& laid, Tin& tin) {
  if (laid.breaklines.empty()) return {};
  return Conforming(laid, tin).run();
}

}  // namespace microtin::fit
