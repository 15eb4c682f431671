// A picture of a decoded terrain.
#ifndef MICROTIN_ENCODER_RENDER_HPP
#define MICROTIN_ENCODER_RENDER_HPP

#include <cstdint>
#include <vector>

#include "microtin/microtin.h"

namespace microtin {

// A PNG file, `width` pixels wide: shaded relief coloured by height, with the triangles drawn on it
// from the middle to the right. Transparent where there is no terrain.
std::vector<uint8_t> render_png(const microtin_mesh* mesh, uint32_t width);

}  // namespace microtin

#endif
