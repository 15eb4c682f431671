// SPDX-License-Identifier: MIT
// Reads the marks of edges out of the chunks behind a stream.
#include "shared/edge_marks.hpp"

#include "decoder/state.hpp"
#include "microtin/edge_marks.h"
#include "shared/header.hpp"

namespace microtin {
namespace {

enum class MarkItem : uint8_t {
  kType,    // of a chunk
  kLength,  // of its content
  kEdges,   // how many have marks
  kSize,    // of the payload
  kBegin,   // of the payload
  kStep,
  kRest,  // of payload and content
  kCheck
};

// A reading coder. It knows nothing of what it will read.
struct MarkReader : RangeDecoder {
  bool begins(Index) const { return false; }
  uint32_t line_class(Index) const { return 0; }
  uint32_t way(Index, const Ways&) const { return 0; }
};

static_assert((kMostLookedAt + 1) * 9 / 8 + 4 <= kStepBytes,
              "9 bits for each of its decisions: a step finds its bytes at hand");

}  // namespace
}  // namespace microtin

struct microtin_edge_marks {
  const microtin_mesh* mesh;
  uint32_t vertices, edges;
  uint32_t number;        // that is being read
  uint32_t type;          // of the chunk
  uint32_t content_left;  // bytes of the chunk, without what is left of the payload
  microtin_status status;
  microtin_status verdict;  // OK, or what to say once the check has passed
  microtin::MarkItem item;
  microtin::MarkReader coder;
  microtin::EdgeMarking marking;
};

static_assert(sizeof(microtin_edge_marks) <= MICROTIN_EDGE_MARKS_BYTES(0) &&
                  MICROTIN_EDGE_MARKS_BYTES(0) + microtin::edge_mark_bytes(1001) ==
                      MICROTIN_EDGE_MARKS_BYTES(1001),
              "see MICROTIN_EDGE_MARKS_BYTES");

