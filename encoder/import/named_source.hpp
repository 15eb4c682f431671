// SPDX-License-Identifier: MIT
// A file's terrain, and whether those of two files go together.
#ifndef MICROTIN_ENCODER_IMPORT_NAMED_SOURCE_HPP
#define MICROTIN_ENCODER_IMPORT_NAMED_SOURCE_HPP

#include <string>

#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

struct NamedSource {
  std::string path;
  OpenSource source;
};

// Throws Error naming a part, and what to do, if its units or system `b` are not those of the first
// one, `a`.
void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b);

}  // namespace microtin::importing

#endif
