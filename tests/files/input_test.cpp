// SPDX-License-Identifier: MIT
// More files are read in pieces than a process may have open.
#include "encoder/files/input.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

constexpr size_t kFiles = 300;  // more than the pool keeps open

struct Opened {
  Opened() {
    for (size_t i = 0; i < kFiles; ++i) {
      write_file(path(i), {static_cast<uint8_t>(i), static_cast<uint8_t>(i >> 8), 7});
      files.push_back(files::open_file(path(i)));
    }
  }

  std::string path(size_t number) const { return folder / std::to_string(number); }

  bool is_read(size_t number) const {
    const std::vector<uint8_t> bytes = files::bytes_at(*files[number], 0, 3);
    return bytes[0] + 256 * bytes[1] == static_cast<int>(number) && bytes[2] == 7;
  }

  TemporaryFolder folder;
  std::vector<std::unique_ptr<files::ByteSource>> files;
};

size_t open_descriptors() {
  const std::filesystem::directory_iterator entries("/proc/self/fd");
  return static_cast<size_t>(std::distance(begin(entries), end(entries)));
}

std::string refusal(const files::ByteSource& file) {
  try {
    files::bytes_at(file, 0, 1);
  } catch (const base::Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("input: files that are closed meanwhile are read as if they were open") {
  const bool can_count = std::filesystem::exists("/proc/self/fd");
  const size_t before = can_count ? open_descriptors() : 0;
  {
    const Opened opened;
    if (can_count) CHECK(open_descriptors() - before < kFiles / 2);
    for (const size_t step : {size_t{1}, size_t{7}, kFiles - 1}) {
      for (size_t i = 0; i < kFiles; ++i) REQUIRE(opened.is_read(i * step % kFiles));
    }
  }
  if (can_count) CHECK(open_descriptors() == before);
}

TEST_CASE("input: threads read more files than the pool keeps open") {
  const Opened opened;
  std::vector<std::thread> threads;
  std::vector<size_t> right(4);
  for (size_t t = 0; t < right.size(); ++t) {
    threads.emplace_back([&, t] {
      for (size_t i = 0; i < 2 * kFiles; ++i) {
        if (opened.is_read((i * 89 + t * 17) % kFiles)) ++right[t];
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const size_t count : right) CHECK(count == 2 * kFiles);
}

TEST_CASE("input: another file under the name of one that was closed is refused") {
  const Opened opened;
  std::filesystem::remove(opened.path(0));
  CHECK(contains(refusal(*opened.files[0]), "0: cannot be read: "));
  write_file(opened.path(1), {1, 0, 7, 7});
  CHECK(contains(refusal(*opened.files[1]), "1: became another file while it was read"));
  write_file(opened.path(3), {2, 0, 7});
  std::filesystem::rename(opened.path(3), opened.path(2));
  CHECK(contains(refusal(*opened.files[2]), "2: became another file while it was read"));
  CHECK(opened.is_read(kFiles - 1));
}

}  // namespace microtin::tests
