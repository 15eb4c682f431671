// SPDX-License-Identifier: MIT
// What a status of the decoder means to a reader.
#ifndef MICROTIN_ENCODER_BASE_STATUS_TEXT_HPP
#define MICROTIN_ENCODER_BASE_STATUS_TEXT_HPP

#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::base {

// A sentence for a status of the decoder.
const char* describe(microtin_status status);

}  // namespace microtin::base

#endif
