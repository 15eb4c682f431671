// SPDX-License-Identifier: MIT
// Writes marks of edges with the coding that decoders run, and reads them with the shipped decoder.
#include "encoder/stream/edge_marks.hpp"

#include <cmath>
#include <deque>
#include <optional>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/stream/range_encoder.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "shared/edge_marks.hpp"

namespace microtin::stream {
namespace {

// The half-edges of a mesh, which the library does not show.
class HalfEdges {
 public:
  explicit HalfEdges(const microtin_mesh* mesh) {
    const uint32_t vertices = microtin_mesh_vertex_count(mesh);
    const uint32_t triangles = microtin_mesh_triangle_count(mesh);
    for (uint32_t v = 0; v < vertices; ++v) {
      const Vertex vertex = vertex_of(mesh, v);
      places_.push_back({vertex.x, vertex.y});
    }
    origin_.resize(3 * std::size_t{triangles});
    twin_.resize(origin_.size());
    for (uint32_t t = 0; t < triangles; ++t) microtin_mesh_triangle(mesh, t, &origin_[3 * t]);
    for (uint32_t h = 0; h < origin_.size(); ++h) {
      const uint32_t other = 3 * microtin_mesh_neighbour(mesh, h / 3, h % 3);
      twin_[h] = other;
      while (origin_[twin_[h]] != origin_[next_in_triangle(h)]) ++twin_[h];
    }
    mesh_ = {places_.data(), nullptr, origin_.data(), twin_.data(), vertices, triangles};
  }
  HalfEdges(const HalfEdges&) = delete;
  HalfEdges& operator=(const HalfEdges&) = delete;

  const Mesh& mesh() const { return mesh_; }

  // A half-edge from each vertex.
  std::vector<Index> starts() const {
    std::vector<Index> starts(places_.size());
    for (Index h = 0; h < origin_.size(); ++h) {
      if (origin_[h] != kInfinity) starts[origin_[h]] = h;
    }
    return starts;
  }

 private:
  std::vector<Point> places_;
  std::vector<Index> origin_, twin_;
  Mesh mesh_{};
};

// The half-edge from a vertex to another, of which `start` is one.
std::optional<Index> edge_to(const Mesh& mesh, Index start, Index to) {
  Index h = start;
  do {
    if (end_of(mesh, h) == to) return h;
    h = mesh.twin[previous_in_triangle(h)];
  } while (h != start);
  return std::nullopt;
}

// Classes of edges that are to become lines, each at both half-edges; 0: none.
using Wanted = std::vector<uint8_t>;

// The sine of how far an edge turns away from straight on, or more if it turns back.
double turn_of(const Mesh& mesh, Index h, Index e) {
  const Point at = point_of(mesh, mesh.origin[e]);
  const Offset way = at - point_of(mesh, mesh.origin[h]);
  const Offset to = point_of(mesh, end_of(mesh, e)) - at;
  const auto along = static_cast<double>(dot(way, to));
  const auto area = std::abs(static_cast<double>(cross(way, to)));
  const double size =
      std::sqrt(static_cast<double>(dot(way, way)) * static_cast<double>(dot(to, to)));
  return along > 0 ? area / size : 2 - area / size;
}

// Where lines go: on along the edge of their class that goes straight on best.
class Plan {
 public:
  Plan(const Mesh& mesh, const Wanted& wanted) : mesh_(mesh), wanted_(wanted) {}

  bool begins(Index h) const { return wanted_[h] != 0; }
  uint32_t line_class(Index h) const { return wanted_[h]; }

  uint32_t way(Index h, const Ways& ways) const {
    uint32_t best = ways.count;
    double least = 0;
    for (uint32_t i = 0; i < ways.count; ++i) {
      if (wanted_[ways.edge[i]] != wanted_[h]) continue;
      const double turn = turn_of(mesh_, h, ways.edge[i]);
      if (best != ways.count && turn >= least) continue;
      best = i;
      least = turn;
    }
    return best;
  }

