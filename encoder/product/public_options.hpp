// SPDX-License-Identifier: MIT
// The public options: the table of their names and values, for every user of the library, and what
// they are in the terms of the parts that do the work.
#ifndef MICROTIN_ENCODER_PRODUCT_PUBLIC_OPTIONS_HPP
#define MICROTIN_ENCODER_PRODUCT_PUBLIC_OPTIONS_HPP

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
#include "encoder/product/options.hpp"
#include "microtin/encoder.hpp"

namespace microtin::product {

// The options of the encoding itself, without the lines of the file `breaklines` and without what
// `obstacles` imply. Throws Error naming an option that does not take its value.
EncodeOptions options_of(const encoder::Options& options);

// Reads the file of breaklines, if there is one. Throws Error naming the file.
void take_breaklines(const encoder::Options& options, const FeatureFiles& files,
                     EncodeOptions& all);

// The preparation of the terrain with the options that shape it, and with its units and systems.
// The values are those that options_of accepts. Throws Error if they contradict.
Preparation preparation_of(const encoder::Options& options, Preparation preparation = {});

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
  bool is_file = false;              // a text that names a file, which an empty one does not
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
