// SPDX-License-Identifier: MIT
// The exceptions of the host tools.
#ifndef MICROTIN_ENCODER_BASE_ERROR_HPP
#define MICROTIN_ENCODER_BASE_ERROR_HPP

#include <stdexcept>

#include "encoder/layers.hpp"

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

}  // namespace microtin::base

#endif
