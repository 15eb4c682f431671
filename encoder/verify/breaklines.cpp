// SPDX-License-Identifier: MIT
// Walks along a line from vertex to vertex of a mesh, wherever edges follow the line, or marked
// edges.
#include "encoder/verify/breaklines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "shared/lattice.hpp"

namespace microtin::verifying {
namespace {

constexpr double kStride = 0.25;  // between the places of a line around which vertices are sought
constexpr double kWindow = 3;     // of a line, around a place: vertices nearby are nearest there
constexpr double kFine = 1.0 / 65536;  // z steps, as height queries answer

using Neighbours = std::unordered_map<uint32_t, std::vector<uint32_t>>;

uint32_t key_of(int x, int y) {
  return (static_cast<uint32_t>(x) << 16) | static_cast<uint32_t>(y);
}

// Calls visit(length) for lengths along a line from 0 to all of it.
template <class Visit>
void visit_strides(const LatticeLine& line, const Visit& visit) {
  const auto strides = static_cast<int64_t>(line.length() / kStride) + 1;
  for (int64_t i = 0; i <= strides; ++i) {
    visit(line.length() * static_cast<double>(i) / static_cast<double>(strides));
  }
}

// The vertices of a mesh at positions near lines, and the edges between them.
class NearbyEdges {
 public:
  NearbyEdges(const microtin_mesh* mesh, const std::vector<LatticeLine>& lines) : mesh_(mesh) {
    for (const LatticeLine& line : lines) mark(line);
    const uint32_t vertices = microtin_mesh_vertex_count(mesh);
    for (uint32_t v = 0; v < vertices; ++v) {
      const LinePlace place = vertex(v);
      const auto at = vertices_.find(key_of(static_cast<int>(place.x), static_cast<int>(place.y)));
      if (at != vertices_.end()) at->second = v;
    }
    add_edges();
  }

  LinePlace vertex(uint32_t v) const {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_mesh_vertex(mesh_, v, &x, &y, &z);
    return {double{0} + x, double{0} + y, double{0} + z};
  }

  const std::vector<uint32_t>& neighbours(uint32_t v) const {
    static const std::vector<uint32_t> none;
    const auto at = neighbours_.find(v);
    return at == neighbours_.end() ? none : at->second;
  }

  // Calls visit(vertex) for each vertex in the square of three steps around a place.
  template <class Visit>
  void visit_near(LinePlace place, const Visit& visit) const {
    visit_positions(place, [&](int x, int y) {
      const auto at = vertices_.find(key_of(x, y));
      if (at != vertices_.end() && at->second != kNone) visit(at->second);
    });
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;

  template <class Visit>
  static void visit_positions(LinePlace place, const Visit& visit) {
    const int column = static_cast<int>(nearest_step(place.x)),
              row = static_cast<int>(nearest_step(place.y));
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, kLatticeMax + 0); ++x) {
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, kLatticeMax + 0); ++y) visit(x, y);
    }
  }

  void mark(const LatticeLine& line) {
    visit_strides(line, [&](double along) {
      visit_positions(line.at(along), [&](int x, int y) { vertices_[key_of(x, y)] = kNone; });
    });
  }

  bool is_near(uint32_t v) const {
    const LinePlace place = vertex(v);
    return vertices_.count(key_of(static_cast<int>(place.x), static_cast<int>(place.y))) != 0;
  }

  void add_edges() {
    const uint32_t triangles = microtin_mesh_triangle_count(mesh_);
    for (uint32_t t = 0; t < triangles; ++t) {
      uint32_t v[3];
      const microtin_triangle_kind kind = microtin_mesh_triangle(mesh_, t, v);
      if (kind != MICROTIN_TRIANGLE_REAL && kind != MICROTIN_TRIANGLE_VOID) continue;
      for (int i = 0; i < 3; ++i) {
        const uint32_t from = v[i], to = v[(i + 1) % 3];
        if (!is_near(from) || !is_near(to)) continue;
        neighbours_[from].push_back(to);
        neighbours_[to].push_back(from);
      }
    }
  }

  const microtin_mesh* mesh_;
  std::unordered_map<uint32_t, uint32_t> vertices_;  // by position, kNone: there is none
  Neighbours neighbours_;
};

