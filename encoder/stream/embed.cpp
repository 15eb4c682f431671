// SPDX-License-Identifier: MIT
// Prints bytes as an array.
#include "encoder/stream/embed.hpp"

#include <cctype>
#include <cstdio>

namespace microtin::stream {
namespace {

// Locales do not matter: names of C are ASCII.
std::string identifier(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool plain = static_cast<unsigned char>(c) < 128 && std::isalnum(c) != 0;
    result += plain ? c : '_';
  }
  const bool begins_well = !result.empty() && std::isalpha(result[0]) != 0;
  return begins_well ? result : "t" + result;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  return text;
}

std::string array_of(const std::vector<uint8_t>& bytes) {
  std::string text;
  for (size_t i = 0; i < bytes.size(); ++i) {
    char number[8];
    std::snprintf(number, sizeof number, "0x%02x,", bytes[i]);
    text += i % 16 == 0 ? "\n    " : " ";
    text += number;
  }
  return text + "\n";
}

}  // namespace

std::string embed(const std::vector<uint8_t>& bytes, Embedded kind, uint32_t vertices,
                  const std::string& name) {
  const bool is_pack = kind == Embedded::kPack;
  const std::string lower = identifier(name), upper = upper_case(lower);
  const std::string guard = "MICROTIN_EMBEDDED_" + upper + "_H";
  return "/* A terrain for microtin. Made by `microtin embed`; to be included in one source file. "
         "*/\n"
         "#ifndef " +
         guard + "\n#define " + guard + "\n\n#include <stdint.h>\n\n" + "#define " + upper +
         (is_pack ? "_MOST_VERTICES " : "_VERTICES ") + std::to_string(vertices) + "\n\n" +
         "static const uint8_t " + lower + (is_pack ? "_pack[" : "_stream[") +
         std::to_string(bytes.size()) + "] = {" + array_of(bytes) + "};\n\n#endif\n";
}

}  // namespace microtin::stream
