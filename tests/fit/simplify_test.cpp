// SPDX-License-Identifier: MIT
#include "encoder/fit/simplify.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/fit/error_model.hpp"
#include "encoder/stream/triangulation.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/reference_delaunay.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using reference::Wide;

constexpr int32_t kStep = 65536;  // one step of height

// --- Surveys -----------------------------------------------------------------------------------

Sample sample_at(Point place, int32_t height, int32_t bound) {
  return {place, height, height - bound, height + bound};
}

using HeightAt = std::function<int32_t(int, int)>;
using VoidAt = std::function<bool(int, int)>;

Survey raster(
    int width, int height, const HeightAt& height_at, int32_t bound,
    const VoidAt& void_at = [](int, int) { return false; }) {
  Survey survey;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) {
      if (void_at(x, y)) {
        survey.voids.push_back(point(x, y));
      } else {
        survey.samples.push_back(sample_at(point(x, y), height_at(x, y), bound));
      }
    }
  }
  return survey;
}

int32_t flat(int, int) {
  return 7 * kStep;
}

// Waves and a cliff, with heights between whole steps.
int32_t rough(int x, int y) {
  const double waves = 20 * std::sin(x * 0.4) + 15 * std::cos(y * 0.3 + x * 0.1);
  return static_cast<int32_t>(std::lround(waves * kStep)) + (x + 2 * y > 60 ? 30 * kStep : 0);
}

// --- An independent look at the result ---------------------------------------------------------

bool in_closed_triangle(Point a, Point b, Point c, Point p) {
  return reference::area(a, b, p) >= 0 && reference::area(b, c, p) >= 0 &&
         reference::area(c, a, p) >= 0;
}

// The exact height at p of the plane through three vertices, rounded to nearest, halves up.
int32_t plane_height(Vertex a, Vertex b, Vertex c, Point p) {
  const Point pa{a.x, a.y}, pb{b.x, b.y}, pc{c.x, c.y};
  const Wide w = reference::area(pa, pb, pc);
  const Wide sum = reference::area(pb, pc, p) * a.z + reference::area(pc, pa, p) * b.z +
                   reference::area(pa, pb, p) * c.z;
  const Wide doubled = 2 * sum * kStep + w;
  const Wide floor = doubled >= 0 ? doubled / (2 * w) : -((2 * w - 1 - doubled) / (2 * w));
  return static_cast<int32_t>(floor);
}

class Surface {
 public:
  explicit Surface(const Tin& tin) {
    Points points;
    for (const Vertex v : tin.vertices) {
      points.push_back(Point{v.x, v.y});
      vertices_[points.back()] = v;
    }
    distinct_ = vertices_.size() == tin.vertices.size();
    triangles_ = triangles_of(Triangulation(points).mesh()).triangles;
    for (const Tin::Triangle& t : tin.voids) {
      const TriangleSet::Triangle corners = {t.a, t.b, t.c};
      known_ = known_ && std::binary_search(triangles_.begin(), triangles_.end(), corners);
      distinct_ = voids_.insert(corners).second && distinct_;
    }
  }

  bool well_formed() const { return distinct_ && known_; }

  // The heights that the vertex at p, or the triangles that are not void and hold p, give it.
  std::set<int32_t> heights_at(Point p) const {
    const auto vertex = vertices_.find(p);
    if (vertex != vertices_.end()) return {vertex->second.z * kStep};
    std::set<int32_t> heights;
    for (const TriangleSet::Triangle& t : triangles_) {
      const auto& [a, b, c] = t;
      if (!in_closed_triangle(a, b, c, p) || voids_.count(t) != 0) continue;
      heights.insert(plane_height(vertices_.at(a), vertices_.at(b), vertices_.at(c), p));
    }
    return heights;
  }

 private:
  std::map<Point, Vertex> vertices_;
  std::vector<TriangleSet::Triangle> triangles_;
  std::set<TriangleSet::Triangle> voids_;
  bool distinct_ = true, known_ = true;
};