namespace microtin {
namespace {

typedef microtin_edge_marks Marks;

uint8_t* marks_behind(Marks& m) {
  return reinterpret_cast<uint8_t*>(&m + 1);
}

microtin_status skip_content(Marks& m, bool legal) {
  if (!legal) m.verdict = MICROTIN_STATUS_MALFORMED;
  m.item = MarkItem::kRest;
  return MICROTIN_STATUS_NEED_INPUT;
}

// Takes a byte of a number. False if more follow.
bool take_number(Marks& m, bool* legal) {
  return !take_length(&m.number, m.coder.window.take(), legal);
}

// A chunk's type, then its length. A fault there is damage: it is not a chunk.
microtin_status handle_frame(Marks& m) {
  bool legal = true;
  const bool is_done = take_number(m, &legal);
  if (!legal) return MICROTIN_STATUS_CHECKSUM;
  if (!is_done) return MICROTIN_STATUS_NEED_INPUT;
  if (m.item == MarkItem::kType) {
    m.type = m.number;
    m.item = MarkItem::kLength;
  } else {
    m.content_left = m.number;
    m.item = m.type == kMarkChunk ? MarkItem::kEdges : MarkItem::kRest;
  }
  m.number = 0;
  return MICROTIN_STATUS_NEED_INPUT;
}

// The number of edges, then that of the payload's bytes.
microtin_status handle_numbers(Marks& m) {
  if (m.content_left == 0) return skip_content(m, false);
  bool legal = true;
  const bool is_done = take_number(m, &legal);
  --m.content_left;
  if (!legal) return skip_content(m, false);
  if (!is_done) return MICROTIN_STATUS_NEED_INPUT;
  if (m.item == MarkItem::kEdges) {
    m.edges = m.number;
    m.item = MarkItem::kSize;
    m.number = 0;
    return MICROTIN_STATUS_NEED_INPUT;
  }
  if (m.edges == 0 || m.number > m.content_left) return skip_content(m, false);
  m.content_left -= m.number;
  m.coder.payload_left = m.number;
  m.item = MarkItem::kBegin;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_begin(Marks& m) {
  m.coder.begin();
  if (m.coder.overrun) return skip_content(m, false);
  begin_marking(m.marking, m.mesh->mesh, marks_behind(m), m.edges);
  m.item = MarkItem::kStep;
  return MICROTIN_STATUS_NEED_INPUT;
}

// As many steps as surely find their bytes at hand.
microtin_status handle_mark_steps(Marks& m, uint32_t* steps_left) {
  while (*steps_left != 0) {
    --*steps_left;
    const bool legal = code_marks(m.marking, m.coder) && !m.coder.overrun;
    if (!legal) return skip_content(m, false);
    if (m.marking.left == 0) return skip_content(m, m.coder.payload_left == 0);
    if (m.coder.window.left < kStepBytes) return MICROTIN_STATUS_NEED_INPUT;
  }
  return MICROTIN_STATUS_STEP_LIMIT;
}

// Takes what is at hand of the bytes that are not read.
microtin_status handle_content(Marks& m) {
  m.content_left += m.coder.payload_left;
  m.coder.payload_left = 0;
  const uint32_t taken = smaller(static_cast<uint32_t>(m.coder.window.left), m.content_left);
  m.coder.window.skip(taken);
  m.content_left -= taken;
  if (m.content_left == 0) m.item = MarkItem::kCheck;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_chunk_check(Marks& m) {
  ByteWindow& window = m.coder.window;
  window.skip(kCheckBytes);
  window.settle();
  const bool passes = window.crc == kCheckedCrc;
  window.crc = 0;
  if (!passes) return MICROTIN_STATUS_CHECKSUM;
  if (m.type == kMarkChunk) return m.verdict;
  m.item = MarkItem::kType;
  return MICROTIN_STATUS_NEED_INPUT;
}

// NEED_INPUT means: go on.
microtin_status handle_mark_item(Marks& m, uint32_t* steps_left) {
  switch (m.item) {
    case MarkItem::kType:
    case MarkItem::kLength:
      return handle_frame(m);
    case MarkItem::kEdges:
    case MarkItem::kSize:
      return handle_numbers(m);
    case MarkItem::kBegin:
      return handle_begin(m);
    case MarkItem::kStep:
      return handle_mark_steps(m, steps_left);
    case MarkItem::kRest:
      return handle_content(m);
    case MarkItem::kCheck:
      break;
  }
  return handle_chunk_check(m);
}

// Bytes that must be at hand before an item can be handled.
uint32_t bytes_needed(const Marks& m) {
  switch (m.item) {
    case MarkItem::kType:
    case MarkItem::kLength:
      return 1;
    case MarkItem::kEdges:
    case MarkItem::kSize:
      return smaller<uint32_t>(1, m.content_left);
    case MarkItem::kBegin:
    case MarkItem::kCheck:
      break;
    case MarkItem::kStep:
      return smaller(kStepBytes, m.coder.payload_left);
    case MarkItem::kRest:
      return smaller<uint32_t>(1, m.content_left + m.coder.payload_left);
  }
  return m.item == MarkItem::kCheck ? kCheckBytes : smaller<uint32_t>(4, m.coder.payload_left);
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_edge_marks_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                         microtin_edge_marks** marks) {
  if (workspace == nullptr || mesh == nullptr || marks == nullptr) return MICROTIN_STATUS_ARGUMENT;
  *marks = nullptr;
  const uint32_t vertices = mesh->mesh.vertices;
  if (vertices == 0 || vertices != mesh->verified_vertices) return MICROTIN_STATUS_ARGUMENT;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) {
    return MICROTIN_STATUS_MISALIGNED;
  }
  if (size < MICROTIN_EDGE_MARKS_BYTES(static_cast<size_t>(vertices))) {
    return MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
  }
  Marks& m = *static_cast<Marks*>(workspace);
  m.mesh = mesh;
  m.vertices = vertices;
  m.edges = m.number = m.content_left = 0;
  m.status = MICROTIN_STATUS_NEED_INPUT;
  m.verdict = MICROTIN_STATUS_OK;
  m.item = MarkItem::kType;
  m.coder.payload_left = 0;
  m.coder.overrun = false;
  ByteWindow& window = m.coder.window;
  window.next = window.bytes;
  window.left = 0;
  window.crc = 0;
  window.used = 0;
  uint8_t* const bits = marks_behind(m);
  for (uint32_t i = 0; i < edge_mark_bytes(vertices); ++i) bits[i] = 0;
  *marks = &m;
  return MICROTIN_STATUS_OK;
}

microtin_status microtin_edge_marks_feed(microtin_edge_marks* marks, const uint8_t* bytes,
                                         size_t size, size_t* used, uint32_t step_limit) {
  if (marks == nullptr || used == nullptr || (bytes == nullptr && size != 0)) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  *used = 0;
  Marks& m = *marks;
  if (m.status != MICROTIN_STATUS_NEED_INPUT) return m.status;
  ByteWindow& window = m.coder.window;
  uint32_t steps_left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT) {
    while (window.left < bytes_needed(m)) {
      if (*used == size) return status;
      *used += window.fill(bytes + *used, size - *used);
    }
    status = handle_mark_item(m, &steps_left);
  }
  const size_t returned = smaller<size_t>(window.left, *used);
  window.left -= returned;
  *used -= returned;
  if (status != MICROTIN_STATUS_STEP_LIMIT) m.status = status;
  return status;
}

microtin_status microtin_edge_marks_finish(microtin_edge_marks* marks) {
  if (marks == nullptr) return MICROTIN_STATUS_ARGUMENT;
  if (marks->status == MICROTIN_STATUS_NEED_INPUT) {
    const bool is_between = marks->item == MarkItem::kType && marks->number == 0;
    marks->status = is_between ? MICROTIN_STATUS_NOT_FOUND : MICROTIN_STATUS_TRUNCATED;
  }
  return marks->status;
}

uint32_t microtin_edge_marks_count(const microtin_edge_marks* marks) {
  return marks->status == MICROTIN_STATUS_OK ? marks->edges : 0;
}

uint32_t microtin_edge_marks_class(const microtin_edge_marks* marks, uint32_t t, uint32_t corner) {
  MICROTIN_ASSERT(t < 2 * marks->vertices - 2 && corner < 3);
  const Mesh& mesh = marks->mesh->mesh;
  if (marks->status != MICROTIN_STATUS_OK || mesh.vertices != marks->vertices) return 0;
  const Index h = static_cast<Index>(first_edge(static_cast<Index>(t)) + corner);
  return class_of_edge(mesh, reinterpret_cast<const uint8_t*>(marks + 1), h);
}
