// SPDX-License-Identifier: MIT
// Shifts heights until no post is out of bounds, or gives up soon.
#include "encoder/fit/height_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace microtin::fit {
namespace {

constexpr uint32_t kFixed = ~uint32_t{0};
constexpr uint32_t kMostSteps = 30;
constexpr float kHopeless = 1;        // excess, in squared mean radii: fits rarely begin worse
constexpr double kNegligible = 1e-8;  // excess, in squared steps
constexpr float kUnknown = -1;

// Several numbers at once.
constexpr std::size_t kLanes = 4;
static_assert(kLanes <= PostIndex::kReadAhead, "runs are read beyond their ends");
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

void store(Lanes lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

// Masks by lane: quicker than comparisons for the sign.
typedef int32_t Bits __attribute__((vector_size(sizeof(Lanes))));
constexpr int32_t kMagnitude = 0x7FFFFFFF;
static_assert(std::numeric_limits<float>::is_iec559, "the first bit is the sign");

// How far each is beyond its radius.
Lanes beyond(Lanes error, Lanes radius) {
  const Lanes over = reinterpret_cast<Lanes>(reinterpret_cast<Bits>(error) & kMagnitude) - radius;
  return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(over) & (over > 0));
}

Lanes with_sign_of(Lanes error, Lanes magnitude) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(magnitude) |
                                 (reinterpret_cast<Bits>(error) & ~kMagnitude));
}

// The first `count` lanes, and 0 in the others.
Lanes first_of(Lanes lanes, std::size_t count) {
  if (count >= kLanes) return lanes;
  constexpr Bits kNumber = {0, 1, 2, 3};
  const Bits is_first = kNumber < static_cast<int32_t>(count);
  return reinterpret_cast<Lanes>(reinterpret_cast<Bits>(lanes) & is_first);
}

// How a number on a plane grows along x and y.
struct Along {
  float x, y;
};

// The weights of a triangle's corners: 1 at their own, 0 at the others.
struct Weights {
  Weights(Vertex va, Vertex vb, Vertex vc) {
    const float scale =
        1.0F / static_cast<float>(orient2d({va.x, va.y}, {vb.x, vb.y}, {vc.x, vc.y}));
    b = {static_cast<float>(vc.y - va.y) * scale, static_cast<float>(va.x - vc.x) * scale};
    c = {static_cast<float>(va.y - vb.y) * scale, static_cast<float>(vb.x - va.x) * scale};
    a = {-b.x - c.x, -b.y - c.y};
  }

  Along rise(Vertex va, Vertex vb, Vertex vc) const {
    const auto of_b = static_cast<float>(vb.z - va.z), of_c = static_cast<float>(vc.z - va.z);
    return {b.x * of_b + c.x * of_c, b.y * of_b + c.y * of_c};
  }

  Along a, b, c;
};

void forget(std::array<float, 2> (&shifted)[3]) {
  for (auto& both : shifted) both.fill(kUnknown);
}

float sum_of(Lanes lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

}  // namespace

HeightFit::HeightFit(const Surface& surface)
    : surface_(surface), mover_(surface.vertex_limit(), kFixed), met_(surface.mesh().triangles) {
  const auto radius = static_cast<float>(std::max(surface.mean_radius(), 1.0));
  hopeless_ = kHopeless * radius * radius;
}

bool HeightFit::fit(const std::vector<Index>& vertices, const std::vector<Index>& new_ones) {
  begin(vertices);
  bool fits = add_hopeful(new_ones);
  if (fits) {
    find_triangles(vertices);
    fits = add_hopeful(inner_) && descend();
  }
  inner_faces_ = faces_.size();
  if (fits && has_moved()) {
    go_back();
    for (const Index t : outer_) add_face(t);
    fits = descend();
  }
  if (fits) {
    settle();
    keep_changed();
  }
  for (const Index v : vertices) mover_[v] = kFixed;
  return fits;
}

// Adds triangles, and stops where posts are so far out that heights around will hardly mend it.
// Says whether they are not.
bool HeightFit::add_hopeful(const std::vector<Index>& triangles) {
  for (const Index t : triangles) {
    if (!surface_.is_covered(t)) continue;
    met_[t] = call_;
    add_face(t);
    first_excess_ += faces_.back().excess;
    if (first_excess_ > hopeless_) return false;
  }
  return true;
}