 private:
  const Mesh& mesh_;
  const Wanted& wanted_;
};

// A writing coder.
struct MarkWriter : RangeEncoder, Plan {
  MarkWriter(const Mesh& mesh, const Wanted& wanted) : Plan(mesh, wanted) {}
};

// A coder that writes nothing.
struct MarkTracer : Plan {
  MarkTracer(const Mesh& mesh, const Wanted& wanted) : Plan(mesh, wanted) {}
  static bool bit(uint32_t /*probability*/, bool value) { return value; }
  static uint32_t uniform(uint32_t /*count*/, uint32_t value) { return value; }
};

// Codes all lines; visit(marking) after each edge that was marked.
template <class Coder, class Visit>
void code_lines(const Mesh& mesh, uint32_t edges, Coder& coder, const Visit& visit) {
  std::vector<uint8_t> marks(edge_mark_bytes(mesh.vertices));
  EdgeMarking marking{};
  begin_marking(marking, mesh, marks.data(), edges);
  for (uint32_t left = edges; left != 0; left = marking.left) {
    if (!code_marks(marking, coder)) throw InternalFault("an edge of a line was not found");
    if (marking.left != left) visit(marking);
  }
}

// Unknown classes are other lines.
LineClass known_class(uint8_t number) {
  return number <= static_cast<uint8_t>(LineClass::kBorder) ? static_cast<LineClass>(number)
                                                            : LineClass::kOther;
}

uint32_t want(const Mesh& mesh, Index h, LineClass kind, Wanted& wanted) {
  if (wanted[h] != 0) return 0;
  wanted[h] = wanted[mesh.twin[h]] = static_cast<uint8_t>(kind);
  return 1;
}

}  // namespace

EdgeMarks::EdgeMarks(const microtin_mesh* mesh, const uint8_t* begin, const uint8_t* end) {
  if (begin == end) return;
  const std::size_t bytes =
      MICROTIN_EDGE_MARKS_BYTES(std::size_t{microtin_mesh_vertex_count(mesh)});
  storage_.resize((bytes + 7) / 8);
  microtin_edge_marks* marks = nullptr;
  microtin_status status =
      microtin_edge_marks_init(storage_.data(), storage_.size() * 8, mesh, &marks);
  std::size_t used = 0;
  if (status == MICROTIN_STATUS_OK) {
    status =
        microtin_edge_marks_feed(marks, begin, static_cast<std::size_t>(end - begin), &used, 0);
  }
  if (status == MICROTIN_STATUS_NEED_INPUT) status = microtin_edge_marks_finish(marks);
  if (status == MICROTIN_STATUS_NOT_FOUND) return;
  if (status != MICROTIN_STATUS_OK) {
    throw Error(std::string("the marks of edges behind the stream are ") +
                (status == MICROTIN_STATUS_MALFORMED ? "malformed" : "damaged"));
  }
  marks_ = marks;
}

std::vector<MarkedLine> EdgeMarks::lines(const microtin_mesh* mesh) const {
  std::vector<MarkedLine> lines;
  if (edges() == 0) return lines;
  const HalfEdges half_edges(mesh);
  const Mesh& m = half_edges.mesh();
  Wanted wanted(3 * std::size_t{m.triangles});
  for (Index h = 0; h < wanted.size(); ++h) {
    wanted[h] = static_cast<uint8_t>(microtin_edge_marks_class(marks_, h / 3, h % 3));
  }
  MarkTracer tracer(m, wanted);
  std::deque<uint32_t> path;
  const auto end_line = [&] {
    if (!path.empty()) lines.back().vertices.assign(path.begin(), path.end());
    path.clear();
  };
  code_lines(m, edges(), tracer, [&](const EdgeMarking& marking) {
    const Index end = end_of(m, marking.last);
    if (marking.stage == MarkStage::kBackward) {
      path.push_front(end);
      return;
    }
    if (marking.last == marking.first) {
      end_line();
      lines.push_back({known_class(marking.kind), {}});
      path.push_back(m.origin[marking.first]);
    }
    path.push_back(end);
  });
  end_line();
  return lines;
}

void append_edge_marks(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                       std::vector<uint8_t>& stream) {
  const HalfEdges half_edges(mesh);
  const Mesh& m = half_edges.mesh();
  const std::vector<Index> starts = half_edges.starts();
  Wanted wanted(3 * std::size_t{m.triangles});
  uint32_t edges = 0;
  for (const MarkedLine& line : lines) {
    for (std::size_t i = 1; i < line.vertices.size(); ++i) {
      const Index from = line.vertices[i - 1], to = line.vertices[i];
      const std::optional<Index> h = edge_to(m, starts[from], to);
      if (!h) throw InternalFault("a line is not an edge");
      edges += want(m, *h, line.kind, wanted);
    }
  }
  if (edges == 0) return;
  MarkWriter writer(m, wanted);
  code_lines(m, edges, writer, [](const EdgeMarking&) {});
  const std::vector<uint8_t> payload = writer.finish();
  std::vector<uint8_t> content;
  append_varint(content, edges);
  append_varint(content, payload.size());
  content.insert(content.end(), payload.begin(), payload.end());
  const std::size_t begin = stream.size();
  append_varint(stream, kMarkChunk);
  append_varint(stream, content.size());
  stream.insert(stream.end(), content.begin(), content.end());
  append_check(stream, begin);
}

LineCounts count_by_class(const std::vector<MarkedLine>& lines) {
  LineCounts counts{};
  for (const MarkedLine& line : lines) ++counts[static_cast<std::size_t>(line.kind)];
  return counts;
}

}  // namespace microtin::stream
