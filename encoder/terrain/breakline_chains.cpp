// SPDX-License-Identifier: MIT
// Chains of lattice positions for breaklines: vertices where lines cross, and where they bend.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "encoder/terrain/breaklines.hpp"

namespace microtin::terrain {
namespace {

// A chain's edge may be that far from the places of its line. Each place is nearer to its own
// lattice position, and kMostShift leaves room for rounding.
constexpr double kSimplified = 0.7075;

// Places of lines so near to each other are one, in steps.
constexpr double kTouching = 1e-6;

// Finds where lines cross or touch themselves or each other.
class Crossings {
 public:
  explicit Crossings(const std::vector<LatticeLine>& lines) : lines_(lines), found_(lines.size()) {
    for (std::size_t line = 0; line < lines.size(); ++line) {
      for (std::size_t i = 0; i + 1 < lines[line].places().size(); ++i) {
        const LinePlace a = lines[line].places()[i], b = lines[line].places()[i + 1];
        segments_.push_back({line, i, std::min(a.x, b.x), std::max(a.x, b.x)});
      }
    }
    std::sort(segments_.begin(), segments_.end(),
              [](const Segment& a, const Segment& b) { return a.left < b.left; });
    find();
  }

  // How much of each line lies before each of its crossings.
  const std::vector<std::vector<double>>& found() const { return found_; }

 private:
  struct Segment {
    std::size_t line, place;
    double left, right;
  };

  void find() {
    std::vector<Segment> open;
    for (const Segment& next : segments_) {
      open.erase(
          std::remove_if(open.begin(), open.end(),
                         [&](const Segment& one) { return one.right + kTouching < next.left; }),
          open.end());
      for (const Segment& one : open) meet(one, next);
      open.push_back(next);
    }
  }

  LinePlace start(const Segment& s) const { return lines_[s.line].places()[s.place]; }
  LinePlace end(const Segment& s) const { return lines_[s.line].places()[s.place + 1]; }

  void meet(const Segment& a, const Segment& b) {
    const LinePlace p = start(a), q = end(a), r = start(b), s = end(b);
    if (std::max(p.y, q.y) + kTouching < std::min(r.y, s.y)) return;
    if (std::max(r.y, s.y) + kTouching < std::min(p.y, q.y)) return;
    const bool follow = a.line == b.line && (a.place + 1 == b.place || b.place + 1 == a.place);
    if (!follow) touch(a, b);
    const double cross = (q.x - p.x) * (s.y - r.y) - (q.y - p.y) * (s.x - r.x);
    if (cross == 0 || follow) return;
    const double of_a = ((r.x - p.x) * (s.y - r.y) - (r.y - p.y) * (s.x - r.x)) / cross;
    const double of_b = ((r.x - p.x) * (q.y - p.y) - (r.y - p.y) * (q.x - p.x)) / cross;
    if (of_a <= 0 || of_a >= 1 || of_b <= 0 || of_b >= 1) return;
    note(a, of_a);
    note(b, of_b);
  }

  // Ends of one that lie on the other.
  void touch(const Segment& a, const Segment& b) {
    touch_end(a, b, start(b), 0);
    touch_end(a, b, end(b), 1);
    touch_end(b, a, start(a), 0);
    touch_end(b, a, end(a), 1);
  }

  void touch_end(const Segment& on, const Segment& of, LinePlace place, double share_of_end) {
    const double share = share_of(place, start(on), end(on));
    const LinePlace a = start(on), b = end(on);
    const LinePlace there{a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, 0};
    if (distance(there, place) > kTouching) return;
    note(on, share);
    note(of, share_of_end);
  }

  void note(const Segment& on, double share) {
    const LatticeLine& line = lines_[on.line];
    const double from = line.along(on.place), to = line.along(on.place + 1);
    found_[on.line].push_back(from + (to - from) * share);
  }

