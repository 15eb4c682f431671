// What the importers' targets share: any content ends in a terrain that can be worked with, or in
// an error of one line.
#ifndef MICROTIN_FUZZ_IMPORT_FUZZ_HPP
#define MICROTIN_FUZZ_IMPORT_FUZZ_HPP

#include <algorithm>
#include <string>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"
#include "encoder/import.hpp"
#include "encoder/lay_out.hpp"
#include "encoder/simplify.hpp"
#include "encoder/verify.hpp"
#include "encoder/voids.hpp"
#include "fuzz/expect.hpp"

namespace microtin {

inline void check_message(const Error& error) {
  const std::string text = error.what();
  EXPECT(!text.empty() && text.size() < 400 && text.find("internal error") == text.npos);
  EXPECT(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

// Every height within the bound, every void kept: what the encoder does with any terrain.
inline void encode_bounded(const Source& source, const LatticeOptions& options) {
  const Laid laid = lay_out(source, options);
  const Tin tin = simplify(laid.survey, {options.max_error.has_value(), 0});
  Metadata metadata;
  metadata.placement = laid.placement;
  const Encoding encoding = encode_and_decode(tin, metadata, Effort());
  const Verification measured = verify(encoding.decoded.mesh(), source, options.max_error);
  EXPECT(measured.within_bound && measured.uncovered == 0 && measured.voids_answered == 0);
}

// Imports, then encodes if the terrain is small.
template <class Import>
int import_and_encode(const Import& import, const LatticeOptions& options) {
  try {
    Source source = import();
    size_t posts = 0;
    for_each_post(source, [&posts](int64_t, int64_t, int64_t) { ++posts; });
    if (posts > 2000) return 0;
    encode_bounded(source, options);
    fill_voids(source, 3);
    encode_bounded(source, {});
  } catch (const Error& error) {
    check_message(error);
  }
  return 0;
}

}  // namespace microtin

#endif
