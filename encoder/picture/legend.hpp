// SPDX-License-Identifier: MIT
// What tells how to read a map.
#ifndef MICROTIN_ENCODER_PICTURE_LEGEND_HPP
#define MICROTIN_ENCODER_PICTURE_LEGEND_HPP

#include <functional>
#include <string>

#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

constexpr Colour kInk{0.16, 0.18, 0.22};
constexpr Colour kHalo{0.98, 0.97, 0.94};  // around what stands on a map

// Sizes of legends are in units of so many pixels, as those of text.

// "1,234.5": with commas between thousands and so many decimals.
std::string grouped(double value, int decimals);

// Decimals that multiples of a round step need.
int decimals_for(double step);

// With four digits that matter, at most.
std::string rounded_text(double value);

// The largest 1, 2 or 5 times a power of ten up to a number above 0.
double round_length(double most);

// Colours from a lowest to a highest number, and round numbers below them; 18 units high.
void draw_ramp(Drawing& drawing, Spot corner, double width, double unit, double low, double high,
               const std::function<Colour(double)>& colour);

// A bar of a round length, at most so many pixels, its ends labelled below; 18 units high. A pixel
// is `ground` units on the ground; a thousand of "m" are told as "km".
void draw_scale_bar(Drawing& drawing, Spot corner, double most, double unit, double ground,
                    const std::string& ground_unit);

// A small box and what it means, 7 units high; the corner is the upper left one.
void draw_swatch(Drawing& drawing, Spot corner, double unit, Colour colour,
                 const std::string& text);

}  // namespace microtin::picture

#endif
