// SPDX-License-Identifier: MIT
// The search over all vertices, and the part of it that brings the mean error nearer zero.
#include "encoder/fit/decimation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace microtin::fit {

// In which order, on which threads vertices are tried, and which of the attempts count.

namespace {

// How much more odd coordinates may cost on the way: the search finds more when at first it
// takes the places that fit best.
constexpr double kDaring = 10, kCareful = 0.8;  // the part of the search after which none does

// Steps of a block's sides. All queues' blocks, with what lies around them, fit into the cache.
constexpr int kBlock = 32;

// Some vertices of each queue are tried before threads wait for one another. Queues that are
// shorter would get into each other's way.
constexpr std::size_t kQueues = 16, kRun = 8, kShortestQueue = 512;

// Edits that wait for surfaces of threads: they take memory.
constexpr std::size_t kMostEdits = 4096;

}  // namespace

Decimation::Decimation(Surface& surface, Team& team)
    : surface_(surface), team_(team), stale_(surface.vertex_limit()) {
  workers_.push_back({surface_, Attempts(surface_), 0});
}

std::size_t Decimation::remove_vertices(const Progress& progress) {
  const auto remove = [](Attempts& attempts, Index v) { return attempts.remove_vertex(v); };
  const std::size_t removed = try_each(progress, remove, [](const Outcome&) { return true; });
  forget();  // what could not be removed has not been moved yet
  return removed;
}

std::size_t Decimation::remove_and_move_vertices(double done, const Progress& progress) {
  cheapness_ = std::pow(even_part(), kDaring * std::max(0.0, 1 - done / kCareful));
  const auto move = [](Attempts& attempts, Index v) { return attempts.move_vertex(v); };
  return try_each(progress, move, [](const Outcome&) { return true; });
}

bool Decimation::remove_vertex(Index v) {
  Attempts& attempts = workers_.front().attempts;
  attempts.begin(0);
  const bool is_removed = attempts.remove_vertex(v);
  try_again_near(attempts.outcome(is_removed));
  attempts.keep();
  return is_removed;
}

// The coder learns how often coordinates are even: odd ones cost more by that.
double Decimation::even_part() const {
  std::size_t even = 0;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (surface_.has_vertex(v)) even += 2u - surface_.place(v).x % 2u - surface_.place(v).y % 2u;
  }
  return static_cast<double>(even) / (2.0 * surface_.vertices());
}

// Those that are not stale, block by block, since posts nearby are then at hand; within a block in
// an order that looks random.
std::vector<Index> Decimation::order_of_attempts() {
  std::vector<Index> order;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (surface_.has_vertex(v) && !surface_.is_fixed(v) && !stale_[v]) order.push_back(v);
  }
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_.below(i)]);
  const auto block = [this](Index v) {
    const Point p = surface_.place(v);
    return std::make_pair(p.x / kBlock, p.y / kBlock);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return block(a) < block(b); });
  return order;
}

// Gives each thread a surface, until end_pass.
void Decimation::begin_pass() {
  ++passes_;
  while (workers_.size() < team_.size()) {
    copies_.push_back(surface_);
    workers_.push_back({copies_.back(), Attempts(copies_.back()), 0});
  }
  const int64_t usual_area = 3 * surface_.covered_area() / surface_.vertices();
  for (Worker& worker : workers_) {
    worker.attempts.set_cheapness(cheapness_);
    worker.attempts.set_usual_area(usual_area);
    worker.attempts.prefer(preferred_);
  }
}

void Decimation::end_pass() {
  while (workers_.size() > 1) workers_.pop_back();
  copies_.clear();
}

// Applies to the thread's surface what other threads found.
Decimation::Worker& Decimation::up_to_date(std::size_t worker) {
  Worker& own = workers_[worker];
  for (; own.edits < edits_.size(); ++own.edits) apply(own.surface, edits_[own.edits]);
  return own;
}

std::vector<Decimation::Queue> Decimation::queues_of(const std::vector<Index>& order) {
  if (order.empty()) return {};
  const std::size_t count = std::clamp<std::size_t>(order.size() / kShortestQueue, 1, kQueues);
  std::vector<Queue> queues;
  for (std::size_t i = 0; i < count; ++i) {
    const Index* const all = order.data();
    queues.push_back({all + order.size() * i / count, all + order.size() * (i + 1) / count});
  }
  return queues;
}

double Decimation::part_left(const std::vector<Queue>& queues, std::size_t all) {
  std::ptrdiff_t left = 0;
  for (const Queue& queue : queues) left += queue.end - queue.next;
  return static_cast<double>(left) / static_cast<double>(all);
}

void Decimation::update_all() {
  team_.for_each(workers_.size(), [this](std::size_t i, std::size_t) { up_to_date(i).edits = 0; });
  edits_.clear();
}

std::size_t Decimation::try_each(const Progress& progress, const Attempt& attempt,
                                 const Decision& is_wanted) {
  const std::vector<Index> order = order_of_attempts();
  begin_pass();
  std::vector<Queue> queues = queues_of(order);
  std::vector<std::vector<Outcome>> outcomes(queues.size());
  std::size_t removed = 0;
  for (std::size_t batch = 0; !queues.empty(); ++batch) {
    if (batch % 16 == 0) progress.at(1 - part_left(queues, order.size()));
    team_.for_each(queues.size(), [&](std::size_t i, std::size_t worker) {
      outcomes[i] = outcomes_in(queues[i], worker, attempt);
    });
    removed += keep_some(outcomes, queues, is_wanted);
    if (edits_.size() > kMostEdits || queues.empty()) update_all();
  }
  end_pass();
  return removed;
}