// The largest distance of the surface from what a sample allows. Complains about samples without a
// height, ambiguous heights and void posts with one.
uint64_t largest_violation(const Survey& survey, const Tin& tin, bool bounded) {
  const Surface surface(tin);
  CHECK(surface.well_formed());
  uint64_t largest = 0;
  std::size_t wrong = 0;
  for (const Sample& sample : survey.samples) {
    const std::set<int32_t> heights = surface.heights_at(sample.place);
    if (heights.size() != 1) {
      ++wrong;
    } else {
      largest = std::max(largest, ErrorModel{bounded}.violation(sample, *heights.begin()));
    }
  }
  for (const Point p : survey.voids) {
    if (!surface.heights_at(p).empty()) ++wrong;
  }
  CHECK(wrong == 0);
  return largest;
}

std::set<Point> places(const Tin& tin) {
  std::set<Point> places;
  for (const Vertex v : tin.vertices) places.insert(Point{v.x, v.y});
  return places;
}

SimplifyOptions bounded() {
  SimplifyOptions options;
  options.bounded = true;
  return options;
}

SimplifyOptions at_most(uint32_t vertices) {
  SimplifyOptions options;
  options.max_vertices = vertices;
  return options;
}

}  // namespace

TEST_CASE("error model: the whole step nearest to the middle, halves up, that is allowed") {
  const auto at = [](int32_t height) { return Sample{point(0, 0), height, 0, 0}; };
  const ErrorModel free{false};
  CHECK(free.vertex_height(at(0)) == 0);
  CHECK(free.vertex_height(at(32767)) == 0);
  CHECK(free.vertex_height(at(32768)) == 1);
  CHECK(free.vertex_height(at(-32768)) == 0);
  CHECK(free.vertex_height(at(-32769)) == -1);
  CHECK(free.vertex_height(at(std::numeric_limits<int32_t>::max())) == 32767);
  CHECK(free.vertex_height(at(std::numeric_limits<int32_t>::min())) == -32768);
  const ErrorModel bound{true};
  CHECK(bound.vertex_height({point(0, 0), 40000, 0, 65535}) == 0);
  CHECK(bound.vertex_height({point(0, 0), 20000, 1, 70000}) == 1);
  CHECK(bound.vertex_height({point(0, 0), -40000, -65535, 0}) == 0);
  CHECK(bound.vertex_height({point(0, 0), -20000, -70000, -1}) == -1);
  CHECK(bound.vertex_height({point(0, 0), 0, 0, 3 * 65536}) == 2);
  const auto unbounded = [](int32_t height) {
    return Sample{point(0, 0), height, std::numeric_limits<int32_t>::min(),
                  std::numeric_limits<int32_t>::max()};
  };
  CHECK(bound.vertex_height(unbounded(40000)) == 1);  // as near to the source as a step can be
  CHECK(bound.vertex_height(unbounded(-40000)) == -1);
  CHECK(bound.violation(unbounded(0), 99 * 65536) == 0);
}

TEST_CASE("error model: the distance from what is allowed") {
  const Sample sample = {point(0, 0), 10, -5, 12};
  CHECK(ErrorModel{true}.violation(sample, -5) == 0);
  CHECK(ErrorModel{true}.violation(sample, 12) == 0);
  CHECK(ErrorModel{true}.violation(sample, -7) == 2);
  CHECK(ErrorModel{true}.violation(sample, 15) == 3);
  CHECK(ErrorModel{false}.violation(sample, 10) == 0);
  CHECK(ErrorModel{false}.violation(sample, 7) == 3);
  const Sample lowest = {point(0, 0), std::numeric_limits<int32_t>::min(), 0, 0};
  CHECK(ErrorModel{false}.violation(lowest, std::numeric_limits<int32_t>::max()) == 0xffffffffu);
}

TEST_CASE("simplify: without options every sample is a vertex") {
  const Survey survey = raster(20, 15, rough, 0);
  const Tin tin = simplify(survey, {});
  REQUIRE(tin.vertices.size() == survey.samples.size());
  CHECK(largest_violation(survey, tin, false) <= kStep / 2);
  CHECK(tin.voids.empty());
}

TEST_CASE("simplify: samples without a triangle are refused") {
  Survey survey;
  CHECK_THROWS_AS(simplify(survey, {}), Error);
  CHECK_THROWS_AS(simplify(survey, bounded()), Error);
  for (int i = 0; i < 10; ++i) {
    survey.samples.push_back(sample_at(point(i, 2 * i), i * i * kStep, 0));
    CHECK_THROWS_AS(simplify(survey, {}), Error);
    CHECK_THROWS_AS(simplify(survey, bounded()), Error);
    CHECK_THROWS_AS(simplify(survey, at_most(5)), Error);
  }
}

