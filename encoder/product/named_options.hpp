// SPDX-License-Identifier: MIT
// The table of an encoding's options: names and values, for every user of the library.
#ifndef MICROTIN_ENCODER_PRODUCT_NAMED_OPTIONS_HPP
#define MICROTIN_ENCODER_PRODUCT_NAMED_OPTIONS_HPP

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/layers.hpp"
#include "microtin/encoder.hpp"

namespace microtin::product {

// "quick, balanced or dense".
std::string alternatives(const std::vector<std::string>& names);

// A member of encoder::Options. Exactly one of `text`, `flag`, `number` and `choice` is not null.
struct NamedOption {
  // A choice, by the number of its enumerator.
  struct Choice {
    uint32_t (*get)(const encoder::Options& options);
    void (*set)(encoder::Options& options, uint32_t number);
  };

  const char* name;  // of the member: "max_error"
  std::string encoder::Options::*text = nullptr;
  bool encoder::Options::*flag = nullptr;
  uint32_t encoder::Options::*number = nullptr;
  const Choice* choice = nullptr;

  // Whether a text is allowed, if it is not empty; null: every text is.
  bool (*is_allowed)(const std::string& value) = nullptr;
  const char* wanted = nullptr;      // what is allowed
  uint32_t least = 0, most = 0;      // of a number that is not 0, which selects the default
  std::vector<std::string> words{};  // of a choice, in the order of its enumerators
};

// Throws Error if there is no such option.
const NamedOption& named_option(std::string_view name);

// What texts an option takes: "quick, balanced or dense".
std::string wanted_by(const NamedOption& option);

// Returns whether the option takes the text. An empty text is the default of a text.
bool set(const NamedOption& option, encoder::Options& options, const std::string& value);

// Throws Error naming the first option that does not take its value.
void check_options(const encoder::Options& options);

}  // namespace microtin::product

#endif