bool HeightFit::is_hopeless(Vertex vertex) const {
  float sum = 0;
  surface_.visit_rim([&](Vertex a, Vertex b) {
    sum += excess_under(vertex, a, b);
    return sum <= hopeless_;
  });
  return sum > hopeless_;
}

// The sum of squared distances from the bounds. Above hopeless_ it may stop at a part of the sum.
float HeightFit::excess_under(Vertex va, Vertex vb, Vertex vc) const {
  const Along rise = Weights(va, vb, vc).rise(va, vb, vc);
  const PostIndex& posts = surface_.posts();
  float sum = 0;
  posts.visit_runs({va.x, va.y}, {vb.x, vb.y}, {vc.x, vc.y}, [&](const PostIndex::Run& run) {
    if (sum > hopeless_) return;
    const float* const rows = posts.rows_of(run);
    const float* const middles = surface_.middles() + run.first;
    const float* const radii = surface_.radii() + run.first;
    const std::size_t size = run.last - run.first;
    const auto x = static_cast<float>(run.place.x - va.x);
    const float height = static_cast<float>(va.z) + rise.x * x;
    Lanes squares{};
    for (std::size_t i = 0; i < size; i += kLanes) {
      const Lanes y = load(rows + i) - static_cast<float>(va.y);
      const Lanes over = beyond(height + rise.y * y - load(middles + i), load(radii + i));
      const Lanes within = first_of(over, size - i);
      squares += within * within;
    }
    sum += sum_of(squares);
  });
  return sum;
}

bool HeightFit::has_moved() const {
  return std::any_of(movers_.begin(), movers_.begin() + static_cast<std::ptrdiff_t>(mover_count_),
                     [](const Mover& mover) { return mover.shift != 0; });
}

// Brings heights nearer to the source, or where they are preferred, one step each, where no excess
// comes of it: those of vertices whose triangles have all been added.
void HeightFit::settle() {
  const bool all_added = faces_.size() == inner_faces_ + outer_.size();
  for (std::size_t m = 0; m < mover_count_; ++m) {
    if (!all_added && !movers_[m].is_inner) continue;
    const int32_t shift = preferred_ != 0 ? preferred_ : step_to_source(movers_[m]);
    const auto stays = [&](const std::pair<uint32_t, uint32_t>& at) {
      const Face& face = faces_[at.first];
      return excess_of(face, at.second, shift) <= face.excess;
    };
    const auto& corners = movers_[m].corners;
    if (shift != 0 && std::all_of(corners.begin(), corners.end(), stays)) move(movers_[m], shift);
  }
}

// What has an unmoved corner and moves no other keeps its bounds as it did.
void HeightFit::keep_changed() {
  std::size_t kept = inner_faces_;
  for (std::size_t f = kept; f < faces_.size(); ++f) {
    if (moves(faces_[f])) triangles_[kept++] = triangles_[f];
  }
  triangles_.resize(kept);
}

bool HeightFit::moves(const Face& face) const {
  return std::any_of(face.mover.begin(), face.mover.end(), [this](uint32_t mover) {
    return mover != kFixed && movers_[mover].shift != 0;
  });
}

void HeightFit::go_back() {
  for (std::size_t m = 0; m < mover_count_; ++m) {
    if (movers_[m].shift != 0) move(movers_[m], -movers_[m].shift);
  }
}

// Which step of a height, if any, lowers the sum of squared errors.
int32_t HeightFit::step_to_source(const Mover& mover) const {
  Lanes slopes{}, bends{};
  for (const auto& [f, corner] : mover.corners) {
    const float* const weight = weight_[corner].data();
    for (std::size_t i = faces_[f].begin; i < faces_[f].end; i += kLanes) {
      const Lanes w = load(weight + i);
      slopes += w * load(error_.data() + i);
      bends += w * w;
    }
  }
  const float slope = sum_of(slopes), bend = sum_of(bends);
  if (2 * std::abs(slope) <= bend) return 0;
  return slope > 0 ? -1 : 1;
}

bool HeightFit::descend() {
  for (stride_ = surface_.widest_stride(); stride_ != 0; stride_ /= 2) {
    if (excess() <= kNegligible) return true;
    for (Face& face : faces_) forget(face.shifted);
    for (uint32_t steps = 0; steps < kMostSteps; ++steps) {
      const Step step = best_step();
      if (step.shift == 0) break;
      move(movers_[step.mover], step.shift);
      if (excess() <= kNegligible) return true;
    }
  }
  return false;
}