TEST_CASE("simplify: planes need the corners of their hull only") {
  CHECK(simplify(raster(30, 20, flat, 0), bounded()).vertices.size() == 4);
  const auto slope = [](int x, int y) { return (3 * x - 2 * y) * kStep; };
  CHECK(simplify(raster(30, 20, slope, 0), bounded()).vertices.size() == 4);
  const auto roof = [](int x, int) { return std::min(x, 30 - x) * kStep; };
  CHECK(simplify(raster(31, 31, roof, 0), bounded()).vertices.size() < 12);
}

TEST_CASE("simplify: the bound holds at every sample") {
  std::size_t more = std::numeric_limits<std::size_t>::max();
  for (const int32_t bound : {kStep / 2, 2 * kStep, 5 * kStep, 20 * kStep, 100 * kStep}) {
    CAPTURE(bound);
    const Survey survey = raster(33, 40, rough, bound);
    const Tin tin = simplify(survey, bounded());
    CHECK(largest_violation(survey, tin, true) == 0);
    CHECK(tin.vertices.size() < more);
    more = tin.vertices.size();
  }
  CHECK(more == 4);
}

TEST_CASE("simplify: vertices prefer places whose coordinates are multiples of two") {
  const auto smooth = [](int x, int y) {
    return static_cast<int32_t>(
        std::lround(kStep * (12 * std::sin(x * 0.11) + 9 * std::cos(y * 0.13))));
  };
  const Tin tin = simplify(raster(97, 97, smooth, 3 * kStep / 2), bounded());
  REQUIRE(tin.vertices.size() > 40);
  const auto even = std::count_if(tin.vertices.begin(), tin.vertices.end(),
                                  [](const Vertex& v) { return v.x % 2 == 0 && v.y % 2 == 0; });
  CHECK(static_cast<double>(even) > 0.85 * static_cast<double>(tin.vertices.size()));
}

TEST_CASE("simplify: flat ground keeps its height, and errors their balance") {
  const int32_t bound = 5 * kStep / 2;
  const auto coast = [](int x, int y) {
    const double hills = 14 * std::sin(x * 0.13) + 11 * std::cos(y * 0.11 + x * 0.04) - 4;
    return static_cast<int32_t>(std::lround(kStep * std::max(hills, 0.0)));
  };
  const Survey survey = raster(81, 81, coast, bound);
  for (const Search search : {Search::kFast, Search::kNormal}) {
    SimplifyOptions options = bounded();
    options.search = search;
    const Surface surface(simplify(survey, options));
    double sum = 0, flat_sum = 0, flat_count = 0;
    for (const Sample& s : survey.samples) {
      const double error = static_cast<double>(*surface.heights_at(s.place).begin()) - s.height;
      sum += error;
      if (s.height != 0) continue;
      flat_sum += error;
      ++flat_count;
    }
    REQUIRE(flat_count > 1000);
    CHECK(std::abs(flat_sum / flat_count) < 0.2 * bound);
    CHECK(std::abs(sum / static_cast<double>(survey.samples.size())) < 0.03 * bound);
  }
}

// The mean error of all posts, in bounds.
double imbalance(const Survey& survey, const Tin& tin, int32_t bound) {
  const Surface surface(tin);
  double sum = 0;
  for (const Sample& s : survey.samples) {
    sum += static_cast<double>(*surface.heights_at(s.place).begin()) - s.height;
  }
  return std::abs(sum / static_cast<double>(survey.samples.size())) / bound;
}