// Which edges a chain may have.
using EdgeTest = std::function<bool(uint32_t from, uint32_t to)>;

bool any_edge(uint32_t /*from*/, uint32_t /*to*/) {
  return true;
}

// A search for a chain of edges along one line.
class LineSearch {
 public:
  LineSearch(const NearbyEdges& edges, const LatticeLine& line, const std::optional<LineRoom>& room)
      : edges_(edges), line_(line), room_(line.has_heights() ? room : std::nullopt) {
    find_feet();
  }

  // Says whether there is a chain of edges that pass the test; if so, adds it.
  bool find(const EdgeTest& may_use, FoundBreaklines& found) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (!follows(node, {node.vertex, 0}) || !keeps_height(node)) continue;
      reach(i, i);
    }
    for (std::size_t next = 0; next < order_.size(); ++next) {
      const std::size_t i = order_[next];
      if (follows(nodes_[i], {nodes_[i].vertex, line_.length()})) {
        add_chain(i, found);
        return true;
      }
      farthest_ = std::max(farthest_, nodes_[i].along);
      go_on(i, may_use);
    }
    return false;
  }

  // Calls visit(vertex, vertex) for each edge that follows the line, from both ends.
  template <class Visit>
  void visit_edges(const Visit& visit) const {
    for (const Node& node : nodes_) {
      for (const uint32_t neighbour : edges_.neighbours(node.vertex)) {
        const auto at = by_vertex_.find(neighbour);
        if (at == by_vertex_.end()) continue;
        const auto is_next = [&](std::size_t next) { return follows(node, nodes_[next]); };
        if (std::any_of(at->second.begin(), at->second.end(), is_next)) {
          visit(node.vertex, neighbour);
        }
      }
    }
  }

  LinePlace farthest() const { return line_.at(farthest_); }

 private:
  struct Node {
    uint32_t vertex;
    double along;  // of the place of the line that is nearest, at least locally
  };

  // The vertices that are near enough to the line, and where they are nearest: each with those
  // segments of the line that it may be near to.
  void find_feet() {
    std::map<uint32_t, std::set<std::size_t>> near;
    visit_strides(line_, [&](double along) {
      const LatticeLine::Range places = line_.between(along - kWindow, along + kWindow);
      const std::size_t first = places.first == 0 ? 0 : places.first - 1,
                        last = std::min(places.last, line_.places().size() - 1);
      edges_.visit_near(line_.at(along), [&](uint32_t v) {
        for (std::size_t segment = first; segment < last; ++segment) near[v].insert(segment);
      });
    });
    for (const auto& [v, segments] : near) add_feet(v, segments);
  }

  void add_feet(uint32_t v, const std::set<std::size_t>& segments) {
    struct Foot {
      std::size_t segment;
      double share, away, along;
    };
    const std::vector<LinePlace>& places = line_.places();
    const LinePlace vertex = edges_.vertex(v);
    std::vector<Foot> feet;
    for (const std::size_t i : segments) {
      const double share = terrain::share_of(vertex, places[i], places[i + 1]);
      const double along = line_.along(i) + (line_.along(i + 1) - line_.along(i)) * share;
      feet.push_back({i, share, terrain::distance(line_.at(along), vertex), along});
    }
    const auto is_nearer = [&](std::size_t other, std::size_t segment, double away) {
      return other < feet.size() && feet[other].segment == segment && feet[other].away < away;
    };
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const Foot& foot = feet[i];
      if (foot.away > terrain::kMostShift) continue;
      // At the end of a segment the next one may go on towards the vertex.
      if (foot.share == 0 && i != 0 && is_nearer(i - 1, foot.segment - 1, foot.away)) continue;
      if (foot.share == 1 && is_nearer(i + 1, foot.segment + 1, foot.away)) continue;
      by_vertex_[v].push_back(nodes_.size());
      nodes_.push_back({v, foot.along});
      parent_.push_back(kUnreached);
    }
  }

  void reach(std::size_t node, std::size_t from) {
    if (parent_[node] != kUnreached) return;
    parent_[node] = from;
    order_.push_back(node);
  }

  void go_on(std::size_t from, const EdgeTest& may_use) {
    const Node node = nodes_[from];
    for (const uint32_t neighbour : edges_.neighbours(node.vertex)) {
      const auto at = by_vertex_.find(neighbour);
      if (at == by_vertex_.end() || !may_use(node.vertex, neighbour)) continue;
      for (const std::size_t next : at->second) {
        if (parent_[next] != kUnreached) continue;
        if (follows(node, nodes_[next]) && keeps_height(nodes_[next])) reach(next, from);
      }
    }
  }

  bool keeps(double surface, double line) const {
    return !room_ || std::abs(surface - line - room_->middle) <= room_->radius + kFine;
  }

  bool keeps_height(const Node& node) const {
    return keeps(edges_.vertex(node.vertex).z, line_.at(node.along).z);
  }

  // Calls visit(place of the line, place on the edge) for all places between two nodes.
  template <class Visit>
  void visit_between(const Node& a, const Node& b, const Visit& visit) const {
    const LinePlace from = edges_.vertex(a.vertex), to = edges_.vertex(b.vertex);
    const LatticeLine::Range range =
        line_.between(std::min(a.along, b.along), std::max(a.along, b.along));
    const auto look_at = [&](LinePlace place) {
      const double share = terrain::share_of(place, from, to);
      visit(place, LinePlace{from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share,
                             from.z + (to.z - from.z) * share});
    };
    for (std::size_t i = range.first; i < range.last; ++i) look_at(line_.places()[i]);
    if (a.vertex != b.vertex) return;
    look_at(line_.at(a.along));  // an end of the line, and what is nearest to it
    look_at(line_.at(b.along));
  }

  // Whether the line between two nodes is near their edge, or their vertex.
  bool follows(const Node& a, const Node& b) const {
    bool is_near = true;
    visit_between(a, b, [&](LinePlace place, LinePlace on) {
      is_near =
          is_near && terrain::distance(place, on) <= terrain::kMostShift && keeps(on.z, place.z);
    });
    return is_near;
  }

  void add_chain(std::size_t last, FoundBreaklines& found) const {
    const auto add = [&](LinePlace place, LinePlace on) {
      found.max_shift = std::max(found.max_shift, terrain::distance(place, on));
      if (!line_.has_heights()) return;
      found.max_error = std::max(found.max_error, std::abs(on.z - place.z));
    };
    const Node end = nodes_[last];
    visit_between(end, {end.vertex, line_.length()}, add);
    std::size_t i = last;
    FoundChain chain{line_.number(), {}};
    for (; parent_[i] != i; i = parent_[i]) {
      visit_between(nodes_[parent_[i]], nodes_[i], add);
      add(line_.at(nodes_[i].along), edges_.vertex(nodes_[i].vertex));
      chain.vertices.push_back(nodes_[i].vertex);
      ++found.pieces;
    }
    chain.vertices.push_back(nodes_[i].vertex);
    found.chains.push_back(std::move(chain));
    add(line_.at(nodes_[i].along), edges_.vertex(nodes_[i].vertex));
    visit_between(nodes_[i], {nodes_[i].vertex, 0}, add);
  }

  static constexpr std::size_t kUnreached = SIZE_MAX;

  const NearbyEdges& edges_;
  const LatticeLine& line_;
  std::optional<LineRoom> room_;
  std::vector<Node> nodes_;
  std::unordered_map<uint32_t, std::vector<std::size_t>> by_vertex_;
  std::vector<std::size_t> parent_, order_;
  double farthest_ = 0;
};

