#include "encoder/decoded_terrain.hpp"

#include <string>

#include "encoder/error.hpp"
#include "encoder/header.hpp"

namespace microtin {
namespace {

void expect_done(microtin_status status) {
  if (status != MICROTIN_DONE) throw Error(describe(status));
}

}  // namespace

DecodedTerrain::DecodedTerrain(const std::vector<uint8_t>& stream) {
  const Header header = read_header(stream);
  storage_.resize((header.info.mesh_bytes + 7) / 8);
  std::vector<uint64_t> working((header.info.decoder_bytes + 7) / 8);
  expect_done(microtin_mesh_init(storage_.data(), storage_.size() * 8, &mesh_));
  microtin_decoder* decoder = nullptr;
  expect_done(microtin_decoder_init(working.data(), working.size() * 8, mesh_, &decoder));
  size_t used = 0;
  microtin_feed(decoder, stream.data(), stream.size(), 0, &used);
  expect_done(microtin_finish(decoder));
  if (used != stream.size()) {
    throw Error(std::to_string(stream.size() - used) + " bytes follow the end of the stream");
  }
  phases_ = microtin_phase(decoder);
}

}  // namespace microtin