// Midway between ground and the tops of trees is above most of the plain.
TEST_CASE("simplify: errors keep their balance where most of the ground is low or high" * kSlow) {
  const int32_t bound = 5 * kStep / 2;
  for (const uint32_t seed : {11u, 12u, 13u}) {
    for (const int32_t sign : {1, -1}) {
      Random random(seed);
      const auto plain = [&](int x, int y) {
        const double hills = 9 * std::sin(x * 0.07) + 7 * std::cos(y * 0.06 + x * 0.02);
        const bool tree = random.below(100) == 0;
        const uint32_t above = tree ? random.below(7 * kStep) : random.below(kStep);
        return static_cast<int32_t>(std::lround(kStep * hills)) +
               sign * static_cast<int32_t>(above);
      };
      const Survey survey = raster(161, 161, plain, bound);
      for (const Search search : {Search::kFast, Search::kNormal}) {
        SimplifyOptions options = bounded();
        options.search = search;
        const Tin tin = simplify(survey, options);
        CHECK(largest_violation(survey, tin, true) == 0);
        CHECK(imbalance(survey, tin, bound) <= 0.02);
      }
    }
  }
}

// With so few vertices none can move far enough. Mean errors are 0.20 and 0.11 of those of a search
// that does not care about them. Without added vertices they are 0.48 and 0.45.
TEST_CASE("simplify: vertices are added on a plain for the sake of the mean error") {
  const std::pair<int32_t, double> most[] = {{2 * kStep, 0.27}, {5 * kStep / 2, 0.27}};
  for (const auto& [bound, part] : most) {
    const int32_t allowed = bound;
    double centred = 0, as_it_comes = 0;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
      Random random(seed);
      const auto plain = [&](int x, int y) {
        const double hills = 4 * std::sin(x * 0.05) + 3 * std::cos(y * 0.04 + x * 0.02);
        const bool tree = random.below(300) == 0;
        const uint32_t above = random.below(tree ? static_cast<uint32_t>(2 * allowed) : kStep);
        return static_cast<int32_t>(std::lround(kStep * hills)) + static_cast<int32_t>(above);
      };
      const Survey survey = raster(129, 129, plain, allowed);
      SimplifyOptions options = bounded();
      centred += imbalance(survey, simplify(survey, options), bound);
      options.centred = false;
      as_it_comes += imbalance(survey, simplify(survey, options), bound);
    }
    CHECK(centred < part * as_it_comes);
  }
}

TEST_CASE("simplify: a longer search finds fewer vertices, always the same" * kSlow) {
  const Survey survey = raster(65, 65, rough, 4 * kStep);
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const Search search : {Search::kGreedy, Search::kFast, Search::kBest}) {
    SimplifyOptions options = bounded();
    options.search = search;
    const Tin tin = simplify(survey, options);
    CHECK(largest_violation(survey, tin, true) == 0);
    CHECK(tin.vertices.size() < before * 19 / 20);
    before = tin.vertices.size();
    const Tin again = simplify(survey, options);
    REQUIRE(again.vertices.size() == before);
    const bool same =
        std::equal(tin.vertices.begin(), tin.vertices.end(), again.vertices.begin(),
                   [](Vertex a, Vertex b) { return a.x == b.x && a.y == b.y && a.z == b.z; });
    CHECK(same);
  }
}

// Queues get into each other's way where there are many of them on little ground.
TEST_CASE("simplify: the same vertices for any number of threads") {
  Random random(7);
  const auto noise = [&](int x, int y) {
    const double hills = 14 * std::sin(x * 0.13) + 11 * std::cos(y * 0.11 + x * 0.04);
    return static_cast<int32_t>(std::lround(kStep * hills + random.below(4 * kStep)));
  };
  const auto plain = [&](int x, int) {
    const bool tree = random.below(20) == 0;
    return x * kStep / 30 + static_cast<int32_t>(random.below((tree ? 8 : 2) * kStep));
  };
  const auto pond = [](int x, int y) { return (x - 60) * (x - 60) + (y - 50) * (y - 50) < 300; };
  const std::pair<Survey, Search> cases[] = {
      {raster(80, 90, noise, 3 * kStep / 2, pond), Search::kFast},
      {raster(50, 50, noise, kStep), Search::kNormal},
      {raster(64, 200, noise, 5 * kStep / 4), Search::kFast},
      {raster(120, 90, plain, 5 * kStep / 2), Search::kFast}};
  for (const auto& [survey, search] : cases) {
    SimplifyOptions options = bounded();
    options.search = search;
    const std::vector<uint8_t> alone = encode(simplify(survey, options), {});
    for (const std::size_t threads : {2u, 3u, 16u}) {
      options.threads = threads;
      CAPTURE(threads);
      const Tin tin = simplify(survey, options);
      CHECK(largest_violation(survey, tin, true) == 0);
      CHECK((encode(tin, {}) == alone));
    }
  }
}

