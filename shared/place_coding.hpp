// SPDX-License-Identifier: MIT
// Coding of the next point's place. In the free region of the triangle that it conflicts with:
// first its column, among those that hold legal places, then its row, in the column's legal part:
// of both first whether they are even, then by halves, and what remains is uniform. An escape
// serves every place that the estimates have missed. Outside the hull: along its edge, or anywhere.
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"
#include "shared/parity_coding.hpp"
#include "shared/place_odds.hpp"
#include "shared/probability.hpp"

namespace microtin {

// --- Places in the free region ---

constexpr uint32_t kLevels = 4;  // most halvings
constexpr uint32_t kColumnContexts = 16, kRowContexts = 12;
constexpr uint32_t kQuickContexts = kColumnContexts + kRowContexts;

// The two halvings of quick decoding: the first, the second in the lower and in the upper half.
struct Quarters {
  AdaptiveBit bit[3];
};

// Columns come before rows. What this build leaves out has one entry, which is not used.
struct PlaceModel {
  Calibration calibration[kBuiltWeighed ? 2 : 1][kBuiltWeighed ? kLevels : 1];  // of odds
  Quarters quick[kBuiltQuick ? kQuickContexts : 1];
};

// Keeps the upper or the lower half.
inline void halve(Numbers& numbers, bool upper) {
  const FastInt half = numbers.count >> 1;
  if (upper) {
    numbers.first += half;
    numbers.count -= half;
  } else {
    numbers.count = half;
  }
}

inline bool is_in_upper_half(const Numbers& numbers, FastInt number) {
  return number - numbers.first >= numbers.count >> 1;
}

// Codes a number in one of four quarters, if there are as many numbers; keeps the quarter.
template <class Coder>
MICROTIN_ROOMY_IN_PLACE void code_quarter(Coder& coder, Quarters& quarters, Numbers& numbers,
                                          FastInt number) {
  if (numbers.count < 4) return;
  const bool upper = code_bit(coder, quarters.bit[0], is_in_upper_half(numbers, number));
  halve(numbers, upper);
  halve(numbers, code_bit(coder, quarters.bit[upper ? 2 : 1], is_in_upper_half(numbers, number)));
}

template <class Coder>
MICROTIN_IN_PLACE inline bool code_half(Coder& coder, Calibration& calibration, Numbers& numbers,
                                        Halves weight, FastInt number) {
  const FastInt count = numbers.count, half = count >> 1;
  if (count < kFewLines) {
    weight.low *= static_cast<uint32_t>(half);
    weight.high *= static_cast<uint32_t>(count - half);
  }
  const uint32_t share = (weight.high << 11) / (weight.low + weight.high + 1);  // < 2^31
  const bool upper = code_calibrated(coder, calibration, share, is_in_upper_half(numbers, number));
  halve(numbers, upper);
  return upper;
}

// Codes one of `numbers`, all equally likely, or that it is none of them: then false.
template <class Coder>
MICROTIN_IN_PLACE inline bool code_any_or_none(Coder& coder, const Numbers& numbers,
                                               FastInt& number) {
  const uint32_t count = static_cast<uint32_t>(numbers.count);
  const uint32_t which =
      coder.uniform_or_escape(count, static_cast<uint32_t>(number - numbers.first));
  number = numbers.first + static_cast<FastInt>(which);
  return which < count;
}

// Codes one of `lines`, all equally likely.
template <class Coder>
FastInt code_any(Coder& coder, const Lines& lines, FastInt line) {
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

// How often columns are halved by weights found anew, rows once less; after that those that are
// known tell what is left. Quick decoding has none.
constexpr uint32_t kWeighedInQuick = 0, kWeighedInBalanced = 3, kWeighedInDense = 5;

inline uint32_t weighed_in(Coding coding) {
  return coding == Coding::kQuick   ? kWeighedInQuick
         : coding == Coding::kDense ? kWeighedInDense
                                    : kWeighedInBalanced;
}

// The number itself; where this build has one coding, the constant that the number must be.
MICROTIN_IN_PLACE inline uint32_t as_built(uint32_t weighed) {
  if (!kBuiltWeighed) return kWeighedInQuick;
  return kBuiltQuick || kBuiltDense ? weighed : kWeighedInBalanced;
}

// What is learned of places in addition to adaptive bits.
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

// The weights of two columns or, in one, of two rows.
inline Halves weights_of(const Place& place, const Column* column, int32_t low, int32_t high) {
  if (column != nullptr) return weights_at(place.odds, place.legal, *column, low, high);
  return Halves{column_weight(place.odds, place.legal, low),
                column_weight(place.odds, place.legal, high)};
}

inline uint32_t weight_of(const Place& place, const Column* column, int32_t at) {
  if (column != nullptr) return weight_at(place.odds, place.legal, *column, at);
  return column_weight(place.odds, place.legal, at);
}

// The weight of the half of a half away from the other half: `towards` is that of the half towards
// it, `mean` of both.
inline uint32_t outer_weight(uint32_t mean, uint32_t towards) {
  const uint32_t least = (mean >> 2) + 1;
  return 2 * mean > towards + least ? 2 * mean - towards : least;
}

// Keeps a part of the numbers that holds `number`. The first two times lines are halved both halves
// are weighed at their middles, then that away from what was left out: the other's middle is
// between those of the two halves that were kept last.
template <class Coder>
MICROTIN_IN_PLACE inline void code_halves(Coder& coder, Calibration* level, Ruling& ruling,
                                          FastInt number, const Place& place, const Column* column,
                                          uint32_t weighed) {
  Numbers& numbers = ruling.numbers;
  const FastInt base = ruling.base;
  const int32_t shift = twice_shift(ruling, place.legal.shift);
  const uint32_t kind = column != nullptr ? 1 : 0;
  uint32_t before = 0, kept = 0;
  bool upper = false;
  for (uint32_t i = 0; i < kLevels && numbers.count > 1; ++i) {
    const FastInt count = numbers.count, middle = 2 * numbers.first + (count >> 1) - 1 + base;
    Halves weight;
    if (i < 2) {
      weight = weights_of(place, column, shifted(middle, shift), shifted(middle + count, shift));
    } else {
      const uint32_t towards = (kept + before) >> 1;
      const uint32_t outer =
          i + kind < weighed
              ? weight_of(place, column, shifted(upper ? middle + count : middle, shift))
              : outer_weight(kept, towards);
      weight = upper ? Halves{towards, outer} : Halves{outer, towards};
    }
    upper = code_half(coder, level[i], numbers, weight, number);
    before = kept;
    kept = upper ? weight.high : weight.low;
  }
}

// Codes one of several columns or, in a column, of several rows. Quick decoding has the context.
template <class Coder>
MICROTIN_FOLDED bool code_line(Coder& coder, PlaceModel& model, const Tally& tally,
                               const Place& place, const Lines& lines, uint32_t context,
                               const Column* column, FastInt& line, uint32_t weighed) {
  const uint32_t kind = column != nullptr ? 1 : 0;
  Ruling ruling = rule(coder, tally, lines, place.legal.odd[kind], line);
  const FastInt number = number_of(ruling, line);
  weighed = as_built(weighed);
  if (weighed == 0) {
    code_quarter(coder, model.quick[context], ruling.numbers, number);
  } else {
    code_halves(coder, model.calibration[kind], ruling, number, place, column, weighed);
  }
  FastInt found = number;
  const bool is_there = code_any_or_none(coder, ruling.numbers, found);
  line = line_at(ruling, found);
  return is_there;
}

// Codes x. False if that is none of the columns with legal places.
template <class Coder>
MICROTIN_IN_PLACE inline bool code_column(Coder& coder, PlaceModel& model, const Tally& tally,
                                          const FreeRegion& region, const Place& place, FastInt& x,
                                          uint32_t weighed) {
  const Columns columns = legal_columns(place.legal, region);
  const uint32_t context = (columns.open_east ? 0u : 1u) + (columns.open_west ? 0u : 2u) +
                           (region.next.certified ? 4u : 0u) +
                           (expected_points(region) > 1 ? 8u : 0u);
  return code_line(coder, model, tally, place, columns.lines, context, nullptr, x, weighed);
}

template <class Coder>
MICROTIN_IN_PLACE inline bool code_row(Coder& coder, PlaceModel& model, const Tally& tally,
                                       const FreeRegion& region, const Place& place,
                                       const Column& column, const Lines& rows, FastInt& y,
                                       uint32_t weighed) {
  const uint32_t zone = column.x < place.legal.corner[1].x ? 4u : column.x > 0 ? 8u : 0u;
  const uint32_t context = kColumnContexts + zone + expected_points(region);
  return code_line(coder, model, tally, place, rows, context, &column, y, weighed);
}

// Codes `at`, as seen from v and turned.
template <class Coder>
MICROTIN_IN_PLACE inline Offset code_turned_place(Coder& coder, PlaceModel& model,
                                                  const FreeRegion& region, const Place& place,
                                                  Offset at, PlaceHabits& habits,
                                                  uint32_t weighed) {
  const LegalPlaces& legal = place.legal;
#if defined(__clang_analyzer__)
  if (legal.shift < -10 || legal.shift > 10) return at;  // never: it does not follow so far
#endif
  Tally& first = habits.parities.first[legal.turns & 1];
  const Offset known = at;
  Column column;
  bool is_there = code_column(coder, model, first, region, place, at.x, weighed);
  Tally& second = habits.parities.second[legal.turns & 1][is_odd(at.x, legal.odd[0]) ? 1 : 0];
  if (is_there) {
    column.x = grains(2 * at.x, legal.shift);
    const Lines rows = legal_rows(legal, legal_span(legal, column.x, true, column.own));
    is_there = code_row(coder, model, second, region, place, column, rows, at.y, weighed);
  }
  if (!is_there) {
    at.x = code_any(coder, legal.columns, known.x);
    at.y = code_any(coder, legal.rows, known.y);
    return at;
  }
  learn(first, is_odd(at.x, legal.odd[0]));
  learn(second, is_odd(at.y, legal.odd[1]));
  if (kBuiltWeighed && place.odds.repels) {
    learn(habits.crowding, place.odds, legal, Spot{column.x, grains(2 * at.y, legal.shift)});
  }
  return at;
}

// Finds legal places and, unless decoding is quick, their odds.
MICROTIN_FOLDED void estimate_place(Place& place, const FreeRegion& region,
                                    const Contract& contract, Log2 density, Crowding crowding) {
  const Cotangent own = cotangent(region.cc - region.ca, region.by_twice, kOwnCap);
  const Side& chord = region.chord;
  Cotangent behind = chord.ghost ? -4 * (1 << kCotangentBits) : chord.behind;
  if (behind > own) behind = own;
  const Spot a = find_places(place.legal, region, contract, own, behind);
  const bool is_weighed = as_built(weighed_in(contract.coding)) != 0;
  place.odds.repels = contract.has_heights && is_weighed;
  if (!is_weighed) return;
  estimate_sweep(place.odds, place.legal, region, a, density, own, behind);
  if (place.odds.repels) estimate_repulsion(place.odds, place.legal, density, crowding);
}

// Codes the next vertex's place, as seen from v. `density` is the logarithm of points per unit
// area.
template <class Coder>
MICROTIN_IN_PLACE inline Offset code_place(Coder& coder, PlaceModel& model,
                                           const FreeRegion& region, const Contract& contract,
                                           Log2 density, Place& place, PlaceHabits& habits) {
  estimate_place(place, region, contract, density, habits.crowding);
  const uint32_t weighed = as_built(weighed_in(contract.coding));
  const Vertex next = coder.next();
  const Offset known = turned(Point{next.x, next.y} - region.origin, place.legal.turns);
#if defined(MICROTIN_LARGE_TABLES)
  // Quick decoding has a copy without weights.
  const Offset at = weighed == 0
                        ? code_turned_place(coder, model, region, place, known, habits, 0)
                        : code_turned_place(coder, model, region, place, known, habits, weighed);
#else
  const Offset at = code_turned_place(coder, model, region, place, known, habits, weighed);
#endif
  return turned(at, -place.legal.turns & 3);
}

// --- Places outside the hull, or on its boundary ---

// The hull edge from a to c; the outside is to its right.
struct HullEdge {
  Point a;
  Offset along;    // from a to c
  int32_t length;  // in lattice steps if the edge is part of the lattice's border, else 0
};

inline bool at_border(uint16_t a, uint16_t c, uint16_t most) {
  return a == c && (a == 0 || a == most);
}

inline HullEdge hull_edge(const Contract& contract, Point a, Point c) {
  HullEdge edge = {a, c - a, 0};
  if (at_border(a.x, c.x, contract.x_max) || at_border(a.y, c.y, contract.y_max)) {
    edge.length = static_cast<int32_t>(absolute(edge.along.x + edge.along.y));
  }
  return edge;
}

// A coordinate that is likely to be the smallest or the largest.
template <class Coder>
uint16_t code_outer_coordinate(Coder& coder, uint32_t largest, uint32_t value) {
  if (coder.bit(kProbabilityOne / 4 * 3, value == 0 || value == largest)) {
    const bool high = coder.bit(kProbabilityOne / 2, value == largest);
    return static_cast<uint16_t>(high ? largest : 0);
  }
  return static_cast<uint16_t>(coder.uniform(largest + 1u, value));
}

// How many steps beyond a the next point on an edge at the border is. Such that lead too far give
// 0. `density` is the logarithm of vertices per unit area.
template <class Coder>
int32_t code_gap(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                 const Contract& contract, const HullEdge& edge, Log2 density, FastInt known) {
  const bool along_x = edge.along.y == 0;
  const bool odd =
      along_x ? is_odd(edge.a.x, contract.odd_origin_x) : is_odd(edge.a.y, contract.odd_origin_y);
  Tally& tally = parities.first[along_x ? 0 : 1];
  const Ruling steps = rule(coder, tally, Lines{1, edge.length - 1}, odd, known);
  uint32_t bits = density < 0 ? static_cast<uint32_t>(-density) / (2 * kLog2One) : 0;  // at most 16
  if (steps.step == 2 && bits != 0) --bits;
  const FastInt first = steps.numbers.first;
  const FastInt number = first + static_cast<FastInt>(code_magnitude(
                                     coder, gap, mantissa, bits,
                                     static_cast<uint32_t>(number_of(steps, known) - first)));
  if (number - first >= steps.numbers.count) return 0;
  const FastInt gone = line_at(steps, number);
  learn(tally, is_odd(gone, odd));
  return static_cast<int32_t>(gone);
}

// A point on the edge, if that is at the border, or anywhere. Gaps that lead too far give a, which
// is not beyond the edge.
template <class Coder>
Point code_hull_place(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                      const Contract& contract, const HullEdge& edge, Log2 density) {
  const Vertex next = coder.next();
  Point place = {next.x, next.y};
  if (edge.length == 0) {
    place.x = code_outer_coordinate(coder, contract.x_max, place.x);
    place.y = code_outer_coordinate(coder, contract.y_max, place.y);
    return place;
  }
  const Offset past = place - edge.a;
  const int32_t length = edge.length;
  const int32_t steps =
      code_gap(coder, gap, mantissa, parities, contract, edge, density, absolute(past.x + past.y));
  return Point{static_cast<uint16_t>(edge.a.x + edge.along.x / length * steps),
               static_cast<uint16_t>(edge.a.y + edge.along.y / length * steps)};
}

}  // namespace microtin

#endif
