// SPDX-License-Identifier: MIT
// Chooses vertices for a survey, and steps of height for a source.
#include "encoder/fit/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/fit/decimation.hpp"
#include "encoder/fit/error_model.hpp"
#include "encoder/fit/height_choice.hpp"
#include "encoder/fit/refinement.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/polygons.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

// Refinement, then decimation, then cheaper heights, as long as requested.

namespace {

std::vector<uint32_t> all_of(const std::vector<Sample>& samples) {
  std::vector<uint32_t> all(samples.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// The corners of the hull, and all samples that must become vertices.
std::vector<uint32_t> first_vertices(const Survey& survey) {
  std::vector<uint32_t> first = hull_corners(places_of(survey.samples));
  if (survey.fixed.empty()) return first;
  const auto before = [](const Sample& sample, Point p) { return sample.place < p; };
  auto at = survey.samples.begin();
  for (const Point p : survey.fixed) {
    at = std::lower_bound(at, survey.samples.end(), p, before);
    first.push_back(static_cast<uint32_t>(at - survey.samples.begin()));
  }
  std::sort(first.begin(), first.end());
  first.erase(std::unique(first.begin(), first.end()), first.end());
  return first;
}

constexpr int kHeightPasses = 8, kFastPasses = 2;

// Rounds become shorter: less and less is left to be tried.
double time_of(double done) {
  return (1.5 - 0.5 * done) * done;
}

void remove_and_move(Decimation& decimation, uint32_t rounds, const Progress& progress) {
  for (uint32_t round = 1; round <= rounds; ++round) {
    const double before = static_cast<double>(round - 1) / rounds;
    const double done = static_cast<double>(round) / rounds;
    const Progress part = progress.part(time_of(before), time_of(done));
    if (decimation.remove_and_move_vertices(done, part) == 0) decimation.forget();
  }
}

// What means near zero may cost, and how often that is tried, by heights and by moves. Plains of a
// few vertices may take some bytes more.
constexpr double kBalanceCost = 0.005, kCentringCost = 0.08;
constexpr std::size_t kCentringBytes = 16;
constexpr int kBalancePasses = 8;
constexpr uint32_t kCentringRounds = 12;

// The part of the vertices that may be added in the second of these rounds; in the third twice as
// many, and so on.
constexpr uint32_t kAddedPart = 130, kFewestAdded = 2;

// What a mean that is off by a radius is worth, in bits a vertex: at first, and after moves.
constexpr double kMeanWeight = 4, kCentringWeight = 128;
constexpr int kCentringPasses = 3;

// How far a vertex goes for that, at first and at most: its place is even as before then.
constexpr uint32_t kNear = 2, kFar = 6;

std::size_t bytes_of(const Tin& tin, const SimplifyOptions& options) {
  return encode(tin, {}, options.effort).size();
}

// A surface with heights that were chosen, and its mean error, in steps.
struct Fitted {
  Tin tin;
  std::size_t bytes;
  double mean;
  bool is_centred;
};

Fitted fitted(const Surface& surface, const HeightChoice& heights, const SimplifyOptions& options) {
  Tin tin = surface.tin();
  const std::size_t bytes = bytes_of(tin, options);
  return {std::move(tin), bytes, heights.mean_error(), heights.is_centred()};
}

Fitted with_cheap_heights(const Surface& surface, HeightChoice& heights, int passes,
                          const SimplifyOptions& options) {
  for (int i = 0; i < passes; ++i) heights.pass();
  return fitted(surface, heights, options);
}

// Means nearer zero by heights alone, for at most this many bytes.
void balance(const Surface& surface, HeightChoice& heights, std::size_t most, Fitted& found,
             const SimplifyOptions& options) {
  for (int i = 0; i < kBalancePasses && !heights.is_balanced(); ++i) {
    heights.balance();
    Fitted balanced = fitted(surface, heights, options);
    if (balanced.bytes > most) return;
    found = std::move(balanced);
  }
}

// The mean of all nearer zero by moves and removals, farther and farther, and by a few vertices
// more, where heights alone did not bring it there: most vertices have one allowed height.
void centre(Surface& surface, Team& team, Decimation& decimation, std::size_t most, Fitted& found,
            const SimplifyOptions& options) {
  double mean = found.mean;
  for (uint32_t i = 0; i < kCentringRounds && !found.is_centred; ++i) {
    const Progress part = options.progress.part(static_cast<double>(i) / kCentringRounds,
                                                static_cast<double>(i + 1) / kCentringRounds);
    decimation.aim(mean);
    if (i > 0) decimation.add_vertices(std::max(i * surface.vertices() / kAddedPart, kFewestAdded));
    decimation.centre(static_cast<int>(std::min(kNear * (i + 1), kFar)), part);
    HeightChoice heights(surface, team, usual_degree(options.effort), kCentringWeight);
    Fitted next = with_cheap_heights(surface, heights, kCentringPasses, options);
    balance(surface, heights, most, next, options);
    if (next.bytes > most) return;
    mean = next.mean;
    if (std::abs(mean) < std::abs(found.mean)) found = std::move(next);
  }
}

// The surface with cheaper heights and means near zero, or the one before if that was cheaper
// nevertheless.
Tin finished(Surface& surface, Team& team, Decimation& decimation, const Tin& before,
             const SimplifyOptions& options) {
  HeightChoice heights(surface, team, usual_degree(options.effort), kMeanWeight);
  const int passes = options.search == Search::kFast ? kFastPasses : kHeightPasses;
  Fitted found = with_cheap_heights(surface, heights, passes, options);
  const std::size_t allowed = bytes_of(before, options);
  if (found.bytes > allowed) return before;
  const auto with_cost = [&](double cost) {
    const double bytes = static_cast<double>(found.bytes) * (1 + cost);
    return std::min(allowed, static_cast<std::size_t>(bytes));
  };
  const std::size_t most = std::min(allowed, with_cost(kCentringCost) + kCentringBytes);
  balance(surface, heights, with_cost(kBalanceCost), found, options);
  if (options.centred) centre(surface, team, decimation, most, found, options);
  return std::move(found.tin);
}

Tin refined_surface(const Survey& survey, const PostIndex& posts, const SimplifyOptions& options) {
  const bool keep_all = !options.bounded && options.max_vertices == 0;
  Refinement refinement(survey, ErrorModel{options.bounded}, posts,
                        keep_all ? all_of(survey.samples) : first_vertices(survey));
  refinement.refine(options.max_vertices != 0 ? options.max_vertices
                                              : std::numeric_limits<std::size_t>::max());
  return refinement.tin();
}

// The vertices, and those samples that are fixed and were none.
Tin with_fixed(const Survey& survey, const PostIndex& posts, Tin tin) {
  std::vector<Point> places = places_of(tin);
  std::sort(places.begin(), places.end());
  for (const Point place : survey.fixed) {
    if (std::binary_search(places.begin(), places.end(), place)) continue;
    const Sample& sample = survey.samples[posts.number(*posts.find(place))];
    tin.vertices.push_back({place.x, place.y, ErrorModel{true}.vertex_height(sample)});
  }
  return tin;
}

// Each thread has a copy of the triangulation, about a byte for each post of a large raster.
constexpr std::size_t kMostThreads = 8;

// Parts of the time: the first attempt to remove all, and until means come last.
constexpr double kRemovalPart = 0.1, kSearchPart = 0.8;

SimplifyOptions after_search(SimplifyOptions options) {
  options.progress = options.progress.part(kSearchPart, 1);
  return options;
}

}  // namespace

uint32_t rounds_of(Search search) {
  switch (search) {
    case Search::kBest:
      return 400;
    case Search::kLong:
      return 130;
    case Search::kNormal:
      return 24;
    case Search::kFast:
      return 2;
    default:  // without any, steps of height that are too large would look better than they are
      return 1;
  }
}

Tin simplify(const Survey& survey, const SimplifyOptions& options) {
  const PostIndex posts(places_of(survey.samples));
  Tin refined = refined_surface(survey, posts, options);
  if (!options.bounded || options.max_vertices != 0 || options.search == Search::kGreedy) {
    return refined;
  }
  const PostLimits limits(survey, ErrorModel{true}, posts);
  Surface surface(survey, ErrorModel{true}, posts, limits, refined);
  Team team(std::min(options.threads, kMostThreads));
  Decimation decimation(surface, team);
  decimation.remove_vertices(options.progress.part(0, kRemovalPart));
  remove_and_move(decimation, rounds_of(options.search),
                  options.progress.part(kRemovalPart, kSearchPart));
  if (options.search == Search::kTrial) return surface.tin();
  return finished(surface, team, decimation, refined, after_search(options));
}

Tin search_on(const Survey& survey, const Tin& tin, uint32_t rounds,
              const SimplifyOptions& options) {
  const PostIndex posts(places_of(survey.samples));
  const PostLimits limits(survey, ErrorModel{true}, posts);
  Surface surface(survey, ErrorModel{true}, posts, limits, tin);
  Team team(std::min(options.threads, kMostThreads));
  Decimation decimation(surface, team);
  remove_and_move(decimation, rounds, options.progress.part(0, kSearchPart));
  return finished(surface, team, decimation, tin, after_search(options));
}

Tin mended(const Survey& survey, const Tin& tin) {
  const PostIndex posts(places_of(survey.samples));
  Refinement refinement(survey, ErrorModel{true}, posts, with_fixed(survey, posts, tin));
  refinement.refine(std::numeric_limits<std::size_t>::max());
  return refinement.tin();
}

// Tries steps of height and keeps the one whose stream is smallest.

namespace {

// The z steps to be tried, in hundredths of the bound: smaller ones cost more in heights than they
// save in vertices, of which larger ones take more.
std::vector<int> steps_to_try(const SimplifyOptions& options, bool has_own_bounds) {
  if (options.few_vertices) return {kFineStep};
  switch (options.search) {
    case Search::kBest:
      return {30, 40, 50, 60, 75, 100};
    case Search::kNormal:  // own bounds are wider than the least one, of which these are parts
      return has_own_bounds ? std::vector<int>{38, 75, 100} : std::vector<int>{38, 75};
    default:
      return {75};
  }
}

// Where the bound is so few own steps, most posts of a rough terrain are vertices, and heights take
// most bits: then a step is tried that is coarser, if the coarsest of all others is the best.
constexpr int kFewSteps = 6, kCoarseStep = 140;

// Whether heights are held by more than the bounds of posts: by breaklines, or by a bound that
// holds between posts, too. A coarse step then often has no height within all limits.
bool needs_fine_steps(const LatticeOptions& lattice) {
  return lattice.bound_at == BoundScope::kEverywhere || !lattice.breaklines.empty();
}

// A source, laid out with each of the steps of its heights that fit it.
class Layouts {
 public:
  Layouts(const Source& source, const LatticeOptions& lattice, const SimplifyOptions& options)
      : source_(source), lattice_(lattice) {
    if (options.bounded && !lattice.z_step) {
      find_steps(options);
    } else {
      steps_.push_back(lattice.z_step);
    }
  }

  std::size_t size() const { return steps_.size(); }
  // Those that are tried in any case.
  std::size_t usual() const { return usual_; }
  std::size_t samples() const { return samples_; }
  Laid operator[](std::size_t i) const { return laid_out_with(steps_[i]); }
  // If there is but one.
  Laid take_only() { return only_ ? std::move(*only_) : laid_out_with(steps_[0]); }

 private:
  void find_steps(const SimplifyOptions& options);
  void add_step(const std::optional<Decimal>& step);
  Laid laid_out_with(const std::optional<Decimal>& step) const {
    LatticeOptions lattice = lattice_;
    lattice.z_step = step;
    return lay_out(source_, lattice);
  }

  const Source& source_;
  LatticeOptions lattice_;
  std::vector<std::optional<Decimal>> steps_;  // nothing: the source's own
  std::size_t usual_ = 1;
  std::size_t samples_ = 0;   // if there is a choice of steps
  std::optional<Laid> only_;  // laid out with the only step, if it is at hand
};

void Layouts::find_steps(const SimplifyOptions& options) {
  // A one-sided bound leaves half the room.
  const Decimal least = least_bound(bounds_of(source_), *lattice_.max_error);
  const Decimal bound = lattice_.never_below ? half(least) : least;
  only_ = laid_out_with(std::nullopt);
  const Decimal own = only_->z_step;
  samples_ = only_->survey.samples.size();
  const auto add = [&](int hundredths) {
    const Decimal step = step_near(own, bound, hundredths);
    add_step(step == own ? std::nullopt : std::optional<Decimal>(step));
  };
  if (needs_fine_steps(lattice_)) {
    add(kFineStep);
  } else {
    for (const int hundredths : steps_to_try(options, !bounds_of(source_).empty())) add(hundredths);
  }
  if (steps_.empty()) steps_.push_back(std::nullopt);
  usual_ = steps_.size();
  if (usual_ > 1 && bound <= make_decimal(Wide{own.mantissa} * kFewSteps, own.decimals)) {
    add(kCoarseStep);
  }
  if (steps_.size() > 1) only_.reset();
}

// Unless it is there, or does not fit.
void Layouts::add_step(const std::optional<Decimal>& step) {
  if (std::find(steps_.begin(), steps_.end(), step) != steps_.end()) return;
  only_.reset();  // two would take too much memory
  try {
    only_ = laid_out_with(step);
    steps_.push_back(step);
  } catch (const Error&) {  // some heights, or points that share a place, have none within bounds
  }
}

// Larger layouts are not in memory at the same time.
constexpr std::size_t kSamplesAtOnce = std::size_t{1} << 21;

// The layout whose quick surface takes the fewest bytes, the first of equals, and this surface.
Approximation cheapest(const Layouts& all, const SimplifyOptions& options) {
  struct Trial {
    Tin tin;
    std::size_t bytes;
  };
  std::vector<Trial> trials(all.size(), Trial{{}, SIZE_MAX});
  SharedProgress progress(options.progress, all.size());
  const auto attempt = [&](std::size_t i, std::size_t threads) {
    SimplifyOptions trial = options;
    trial.search = Search::kTrial;
    trial.threads = threads;
    trial.progress = progress.of(i);
    trials[i].tin = simplify(all[i].survey, trial);
    trials[i].bytes = bytes_of(trials[i].tin, options);
  };
  const auto best = [&] {
    const auto found =
        std::min_element(trials.begin(), trials.end(),
                         [](const Trial& a, const Trial& b) { return a.bytes < b.bytes; });
    return static_cast<std::size_t>(found - trials.begin());
  };
  Team team(all.samples() <= kSamplesAtOnce ? std::min(options.threads, all.usual()) : 1);
  team.for_each(all.usual(),
                [&](std::size_t i, std::size_t) { attempt(i, options.threads / team.size()); });
  if (best() + 1 == all.usual() && all.usual() < all.size()) attempt(all.usual(), options.threads);
  return {all[best()], std::move(trials[best()].tin)};
}

// The part of the time that looking for the step takes.
double trial_part(Search search) {
  return search == Search::kBest ? 0.15 : 0.3;
}

}  // namespace

constexpr long kLargestPower = 3;  // of two; above that, any even number

Decimal step_near(Decimal own, Decimal bound, int hundredths) {
  constexpr double kMost = 1e15;  // heights have fewer steps
  const double steps = std::min(0.01 * hundredths * (real(bound) / real(own) + 1), kMost);
  const long power = std::lround(std::log2(steps));
  const int64_t multiple =
      power <= kLargestPower ? int64_t{1} << std::max(power, 0L) : 2 * std::llround(steps / 2);
  return make_decimal(Wide{multiple} * own.mantissa, own.decimals);
}

Approximation approximate(const Source& source, const LatticeOptions& lattice,
                          const SimplifyOptions& options) {
  Layouts all(source, lattice, options);
  if (all.size() == 1) {
    Laid laid = all.take_only();
    Tin tin = simplify(laid.survey, options);
    return {std::move(laid), std::move(tin)};
  }
  const double trials = trial_part(options.search);
  SimplifyOptions part = options;
  part.progress = options.progress.part(0, trials);
  Approximation found = cheapest(all, part);
  part.progress = options.progress.part(trials, 1);
  search_further(found, rounds_of(options.search), part);
  return found;
}

void search_further(Approximation& found, uint32_t rounds, const SimplifyOptions& options) {
  found.tin = search_on(found.laid.survey, found.tin, rounds, options);
}

}  // namespace microtin::fit
