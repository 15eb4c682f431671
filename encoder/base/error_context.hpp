// SPDX-License-Identifier: MIT
// Errors that learn on their way which file they are about.
#ifndef MICROTIN_ENCODER_BASE_ERROR_CONTEXT_HPP
#define MICROTIN_ENCODER_BASE_ERROR_CONTEXT_HPP

#include <string>

#include "encoder/base/error.hpp"
#include "encoder/layers.hpp"

namespace microtin::base {

// Runs `work`; its errors are about the file `path`, which they do not name themselves.
template <class Work>
auto with_file_context(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

// Runs `work` on what this program made itself: whatever is wrong with that is a fault of ours.
template <class Work>
auto on_our_own(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw InternalFault(error.what());
  }
}

}  // namespace microtin::base

#endif
