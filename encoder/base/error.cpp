// SPDX-License-Identifier: MIT
// Texts of errors, and a sentence for each status.
#include "encoder/base/error.hpp"

#include <algorithm>

namespace microtin::base {
namespace {

// Marks both ends of a parameter's name: a control character, which other texts hardly contain.
constexpr char kMark = '\x1f';

// The name of the parameter that begins the text; empty if none does.
std::string_view parameter_at(std::string_view text) {
  if (text.empty() || text.front() != kMark) return {};
  const std::string_view rest = text.substr(1);
  const auto is_in_name = [](char c) { return c == '_' || (c >= 'a' && c <= 'z'); };
  const auto* const end = std::find_if_not(rest.begin(), rest.end(), is_in_name);
  if (end == rest.end() || *end != kMark) return {};
  return rest.substr(0, static_cast<size_t>(end - rest.begin()));
}

}  // namespace

std::string parameter(std::string_view name) {
  return kMark + std::string(name) + kMark;
}

std::string spelled(std::string_view text, const Spelling& spelling) {
  std::string result;
  while (!text.empty()) {
    const std::string_view name = parameter_at(text);
    result += name.empty() ? std::string(1, text.front()) : spelling(std::string(name));
    text.remove_prefix(name.empty() ? 1 : name.size() + 2);
  }
  return result;
}

Error::Error(const std::string& text)
    : std::runtime_error(spelled(text, [](const std::string& name) { return name; })),
      text_(text) {}

const char* describe(microtin_status status) {
  switch (status) {
    case MICROTIN_STATUS_OK:
      return "complete";
    case MICROTIN_STATUS_NEED_INPUT:
      return "more bytes are needed";
    case MICROTIN_STATUS_STEP_LIMIT:
      return "the step limit was reached";
    case MICROTIN_STATUS_STOPPED:
      return "stopped after the requested phase";
    case MICROTIN_STATUS_BAD_MAGIC:
      return "not a microtin stream";
    case MICROTIN_STATUS_UNSUPPORTED_VERSION:
      return "a version of the format, or a part of it, that this program does not know";
    case MICROTIN_STATUS_TOO_BIG:
      return "more vertices than this build can hold";
    case MICROTIN_STATUS_CHECKSUM:
      return "damaged: a checksum does not match";
    case MICROTIN_STATUS_MALFORMED:
      return "malformed: a rule of the format is broken";
    case MICROTIN_STATUS_TRUNCATED:
      return "cut off: the stream ends too early";
    case MICROTIN_STATUS_MISALIGNED:
      return "misaligned workspace";
    case MICROTIN_STATUS_WORKSPACE_TOO_SMALL:
      return "workspace too small";
    case MICROTIN_STATUS_ARGUMENT:
      return "wrong argument";
    case MICROTIN_STATUS_IO:
      return "reading failed";
    case MICROTIN_STATUS_BAD_TILES:
      return "bad tiles";
    case MICROTIN_STATUS_OUT_OF_RANGE:
      return "a number out of range";
    case MICROTIN_STATUS_NOT_FOUND:
      return "not found";
    case MICROTIN_STATUS_WRONG_PACK_KIND:
      return "a pack with slots of the other kind";
    case MICROTIN_STATUS_REJECTED:
      return "rejected";
    case MICROTIN_STATUS_NO_MEMORY:
      return "out of memory";
    case MICROTIN_STATUS_CANCELLED:
      return "cancelled";
    case MICROTIN_STATUS_INTERNAL:
      return "an internal fault of microtin";
  }
  return "unknown status";
}

}  // namespace microtin::base