TEST_CASE("simplify: a surface is mended where narrower bounds do not hold") {
  const auto hole = [](int x, int y) { return x > 20 && x < 30 && y > 5 && y < 40; };
  const Survey wide = raster(65, 65, rough, 6 * kStep, hole);
  const Survey narrow = raster(65, 65, rough, 3 * kStep, hole);
  const Tin tin = simplify(wide, bounded());
  const std::size_t vertices = tin.vertices.size();
  CHECK(mended(wide, tin).vertices.size() == vertices);
  CHECK(largest_violation(narrow, tin, true) > 0);
  const Tin more = mended(narrow, tin);
  CHECK(largest_violation(narrow, more, true) == 0);
  REQUIRE(more.vertices.size() > vertices);
  CHECK(std::equal(tin.vertices.begin(), tin.vertices.end(), more.vertices.begin(),
                   [](Vertex a, Vertex b) { return a.x == b.x && a.y == b.y; }));
}

// Without small moves the sums are 15 and 25 larger.
TEST_CASE("simplify: vertices that move a little let others go") {
  const auto smooth = [](int x, int y) {
    return static_cast<int32_t>(
        std::lround(kStep * (12 * std::sin(x * 0.11) + 9 * std::cos(y * 0.13))));
  };
  const auto hills = [](int x, int y) {
    const double height = 14 * std::sin(x * 0.13) + 11 * std::cos(y * 0.11 + x * 0.04);
    return static_cast<int32_t>(std::lround(kStep * (height + 3 * std::sin(x * y * 0.01))));
  };
  const Survey surveys[] = {raster(97, 97, smooth, 3 * kStep / 2), raster(65, 65, rough, 4 * kStep),
                            raster(81, 81, hills, 5 * kStep / 2)};
  const std::pair<Search, std::size_t> most[] = {{Search::kFast, 863}, {Search::kNormal, 790}};
  for (const auto& [search, bytes] : most) {
    SimplifyOptions options = bounded();
    options.search = search;
    std::size_t sum = 0;
    for (const Survey& survey : surveys) sum += encode(simplify(survey, options), {}).size();
    CHECK(sum <= bytes);
  }
}

TEST_CASE("simplify: never more bytes than greedy insertion takes") {
  Random random(3);
  const auto noise = [&](int, int) { return static_cast<int32_t>(random.below(9 * kStep)); };
  for (const HeightAt& height_at : {HeightAt(flat), HeightAt(rough), HeightAt(noise)}) {
    for (const int32_t bound : {0, kStep / 2, 3 * kStep}) {
      const Survey survey = raster(20, 20, height_at, bound);
      SimplifyOptions options = bounded();
      if (bound == 0 && height_at(1, 1) % kStep != 0) continue;  // no whole step is allowed
      const std::size_t found = encode(simplify(survey, options), {}).size();
      options.search = Search::kGreedy;
      CHECK(found <= encode(simplify(survey, options), {}).size());
    }
  }
}

TEST_CASE("simplify: one-sided and narrow bounds hold") {
  Survey survey = raster(25, 25, rough, 0);
  Random random(1);
  for (Sample& sample : survey.samples) {
    const int32_t step = sample.height & -kStep;  // the whole step below
    sample.lowest = step;
    sample.highest =
        random.below(4) == 0 ? step : step + static_cast<int32_t>(random.below(9 * kStep));
  }
  const Tin tin = simplify(survey, bounded());
  CHECK(largest_violation(survey, tin, true) == 0);
  CHECK(tin.vertices.size() < survey.samples.size());
}

TEST_CASE("simplify: scattered points of every kind") {
  Random random(2);
  for (PointSet& set : point_sets(150, 7)) {
    CAPTURE(set.name);
    std::sort(set.points.begin(), set.points.end());
    Survey survey;
    for (const Point p : set.points) {
      const int32_t height = static_cast<int32_t>(random.below(40 * kStep)) - 20 * kStep;
      survey.samples.push_back(sample_at(p, height, 10 * kStep));
    }
    CHECK(largest_violation(survey, simplify(survey, bounded()), true) == 0);
    CHECK(largest_violation(survey, simplify(survey, {}), false) <= kStep / 2);
  }
}

