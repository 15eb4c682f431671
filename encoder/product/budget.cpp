// SPDX-License-Identifier: MIT
// Finds the smallest bound that keeps a limit of vertices or bytes, in a limited number of trials.
// A first trial inserts the worst samples until the limit is reached; its error suggests the bounds
// to try. A limit of bytes: bounds that need slightly more than the limit are tried, and the search
// goes on from each surface within wider bounds until the result fits. A limit of vertices: the
// search goes on from the last surface as long as time allows; the bound grows where the result
// needs too many vertices, and shrinks where it fits. Where the lattice moves points so far that
// errors at their own positions are much larger, more bounds are tried that hold there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/fit/bound_search.hpp"
#include "encoder/product/encode_stream.hpp"

namespace microtin::product {
namespace {

// More than fits, as searching on within a little wider bound then makes it fit for a part of the
// time that another trial takes; each trial comes nearer.
constexpr double kMore = 0.05, kNearer = 0.4;
constexpr double kWideAim = 0.997, kUsed = 0.994;  // of a wider bound; what is enough
constexpr double kNearlyUsed = 0.97;               // before a round bound is tried
constexpr double kLastAim = 0.99;                  // of the last wider bound, if less is used
constexpr double kLoose = 1.35;  // how much more than fits a wider bound may have to save
constexpr double kClose = 0.2;   // of the logarithm of a size: near enough for a rough trial
constexpr double kRound = 0.97;  // of a bound: round ones above that are tried
constexpr int kRoughTrials = 3, kWiderBounds = 7, kMoreTrials = 12;
constexpr uint32_t kPieces = 4;  // of the rounds of a search: what each wider bound takes

constexpr double kNear = 0.3;  // of the logarithm of a number of vertices: to search on from there

// Vertices fall with such a power of the bound where a search goes on: at first, and once one
// fitted, when small steps lose least of what was found. A step's largest ones, as parts of a
// bound.
constexpr double kFirstSlope = 2, kSlope = 4;
constexpr double kNarrowest = 0.95, kWidest = 1.2;
constexpr int kMisses = 2;  // after this many a search is not relied on to make vertices fit

// The error where points truly lie, as a part of that on the lattice, from which on bounds are
// tried there; how many.
constexpr double kFarOff = 1.05;
constexpr double kLeastStep = 1.5;  // from a bound that takes too much to the next
constexpr int kTrialsOfFew = 16, kTrialsOfMany = 4;

constexpr double kHeaderBytes = 100, kBytesPerVertex = 1.4;  // usually

// What all may take, in times of one encoding, as measured on development terrains.
constexpr double kMost = 3.6, kMostOfFew = 20;
constexpr double kRescue = 1.75, kLittleMore = 1;  // more while the limit is badly used
constexpr double kWellUsed = 0.99;
constexpr uint64_t kFewPosts = 20000;  // which take no time

// What efforts take, and what comes of them.
struct Costs {
  double greedy, rough, trial, widening;  // times of one encoding
  double quick_excess;                    // how much more a quick search takes
  double rest;                            // of a size, if it is searched on
  double guess;                           // the bound, as a part of the greedy error
  double one_step;                        // of a trial: one that compares no steps of height
};

Costs costs_of(Search search) {
  switch (search) {
    case Search::kFast:
      return {0.3, 1, 1, 0.5, 1, 0.94, 0.58, 1};
    case Search::kBest:
      return {0.05, 0.1, 1, 0.25, 1.25, 0.995, 0.5, 0.85};
    default:
      return {0.1, 0.3, 1, 0.25, 1.2, 0.99, 0.5, 0.7};
  }
}

// The distance of the lowest and the highest height; 1 if there is none.
Decimal height_range(const Source& source) {
  int64_t low = std::numeric_limits<int64_t>::max(), high = std::numeric_limits<int64_t>::min();
  for_each_post(source, [&](int64_t, int64_t, int64_t z) {
    if (z == kVoidHeight) return;
    low = std::min(low, z);
    high = std::max(high, z);
  });
  if (low >= high) return {1, 0};
  return make_decimal(Wide{high} - low, height_decimals(source));
}

// The largest bound that is worth a trial: of posts with bounds of their own the largest scale.
Decimal largest_bound(const Source& source, const EncodeOptions& options) {
  const Decimal range = height_range(source);
  const OwnBounds& own = bounds_of(source);
  if (own.empty()) return range;
  const double least = real(least_bound(own, *options.lattice.max_error));
  return rounded(real(range) * std::max(real(*own.unscaled) / least, 1.0)).value_or(range);
}

// The largest number of two digits that is not larger.
Decimal rounded_down(Decimal bound) {
  int64_t digit = 1;
  while (bound.mantissa / digit >= 100) digit *= 10;
  return make_decimal(Wide{bound.mantissa / digit} * digit, bound.decimals);
}

class Budget {
 public:
  Budget(const Source& source, const EncodeOptions& options, const Progress& progress)
      : source_(source),
        requested_(options),
        options_(options),
        costs_(costs_of(options.search)),
        progress_(progress),
        largest_(largest_bound(source, options)) {
    const uint32_t vertices = vertex_limit(options);
    of_vertices_ = vertices != 0;
    if (of_vertices_) costs_.trial *= costs_.one_step;
    limit_ = of_vertices_ ? vertices : options.max_bytes;
    options_.max_vertices = options_.max_bytes = 0;
    options_.device_ram = 0;
  }

