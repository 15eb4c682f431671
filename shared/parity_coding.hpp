// SPDX-License-Identifier: MIT
// Coding of whether a lattice line is a multiple of two. Where the encoder prefers such lines, or
// the source has a coarser grid, most vertices lie on them: how many is counted. Lines count from
// the origin of the stream's pack, so that tiles agree on them.
#ifndef MICROTIN_SHARED_PARITY_CODING_HPP
#define MICROTIN_SHARED_PARITY_CODING_HPP

#include "shared/lattice.hpp"
#include "shared/probability.hpp"

namespace microtin {

// Lattice lines, both ends included.
struct Lines {
  FastInt first, last;
};

inline FastInt count_of(const Lines& lines) {
  return lines.last - lines.first + 1;
}

constexpr FastInt kFewLines = 32;  // of fewer the counts of two halves differ noticeably

// Whether a line of a stream is odd in the pack, where the stream's first one may be.
inline bool is_odd(FastInt line, bool odd_origin) {
  return ((line & 1) != 0) != odd_origin;
}

// How often lines of either parity were met: at least 1, together at most kTallyMost.
struct Tally {
  uint16_t met[2];  // even, odd
};

constexpr uint32_t kTallyMost = 512;

// The tallies of each axis, x or y: for the first line of a place to be known, and for the second,
// where the first is even and where it is odd.
struct Parities {
  Tally first[2], second[2][2];
};

inline void reset(Parities& parities) {
  uint16_t* met = parities.first[0].met;
  for (uint32_t i = 0; i < sizeof parities / sizeof *met; ++i) *met++ = 1;
}

inline bool prefers_one(const Tally& tally) {
  const uint32_t even = tally.met[0], odd = tally.met[1];
  return even > 2 * odd || odd > 2 * even;
}

// When the tally is full all is halved: what is long ago counts less.
inline void learn(Tally& tally, bool odd) {
  uint16_t* const met = tally.met;
  met[odd] = static_cast<uint16_t>(met[odd] + 1u);
  if (static_cast<uint32_t>(met[0]) + met[1] <= kTallyMost) return;
  met[0] = static_cast<uint16_t>((met[0] + 1u) >> 1);
  met[1] = static_cast<uint16_t>((met[1] + 1u) >> 1);
}

// The probability, with 15 bits, that one of several lines, of which any is as likely as the others
// of its parity, is odd.
inline uint32_t probability_of_odd(const Tally& tally, const Lines& lines) {
  uint32_t even = tally.met[0], odd = tally.met[1];
  const FastInt count = count_of(lines);
  if ((count & 1) != 0 && count < kFewLines) {
    const uint32_t half = static_cast<uint32_t>(count >> 1), first = lines.first & 1;
    even *= half + 1u - first;
    odd *= half + first;  // below 2^13
  }
  const int32_t probability = static_cast<int32_t>((odd << 15) / (even + odd));
  return static_cast<uint32_t>(kept_within(
      probability, kProbabilityMargin, static_cast<int32_t>(kProbabilityOne) - kProbabilityMargin));
}

// As many as `count`, from the first on: halves are found sooner than by both ends.
struct Numbers {
  FastInt first, count;
};

inline Numbers numbers_of(const Lines& lines) {
  return Numbers{lines.first, count_of(lines)};
}

// Lines that are left to choose from: all, or those of one parity. Number i is line step i + base.
struct Ruling {
  Numbers numbers;
  FastInt step, base;  // 1, 0 or 2, -1 .. 1
};

inline FastInt line_at(const Ruling& ruling, FastInt number) {
  return ruling.step * number + ruling.base;
}

// The number of a line that is one of them.
inline FastInt number_of(const Ruling& ruling, FastInt line) {
  return (line - ruling.base) >> (ruling.step - 1);
}

// Codes the parity of one of several lines, which count from one that may be odd itself. Returns
// those of this parity.
template <class Coder>
MICROTIN_OUT_OF_LINE Ruling code_parity(Coder& coder, const Tally& tally, const Lines& all,
                                        bool odd_origin, FastInt line) {
  const FastInt origin = odd_origin ? 1 : 0;
  const Lines lines = {all.first + origin, all.last + origin};
  const FastInt odd =
      coder.bit(probability_of_odd(tally, lines), ((line + origin) & 1) != 0) ? 1 : 0;
  return Ruling{numbers_of(Lines{(lines.first + 1 - odd) >> 1, (lines.last - odd) >> 1}), 2,
                odd - origin};
}

// Where no parity is preferred none is coded: that would take longer, and save nothing.
template <class Coder>
Ruling rule(Coder& coder, const Tally& tally, const Lines& lines, bool odd_origin, FastInt line) {
  if (lines.first >= lines.last || !prefers_one(tally)) return Ruling{numbers_of(lines), 1, 0};
  return code_parity(coder, tally, lines, odd_origin, line);
}

}  // namespace microtin

#endif
