// SPDX-License-Identifier: MIT
// Lines among the edges of a mesh: as a chunk behind a stream, and back.
#ifndef MICROTIN_ENCODER_STREAM_EDGE_MARKS_HPP
#define MICROTIN_ENCODER_STREAM_EDGE_MARKS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/line_class.hpp"
#include "microtin/edge_marks.h"
#include "microtin/microtin.h"

namespace microtin::stream {

// The marks of a mesh's edges, in memory of their own. The mesh must outlive them.
class EdgeMarks {
 public:
  EdgeMarks() = default;

  // Reads the chunks behind a stream, up to the first one with marks, if there is any. Throws Error
  // if it is malformed.
  EdgeMarks(const microtin_mesh* mesh, const uint8_t* begin, const uint8_t* end);

  // How many edges have marks.
  uint32_t edges() const { return marks_ == nullptr ? 0 : microtin_edge_marks_count(marks_); }

  // The lines that the edges make: each goes on straight on wherever lines of its class meet.
  std::vector<MarkedLine> lines(const microtin_mesh* mesh) const;

 private:
  std::vector<uint64_t> storage_;
  microtin_edge_marks* marks_ = nullptr;
};

// Appends a chunk with marks of these lines' edges to a stream, the mesh of which is given. An edge
// of several lines has the class of the first one. Nothing if there is no edge.
void append_edge_marks(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                       std::vector<uint8_t>& stream);

// How many lines each class has, by its number.
using LineCounts = std::array<std::size_t, kLineClassNumbers>;
LineCounts count_by_class(const std::vector<MarkedLine>& lines);

}  // namespace microtin::stream

#endif