  EncodedStream best_within_limit() {
    if (insert_worst()) return std::move(*best_);
    BoundSearch search(largest_, guess_, limit_);
    const bool fast = options_.search == Search::kFast;
    if (!fast) try_roughly(search);
    of_vertices_ && !fast ? try_bounds_until_near(search) : try_bounds_while_affordable(search);
    bool continues = of_vertices_ && surface_;
    while (continues && spent_ + costs_.widening <= most_)
      continues = search_on_from_last_surface();
    for (int i = 0; i < kMoreTrials && !best_ && !misses_points_; ++i) {
      try_bound(search, std::pow(kWideAim, 1 << i) * limit_);
    }
    if (misses_points_) try_true_places();
    if (!best_) fail();
    return std::move(*best_);
  }

 private:
  double size_of(const EncodedStream& encoded) const {
    return of_vertices_ ? encoded.vertices : static_cast<double>(encoded.stream.size());
  }
  bool fits(double size) const { return size <= limit_; }

  // Where points truly lie, or everywhere, if the bound is to hold there. Of posts with bounds of
  // their own: the scale that these would need.
  Decimal error_of(const EncodedStream& encoded) const {
    if (const std::optional<BoundSpan>& span = encoded.verification.bounds) {
      return rounded(real(span->ratio) * real(*encoded.bound)).value_or(*encoded.bound);
    }
    return error_where_bound(encoded, requested_.lattice.bound_at);
  }
  bool is_too_low(const EncodedStream& encoded) const {
    if (!requested_.lattice.never_below) return false;
    if (requested_.lattice.bound_at == BoundScope::kEverywhere) {
      return encoded.everywhere && encoded.everywhere->below.mantissa != 0;
    }
    return requested_.lattice.bound_at == BoundScope::kTruePlaces && encoded.true_places &&
           encoded.true_places->max_below.mantissa != 0;
  }

  // By a bound: insertion alone uses all vertices, but badly.
  bool uses(double part) const { return best_bound_ && best_size_ >= part * limit_; }
  bool nearly_used() const { return uses(kNearlyUsed); }

  double most() const {
    if (uses(kWellUsed)) return most_;
    return most_ + (nearly_used() ? kLittleMore : kRescue);
  }
  bool affords(double cost) const { return spent_ + cost <= most(); }
  Progress spending(double cost) {
    const double before = std::min(spent_ / most_, 1.0);
    spent_ += cost;
    return progress_.part(before, std::min(spent_ / most_, 1.0));
  }

  // Says what it takes.
  double keep(EncodedStream&& encoded) {
    const double size = size_of(encoded);
    smallest_ = std::min(smallest_, size);
    if (!fits(size)) return size;
    const Decimal error = error_of(encoded);
    const bool is_low = is_too_low(encoded);
    const bool is_best = !best_ || !(error_of(*best_) <= error);
    if (is_low || is_best) {
      misses_points_ = is_low || real(error) > kFarOff * real(encoded.verification.max_error);
    }
    if (is_low || !is_best) return size;
    if (encoded.bound) best_bound_ = options_.lattice.max_error;
    best_size_ = size;
    best_ = std::move(encoded);
    return size;
  }

  // Keeps a surface, from which to go on.
  double take(Approximation&& found) {
    surface_ = {found.tin, *options_.lattice.max_error, found.laid.z_step, 0};
    const double size = keep(measured(source_, options_, std::move(found)));
    surface_->size = size;
    fitted_ = fitted_ || fits(size);
    misses_ = fits(size) ? 0 : misses_ + 1;
    return size;
  }

