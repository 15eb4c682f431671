// SPDX-License-Identifier: MIT
// switches CODINGS VOIDS: a decoder that is built with switches of config.h decodes the golden
// streams as every other does, and returns UNSUPPORTED_VERSION for those that need what it leaves
// out. CODINGS are the digits of the codings that it has; VOIDS is 1 if it has voids, else 0.
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "microtin/microtin.hpp"
#include "shared/crc32.hpp"
#include "tests/firmware/report.hpp"
#include "tests/support/paths.hpp"

namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kCapacity = 2000;

int wrong = 0;
std::string printed;

void put_char(char c) {
  printed += c;
}

void check(bool holds, const std::string& stream, const char* what) {
  if (holds) return;
  std::printf("%s: %s\n", stream.c_str(), what);
  ++wrong;
}

std::string content_of(const std::filesystem::path& path) {
  std::string content;
  std::FILE* const file = std::fopen(path.string().c_str(), "rb");
  if (file == nullptr) return content;
  for (int c; (c = std::fgetc(file)) != EOF;) content += static_cast<char>(c);
  std::fclose(file);
  return content;
}

// Where the last byte of the number that begins at `at` is.
size_t end_of_number(const Bytes& stream, size_t at) {
  while (stream[at] >= 128) ++at;
  return at;
}

// The last byte of the properties, which has the flag of voids and the coding.
size_t properties_at(const Bytes& stream) {
  return end_of_number(stream, end_of_number(stream, 5) + 1);
}

// What the decoder under test has.
struct Built {
  std::string codings;
  bool voids;

  microtin_status status_for(uint8_t properties) const {
    const char coding = static_cast<char>('0' + (properties >> 3 & 3));
    const bool supported =
        codings.find(coding) != std::string::npos && (voids || (properties & 2) == 0);
    return supported ? MICROTIN_STATUS_OK : MICROTIN_STATUS_UNSUPPORTED_VERSION;
  }
};

// The stream with other properties, and the header's check that they need.
Bytes with_properties(Bytes stream, uint8_t properties) {
  size_t length = 0, at = 5;
  for (bool more = true; more; ++at) {
    more = stream[at] >= 128;
    length = length << 7 | (stream[at] & 127u);
  }
  stream[properties_at(stream)] = properties;
  const uint32_t crc = microtin::crc32(0, stream.data(), at + length);
  for (size_t i = 0; i < 4; ++i) stream[at + length + i] = static_cast<uint8_t>(crc >> (8 * i));
  return stream;
}

microtin_status info_status(const Bytes& stream) {
  microtin_stream_info info;
  return microtin_read_stream_info(stream.data(), stream.size(), &info);
}

microtin_status decode(const Bytes& stream, uint32_t step_limit,
                       microtin::Terrain<kCapacity>& terrain) {
  const auto decoder = std::make_unique<microtin::Decoder<kCapacity>>(terrain);
  size_t at = 0, used = 0;
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  while (status == MICROTIN_STATUS_STEP_LIMIT) {
    status = decoder->feed(stream.data() + at, stream.size() - at, &used, step_limit);
    at += used;
  }
  return decoder->finish();
}

void check_golden(const std::string& name, const Bytes& stream, const Built& built) {
  const microtin_status expected = built.status_for(stream[properties_at(stream)]);
  check(info_status(stream) == expected, name, "its header is read with another status");
  const auto terrain = std::make_unique<microtin::Terrain<kCapacity>>();
  for (const uint32_t step_limit : {0u, 1u}) {
    const microtin_status status = decode(stream, step_limit, *terrain);
    check(status == expected, name, "decoding ends with another status");
    if (expected != MICROTIN_STATUS_OK) {
      check(terrain->vertices() == 0, name, "a terrain is there");
      continue;
    }
    printed.clear();
    microtin::report(put_char, terrain->mesh(), status);
    check(printed == content_of(microtin::tests::golden(name + ".report")), name,
          "the terrain is another");
  }
}

// Headers of all codings, and of a later version's coding 0, with and without voids.
void check_headers(const std::string& name, const Bytes& stream, const Built& built) {
  const uint8_t others = stream[properties_at(stream)] & 0xE5;
  for (uint8_t choice = 0; choice < 8; ++choice) {
    const uint8_t properties =
        static_cast<uint8_t>(others | (choice & 3) << 3 | (choice >> 2 & 1) << 1);
    const microtin_status expected = built.status_for(properties);
    Bytes other = with_properties(stream, properties);
    check(info_status(other) == expected, name, "a header is read with another status");
    const auto terrain = std::make_unique<microtin::Terrain<kCapacity>>();
    const bool refused = decode(other, 0, *terrain) == MICROTIN_STATUS_UNSUPPORTED_VERSION;
    check(refused == (expected != MICROTIN_STATUS_OK), name, "decoding takes a header otherwise");
    other[properties_at(other) + 1] ^= 1;
    check(info_status(other) == MICROTIN_STATUS_CHECKSUM, name, "damage is not found first");
    check(decode(other, 0, *terrain) == MICROTIN_STATUS_CHECKSUM, name,
          "damage is not found first");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const Built built = {argv[1], std::strcmp(argv[2], "1") == 0};
  int streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(microtin::tests::golden_folder())) {
    if (entry.path().extension() != ".mtin") continue;
    const std::string content = content_of(entry.path());
    const Bytes stream(content.begin(), content.end());
    check_golden(entry.path().stem().string(), stream, built);
    check_headers(entry.path().stem().string(), stream, built);
    ++streams;
  }
  std::printf("%d streams, %d wrong\n", streams, wrong);
  return streams != 0 && wrong == 0 ? 0 : 1;
}
