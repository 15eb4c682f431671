// SPDX-License-Identifier: MIT
// Comparing a decoded terrain with its source: by height queries at places of the lattice, and by
// the exact plane where points truly lie.
#ifndef MICROTIN_ENCODER_VERIFY_VERIFY_HPP
#define MICROTIN_ENCODER_VERIFY_VERIFY_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::verifying {

// Errors are in the source's unit, rounded up to 9 decimals (their mean to nearest, from such):
// compared with a bound of at most 9 decimals, that changes nothing.
struct Verification {
  uint64_t posts = 0;           // with a height; covered and uncovered ones
  uint64_t covered = 0;         // where the terrain answers a height
  uint64_t uncovered = 0;       // where it does not
  uint64_t voids = 0;           // void posts
  uint64_t voids_answered = 0;  // void posts where the terrain answers a height
  Decimal max_error;
  Decimal max_below;  // how far the surface is below a height at most
  Decimal max_above;  // how far the surface is above a height at most
  Decimal rms_error;
  Decimal mean_error;        // above 0: the terrain is too high
  bool within_bound = true;  // errors are at most the bound, or each post's own, or there is none
  std::optional<BoundSpan> bounds;  // if posts have bounds of their own
  // From the bilinear surface of a raster's posts, at posts and between them; if it was measured.
  std::optional<Distances> everywhere;
  std::string broken;  // the first promise of a pack's tile or a stream's phase that does not hold
};

// Told of every post with a height that the terrain answers: its place on the lattice (of a pack:
// of all of it), its height as the source's number, and how far the terrain is above it, in the
// source's unit.
using PostVisitor = std::function<void(int64_t x, int64_t y, int64_t z, double above)>;

// Evaluates every post or point, also those that share a place, at its place on the lattice, the
// nearest to where it lies.
Verification verify(const microtin_mesh* mesh, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit = {});

// Verifies a mesh whose lattice is placed otherwise than it states.
Verification verify(const microtin_mesh* mesh, const Placement& lattice, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit = {});

// The verification of several parts together; what lies in more than one counts for each.
Verification combine(const std::vector<Verification>& parts);

// What a message says, from `where` on, if a surface is farther from its source than a header
// states; else empty.
std::string broken_promise(const std::optional<Distances>& stated, const Distances& found,
                           const std::string& where);

// Sums errors of heights up exactly.

// Squares of up to 2^33 numbers from 0 to 2^92, or of up to 2^52 from 0 to 2^36, added up exactly
// in parts of 46 bits: each part stays below 2^125.
class SquareSum {
 public:
  void add(Wide number, Wide times);
  bool operator<=(const SquareSum& other) const;

  // The root of the mean of the `count` squares, of numbers up to `largest`, rounded up.
  Wide root_of_mean(Wide count, Wide largest) const;

 private:
  Wide high_ = 0, middle_ = 0, low_ = 0;  // high * 2^92 + middle * 2^47 + low
};

// Differences between heights of the source and answers of the terrain, in billionths of a unit.
class ErrorMeter {
 public:
  ErrorMeter(const Axis& source, const Axis& lattice);

  // `number` is the source's; `answer` is a lattice height with 16 fractional bits. With 60 and 31
  // bits in these, 40 in the axes and 30 in the source's denominator, sums stay below 2^117, and an
  // error below 2^62 units, which are 2^92 billionths.
  // Returns how far the answer is above, in units.
  double add(int64_t number, int32_t answer);

  // Adds the error of an exact height.
  double add(int64_t number, const ExactHeight& height);

  // The magnitude of the last error, in billionths of a unit, rounded up.
  Wide last() const { return last_; }

  // Writes the errors, and whether they keep the bound.
  void report(const std::optional<Decimal>& bound, Verification& found) const;

 private:
  void count(Wide billionths, bool is_below);
  Decimal mean() const;
  Decimal root_mean_square() const;  // rounded up

  Wide to_common_, offset_, step_, from_common_, common_;
  Wide last_ = 0;
  Wide below_ = 0, above_ = 0;  // the largest, of each sign
  SquareSum squares_;
  Wide sum_ = 0;
  int64_t count_ = 0;
};

// Posts visited by several threads, reported in one order.

class VisitLog {
 public:
  // Writes down posts whose places count from (x, y); the log must outlive it.
  PostVisitor recorder(int64_t x, int64_t y) {
    return [this, x, y](int64_t dx, int64_t dy, int64_t z, double above) {
      posts_.push_back({x + dx, y + dy, z, above});
    };
  }

  void replay(const PostVisitor& visit) const {
    for (const Post& post : posts_) visit(post.x, post.y, post.z, post.above);
  }

 private:
  struct Post {
    int64_t x, y, z;
    double above;
  };

  std::vector<Post> posts_;
};

// Points where they truly lie, next to the places of the lattice that they moved to.

// The exact height at a place of the lattice.
using HeightQuery = std::function<ExactAnswer(const RealPlace& place)>;

// Told of each point's place on the lattice, where it truly lies, its bound (infinite: none), and
// how far the surface is above.
using TruePlaceVisitor = std::function<void(const RealPlace& nearest, const RealPlace& exact,
                                            double bound, double above)>;

// True if a lattice does not hold all points where they lie.
bool moves_points(const Placement& lattice, const PointCloud& cloud);

// As verify, but compares with the exact plane at each point's true place; where that is outside
// the terrain, at its place on the lattice. Queries from north to south.
Verification verify_at_true_places(const HeightQuery& height_at, const Placement& lattice,
                                   const PointCloud& cloud, const std::optional<Decimal>& bound,
                                   const TruePlaceVisitor& visit = {});

// Counts the posts at the water level where a terrain is not exactly there.
class WaterGauge {
 public:
  // Gauges a source whose heights have `decimals` decimals. Without a level it counts nothing.
  WaterGauge(int decimals, const std::optional<Decimal>& level);

  // The gauge must outlive it.
  PostVisitor visitor();

  uint64_t moved() const { return moved_; }

 private:
  std::optional<int64_t> number_;  // of the source, for the level
  uint64_t moved_ = 0;
};

}  // namespace microtin::verifying

#endif
