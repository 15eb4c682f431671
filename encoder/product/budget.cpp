// SPDX-License-Identifier: MIT
// Finds a bound that takes a little more than there is, then searches on until it fits.
#include "encoder/product/budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/fit/bound_search.hpp"

namespace microtin::product {
namespace {

// A little more than fits, as searching on saves that; nearly as much as fits if not.
constexpr double kAim = 1.012, kLastAim = 0.994;
constexpr double kSavings = 1.03;  // how much more than fits searching on may save
constexpr double kWasted = 0.99;   // what fits and is above needs no more trials
constexpr double kClose = 0.1;     // of the logarithm of a size: near enough for a rough trial
constexpr int kRoughTrials = 4, kTrials = 3, kMoreTrials = 12;
constexpr int kSmallTrials = 8;  // where each has a large effect, and takes no time
constexpr double kSmall = 500;   // vertices
constexpr uint32_t kPieces = 4;  // of a search that goes on

// A quick search takes so much more.
double excess_of_quick(Search search) {
  return search == Search::kFast ? 1 : search == Search::kNormal ? 1.25 : 1.28;
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

double value_of(Decimal d) {
  return static_cast<double>(d.mantissa) / std::pow(10.0, d.decimals);
}

class Budget {
 public:
  Budget(const Source& source, const EncodeOptions& options, const Progress& progress)
      : source_(source),
        asked_(options),
        options_(options),
        progress_(progress),
        largest_(height_range(source)) {
    const uint32_t vertices = vertex_limit(options);
    of_vertices_ = vertices != 0;
    limit_ = of_vertices_ ? vertices : options.max_bytes;
    options_.max_vertices = options_.max_bytes = 0;
    options_.device_ram = 0;
  }

  EncodedStream spend() {
    if (greedy()) return std::move(*best_);
    BoundSearch search(largest_, guess_);
    if (options_.search != Search::kFast) try_roughly(search);
    const int trials = limit_ < kSmall ? kSmallTrials : kTrials;
    for (int i = 0; i < trials && !is_spent(); ++i) {
      try_bound(search, i + 1 < trials || !best_bound_ ? kAim : kLastAim);
    }
    for (int i = 0; i < kMoreTrials && !best_; ++i) try_bound(search, std::pow(kLastAim, 1 << i));
    if (!best_) fail();
    return std::move(*best_);
  }

 private:
  double size_of(const EncodedStream& encoded) const {
    return of_vertices_ ? encoded.vertices : static_cast<double>(encoded.stream.size());
  }
  bool fits(double size) const { return size <= limit_; }
  bool is_spent() const { return best_bound_ && best_size_ >= kWasted * limit_; }

  void keep(EncodedStream&& encoded) {
    const double size = size_of(encoded);
    smallest_ = std::min(smallest_, size);
    if (!fits(size)) return;
    if (best_ && best_->verification.max_error <= encoded.verification.max_error) return;
    best_bound_ = encoded.bound;
    best_size_ = size;
    best_ = std::move(encoded);
  }

  // Insertion of the worst sample alone, which also tells about which bound to try. Says whether
  // nothing better can be had.
  bool greedy() {
    EncodeOptions options = asked_;
    options.max_bytes = 0;
    options.lattice.never_below = false;
    if (!of_vertices_) options.max_vertices = static_cast<uint32_t>(std::max(limit_ / 2, 4.0));
    EncodedStream encoded = encode_measured(source_, options, {});
    const double error = value_of(encoded.verification.max_error);
    guess_ = error > 0 ? error / 2 : value_of(largest_) / 1000;
    const bool exact = error == 0 && of_vertices_;
    if (of_vertices_) keep(std::move(encoded));
    return exact;
  }

  std::optional<Approximation> approximate_at(Decimal bound, Search effort, double until) {
    options_.lattice.max_error = bound;
    SimplifyOptions simplify = simplify_options(options_, progress_.part(done_, until));
    simplify.search = effort;
    done_ = until;
    try {
      return approximate(source_, options_.lattice, simplify);
    } catch (const Error&) {  // points that share a place, or the step of heights, rule it out
      return std::nullopt;
    }
  }

  void try_roughly(BoundSearch& search) {
    for (int i = 0; i < kRoughTrials; ++i) {
      const double wanted = limit_ * excess_of_quick(options_.search);
      const Decimal bound = search.bound_for(wanted);
      const auto found = approximate_at(bound, Search::kFast, 0.05 * (i + 1));
      if (!found) {
        search.add(bound, std::nullopt);
        continue;
      }
      const EncodedStream encoded = measured(source_, options_, Approximation(*found));
      const double size = size_of(encoded);
      search.add(bound, size / excess_of_quick(options_.search));
      if (std::abs(std::log(size / wanted)) < kClose) return;
    }
  }

  void try_bound(BoundSearch& search, double aim) {
    const Decimal bound = search.bound_for(aim * limit_);
    const double room = 0.9 * (1 - done_);
    std::optional<Approximation> found = approximate_at(bound, options_.search, done_ + room / 3);
    if (!found) {
      search.add(bound, std::nullopt);
      return;
    }
    EncodedStream encoded = measured(source_, options_, Approximation(*found));
    double size = size_of(encoded);
    search.add(bound, size);
    const uint32_t rounds = std::max(rounds_of(options_.search) / kPieces, 1u);
    for (uint32_t i = 0; i < kPieces && !fits(size) && size <= kSavings * limit_; ++i) {
      const double until = done_ + room / 3 / kPieces;
      search_further(*found, rounds, simplify_options(options_, progress_.part(done_, until)));
      done_ = until;
      encoded = measured(source_, options_, Approximation(*found));
      size = size_of(encoded);
    }
    keep(std::move(encoded));
  }

  [[noreturn]] void fail() {
    options_.lattice.max_error = largest_;
    encode_measured(source_, options_, {});  // throws if that was the reason
    throw Error("--max-bytes " + std::to_string(static_cast<uint64_t>(limit_)) +
                " is not enough: at any error, at least " +
                std::to_string(static_cast<uint64_t>(smallest_)));
  }

  const Source& source_;
  const EncodeOptions& asked_;
  EncodeOptions options_;  // of a trial
  Progress progress_;
  Decimal largest_;  // bound
  bool of_vertices_ = false;
  double limit_ = 0, guess_ = 1, done_ = 0;
  double smallest_ = std::numeric_limits<double>::max();  // of all that were tried
  std::optional<EncodedStream> best_;
  std::optional<Decimal> best_bound_;
  double best_size_ = 0;
};

}  // namespace

EncodedStream encode_within_budget(const Source& source, const EncodeOptions& options,
                                   const Progress& progress) {
  return Budget(source, options, progress).spend();
}

}  // namespace microtin::product
