// The one exception of the host tools: a sentence for the user.
#ifndef MICROTIN_ENCODER_BASE_ERROR_HPP
#define MICROTIN_ENCODER_BASE_ERROR_HPP

#include <stdexcept>

#include "encoder/layers.hpp"

namespace microtin::base {

// What went wrong, where (file, and line of the input if there is one): printed as it is, on one
// line.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace microtin::base

#endif
