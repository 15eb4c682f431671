// Images as PNG files.
#ifndef MICROTIN_ENCODER_PNG_HPP
#define MICROTIN_ENCODER_PNG_HPP

#include <cstdint>
#include <vector>

namespace microtin {

// `rgba` holds width * height pixels of four bytes, top row first.
std::vector<uint8_t> png(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);

}  // namespace microtin

#endif
