// SPDX-License-Identifier: MIT
// Coding of the next point's place in the free region of the triangle it conflicts with: first its
// column, among those that hold legal places, then its row, in the column's legal part: of both
// first whether they are even, then by halves, and what remains is uniform. An escape serves every
// place that the estimates have missed.
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/place_odds.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr uint32_t kLevels = 4;  // most halvings
constexpr uint32_t kColumnContexts = 16, kRowContexts = 12;

// The two halvings of quick decoding: the first, the second in the lower and in the upper half.
struct Quarters {
  AdaptiveBit bit[3];
};

struct PlaceModel {
  Calibration column[kLevels], row[kLevels];  // odds learned for the estimated ones
  Quarters quick_column[kColumnContexts], quick_row[kRowContexts];
  AdaptiveBit escape;
};

// How often lines are halved, and how often by weights taken at the middles of both halves; after
// that the last two tell what is left.
struct Depth {
  uint32_t weighed, halvings;
};

inline Depth depth_of(Decoding decoding) {
  if (decoding == Decoding::kQuick) return Depth{0, 0};
  return Depth{decoding == Decoding::kDense ? 4u : 3u, kLevels};
}

// Keeps the upper or the lower half.
inline void halve(Lines& lines, bool upper) {
  const FastInt half = count_of(lines) >> 1;
  if (upper) {
    lines.first += half;
  } else {
    lines.last = lines.first + half - 1;
  }
}

inline bool is_in_upper_half(const Lines& lines, FastInt line) {
  return line - lines.first >= count_of(lines) >> 1;
}

// Codes a line in one of four quarters, if there are so many lines; keeps the quarter.
template <class Coder>
void code_quarter(Coder& coder, Quarters& quarters, Lines& lines, FastInt line) {
  if (count_of(lines) < 4) return;
  const bool upper = code_bit(coder, quarters.bit[0], is_in_upper_half(lines, line));
  halve(lines, upper);
  halve(lines, code_bit(coder, quarters.bit[upper ? 2 : 1], is_in_upper_half(lines, line)));
}

template <class Coder>
bool code_half(Coder& coder, Calibration& calibration, Lines& lines, Halves weight, FastInt line) {
  const FastInt count = count_of(lines), half = count >> 1;
  if (count < kFewLines) {
    weight.low *= static_cast<uint32_t>(half);
    weight.high *= static_cast<uint32_t>(count - half);
  }
  const uint32_t share = (weight.high << 11) / (weight.low + weight.high + 1) << 4;  // < 2^31
  const bool upper = code_calibrated(coder, calibration, share, is_in_upper_half(lines, line));
  halve(lines, upper);
  return upper;
}

// The halves of a half, on the line through the weights of both, but at least a quarter of its own.
inline Halves halves_of(Halves weight, bool upper) {
  const int32_t low = static_cast<int32_t>(weight.low), high = static_cast<int32_t>(weight.high);
  const int32_t tilt = (high - low) >> 2, mean = upper ? high : low, least = (mean >> 2) + 1;
  const int32_t first = mean - tilt, second = mean + tilt;
  return Halves{static_cast<uint32_t>(first > least ? first : least),
                static_cast<uint32_t>(second > least ? second : least)};
}

// Keeps of `lines` a part that holds `line`. `weigh` is asked at twice two numbers.
template <class Coder, class Weigh>
void code_halves(Coder& coder, Calibration* level, Lines& lines, FastInt line, Depth depth,
                 const Weigh& weigh) {
  Halves weight;  // number by number: on AVR a constant to copy from would be in RAM
  weight.low = 1;
  weight.high = 1;
  bool upper = false;
  for (uint32_t i = 0; i < depth.halvings && lines.first < lines.last; ++i) {
    if (i < depth.weighed) {
      const FastInt count = count_of(lines), middle = 2 * lines.first + (count >> 1) - 1;
      weight = weigh(middle, middle + count);
    } else {
      weight = halves_of(weight, upper);
    }
    upper = code_half(coder, level[i], lines, weight, line);
  }
}

// Codes one of `lines`, all equally likely.
template <class Coder>
FastInt code_line(Coder& coder, const Lines& lines, FastInt line) {
  return lines.first +
         static_cast<FastInt>(coder.uniform(static_cast<uint32_t>(count_of(lines)),
                                            static_cast<uint32_t>(line - lines.first)));
}

// The chance of a hit here, roughly: the logarithm of the points that the free region should hold.
inline uint32_t expected_points(const FreeRegion& region) {
  return static_cast<uint32_t>(kept_within((region.expected + kLog2One) >> 8, 0, 3));
}

struct Place {
  LegalPlaces legal;
  PlaceOdds odds;
};

// What is learned of places beside adaptive bits.
struct PlaceHabits {
  Crowding crowding;
  Parities parities;
};

inline void reset(PlaceHabits& habits) {
  habits.crowding = kCrowdingStart;
  reset(habits.parities);
}

// Twice a number, plus the base, counts grains times 2^-this.
inline int32_t twice_shift(const Ruling& ruling, int32_t shift) {
  return shift - (ruling.step == 1 ? 1 : 0);
}