constexpr uint32_t kNoLine = UINT32_MAX;

// An edge with a mark.
struct MarkedEdge {
  LineClass kind;
  uint32_t line = kNoLine;  // the first one of its class that the edge follows
};

// Marked edges by their vertices, the smaller one first.
using MarkedEdges = std::map<std::pair<uint32_t, uint32_t>, MarkedEdge>;

std::pair<uint32_t, uint32_t> key_of_edge(uint32_t a, uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

MarkedEdges edges_of(const std::vector<MarkedLine>& marks) {
  MarkedEdges edges;
  for (const MarkedLine& path : marks) {
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      edges.emplace(key_of_edge(path.vertices[i - 1], path.vertices[i]), MarkedEdge{path.kind});
    }
  }
  return edges;
}

// Makes a line that of the edges that follow it and have its class.
void claim_edges(const LineSearch& search, uint32_t line, LineClass kind, MarkedEdges& marked) {
  search.visit_edges([&](uint32_t a, uint32_t b) {
    const auto at = marked.find(key_of_edge(a, b));
    if (at == marked.end() || at->second.kind != kind) return;
    at->second.line = std::min(at->second.line, line);
  });
}

}  // namespace

FoundBreaklines find_breaklines(const microtin_mesh* mesh, const std::vector<LatticeLine>& lines,
                                const std::optional<LineRoom>& room, const Placement& lattice) {
  FoundBreaklines found;
  const NearbyEdges edges(mesh, lines);
  for (const LatticeLine& line : lines) {
    found.lines.insert(line.number());
    LineSearch search(edges, line, room);
    if (search.find(any_edge, found) || found.missing) continue;
    found.missing = "line " + std::to_string(line.number() + 1) + " has no edges from " +
                    terrain::place_text(search.farthest(), lattice) + " on";
  }
  return found;
}

