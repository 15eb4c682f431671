// SPDX-License-Identifier: MIT
// Images as PNG files.
#ifndef MICROTIN_ENCODER_PICTURE_PNG_HPP
#define MICROTIN_ENCODER_PICTURE_PNG_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::picture {

// `rgb` holds width * height pixels of three bytes, top row first.
std::vector<uint8_t> png(const std::vector<uint8_t>& rgb, uint32_t width, uint32_t height);

}  // namespace microtin::picture

#endif
