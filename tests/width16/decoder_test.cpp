// The decoder as devices build it, with 16-bit numbers: same streams, same terrains.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "microtin/microtin.hpp"

namespace {

static_assert(MICROTIN_INDEX_BITS == 16, "this tests the narrow build");

// The widest terrain that 16-bit numbers reach, on the heap.
constexpr uint32_t kCapacity = MICROTIN_MAX_VERTICES;
using Terrain = microtin::Terrain<kCapacity>;
using Decoder = microtin::Decoder<kCapacity>;

std::string hex(uint64_t number) {
  std::ostringstream text;
  text.width(16);
  text.fill('0');
  text << std::hex << number;
  return text.str();
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("golden streams decode to the recorded terrains") {
  int streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MICROTIN_GOLDEN_DIR)) {
    if (entry.path().extension() != ".mtin") continue;
    CAPTURE(entry.path().filename().string());
    const std::string bytes = read_file(entry.path());
    const auto terrain = std::make_unique<Terrain>();
    const auto decoder = std::make_unique<Decoder>(*terrain);
    size_t used = 0;
    CHECK(decoder->feed(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &used) ==
          MICROTIN_DONE);
    CHECK(used == bytes.size());
    const std::string report =
        read_file(std::filesystem::path(entry.path()).replace_extension(".report"));
    CHECK(report.find("digest " + hex(terrain->digest()) + "\n") != std::string::npos);
    ++streams;
  }
  CHECK(streams > 0);
}

TEST_CASE("n independent memory is at most 3 KB and 34 bytes a vertex") {
  const auto bytes = [](unsigned long n) {
    return MICROTIN_MESH_BYTES(n) + MICROTIN_DECODER_BYTES(n);
  };
  CHECK(bytes(0) <= 3072);
  for (const unsigned long n : {250ul, 1000ul, 10923ul}) {
    CHECK(bytes(n) <= 3072 + 34 * n);
    CHECK(MICROTIN_MESH_BYTES(n) <= 3072 + 31 * n);
  }
}
