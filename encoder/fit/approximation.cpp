// SPDX-License-Identifier: MIT
// Tries steps of height and keeps the one whose stream is smallest.
#include "encoder/fit/approximation.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/stream/encode.hpp"

namespace microtin::fit {
namespace {

// The z steps to be tried, in tenths of the bound: smaller ones cost more in heights than they save
// in vertices, of which larger ones take more.
std::vector<int> tenths_to_try(const SimplifyOptions& options) {
  if (options.few_vertices) return {4};
  switch (options.search) {
    case Search::kBest:
      return {10, 8, 6, 5, 4, 3};
    case Search::kNormal:
      return {8, 4};
    default:
      return {4};
  }
}

constexpr int kOwnSteps = 4;

Decimal half(Decimal value) {
  return make_decimal(Wide{value.mantissa} * 5, value.decimals + 1);
}

// Lays the source out with every step that fits it.
std::vector<Laid> lay_out_with_steps(const Source& source, LatticeOptions lattice,
                                     const SimplifyOptions& options) {
  // A one-sided bound leaves half the room.
  const Decimal bound = lattice.never_below ? half(*lattice.max_error) : *lattice.max_error;
  std::vector<Laid> all;
  for (const int tenths : tenths_to_try(options)) {
    if (bound.decimals >= kMaxDecimals) break;
    lattice.z_step = make_decimal(Wide{bound.mantissa} * tenths, bound.decimals + 1);
    try {
      all.push_back(lay_out(source, lattice));
    } catch (const Error&) {  // too many steps, or none where points share a place
    }
  }
  // The source's own step is good if it is not much smaller than the bound.
  lattice.z_step.reset();
  Laid own = lay_out(source, lattice);
  const Decimal steps = make_decimal(Wide{own.z_step.mantissa} * kOwnSteps, own.z_step.decimals);
  if (tenths_to_try(options).size() == 1 && bound <= steps) all.clear();
  if (all.empty() || bound <= steps) all.push_back(std::move(own));
  return all;
}

// The layout whose quick surface takes the fewest bytes, and this surface.
Approximation cheapest(std::vector<Laid> all, const SimplifyOptions& options) {
  std::optional<Approximation> best;
  std::size_t fewest = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    SimplifyOptions trial = options;
    trial.search = Search::kTrial;
    const auto before = static_cast<double>(i), total = static_cast<double>(all.size());
    trial.progress = options.progress.part(before / total, (before + 1) / total);
    Tin tin = simplify(all[i].survey, trial);
    const std::size_t bytes = encode(tin, {}, options.effort).size();
    if (best && bytes >= fewest) continue;
    fewest = bytes;
    best = Approximation{std::move(all[i]), std::move(tin)};
  }
  return std::move(*best);
}

// The part of the time that looking for the step takes.
double trial_part(Search search) {
  return search == Search::kBest ? 0.15 : 0.3;
}

}  // namespace

Approximation approximate(const Source& source, const LatticeOptions& lattice,
                          const SimplifyOptions& options) {
  std::vector<Laid> all;
  if (options.bounded && !lattice.z_step) {
    all = lay_out_with_steps(source, lattice, options);
  } else {
    all.push_back(lay_out(source, lattice));
  }
  if (all.size() == 1) {
    Tin tin = simplify(all[0].survey, options);
    return {std::move(all[0]), std::move(tin)};
  }
  const double trials = trial_part(options.search);
  SimplifyOptions part = options;
  part.progress = options.progress.part(0, trials);
  Approximation found = cheapest(std::move(all), part);
  part.progress = options.progress.part(trials, 1);
  search_further(found, rounds_of(options.search), part);
  return found;
}

void search_further(Approximation& found, uint32_t rounds, const SimplifyOptions& options) {
  found.tin = search_on(found.laid.survey, found.tin, rounds, options);
}

}  // namespace microtin::fit