// Tries the next vertices of a queue, and takes all changes back.
std::vector<Outcome> Decimation::outcomes_in(const Queue& queue, std::size_t worker,
                                             const Attempt& attempt) {
  Worker& own = up_to_date(worker);
  std::vector<Outcome> outcomes;
  for (const Index* v = queue.next; v != queue.end && outcomes.size() < kRun; ++v) {
    outcomes.emplace_back();
    if (!own.surface.has_vertex(*v)) continue;
    own.attempts.begin(uint64_t{passes_} << 32 | *v);
    const bool is_removal = attempt(own.attempts, *v);
    outcomes.back() = own.attempts.outcome(is_removal);
  }
  own.attempts.take_back();
  return outcomes;
}

// Keeps what succeeded, in order, and lets the queues go on. Returns how many vertices fewer there
// are.
std::size_t Decimation::keep_some(const std::vector<std::vector<Outcome>>& outcomes,
                                  std::vector<Queue>& queues, const Decision& is_wanted) {
  std::vector<Region> changed;  // by other queues
  std::size_t removed = 0;
  for (std::size_t i = 0; i < queues.size(); ++i) {
    const std::size_t others = changed.size();
    for (const Outcome& outcome : outcomes[i]) {
      const auto meets = [&](const Region& region) { return region.meets(outcome.region); };
      const bool succeeds = !outcome.edits.empty();
      const auto end = changed.begin() + static_cast<std::ptrdiff_t>(others);
      if (succeeds && std::any_of(changed.begin(), end, meets)) break;  // another try
      stale_[*queues[i].next++] = true;
      if (!succeeds || !is_wanted(outcome)) continue;
      edits_.insert(edits_.end(), outcome.edits.begin(), outcome.edits.end());
      changed.push_back(outcome.region);
      try_again_near(outcome);
      removed += outcome.is_removal ? 1 : 0;
    }
  }
  queues.erase(std::remove_if(queues.begin(), queues.end(),
                              [](const Queue& queue) { return queue.next == queue.end; }),
               queues.end());
  return removed;
}

void Decimation::try_again_near(const Outcome& outcome) {
  for (const Index v : outcome.vertices) stale_[v] = false;
}

// The part of Decimation that brings the mean error nearer zero.

namespace {

// The part of all triangles that may get a vertex: a vertex of large ones moves more posts.
constexpr std::size_t kLargePart = 4;

}  // namespace

void Decimation::aim(double mean) {
  rise_ = std::llround(-3 * mean * static_cast<double>(surface_.covered_area()));
}

void Decimation::centre(int near, const Progress& progress) {
  preferred_ = direction();
  forget();
  const auto move = [&](Attempts& attempts, Index v) {
    return !has_reached_mean() && attempts.move_and_gain(v, near);
  };
  try_each(progress, move, [this](const Outcome& outcome) {
    const bool is_wanted = !has_reached_mean();
    if (is_wanted) rise_ -= outcome.raised;
    return is_wanted;
  });
  preferred_ = 0;
  forget();
}

void Decimation::add_vertices(std::size_t most) {
  most = std::min<std::size_t>(most, surface_.vertex_limit() - surface_.vertices());
  if (most == 0) return;
  preferred_ = direction();
  Attempts& attempts = workers_.front().attempts;
  for (const Attempts::Addition& addition : additions()) {
    if (most == 0 || has_reached_mean()) break;
    attempts.begin(0);
    if (!attempts.add(addition)) continue;
    rise_ -= attempts.outcome(false).raised;
    attempts.keep();
    --most;
  }
  preferred_ = 0;
  forget();
}

// The best first.
std::vector<Attempts::Addition> Decimation::additions() {
  const std::vector<std::array<Index, 3>> triangles = large_triangles();
  begin_pass();
  std::vector<std::optional<Attempts::Addition>> found(triangles.size());
  team_.for_each(triangles.size(), [&](std::size_t i, std::size_t worker) {
    Attempts& attempts = workers_[worker].attempts;
    attempts.begin(0);
    found[i] = attempts.addition_in(triangles[i]);
  });
  end_pass();
  std::vector<Attempts::Addition> additions;
  for (const std::optional<Attempts::Addition>& addition : found) {
    if (addition && addition->gain > 0) additions.push_back(*addition);
  }
  std::stable_sort(additions.begin(), additions.end(),
                   [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return additions;
}

// By their corners, near which a vertex is added.
std::vector<std::array<Index, 3>> Decimation::large_triangles() const {
  std::vector<std::pair<int64_t, std::array<Index, 3>>> triangles;
  surface_.visit_covered([&](Index t) {
    const Index* const corner = surface_.mesh().origin + first_edge(t);
    const int64_t area =
        orient2d(surface_.place(corner[0]), surface_.place(corner[1]), surface_.place(corner[2]));
    triangles.push_back({-area, {corner[0], corner[1], corner[2]}});
  });
  std::sort(triangles.begin(), triangles.end());
  triangles.resize(triangles.size() / kLargePart);
  std::vector<std::array<Index, 3>> large;
  large.reserve(triangles.size());
  for (const auto& triangle : triangles) large.push_back(triangle.second);
  return large;
}

}  // namespace microtin::fit