void HeightFit::begin(const std::vector<Index>& vertices) {
  ++call_;
  posts_ = 0;
  first_excess_ = 0;
  faces_.clear();
  triangles_.clear();
  mover_count_ = vertices.size();
  if (movers_.size() < mover_count_) movers_.resize(mover_count_);
  for (uint32_t i = 0; i < mover_count_; ++i) {
    movers_[i].shift = 0;
    movers_[i].is_inner = true;
    movers_[i].corners.clear();
    mover_[vertices[i]] = i;
  }
}

void HeightFit::find_triangles(const std::vector<Index>& vertices) {
  inner_.clear();
  outer_.clear();
  for (const Index v : vertices) {
    surface_.visit_around(v, [this](Index h) {
      const Index triangle = triangle_of(h);
      if (met_[triangle] == call_) return;
      met_[triangle] = call_;
      if (surface_.is_covered(triangle)) sort_in(triangle);
    });
  }
}

void HeightFit::sort_in(Index triangle) {
  const Index* const corner = surface_.mesh().origin + first_edge(triangle);
  if (std::all_of(corner, corner + 3, [this](Index c) { return mover_[c] != kFixed; })) {
    inner_.push_back(triangle);
    return;
  }
  outer_.push_back(triangle);
  for (Index i = 0; i < 3; ++i) {
    if (mover_[corner[i]] != kFixed) movers_[mover_[corner[i]]].is_inner = false;
  }
}

void HeightFit::add_face(Index triangle) {
  const Index* const corner = surface_.mesh().origin + first_edge(triangle);
  Face face{};
  face.begin = posts_;
  add_posts({surface_.vertex(corner[0]), surface_.vertex(corner[1]), surface_.vertex(corner[2])});
  face.end = posts_;
  assess(face);
  for (uint32_t i = 0; i < 3; ++i) {
    face.mover[i] = mover_[corner[i]];
    if (face.mover[i] == kFixed) continue;
    movers_[face.mover[i]].corners.emplace_back(static_cast<uint32_t>(faces_.size()), i);
  }
  faces_.push_back(face);
  triangles_.push_back(triangle);
}

void HeightFit::add_posts(const std::array<Vertex, 3>& corner) {
  const Vertex &va = corner[0], &vb = corner[1], &vc = corner[2];
  const Weights weights(va, vb, vc);
  const Along rise = weights.rise(va, vb, vc);
  const PostIndex& posts = surface_.posts();
  const float* const middles = surface_.middles();
  const float* const radii = surface_.radii();
  std::size_t end = posts_;
  posts.visit_runs({va.x, va.y}, {vb.x, vb.y}, {vc.x, vc.y}, [&](const PostIndex::Run& run) {
    const std::size_t to = end;
    end += run.last - run.first;
    reserve(end);
    float *const above = error_.data() + to, *const radius = radius_.data() + to;
    float *const to_a = weight_[0].data() + to, *const to_b = weight_[1].data() + to,
                 *const to_c = weight_[2].data() + to;
    const float* const rows = posts.rows_of(run);
    const auto x = static_cast<float>(run.place.x - va.x);
    const float of_a = 1 + weights.a.x * x, of_b = weights.b.x * x, of_c = weights.c.x * x;
    const float height = static_cast<float>(va.z) + rise.x * x;
    for (std::size_t i = 0; i < end - to; i += kLanes) {
      const Lanes y = load(rows + i) - static_cast<float>(va.y);
      store(of_a + weights.a.y * y, to_a + i);
      store(of_b + weights.b.y * y, to_b + i);
      store(of_c + weights.c.y * y, to_c + i);
      store(height + rise.y * y - load(middles + run.first + i), above + i);
      store(load(radii + run.first + i), radius + i);
    }
  });
  // The last lanes are posts that nothing moves.
  for (; end % kLanes != 0; ++end) {
    error_[end] = radius_[end] = weight_[0][end] = weight_[1][end] = weight_[2][end] = 0;
  }
  posts_ = end;
}

// Makes room for `posts` posts, and for lanes that reach beyond the last one.
void HeightFit::reserve(std::size_t posts) {
  if (posts + kLanes <= error_.size()) return;
  const std::size_t size = 2 * posts + kLanes;
  error_.resize(size);
  radius_.resize(size);
  for (std::vector<float>& weight : weight_) weight.resize(size);
}

