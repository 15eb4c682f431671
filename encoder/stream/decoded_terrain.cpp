// SPDX-License-Identifier: MIT
// Gives the shipped decoder memory and a stream.
#include "encoder/stream/decoded_terrain.hpp"

#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/status_text.hpp"
#include "encoder/stream/header.hpp"

namespace microtin::stream {
namespace {

void expect_done(microtin_status status) {
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
}

}  // namespace

void expect_room_for_vertices(const microtin_stream_info& info, uint64_t stream_bytes) {
  if (info.vertices > 3 + kVerticesPerByte * (stream_bytes - info.header_bytes)) {
    throw Error("cut off or malformed: more vertices are announced than so few bytes can hold");
  }
}

DecodedTerrain::DecodedTerrain(const std::vector<uint8_t>& stream) {
  const Header header = read_header(stream);
  expect_room_for_vertices(header.info, stream.size());
  storage_.resize((header.info.mesh_bytes + 7) / 8);
  std::vector<uint64_t> working((header.info.decoder_bytes + 7) / 8);
  expect_done(microtin_mesh_init(storage_.data(), storage_.size() * 8, &mesh_));
  microtin_decoder* decoder = nullptr;
  expect_done(microtin_decoder_init(working.data(), working.size() * 8, mesh_, &decoder));
  size_t used = 0;
  microtin_decoder_feed(decoder, stream.data(), stream.size(), &used, 0);
  expect_done(microtin_decoder_finish(decoder));
  if (used != stream.size()) {
    throw Error(std::to_string(stream.size() - used) + " bytes follow the end of the stream");
  }
  phases_ = microtin_decoder_phase(decoder);
}

}  // namespace microtin::stream
