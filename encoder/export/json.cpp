// Writes numbers, texts and objects as JSON.
#include "encoder/export/json.hpp"

#include <charconv>
#include <cstdint>

namespace microtin::exporting {
namespace {

// The bytes of the character that the text begins with; 0 if that is none of UTF-8.
size_t character_bytes(std::string_view text) {
  const auto byte = [text](size_t i) -> uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const uint32_t first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC0 || first >= 0xF8) return 0;
  const size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  uint32_t code = first & (0x7Fu >> size);
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0u) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  const uint32_t least = size == 2 ? 0x80 : size == 3 ? 0x800 : 0x10000;
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code >= least && code <= 0x10FFFF && !surrogate ? size : 0;
}

std::string escaped(char c) {
  constexpr char kDigits[] = "0123456789abcdef";
  if (c == '"' || c == '\\') return {'\\', c};
  if (c >= 0 && c < ' ') return {'\\', 'u', '0', '0', kDigits[c >> 4], kDigits[c & 15]};
  return {c};
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
    if (size == 0) {
      quoted += "\xEF\xBF\xBD";
    } else if (size == 1) {
      quoted += escaped(text.front());
    } else {
      quoted += text.substr(0, size);
    }
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
