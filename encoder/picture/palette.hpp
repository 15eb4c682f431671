// SPDX-License-Identifier: MIT
// Colours of heights in pictures.
#ifndef MICROTIN_ENCODER_PICTURE_PALETTE_HPP
#define MICROTIN_ENCODER_PICTURE_PALETTE_HPP

#include <algorithm>

#include "encoder/export/scene.hpp"
#include "encoder/layers.hpp"

namespace microtin::picture {

// kLand: from the lowest height to the highest. kSea: the same from 0 on, and blue below: from 0,
// or from the highest height if all are below.
enum class PaletteKind { kLand, kSea };

class Palette {
 public:
  // Colours of heights from `low` to `high`.
  Palette(PaletteKind kind, double low, double high) : kind_(kind), low_(low), high_(high) {}

  // From the lowest, at 0, to the highest, at 1.
  Colour at(double relative) const {
    constexpr double kRounding = 1e-9;  // of what is at 0
    const double height = low_ + relative * (high_ - low_);
    if (kind_ == PaletteKind::kSea && height < -kRounding * (high_ - low_)) {
      const double top = std::min(high_, 0.0);
      return sea(top > low_ ? (top - height) / (top - low_) : 0);
    }
    const double ground = kind_ == PaletteKind::kSea ? std::max(low_, 0.0) : low_;
    return tint(high_ > ground ? (height - ground) / (high_ - ground) : 0);
  }

 private:
  // From the shore, at 0, to the deepest place, at 1.
  static Colour sea(double depth) {
    constexpr Colour kShore{0.75, 0.87, 0.93}, kShelf{0.42, 0.65, 0.82}, kDeep{0.10, 0.25, 0.47};
    const double at = 2 * std::clamp(depth, 0.0, 1.0);
    return at < 1 ? mix(kShore, kShelf, at) : mix(kShelf, kDeep, at - 1);
  }

  PaletteKind kind_;
  double low_, high_;
};

}  // namespace microtin::picture

#endif