std::optional<std::string> compare_marks(const microtin_mesh* mesh,
                                         const std::vector<MarkedLine>& marks,
                                         const std::vector<LatticeLine>& lines,
                                         const std::vector<LineClass>& classes,
                                         const std::optional<LineRoom>& room,
                                         const Placement& lattice) {
  const NearbyEdges edges(mesh, lines);
  MarkedEdges marked = edges_of(marks);
  for (const LatticeLine& line : lines) {  // in plan alone: chains keep the heights
    claim_edges({edges, line, std::nullopt}, line.number(), classes[line.number()], marked);
  }
  for (const auto& [ends, edge] : marked) {
    if (edge.line != kNoLine) continue;
    return "the edge from " + terrain::place_text(edges.vertex(ends.first), lattice) + " to " +
           terrain::place_text(edges.vertex(ends.second), lattice) + " is marked as " +
           std::string(name_of(edge.kind)) + ", and follows no line of this class";
  }
  for (const LatticeLine& line : lines) {
    const LineClass kind = classes[line.number()];
    const auto is_marked = [&](uint32_t a, uint32_t b) {
      const auto at = marked.find(key_of_edge(a, b));
      return at != marked.end() && (at->second.kind == kind || at->second.line < line.number());
    };
    LineSearch search(edges, line, room);
    FoundBreaklines found;
    if (search.find(is_marked, found)) continue;
    return "line " + std::to_string(line.number() + 1) + " has no edges marked as " +
           std::string(name_of(kind)) + " from " + terrain::place_text(search.farthest(), lattice) +
           " on";
  }
  return std::nullopt;
}

void add(const FoundBreaklines& part, FoundBreaklines& all) {
  all.lines.insert(part.lines.begin(), part.lines.end());
  all.pieces += part.pieces;
  all.max_shift = std::max(all.max_shift, part.max_shift);
  all.max_error = std::max(all.max_error, part.max_error);
  if (!all.missing) all.missing = part.missing;
}

}  // namespace microtin::verifying