  // Insertion of the worst sample alone, which also tells about which bound to try. Says whether
  // nothing better can be had.
  bool insert_worst() {
    if (!bounds_of(source_).empty()) {
      guess_ = real(*bounds_of(source_).unscaled);
      return false;
    }
    if (!requested_.lattice.breaklines.empty()) {  // which need a bound
      guess_ = real(largest_) / 10;
      return false;
    }
    EncodeOptions options = requested_;
    options.max_bytes = 0;
    options.lattice.never_below = false;
    if (!of_vertices_) {
      const double vertices = (limit_ - kHeaderBytes) / kBytesPerVertex;
      options.max_vertices = static_cast<uint32_t>(std::max(vertices, 4.0));
    }
    std::optional<EncodedStream> encoded;
    try {
      encoded = encode_measured(source_, options, spending(costs_.greedy));
    } catch (const Error&) {  // it takes outlines as they are, which a bound may simplify
      guess_ = real(largest_) / 10;
      return false;
    }
    if (encoded->verification.posts < kFewPosts) most_ = kMostOfFew;
    const double error = real(encoded->verification.max_error);
    guess_ = error > 0 ? error * costs_.guess : real(largest_) / 1000;
    const bool exact = error == 0 && of_vertices_;
    if (of_vertices_) keep(std::move(*encoded));
    return exact;
  }

  // Moves for the mean error would take more time than there is.
  SimplifyOptions simplify_for(double cost) {
    SimplifyOptions simplify = simplify_options(options_, processors(), spending(cost));
    simplify.centred = false;
    return simplify;
  }

  std::optional<Approximation> approximate_at(Decimal bound, Search effort, double cost) {
    options_.lattice.max_error = bound;
    SimplifyOptions simplify = simplify_for(cost);
    simplify.search = effort;
    simplify.few_vertices = of_vertices_;
    try {
      return approximate(source_, options_.lattice, simplify);
    } catch (const Error&) {  // points that share a place, or the step of heights, rule it out
      return std::nullopt;
    }
  }

  void try_roughly(BoundSearch& search) {
    const double wanted = limit_ * costs_.quick_excess;
    for (int i = 0; i < kRoughTrials; ++i) {
      const Decimal bound = search.bound_for(wanted);
      auto found = approximate_at(bound, Search::kFast, costs_.rough);
      if (!found) {
        search.add(bound, std::nullopt);
        continue;
      }
      const double size = size_of(measured(source_, options_, std::move(*found)));
      search.add(bound, size / costs_.quick_excess);
      if (std::abs(std::log(size / wanted)) < kClose) break;
    }
    search.forget_ends();
  }

  // Until a trial is near enough to go on from.
  void try_bounds_until_near(BoundSearch& search) {
    do {
      const Decimal bound = search.bound_for((1 + kMore) / costs_.rest * limit_);
      auto found = approximate_at(bound, options_.search, costs_.trial);
      search.add(bound, found ? std::optional<double>(take(std::move(*found))) : std::nullopt);
    } while (!(surface_ && std::abs(std::log(surface_->size / limit_)) < kNear) &&
             affords(costs_.trial));
  }

  void try_bounds_while_affordable(BoundSearch& search) {
    // A limit of vertices leaves some time to go on.
    const double reserve = of_vertices_ ? 2 * costs_.widening : 0;
    for (double more = kMore; affords(costs_.trial + reserve); more *= kNearer) {
      try_bound(search, (1 + more) / costs_.rest * limit_);
      if (nearly_used() && affords(costs_.trial + reserve)) try_round_bound();
    }
  }

  void try_bound(BoundSearch& search, double wanted) {
    const Decimal bound = search.bound_for(wanted);
    const auto found = approximate_at(bound, options_.search, costs_.trial);
    if (!found) {
      search.add(bound, std::nullopt);
      return;
    }
    const double size = take(Approximation(*found));
    search.add(bound, size);
    if (size <= limit_) return;
    if (size <= kLoose * limit_ || !affords(costs_.trial))
      widen_until_it_fits(search, bound, size, *found);
  }

  // Searches on from a surface that takes too much, within wider bounds, until it fits closely.
  void widen_until_it_fits(BoundSearch search, Decimal bound, double size,
                           const Approximation& tight) {
    search.forget_ends();
    search.add(bound, size * costs_.rest);
    const Decimal least = bound;
    LatticeOptions& lattice = options_.lattice;
    for (int i = 0; i < kWiderBounds && affords(costs_.widening); ++i) {
      const bool last = !uses(kWellUsed) && !affords(2 * costs_.widening);
      bound = search.bound_for((last ? kLastAim : kWideAim) * limit_);
      if (bound <= least) bound = least;
      lattice.max_error = bound;
      Approximation wide{lay_out_for(tight.tin, tight.laid.z_step), tight.tin};
      search_further(wide, rounds_of_a_piece(), simplify_for(costs_.widening));
      size = take(std::move(wide));
      if (fits(size) && (bound <= least || size >= kUsed * limit_)) return;
      search.add(bound, size);
    }
  }

