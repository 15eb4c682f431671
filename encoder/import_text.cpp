#include "encoder/import_text.hpp"

#include <algorithm>

#include "encoder/error.hpp"

namespace microtin {
namespace {

constexpr int64_t kLargest = 1000000000000000000;  // 10^18

}  // namespace

void fail_at(const std::string& name, size_t line, const std::string& what) {
  throw Error(name + ":" + std::to_string(line) + ": " + what);
}

std::string quoted(std::string_view piece) {
  constexpr size_t kMost = 24;
  std::string text(piece.substr(0, kMost));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return '"' + text + (piece.size() > kMost ? "...\"" : "\"");
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

bool DecimalColumn::add(Decimal value) {
  if (value.decimals > decimals_ && !refine(value.decimals)) return false;
  const Wide mantissa = mantissa_at(value, decimals_);
  largest_ = std::max(largest_, magnitude(mantissa));
  mantissas_.push_back(static_cast<int64_t>(mantissa));
  return largest_ <= kLargest;
}

bool DecimalColumn::refine(int decimals) {
  const int64_t factor = power_of_ten(decimals - decimals_);
  largest_ *= factor;
  if (largest_ > kLargest) return false;
  for (int64_t& mantissa : mantissas_) {
    if (mantissa != kVoidHeight) mantissa *= factor;
  }
  decimals_ = decimals;
  return true;
}

}  // namespace microtin
