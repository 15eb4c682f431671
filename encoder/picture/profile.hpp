// SPDX-License-Identifier: MIT
// Pictures of profiles: the terrain on the curved Earth, the ray above it, and its Fresnel zone.
#ifndef MICROTIN_ENCODER_PICTURE_PROFILE_HPP
#define MICROTIN_ENCODER_PICTURE_PROFILE_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/units.hpp"
#include "encoder/layers.hpp"
#include "microtin/profile.hpp"

namespace microtin::picture {

struct ProfilePicture {
  const encoder::Profile& profile;
  encoder::SightOptions options;
  std::optional<encoder::LineOfSight> sight;
  Unit vertical;
};

// The Earth's bulge is added to the terrain, so that the ray is straight. Parts without heights are
// grey. `width` is a number of pixels, kNarrowest to kWidest.
std::vector<uint8_t> profile_png(const ProfilePicture& picture, uint32_t width);
std::string profile_svg(const ProfilePicture& picture, uint32_t width);

}  // namespace microtin::picture

#endif
