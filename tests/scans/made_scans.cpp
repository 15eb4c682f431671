// SPDX-License-Identifier: MIT
// made_scans FOLDER POINTS [FORMAT...] writes scans of POINTS points into a folder that exists, of
// each point format (all that LAZ is read of): FORMAT.las, and FORMAT.laz, the same compressed.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/laz_file.hpp"

namespace {

using namespace microtin::tests;

std::vector<uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

void write_scans(const std::string& folder, uint32_t points, const std::vector<int>& formats) {
  for (const int format : formats) {
    const std::string las =
        made_scan(static_cast<uint8_t>(format), points, static_cast<uint32_t>(format % 3));
    LazOptions options;
    if (format % 2 != 0) options.chunks = {points / 2, points - points / 2};
    const std::string name = folder + "/" + std::to_string(format);
    write_file(name + ".las", bytes_of(las));
    write_file(name + ".laz", bytes_of(compressed(las, options)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    std::vector<int> formats;
    for (size_t i = 2; i < words.size(); ++i) formats.push_back(std::stoi(words[i]));
    if (formats.empty()) formats = {0, 1, 2, 3, 6, 7, 8, 9, 10};
    write_scans(words.at(0), static_cast<uint32_t>(std::stoul(words.at(1))), formats);
    return 0;
  } catch (const std::exception&) {
    std::fputs("usage: made_scans FOLDER POINTS [FORMAT...]\n", stderr);
    return 2;
  }
}
