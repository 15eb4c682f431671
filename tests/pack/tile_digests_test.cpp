// SPDX-License-Identifier: MIT
// The digest of each tile of each golden pack, or why there is none, as the second decoder must
// find them too. MICROTIN_WRITE_GOLDEN=1 writes them anew.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/pack/file.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {
namespace {

// The word with which the second decoder begins its reason.
std::string word_for(const Error& error) {
  const std::string text = error.what();
  const auto means = [&text](microtin_status status) {
    return text.find(describe(status)) != std::string::npos;
  };
  if (means(MICROTIN_STATUS_UNSUPPORTED_VERSION)) return "unsupported\n";
  if (means(MICROTIN_STATUS_CHECKSUM)) return "damaged\n";
  if (means(MICROTIN_STATUS_BAD_MAGIC)) return "foreign\n";
  if (means(MICROTIN_STATUS_TRUNCATED)) return "truncated\n";
  if (means(MICROTIN_STATUS_MALFORMED)) return "malformed\n";
  return text + "\n";
}

std::string digits_of(uint64_t digest) {
  std::string digits(16, '0');
  for (size_t i = 16; i-- != 0; digest >>= 4) digits[i] = "0123456789abcdef"[digest & 15u];
  return digits;
}

std::string line_of(const PackFile& pack, uint32_t tile) {
  try {
    const auto terrain = pack.tile(tile);
    return terrain ? "digest " + digits_of(microtin_mesh_digest(terrain->mesh())) + "\n"
                   : "no terrain\n";
  } catch (const Error& error) {
    return word_for(error);
  }
}

std::string tile_digests(const std::string& path) {
  try {
    const PackFile pack(open_file(path));
    std::string lines;
    for (uint32_t tile = 0; tile < pack.tiles(); ++tile) {
      lines += "tile " + std::to_string(tile) + "\n" + line_of(pack, tile);
    }
    return lines;
  } catch (const Error& error) {
    return word_for(error);
  }
}

}  // namespace

TEST_CASE("golden packs: each tile has the digest that is recorded") {
  size_t packs = 0;
  for (const auto& file : std::filesystem::directory_iterator(golden_folder())) {
    if (file.path().extension() != ".mtp") continue;
    CAPTURE(file.path().filename().string());
    const std::string digests = tile_digests(file.path().string());
    const std::string recorded =
        std::filesystem::path(file.path()).replace_extension(".digests").string();
    if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) {
      write_file(recorded, {digests.begin(), digests.end()});
    }
    CHECK(digests == read_file(recorded));
    ++packs;
  }
  CHECK(packs == 16);
}

}  // namespace microtin::tests
