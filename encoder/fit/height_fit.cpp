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

bool HeightFit::fit(const std::vector<Index>& vertices) {
  begin(vertices);
  bool fits = add_hopeful() && descend();
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

// Adds the inner triangles, and stops where posts are so far out that heights around will hardly
// mend it. Says whether they are not.
bool HeightFit::add_hopeful() {
  float sum = 0;
  for (const Index t : inner_) {
    add_face(t);
    sum += faces_.back().excess;
    if (sum > hopeless_) return false;
  }
  return true;
}

bool HeightFit::has_moved() const {
  return std::any_of(movers_.begin(), movers_.begin() + static_cast<std::ptrdiff_t>(mover_count_),
                     [](const Mover& mover) { return mover.shift != 0; });
}

// Brings heights nearer to the source, or where they are preferred, one step each, where no excess
// comes of it: those of vertices whose triangles have all been added.
void HeightFit::settle() {
  const bool all_added = faces_.size() == inner_.size() + outer_.size();
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
  std::size_t kept = inner_.size();
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
  find_triangles(vertices);
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
  const Point a{va.x, va.y}, b{vb.x, vb.y}, c{vc.x, vc.y};
  // The weights of b and c grow evenly along x and y.
  const float scale = 1.0F / static_cast<float>(orient2d(a, b, c));
  const float b_along_x = static_cast<float>(c.y - a.y) * scale;
  const float b_along_y = static_cast<float>(a.x - c.x) * scale;
  const float c_along_x = static_cast<float>(a.y - b.y) * scale;
  const float c_along_y = static_cast<float>(b.x - a.x) * scale;
  const PostIndex& posts = surface_.posts();
  const float* const middles = surface_.middles();
  const float* const radii = surface_.radii();
  const std::size_t begin = posts_;
  std::size_t end = begin;
  posts.visit_runs(a, b, c, [&](std::size_t first, std::size_t last) {
    const std::size_t to = end;
    end += last - first;
    if (end + kLanes > error_.size()) reserve(end);
    float* const above = error_.data() + to;
    float* const radius = radius_.data() + to;
    float* const to_b = weight_[1].data() + to;
    float* const to_c = weight_[2].data() + to;
    const float* const rows = posts.rows_from(first);
    const auto x = static_cast<float>(posts.place(first).x - a.x);
    const float b_before = b_along_x * x, c_before = c_along_x * x;
    for (std::size_t i = 0; i < last - first; i += kLanes) {
      const Lanes y = load(rows + i) - static_cast<float>(a.y);
      store(b_before + b_along_y * y, to_b + i);
      store(c_before + c_along_y * y, to_c + i);
      store(static_cast<float>(va.z) - load(middles + first + i), above + i);
      store(load(radii + first + i), radius + i);
    }
  });
  posts_ = end;
  complete_posts(begin, static_cast<float>(vb.z - va.z), static_cast<float>(vc.z - va.z));
}

// Fills the last lanes with posts that nothing moves, and adds what b and c lie above a.
void HeightFit::complete_posts(std::size_t begin, float b_rise, float c_rise) {
  const std::size_t end = posts_;
  for (; posts_ % kLanes != 0; ++posts_) {
    reserve(posts_ + 1);
    error_[posts_] = radius_[posts_] = weight_[1][posts_] = weight_[2][posts_] = 0;
  }
  for (std::size_t i = begin; i < posts_; i += kLanes) {
    const Lanes to_b = load(weight_[1].data() + i), to_c = load(weight_[2].data() + i);
    store(1.0F - to_b - to_c, weight_[0].data() + i);
    store(load(error_.data() + i) + to_b * b_rise + to_c * c_rise, error_.data() + i);
  }
  for (std::size_t i = end; i < posts_; ++i) weight_[0][i] = 0;
}

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
  const auto look = [&](std::size_t first, std::size_t last) {
    if (before <= post && post < before + (last - first)) position = first + (post - before);
    before += last - first;
  };
  surface_.posts().visit_runs(surface_.place(corner[0]), surface_.place(corner[1]),
                              surface_.place(corner[2]), look);
  return position;
}

}  // namespace microtin::fit