// Codes x, or the nearest column with legal places.
template <class Coder>
MICROTIN_IN_PLACE inline FastInt code_column(Coder& coder, PlaceModel& model, const Tally& tally,
                                             const FreeRegion& region, const Place& place,
                                             Depth depth, FastInt x) {
  const LegalPlaces& legal = place.legal;
  const Columns columns = legal_columns(legal, region);
  if (x < columns.lines.first) x = columns.lines.first;
  if (x > columns.lines.last) x = columns.lines.last;
  Ruling ruling = rule(coder, tally, columns.lines, legal.odd_column, x);
  const FastInt number = number_of(ruling, x);
  if (depth.weighed == 0) {
    const uint32_t context = (columns.open_east ? 0u : 1u) + (columns.open_west ? 0u : 2u) +
                             (region.next.certified ? 4u : 0u) +
                             (expected_points(region) > 1 ? 8u : 0u);
    code_quarter(coder, model.quick_column[context], ruling.numbers, number);
  } else {
    const FastInt base = ruling.base;
    const int32_t shift = twice_shift(ruling, legal.shift);
    code_halves(
        coder, model.column, ruling.numbers, number, depth, [=, &place](FastInt low, FastInt high) {
          return Halves{column_weight(place.odds, place.legal, shifted(low + base, shift)),
                        column_weight(place.odds, place.legal, shifted(high + base, shift))};
        });
  }
  return line_at(ruling, code_line(coder, ruling.numbers, number));
}

template <class Coder>
MICROTIN_IN_PLACE inline FastInt code_row(Coder& coder, PlaceModel& model, const Tally& tally,
                                          const FreeRegion& region, const Place& place, Depth depth,
                                          Offset at, Lines rows, Span own) {
  const LegalPlaces& legal = place.legal;
  const int32_t x = grains(2 * at.x, legal.shift);
  Ruling ruling = rule(coder, tally, rows, legal.odd_row, at.y);
  const FastInt number = number_of(ruling, at.y);
  if (depth.weighed == 0) {
    const uint32_t zone = x < legal.a.x ? 4u : x > 0 ? 8u : 0u;
    code_quarter(coder, model.quick_row[zone + expected_points(region)], ruling.numbers, number);
  } else {
    const FastInt base = ruling.base;
    const int32_t shift = twice_shift(ruling, legal.shift);
    code_halves(coder, model.row, ruling.numbers, number, depth,
                [=, &place](FastInt low, FastInt high) {
                  return weights_at(place.odds, place.legal, own, x, shifted(low + base, shift),
                                    shifted(high + base, shift));
                });
  }
  return line_at(ruling, code_line(coder, ruling.numbers, number));
}

// Codes `at`, as seen from v and turned.
template <class Coder>
MICROTIN_IN_PLACE inline Offset code_turned_place(Coder& coder, PlaceModel& model,
                                                  const FreeRegion& region, const Place& place,
                                                  Decoding decoding, Offset at,
                                                  PlaceHabits& habits) {
  const Depth depth = depth_of(decoding);
  const LegalPlaces& legal = place.legal;
#if defined(__clang_analyzer__)
  if (legal.shift < -10 || legal.shift > 10) return at;  // never: it does not follow so far
#endif
  Tally& first = habits.parities.first[legal.turns & 1];
  const FastInt x = code_column(coder, model, first, region, place, depth, at.x);
  const int32_t column = grains(2 * x, legal.shift);
  const Span own = own_span(legal.own, column, 1, FineRoot());
  const Lines rows = legal_rows(legal, legal_span(legal, column, own, 1, FineRoot()));
  Tally& second = habits.parities.second[legal.turns & 1][is_odd(x, legal.odd_column) ? 1 : 0];
  const bool missed = x != at.x || at.y < rows.first || at.y > rows.last;
  if (code_bit(coder, model.escape, missed)) {
    at.x = code_line(coder, legal.columns, at.x);
    at.y = code_line(coder, legal.rows, at.y);
    return at;
  }
  at = Offset{x, code_row(coder, model, second, region, place, depth, Offset{x, at.y}, rows, own)};
  learn(first, is_odd(at.x, legal.odd_column));
  learn(second, is_odd(at.y, legal.odd_row));
  if (place.odds.repels) {
    learn(habits.crowding, place.odds, legal, Spot{column, grains(2 * at.y, legal.shift)});
  }
  return at;
}

// Codes the next vertex's place, as seen from v. `density` is the logarithm of points per unit
// area.
template <class Coder>
Offset code_place(Coder& coder, PlaceModel& model, const FreeRegion& region,
                  const Contract& contract, Log2 density, Place& place, PlaceHabits& habits) {
  const Cotangent own = cotangent(region.cc - region.ca, region.by_twice, kOwnCap);
  const Side& chord = region.chord;
  Cotangent behind = chord.ghost ? -4 * (1 << kCotangentBits) : chord.behind;
  if (behind > own) behind = own;
  find_places(place.legal, region, contract, own, behind);
  place.odds.repels = contract.has_heights && contract.decoding != Decoding::kQuick;
  if (contract.decoding != Decoding::kQuick) {
    estimate_sweep(place.odds, place.legal, region, density, own, behind);
    if (place.odds.repels) estimate_repulsion(place.odds, place.legal, density, habits.crowding);
  }
  const Vertex next = coder.next();
  const Offset known = turned(Point{next.x, next.y} - region.origin, place.legal.turns);
  const Offset at =
      code_turned_place(coder, model, region, place, contract.decoding, known, habits);
  return turned(at, -place.legal.turns & 3);
}

}  // namespace microtin

#endif
