// SPDX-License-Identifier: MIT
// A hint to the memory, where the compiler offers one.
#ifndef MICROTIN_ENCODER_BASE_PREFETCH_HPP
#define MICROTIN_ENCODER_BASE_PREFETCH_HPP

#include "encoder/layers.hpp"

namespace microtin::base {

// What `address` points to will be used soon. Changes nothing but the time.
inline void prefetch(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  static_cast<void>(address);
#endif
}

}  // namespace microtin::base

#endif