// Finds the sum of squared distances from the bounds, and its slopes.
void HeightFit::assess(Face& face) const {
  forget(face.shifted);
  std::fill(face.slope, face.slope + 3, 0.0F);
  Lanes sum{};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    const Lanes over = beyond(load(error_.data() + i), load(radius_.data() + i));
    sum += over * over;
  }
  face.excess = sum_of(sum);
  if (face.excess == 0) return;
  Lanes slope[3] = {};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    const Lanes error = load(error_.data() + i);
    const Lanes over = beyond(error, load(radius_.data() + i));
    const Lanes pull = with_sign_of(error, over);
    for (uint32_t k = 0; k < 3; ++k) slope[k] += pull * load(weight_[k].data() + i);
  }
  for (uint32_t k = 0; k < 3; ++k) face.slope[k] = 2 * sum_of(slope[k]);
}

// What the sum is if a corner moves.
float HeightFit::excess_of(const Face& face, uint32_t corner, int32_t shift) const {
  const auto steps = static_cast<float>(shift);
  const float* const weight = weight_[corner].data();
  Lanes sum{};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    const Lanes error = load(error_.data() + i) + steps * load(weight + i);
    const Lanes over = beyond(error, load(radius_.data() + i));
    sum += over * over;
  }
  return sum_of(sum);
}

double HeightFit::excess() const {
  double sum = 0;
  for (const Face& face : faces_) sum += face.excess;
  return sum;
}

// The shift is 0 if none helps. The excess is convex, so its slope says which way a height may go,
// and how much that saves at most.
HeightFit::Step HeightFit::best_step() {
  Step best{0, 0};
  double lowest = -kNegligible;
  for (std::size_t m = 0; m < mover_count_; ++m) {
    double slope = 0;
    for (const auto& [f, corner] : movers_[m].corners) {
      slope += static_cast<double>(faces_[f].slope[corner]);
    }
    if (-std::abs(slope) * stride_ >= lowest) continue;
    const double change = change_of(movers_[m], slope < 0);
    if (change >= lowest) continue;
    lowest = change;
    best = {m, slope < 0 ? stride_ : -stride_};
  }
  return best;
}

// What a stride of a height adds to the excess.
double HeightFit::change_of(const Mover& mover, bool up) {
  double change = 0;
  for (const auto& [f, corner] : mover.corners) {
    Face& face = faces_[f];
    float& shifted = face.shifted[corner][up ? 1 : 0];
    if (shifted == kUnknown) shifted = excess_of(face, corner, up ? stride_ : -stride_);
    change += static_cast<double>(shifted) - static_cast<double>(face.excess);
  }
  return change;
}

void HeightFit::move(Mover& mover, int32_t shift) {
  mover.shift += shift;
  const auto steps = static_cast<float>(shift);
  for (const auto& [f, corner] : mover.corners) {
    float* const error = error_.data();
    const float* const weight = weight_[corner].data();
    for (std::size_t i = faces_[f].begin; i < faces_[f].end; i += kLanes) {
      store(load(error + i) + steps * load(weight + i), error + i);
    }
    assess(faces_[f]);
  }
}

uint32_t HeightFit::worst_sample(std::size_t rank) {
  std::vector<std::pair<float, std::size_t>> worst;  // how far out, at which position
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (face.excess == 0) continue;
    std::pair<float, std::size_t> most{0.0F, face.begin};
    for (std::size_t i = face.begin; i < face.end; ++i) {
      const float over = std::abs(error_[i]) - radius_[i];
      if (over > most.first) most = {over, i};
    }
    worst.emplace_back(most.first, position_of(triangles_[f], most.second - face.begin));
  }
  std::sort(worst.rbegin(), worst.rend());
  const PostIndex& posts = surface_.posts();
  return posts.number(worst.empty() ? 0 : worst[std::min(rank, worst.size() - 1)].second);
}

// In the index; posts of a triangle count from 0.
std::size_t HeightFit::position_of(Index triangle, std::size_t post) const {
  const Index* const corner = surface_.mesh().origin + first_edge(triangle);
  std::size_t position = 0, before = 0;
  const auto look = [&](const PostIndex::Run& run) {
    const std::size_t after = before + (run.last - run.first);
    if (before <= post && post < after) position = run.first + (post - before);
    before = after;
  };
  surface_.posts().visit_runs(surface_.place(corner[0]), surface_.place(corner[1]),
                              surface_.place(corner[2]), look);
  return position;
}

}  // namespace microtin::fit