  const std::vector<LatticeLine>& lines_;
  std::vector<Segment> segments_;
  std::vector<std::vector<double>> found_;
};

// Fewer vertices between the first and the last of some: each next one is reached from the one
// before that needs the fewest, of those at most kReach before (Imai and Iri).
std::vector<LineVertex> fewer(const LatticeLine& line, LineRoom room,
                              const std::vector<LineVertex>& all) {
  constexpr std::size_t kReach = 24, kMisses = 6;
  std::vector<std::size_t> count(all.size()), before(all.size());
  for (std::size_t to = 1; to < all.size(); ++to) {
    count[to] = count[to - 1] + 1;
    before[to] = to - 1;
    std::size_t misses = 0;
    for (std::size_t from = to - 1; from-- > 0 && to - from <= kReach && misses < kMisses;) {
      if (worst_between(line, all[from], all[to], room)) {
        ++misses;
      } else if (count[from] + 1 < count[to]) {
        count[to] = count[from] + 1;
        before[to] = from;
      }
    }
  }
  std::vector<LineVertex> some{all.back()};
  for (std::size_t at = all.size() - 1; at != 0; at = before[at]) some.push_back(all[before[at]]);
  std::reverse(some.begin(), some.end());
  return some;
}

// Adds what simplification leaves between the last vertex of a chain and the next one that stays.
void add_simplified(const LatticeLine& line, LineRoom room, const PositionTest& may_stand,
                    LineVertex next, std::vector<LineVertex>& chain) {
  std::vector<LineVertex> all{chain.back()};
  const LatticeLine::Range range = line.between(chain.back().along, next.along);
  for (std::size_t i = range.first; i < range.last; ++i) {
    const LineVertex vertex{nearest_position(line.places()[i]), line.along(i)};
    if (may_stand && !may_stand(vertex.place)) continue;
    if (vertex.place != all.back().place || line.has_heights()) all.push_back(vertex);
  }
  all.push_back(next);
  for (std::size_t size = 0; size != all.size();) {
    size = all.size();
    all = fewer(line, room, all);
  }
  for (std::size_t i = 1; i < all.size(); ++i) chain.push_back(all[i]);
}

// The position that stands for a place of a line: the nearest one, or, if that may not be a vertex,
// the nearest corner of the lattice cell around the place that may be one. Nothing if no corner
// near enough to the line may be one.
std::optional<Point> standing_position(LinePlace place, const PositionTest& may_stand) {
  const Point nearest = nearest_position(place);
  if (!may_stand || may_stand(nearest)) return nearest;
  std::optional<Point> best;
  double least = kSimplified;
  for (const double x : {std::floor(place.x), std::floor(place.x) + 1}) {
    for (const double y : {std::floor(place.y), std::floor(place.y) + 1}) {
      const Point corner = nearest_position({x, y, 0});
      const double away = distance(place_of(corner), place);
      if (away > least || !may_stand(corner)) continue;
      best = corner;
      least = away;
    }
  }
  return best;
}

// Vertices of stops, by the coordinates of their places.
using StopsByPlace = std::map<std::pair<double, double>, Point>;

// The vertices that a chain must have, in order: stops, and where the line crosses others or ends.
std::vector<LineVertex> required(const LatticeLine& line, const std::vector<double>& crossings,
                                 const StopsByPlace& stops, const PositionTest& may_stand) {
  std::vector<LineVertex> all;
  for (std::size_t i = 0; i < line.places().size() && !stops.empty(); ++i) {
    const auto stop = stops.find({line.places()[i].x, line.places()[i].y});
    if (stop == stops.end() || (may_stand && !may_stand(stop->second))) continue;
    all.push_back({stop->second, line.along(i)});
  }
  std::vector<double> others = crossings;
  others.insert(others.end(), {0, line.length()});
  for (const double along : others) {
    const std::optional<Point> place = standing_position(line.at(along), may_stand);
    if (place) all.push_back({*place, along});
  }
  // The vertex of a stop comes before others at the same place of the line.
  std::stable_sort(all.begin(), all.end(),
                   [](LineVertex a, LineVertex b) { return a.along < b.along; });
  all.erase(std::unique(all.begin(), all.end(),
                        [](LineVertex a, LineVertex b) { return b.along - a.along < kTouching; }),
            all.end());
  return all;
}

Chain chain_of(LatticeLine&& line, const std::vector<LineVertex>& required, LineRoom room,
               const PositionTest& may_stand) {
  std::vector<LineVertex> wanted;
  for (const LineVertex& next : required) {
    if (wanted.empty()) {
      wanted.push_back(next);
    } else {
      add_simplified(line, room, may_stand, next, wanted);
    }
  }
  std::vector<LineVertex> vertices;
  for (const LineVertex& one : wanted) {
    if (!vertices.empty() && vertices.back().place == one.place) continue;
    vertices.push_back(one);
  }
  return {std::move(line), std::move(vertices)};
}

}  // namespace

std::optional<std::size_t> worst_between(const LatticeLine& line, LineVertex a, LineVertex b,
                                         LineRoom room) {
  const auto place_of_vertex = [&](const LineVertex& v) {
    const LinePlace place = place_of(v.place);
    return LinePlace{place.x, place.y, line.at(v.along).z};
  };
  const LinePlace from = place_of_vertex(a), to = place_of_vertex(b);
  const LatticeLine::Range range = line.between(a.along, b.along);
  std::optional<std::size_t> worst;
  double most = 1;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const LinePlace place = line.places()[i];
    const double share = share_of(place, from, to);
    const LinePlace on{from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share, 0};
    const double height = line.has_heights()
                              ? std::abs(place.z - (from.z + (to.z - from.z) * share)) /
                                    std::max(room.radius / 2, kTouching)
                              : 0;
    const double out = std::max(distance(place, on) / kSimplified, height);
    const Point there = nearest_position(place);
    if (out <= most || there == a.place || there == b.place) continue;
    most = out;
    worst = i;
  }
  return worst;
}

LineVertex chain_vertex(const LatticeLine& line, Point place, double from, double to) {
  return {place, line.foot(place_of(place), std::min(from, to), std::max(from, to))};
}

std::vector<Chain> chains_of(std::vector<LatticeLine> lines, LineRoom room,
                             const std::vector<LineStop>& stops, const PositionTest& may_stand) {
  const std::vector<std::vector<double>> crossings = Crossings(lines).found();
  StopsByPlace by_place;
  for (const LineStop& stop : stops) by_place[{stop.place.x, stop.place.y}] = stop.vertex;
  std::vector<Chain> chains;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<LineVertex> vertices = required(lines[i], crossings[i], by_place, may_stand);
    chains.push_back(chain_of(std::move(lines[i]), vertices, room, may_stand));
  }
  return chains;
}

}  // namespace microtin::terrain
