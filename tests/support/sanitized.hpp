// SPDX-License-Identifier: MIT
// Whether tests run under AddressSanitizer: then long ones try a part of their cases.
#ifndef MICROTIN_TESTS_SUPPORT_SANITIZED_HPP
#define MICROTIN_TESTS_SUPPORT_SANITIZED_HPP

namespace microtin::tests {

#if defined(__SANITIZE_ADDRESS__)  // gcc
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer);  // clang
#else
constexpr bool kIsSanitized = false;
#endif

// How many of `cases` are tried: an eighth under AddressSanitizer, where each takes some ten times
// as long.
constexpr int tried(int cases) {
  return kIsSanitized ? (cases + 7) / 8 : cases;
}

}  // namespace microtin::tests

#endif
