// SPDX-License-Identifier: MIT
// In which units and systems a terrain lies: what its file, codes and people say, made one.
#ifndef MICROTIN_ENCODER_PRODUCT_REFERENCE_HPP
#define MICROTIN_ENCODER_PRODUCT_REFERENCE_HPP

#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::product {

struct SettledReference {
  Reference reference;
  std::vector<std::string> remarks;  // sentences for people: what is guessed, or not known
};

// What is asked for, where it says something, comes before what the file says. Codes that are asked
// for bring their units. Heights of unknown unit have that of x and y if that is a length. Throws
// Error if what is asked for contradicts itself, and if x and y are degrees and nobody knows the
// unit of heights.
SettledReference settle(const Reference& file, const Reference& asked);

// "metre" or "degree:foot", horizontal before vertical; ":foot" is the vertical unit alone. False
// if it is none of these, or degrees are vertical.
bool read_units(const std::string& text, Reference& asked);

}  // namespace microtin::product

#endif
