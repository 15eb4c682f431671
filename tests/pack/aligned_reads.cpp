// SPDX-License-Identifier: MIT
// aligned_reads PACK: a flight with the adapters in a build with MICROTIN_READ_ALIGNMENT. Prints
// what devices print, and ends with 3 if a buffer is not aligned.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tests/firmware/adapters_report.hpp"

namespace {

std::vector<unsigned char> bytes;

// Few bytes at a time, so that most reads continue others.
int32_t read_pack(void* reads, uint64_t offset, uint8_t* buffer, size_t size) {
  uint32_t& count = *static_cast<uint32_t*>(reads);
  if (reinterpret_cast<uintptr_t>(buffer) % MICROTIN_READ_ALIGNMENT != 0) std::exit(3);
  if (offset >= bytes.size()) return 0;
  size_t taken = bytes.size() - static_cast<size_t>(offset);
  if (taken > size) taken = size;
  if (taken > 13 && ++count % 2 == 0) taken = 13;
  std::memcpy(buffer, bytes.data() + offset, taken);
  return static_cast<int32_t>(taken);
}

void put(char c) {
  std::putchar(c);
}

}  // namespace

int main(int argc, char** argv) {
  std::FILE* const file = argc > 1 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr) return 1;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    bytes.push_back(static_cast<unsigned char>(c));
  }
  std::fclose(file);
  static uint64_t space[MICROTIN_PACK_BYTES(5, 300) / 8 + 2];
  uint32_t reads = 0;
  for (size_t shift = 0; shift < 2; ++shift) {  // one of the two is not aligned to more than 8
    microtin_pack* pack = nullptr;
    if (microtin_pack_init(space + shift, sizeof space - 8, 5, 300, &pack) != MICROTIN_STATUS_OK) {
      return 2;
    }
    void (*const print)(char) = shift == 0 ? [](char) {} : put;
    const int failed = microtin::AdaptersReport(print, pack, read_pack, &reads).run();
    if (failed != 0) return 10 + failed;
  }
  return 0;
}
