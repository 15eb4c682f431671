#include "encoder/approximation.hpp"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"

namespace microtin {
namespace {

// The z steps to be tried, in tenths of the bound: smaller ones cost more in heights than they save
// in vertices.
std::vector<int> tenths_to_try(Search search) {
  switch (search) {
    case Search::kBest:
      return {10, 8, 6, 5, 4, 3};
    case Search::kNormal:
      return {8, 5, 4};
    default:
      return {4};
  }
}

Decimal half(Decimal value) {
  return make_decimal(Wide{value.mantissa} * 5, value.decimals + 1);
}

// Lays the source out with every step that fits it.
std::vector<Laid> lay_out_with_steps(const Source& source, LatticeOptions lattice, Search search) {
  // A one-sided bound leaves half the room.
  const Decimal bound = lattice.never_below ? half(*lattice.max_error) : *lattice.max_error;
  std::vector<Laid> all;
  for (const int tenths : tenths_to_try(search)) {
    if (bound.decimals >= kMaxDecimals) break;
    lattice.z_step = make_decimal(Wide{bound.mantissa} * tenths, bound.decimals + 1);
    try {
      all.push_back(lay_out(source, lattice));
    } catch (const Error&) {  // too many steps, or none where points share a place
    }
  }
  // The source's own step is good if it is not much smaller than the bound.
  lattice.z_step.reset();
  if (!all.empty() && search == Search::kFast) return all;
  Laid own = lay_out(source, lattice);
  const Decimal four_steps = make_decimal(Wide{own.z_step.mantissa} * 4, own.z_step.decimals);
  if (all.empty() || bound <= four_steps) all.push_back(std::move(own));
  return all;
}

}  // namespace

Approximation approximate(const Source& source, const LatticeOptions& lattice,
                          const SimplifyOptions& options) {
  std::vector<Laid> all;
  if (options.bounded && !lattice.z_step) {
    all = lay_out_with_steps(source, lattice, options.search);
  } else {
    all.push_back(lay_out(source, lattice));
  }
  SimplifyOptions trial = options;
  trial.search = Search::kFast;
  std::size_t best = 0, fewest = std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < all.size() && all.size() > 1; ++i) {
    const std::size_t bytes = encode(simplify(all[i].survey, trial), {}, options.effort).size();
    if (bytes >= fewest) continue;
    fewest = bytes;
    best = i;
  }
  Tin tin = simplify(all[best].survey, options);
  return {std::move(all[best]), std::move(tin)};
}

}  // namespace microtin
