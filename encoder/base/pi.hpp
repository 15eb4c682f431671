// SPDX-License-Identifier: MIT
// The ratio of a circle's circumference to its diameter.
#ifndef MICROTIN_ENCODER_BASE_PI_HPP
#define MICROTIN_ENCODER_BASE_PI_HPP

#include "encoder/layers.hpp"

namespace microtin::base {

constexpr double kPi = 3.14159265358979323846;

}  // namespace microtin::base

#endif