  uint32_t rounds_of_a_piece() const { return std::max(rounds_of(options_.search) / kPieces, 1u); }

  // A layout for a surface from which the search goes on; breaklines may have left vertices there
  // that this bound does not need.
  Laid lay_out_for(const Tin& tin, Decimal z_step) const {
    LatticeOptions lattice = options_.lattice;
    lattice.z_step = z_step;
    Laid laid = lay_out(source_, lattice);
    if (!laid.breaklines.empty()) add_missing_samples(laid.survey, tin, laid.line_room);
    return laid;
  }

  // Bounds that hold where points truly lie, for each of which limits narrow in several attempts.
  void try_true_places() {
    BoundSearch search(largest_, best_ ? real(best_->verification.max_error) : guess_, limit_);
    options_.few_vertices = of_vertices_;
    const int trials = most_ >= kMostOfFew ? kTrialsOfFew : kTrialsOfMany;
    Decimal least;  // until one fits: sizes are flat where few points are left out
    bool fitted = false;
    for (int i = 0; i < trials; ++i) {
      Decimal bound = search.bound_for(kWideAim * limit_);
      if (bound <= least) bound = least;
      options_.lattice.max_error = bound;
      std::optional<double> size;
      try {
        size = keep(encode_measured(source_, options_, spending(costs_.trial)));
      } catch (const Error&) {  // points miss it, whatever is tried
      }
      search.add(bound, size);
      if (size && fits(*size) && *size >= kUsed * limit_) return;
      fitted = fitted || (size && fits(*size));
      least = fitted ? Decimal{} : rounded(kLeastStep * real(bound)).value_or(largest_);
    }
  }

  // Such bounds, and steps, suit sources of round heights.
  void try_round_bound() {
    if (tried_round_) return;
    tried_round_ = true;
    const Decimal bound = *best_bound_, round = rounded_down(bound);
    if (bound <= round || real(round) < kRound * real(bound)) return;
    auto found = approximate_at(round, options_.search, costs_.trial);
    if (found) take(std::move(*found));
  }

  // Searches on within a bound that should then use what there is. Says whether there is one: the
  // step of heights rules some out.
  bool search_on_from_last_surface() {
    if (best_ && best_->verification.max_error.mantissa == 0) return false;
    options_.lattice.max_error = next_bound();
    Approximation next;
    try {
      next.laid = lay_out_for(surface_->tin, surface_->z_step);
    } catch (const Error&) {
      return false;
    }
    next.tin = mended(next.laid.survey, surface_->tin);
    search_further(next, rounds_of_a_piece(), simplify_for(costs_.widening));
    take(std::move(next));
    return true;
  }

  Decimal next_bound() const {
    const double rest = misses_ >= kMisses ? 1 : costs_.rest;
    const double part =
        std::pow(rest * surface_->size / (kWideAim * limit_), 1 / (fitted_ ? kSlope : kFirstSlope));
    return rounded(real(surface_->bound) * std::clamp(part, kNarrowest, kWidest))
        .value_or(surface_->bound);
  }

  [[noreturn]] void fail() {
    EncodeOptions options = requested_;
    options.max_bytes = 0;
    options.lattice.max_error = largest_;
    // Throws by itself if another limit is the reason.
    const double size = size_of(encode_measured(source_, options, {}));
    throw Error(parameter("max_bytes") + ' ' + std::to_string(static_cast<uint64_t>(limit_)) +
                " is too small: the smallest file found, at any error, has " +
                std::to_string(static_cast<uint64_t>(std::min(size, smallest_))) + " bytes");
  }

  const Source& source_;
  const EncodeOptions& requested_;
  EncodeOptions options_;  // of a trial
  Costs costs_;
  Progress progress_;
  Decimal largest_;  // bound
  bool of_vertices_ = false;
  double limit_ = 0, guess_ = 1;
  double most_ = kMost, spent_ = 0;                       // times of one encoding
  double smallest_ = std::numeric_limits<double>::max();  // of all that were tried
  std::optional<EncodedStream> best_;
  std::optional<Decimal> best_bound_;
  double best_size_ = 0;
  bool tried_round_ = false;
  bool misses_points_ = false;  // by far, or by heights that are too low

  // The last surface that was found, from which to go on.
  struct Bounded {
    Tin tin;
    Decimal bound, z_step;
    double size;
  };
  std::optional<Bounded> surface_;
  bool fitted_ = false;  // it, or one before
  int misses_ = 0;       // since one fitted
};

}  // namespace

EncodedStream encode_within_budget(const Source& source, const EncodeOptions& options,
                                   const Progress& progress) {
  return Budget(source, options, progress).best_within_limit();
}

}  // namespace microtin::product
