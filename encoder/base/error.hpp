// SPDX-License-Identifier: MIT
// What went wrong: the exceptions of the host tools, the files that they are about, and sentences
// for statuses.
#ifndef MICROTIN_ENCODER_BASE_ERROR_HPP
#define MICROTIN_ENCODER_BASE_ERROR_HPP

#include <stdexcept>
#include <string>

#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::base {

// A sentence for the user: what went wrong, where (file, and line of the input if there is one).
// Printed as it is, on one line.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A guarantee of ours that does not hold, whatever the input: no Error, so that nothing takes it
// for one and goes on.
struct InternalFault : std::logic_error {
  using std::logic_error::logic_error;
};

// The work is done and its output, if there is one, whole, but the report did not reach anybody.
struct ReportLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

// A sentence for a status of the decoder.
const char* describe(microtin_status status);

}  // namespace microtin::base

#endif
