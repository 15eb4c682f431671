// SPDX-License-Identifier: MIT
// What the command line makes of any stream: everything its header says, the same after it was
// written anew, and its terrain; or an error.
#include <algorithm>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/header.hpp"
#include "fuzz/support/expect.hpp"
#include "fuzz/support/stream_mutator.hpp"

using namespace microtin::tests;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::vector<uint8_t> stream(data, data + size);
  microtin_info info;
  const bool legal = microtin_peek(data, size, &info) == MICROTIN_DONE;
  try {
    const Header header = read_header(stream);
    EXPECT(legal);
    const std::vector<uint8_t> once = write_header(header.contract, header.metadata);
    const Header again = read_header(once);
    const std::vector<uint8_t> twice = write_header(again.contract, again.metadata);
    EXPECT(once == twice);
    if (info.vertices > 2000) return 0;
    const DecodedTerrain decoded(stream);
    EXPECT(microtin_vertex_count(decoded.mesh()) == info.vertices);
  } catch (const Error& error) {
    EXPECT(error.what()[0] != '\0');
  }
  return 0;
}
