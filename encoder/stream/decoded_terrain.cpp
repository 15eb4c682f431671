// SPDX-License-Identifier: MIT
// Gives the shipped decoder memory and a stream, and copies vertices and triangles out of a mesh.
#include "encoder/stream/decoded_terrain.hpp"

#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "shared/crc32.hpp"
#include "shared/edge_marks.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

void expect_done(microtin_status status) {
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
}

// Where a section ends that begins at `at`; the stream's end if it does not end before.
size_t section_end(const std::vector<uint8_t>& stream, size_t at) {
  const uint8_t *next = stream.data() + at, *const end = stream.data() + stream.size();
  uint64_t length = 0;
  if (!read_varint(&next, end, &length)) return stream.size();
  const auto left = static_cast<uint64_t>(end - next);
  if (left < kCheckBytes || length > left - kCheckBytes) return stream.size();
  return stream.size() - static_cast<size_t>(left - kCheckBytes - length);
}

// A decoder and its mesh in memory of the size that a header states.
struct StartedDecoder {
  std::vector<uint64_t> mesh_memory, working;  // aligned to MICROTIN_ALIGNMENT
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;

  explicit StartedDecoder(const microtin_stream_info& info)
      : mesh_memory((info.mesh_bytes + 7) / 8), working((info.decoder_bytes + 7) / 8) {
    expect_done(microtin_mesh_init(mesh_memory.data(), mesh_memory.size() * 8, &mesh));
    expect_done(microtin_decoder_init(working.data(), working.size() * 8, mesh, &decoder));
  }
};

// All bytes of a chunk with this content.
size_t bytes_of_chunk(uint64_t type, const uint8_t* begin, const uint8_t* end) {
  std::vector<uint8_t> frame;
  append_varint(frame, type);
  append_varint(frame, static_cast<uint64_t>(end - begin));
  return frame.size() + static_cast<size_t>(end - begin) + kCheckBytes;
}

}  // namespace

void expect_room_for_vertices(const microtin_stream_info& info, uint64_t stream_bytes) {
  if (info.vertices > 3 + kVerticesPerByte * (stream_bytes - info.header_bytes)) {
    throw Error("cut off or malformed: its header has more vertices than its bytes can hold");
  }
}

void expect_chunks(const uint8_t* at, const uint8_t* end, const ChunkVisitor& visit) {
  while (at != end) {
    const uint8_t* const begin = at;
    uint64_t type = 0, length = 0;
    const bool is_framed = read_varint(&at, end, &type) && read_varint(&at, end, &length) &&
                           type < kChunkNumberEnd && length < kChunkNumberEnd &&
                           length + kCheckBytes <= static_cast<uint64_t>(end - at);
    const uint8_t* const content = at;
    if (is_framed) at += length + kCheckBytes;
    if (!is_framed || crc32(0, begin, static_cast<size_t>(at - begin)) != kCheckedCrc) {
      throw Error("the bytes behind the end of the stream are damaged: they are no chunks");
    }
    if (visit) visit(type, content, at - kCheckBytes);
  }
}

void append_chunk(const BoundSpan& bounds, std::vector<uint8_t>& stream) {
  const std::vector<uint8_t> content = write_span(bounds);
  const size_t begin = stream.size();
  append_varint(stream, MICROTIN_NOTE_BOUNDS);
  append_varint(stream, content.size());
  stream.insert(stream.end(), content.begin(), content.end());
  append_check(stream, begin);
}

DecodedTerrain::DecodedTerrain(const std::vector<uint8_t>& stream, const SectionVisitor& visit,
                               MarkChunks marks) {
  const Header header = read_header(stream);
  expect_room_for_vertices(header.info, stream.size());
  StartedDecoder started(header.info);
  microtin_decoder* const decoder = started.decoder;
  mesh_ = started.mesh;
  storage_ = std::move(started.mesh_memory);
  size_t at = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  for (size_t end = header.info.header_bytes; status == MICROTIN_STATUS_NEED_INPUT && at < end;
       end = section_end(stream, at)) {
    const bool is_section = at != 0;
    size_t used = 0;
    status = microtin_decoder_feed(decoder, stream.data() + at, end - at, &used, 0);
    at += used;
    const bool is_intact = status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_OK;
    if (visit && is_section && is_intact) visit(mesh_, at - header.info.header_bytes);
  }
  expect_done(microtin_decoder_finish(decoder));
  const uint8_t *const behind = stream.data() + at, *const end = stream.data() + stream.size();
  const bool has_marks = marks == MarkChunks::kRead;
  expect_chunks(behind, end, [&](uint64_t type, const uint8_t* from, const uint8_t* to) {
    if (type == MICROTIN_NOTE_BOUNDS && !bounds_) bounds_ = read_span(from, to);
    if (has_marks && type == kMarkChunk && mark_bytes_ == 0)
      mark_bytes_ = bytes_of_chunk(type, from, to);
  });
  if (has_marks) marks_ = EdgeMarks(mesh_, behind, end);
  phases_ = microtin_decoder_phase(decoder);
}

SurfaceModel model_of(const microtin_mesh* mesh) {
  SurfaceModel model;
  microtin_mesh_axes(mesh, &model.placement.x, &model.placement.y, &model.placement.z);
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    model.vertices.push_back({x, y, z});
  }
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    std::array<uint32_t, 3> corners{};
    if (microtin_mesh_triangle(mesh, t, corners.data()) == MICROTIN_TRIANGLE_REAL) {
      model.triangles.push_back(corners);
    }
  }
  return model;
}

SurfaceModel model_after(const std::vector<uint8_t>& stream, uint64_t bytes) {
  const Header header = read_header(stream);
  expect_room_for_vertices(header.info, stream.size());
  const StartedDecoder started(header.info);
  const auto size = static_cast<size_t>(std::min<uint64_t>(bytes, stream.size()));
  size_t used = 0;
  const microtin_status status =
      microtin_decoder_feed(started.decoder, stream.data(), size, &used, 0);
  if (status != MICROTIN_STATUS_NEED_INPUT) expect_done(status);
  return model_of(started.mesh);
}

}  // namespace microtin::stream
