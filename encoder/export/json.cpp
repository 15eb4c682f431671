// SPDX-License-Identifier: MIT
// Writes numbers, texts and objects as JSON.
#include "encoder/export/json.hpp"

#include <charconv>

#include "encoder/base/text.hpp"

namespace microtin::exporting {
namespace {

std::string escaped(std::string_view character) {
  constexpr char kDigits[] = "0123456789abcdef";
  const auto last = static_cast<unsigned char>(character.back());  // the code of those in question
  if (is_control(character)) return {'\\', 'u', '0', '0', kDigits[last >> 4], kDigits[last & 15]};
  if (last == '"' || last == '\\') return {'\\', character.back()};
  return std::string(character);
}

}  // namespace

std::string json(double value) {
  char buffer[32];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  if (text.find_first_of(".e") == text.npos) text += ".0";
  return text;
}

std::string json(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const size_t size = character_bytes(text);
    quoted += size == 0 ? "\xEF\xBF\xBD" : escaped(text.substr(0, size));
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return quoted + '"';
}

std::string json(const JsonObject& object) {
  std::string text;
  for (const auto& [name, value] : object) {
    text += (text.empty() ? "{" : ", ") + json(name) + ": " + value;
  }
  return text + '}';
}

}  // namespace microtin::exporting
