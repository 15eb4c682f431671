// SPDX-License-Identifier: MIT
// Sources within a bound, all the way: simplified, encoded, decoded and measured.
#ifndef MICROTIN_TESTS_SUPPORT_APPROXIMATIONS_HPP
#define MICROTIN_TESTS_SUPPORT_APPROXIMATIONS_HPP

#include <utility>

#include "encoder/fit/simplify.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/verify/verify.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

struct Measured {
  Approximation found;
  Encoding encoding;
  Verification verified;
};

inline Measured approximated(const Source& source, const LatticeOptions& lattice, Search search) {
  SimplifyOptions options;
  options.bounded = true;
  options.search = search;
  Approximation found = approximate(source, lattice, options);
  Metadata metadata;
  metadata.placement = found.laid.placement;
  Encoding encoding = encode_and_decode(found.tin, metadata, options.effort);
  const Verification verified = verify(encoding.decoded.mesh(), source, lattice.max_error);
  return {std::move(found), std::move(encoding), verified};
}

}  // namespace microtin::tests

#endif
