// SPDX-License-Identifier: MIT
// What this build decodes: the switches of config.h as constants. Code tests them with `if`.
#ifndef MICROTIN_SHARED_BUILD_OPTIONS_HPP
#define MICROTIN_SHARED_BUILD_OPTIONS_HPP

#include "microtin/config.h"

namespace microtin {

#if defined(MICROTIN_NO_VOIDS)
constexpr bool kBuiltVoids = false;
#else
constexpr bool kBuiltVoids = true;
#endif

#if defined(MICROTIN_ONLY_QUICK)
constexpr bool kBuiltQuick = true, kBuiltBalanced = false, kBuiltDense = false;
#elif defined(MICROTIN_ONLY_BALANCED)
constexpr bool kBuiltQuick = false, kBuiltBalanced = true, kBuiltDense = false;
#else
constexpr bool kBuiltQuick = true, kBuiltBalanced = true, kBuiltDense = true;
#endif

constexpr bool kBuiltWeighed = kBuiltBalanced || kBuiltDense;  // codings that weigh places

}  // namespace microtin

#endif
