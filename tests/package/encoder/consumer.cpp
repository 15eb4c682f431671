// SPDX-License-Identifier: MIT
// The smallest user of the encoder's library: posts in, a stream out, decoded at once.
#include <microtin/encoder.hpp>
#include <microtin/microtin.hpp>

int main() {
  using namespace microtin::encoder;
  RasterData posts;
  posts.columns = posts.rows = 9;
  for (int64_t i = 0; i < 81; ++i) posts.heights.push_back((i % 9) * (i % 9) + i / 9);
  Options options;
  options.max_error = "0.5";
  const Stream stream = encode_stream(SourceTerrain(posts), options);

  static microtin::Terrain<81> terrain;
  static microtin::Decoder<81> decoder(terrain);
  size_t used = 0;
  decoder.feed(stream.bytes.data(), stream.bytes.size(), &used);
  uint32_t hint = 0;
  int32_t height = 0;
  const bool done = decoder.finish() == MICROTIN_STATUS_OK;
  const bool found = terrain.height_at(0, 0, &hint, &height) == MICROTIN_QUERY_OK;
  return done && found && stream.report.samples == 81 ? 0 : 1;
}
