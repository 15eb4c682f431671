// SPDX-License-Identifier: MIT
// The tests that documents name exist: shared/docs/guarantees.md has one for each number.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {
namespace {

const std::filesystem::path kTests = golden_folder() / "../..";

// With every run of spaces and line breaks as one space.
std::string text_of(const std::filesystem::path& path) {
  std::string text;
  for (const uint8_t byte : bytes_of_file(path.string())) {
    const char c = byte == '\n' ? ' ' : static_cast<char>(byte);
    if (c != ' ' || text.empty() || text.back() != ' ') text.push_back(c);
  }
  return text;
}

std::string all_tests() {
  std::string text;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTests)) {
    if (entry.path().extension() == ".cpp") text += text_of(entry.path());
  }
  return text;
}

// What stands between quotes in italics: *"one name", "another"*.
std::vector<std::string> names_in(const std::string& document) {
  std::vector<std::string> names;
  for (size_t at = document.find("*\""); at != std::string::npos; at = document.find("*\"", at)) {
    do {
      const size_t begin = document.find('"', at) + 1, end = document.find('"', begin);
      REQUIRE(end != std::string::npos);
      names.push_back(document.substr(begin, end - begin));
      at = end + 1;
    } while (document.compare(at, 3, ", \"") == 0);
  }
  return names;
}

}  // namespace

TEST_CASE("every test case that guarantees.md names exists") {
  const std::string text = text_of(kTests / "../shared/docs/guarantees.md"), tests = all_tests();
  int named = 0;
  for (size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at)) {
    const size_t end = text.find('"', at + 1);
    REQUIRE(end != std::string::npos);
    std::string name = text.substr(at + 1, end - at - 1);
    at = end + 1;
    const bool shortened = name.size() > 4 && name.substr(name.size() - 4) == " ...";
    if (shortened) name.resize(name.size() - 4);
    if (!shortened) name.push_back('"');
    CAPTURE(name);
    CHECK(tests.find(name.insert(0, "TEST_CASE(\"")) != std::string::npos);
    ++named;
  }
  CHECK(named > 20);
}

// There a subject, such as "pack: ", may be left out.
TEST_CASE("every test case that other documents of the decoder name exists") {
  const std::string tests = all_tests();
  size_t named = 0;
  for (const char* document : {"shared/docs/format-pack.md", "shared/docs/format-compact.md"}) {
    for (const std::string& name : names_in(text_of(kTests / ".." / document))) {
      CAPTURE(name);
      CHECK((tests.find('"' + name + '"') != std::string::npos ||
             tests.find(": " + name + '"') != std::string::npos));
      ++named;
    }
  }
  CHECK(named > 20);
}

}  // namespace microtin::tests