TEST_CASE("simplify: extreme heights") {
  const auto spikes = [](int x, int y) { return ((x * 7 + y * 5) % 3 - 1) * 32767 * kStep; };
  Survey survey = raster(12, 12, spikes, 0);
  for (Sample& sample : survey.samples) sample.lowest = sample.highest = sample.height;
  CHECK(largest_violation(survey, simplify(survey, bounded()), true) == 0);
}

TEST_CASE("simplify: the largest error shrinks as vertices are added, and they are nested") {
  const Survey survey = raster(33, 33, rough, 0);
  uint64_t error = std::numeric_limits<uint64_t>::max();
  std::set<Point> fewer;
  for (const uint32_t limit : {1u, 20u, 60u, 180u, 540u}) {
    CAPTURE(limit);
    const Tin tin = simplify(survey, at_most(limit));
    CHECK(tin.vertices.size() == std::max(limit, 4u));
    const uint64_t now = largest_violation(survey, tin, false);
    CHECK(now < error);
    error = now;
    const std::set<Point> more = places(tin);
    CHECK(std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()));
    fewer = more;
  }
}

TEST_CASE("simplify: no vertex is spent once the error is 0") {
  CHECK(simplify(raster(33, 33, flat, 0), at_most(500)).vertices.size() == 4);
}

TEST_CASE("simplify: terrain and void are kept apart") {
  const auto scattered = [](uint32_t percent) {
    return [percent](int x, int y) {
      return Random(static_cast<uint64_t>(x * 1000 + y)).below(100) < percent;
    };
  };
  const std::vector<std::pair<std::string, VoidAt>> kinds = {
      {"one post", [](int x, int y) { return x == 11 && y == 7; }},
      {"two posts", [](int x, int y) { return (x == 11 || x == 13) && y == 7; }},
      {"rectangle", [](int x, int y) { return x > 4 && x < 15 && y > 5 && y < 20; }},
      {"disc", [](int x, int y) { return (x - 12) * (x - 12) + (y - 9) * (y - 9) < 50; }},
      {"diagonal stripe", [](int x, int y) { return std::abs(x - y) < 3; }},
      {"row", [](int, int y) { return y == 12; }},
      {"border", [](int x, int) { return x < 3; }},
      {"slanted border", [](int x, int y) { return 3 * x + y < 30; }},
      {"bay", [](int x, int y) { return x < 12 && y > 8 && y < 14; }},
      {"half of the border posts", [](int x, int y) { return x == 0 && y % 2 == 1; }},
      {"ring",
       [](int x, int y) {
         const int r = (x - 12) * (x - 12) + (y - 12) * (y - 12);
         return r > 20 && r < 60;
       }},
      {"all but an island", [](int x, int y) { return x < 9 || x > 13 || y < 9 || y > 13; }},
      {"chessboard", [](int x, int y) { return (x + y) % 2 == 0; }},
      {"3 of 100", scattered(3)},
      {"30 of 100", scattered(30)},
      {"80 of 100", scattered(80)},
  };
  for (const auto& kind : kinds) {
    CAPTURE(kind.first);
    for (const HeightAt& height_at : {HeightAt(flat), HeightAt(rough)}) {
      const Survey survey = raster(25, 26, height_at, 6 * kStep, kind.second);
      CHECK(largest_violation(survey, simplify(survey, bounded()), true) == 0);
      largest_violation(survey, simplify(survey, at_most(10)), false);
      CHECK(largest_violation(survey, simplify(survey, {}), false) <= kStep / 2);
    }
  }
}

TEST_CASE("simplify: the rim of a straight void needs few vertices") {
  const VoidAt pond = [](int x, int y) { return x > 20 && x < 40 && y > 20 && y < 40; };
  CHECK(simplify(raster(61, 61, flat, 0, pond), bounded()).vertices.size() <= 20);
  const VoidAt sea = [](int x, int) { return x > 40; };
  CHECK(simplify(raster(61, 61, flat, 0, sea), bounded()).vertices.size() == 4);
}

}  // namespace microtin::tests
