// SPDX-License-Identifier: MIT
// The host's side of the comparison: the report of a stream file, which is read whole.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "microtin/microtin.hpp"
#include "tests/firmware/report.hpp"

namespace {

constexpr uint32_t kCapacity = MICROTIN_MAX_VERTICES_FOR(16);  // as a device's

void put_char(char c) {
  std::putchar(c);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: host_report STREAM\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const std::vector<uint8_t> stream(bytes.begin(), bytes.end());
  const auto terrain = std::make_unique<microtin::Terrain<kCapacity>>();
  const auto decoder = std::make_unique<microtin::Decoder<kCapacity>>(*terrain);
  size_t used = 0;
  decoder->feed(stream.data(), stream.size(), &used);
  const microtin_status status = decoder->finish();
  microtin::report(put_char, terrain->mesh(), status);
  if (status != MICROTIN_STATUS_OK) return 1;
  if (microtin::compact_agrees(terrain->mesh(), MICROTIN_MESH_BYTES(kCapacity), decoder.get(),
                               sizeof *decoder)) {
    return 0;
  }
  std::puts("its compact form differs");
  return 1;
}
