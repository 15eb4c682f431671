// SPDX-License-Identifier: MIT
// What the importers' targets share: any content ends in a terrain that can be worked with, or in
// an error of one line.
#ifndef MICROTIN_FUZZ_SUPPORT_IMPORT_TARGET_HPP
#define MICROTIN_FUZZ_SUPPORT_IMPORT_TARGET_HPP

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <optional>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/import/import.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/voids.hpp"
#include "encoder/verify/verify.hpp"
#include "fuzz/support/expect.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

inline void check_message(const Error& error) {
  const std::string text = error.what();
  EXPECT(!text.empty() && text.size() < 400);
  EXPECT(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

// A number from 0 on, as the command line takes it.
inline std::optional<Decimal> decimal_from(FuzzedDataProvider& given) {
  const uint8_t kind = given.ConsumeIntegral<uint8_t>();
  if (kind % 3 == 0) return std::nullopt;
  if (kind % 3 == 1) return Decimal{given.ConsumeIntegral<uint8_t>(), kind / 3 % 10};
  const int64_t most = 1000000000000000000;
  return make_decimal(given.ConsumeIntegralInRange<int64_t>(0, most), kind / 3 % 10);
}

struct Options {
  Options(const uint8_t* data, size_t size) {
    FuzzedDataProvider given(data, size);
    lattice.max_error = decimal_from(given);
    lattice.xy_step = decimal_from(given);
    lattice.z_step = decimal_from(given);
    fill_voids = given.ConsumeIntegralInRange<uint32_t>(0, 5);
    max_vertices = given.ConsumeBool() ? given.ConsumeIntegralInRange<uint32_t>(3, 50) : 0;
    effort.degree = given.ConsumeIntegralInRange<uint32_t>(kMinDegree, kMaxDegree);
    effort.coding = static_cast<Coding>(given.ConsumeIntegralInRange(1, 3));
    if (max_vertices != 0) lattice.max_error.reset();  // the command line allows only one
  }

  LatticeOptions lattice;
  uint32_t fill_voids;
  uint32_t max_vertices;
  Effort effort;
};

// Every height within the bound, every void kept: what the encoder does with any terrain.
inline void encode_bounded(const Source& source, const Options& options) {
  const Laid laid = lay_out(source, options.lattice);
  SimplifyOptions simplification;
  simplification.bounded = options.lattice.max_error.has_value();
  simplification.max_vertices = options.max_vertices;
  simplification.search = Search::kFast;
  simplification.effort = options.effort;
  const Tin tin = simplify(laid.survey, simplification);
  Metadata metadata;
  metadata.placement = laid.placement;
  const Encoding encoding = encode_and_decode(tin, metadata, options.effort);
  const Verification measured = verify(encoding.decoded.mesh(), source, options.lattice.max_error);
  EXPECT(measured.within_bound && measured.uncovered == 0 && measured.voids_answered == 0);
}

// Imports, then encodes if the terrain is small.
template <class Import>
int import_and_encode(const Import& import, const Options& options) {
  try {
    Source source = import();
    size_t posts = 0;
    for_each_post(source, [&posts](int64_t, int64_t, int64_t) { ++posts; });
    if (posts > 2000) return 0;
    if (auto* raster = std::get_if<Raster>(&source)) fill_voids(*raster, options.fill_voids);
    encode_bounded(source, options);
  } catch (const Error& error) {
    check_message(error);
  }
  return 0;
}

}  // namespace microtin::tests

#endif
