// SPDX-License-Identifier: MIT
// Text in pictures.
#ifndef MICROTIN_ENCODER_PICTURE_LETTERING_HPP
#define MICROTIN_ENCODER_PICTURE_LETTERING_HPP

#include <string_view>

#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

// Digits and capitals are 7 units high, letters reach 2 below the line.
constexpr double kCapHeight = 7;

// The first character that is not drawn; empty if all are. There are digits, Latin letters with
// Western accents (those up to U+00FF), blanks and . , : ; ! ? + - = / & _ ( ) ' " and the degree.
std::string_view missing_letter(std::string_view text);

// In units: without the room behind the last character.
double text_width(std::string_view text);

constexpr double kPen = 0.8;  // how wide strokes are, in units

// `start` is where the first character begins on the line, `unit` a number of pixels, `along` the
// direction in which text runs, of length 1. UTF-8; missing letters leave a blank.
void draw_text(Drawing& drawing, std::string_view text, Spot start, double unit, Colour colour,
               Spot along = {1, 0}, double pen = kPen);

}  // namespace microtin::picture

#endif
