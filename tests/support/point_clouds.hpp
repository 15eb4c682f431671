// SPDX-License-Identifier: MIT
// Clouds of points, seeded, that are hard to cut into tiles. x and y are in steps of 1.
#ifndef MICROTIN_TESTS_SUPPORT_POINT_CLOUDS_HPP
#define MICROTIN_TESTS_SUPPORT_POINT_CLOUDS_HPP

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "encoder/pack/encode.hpp"
#include "encoder/terrain/source.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

// Waves and noise.
inline int64_t rough_height(int64_t x, int64_t y) {
  Random random(static_cast<uint64_t>(x * 1000003 + y));
  const double waves =
      60 * std::sin(static_cast<double>(x) * 0.004) + 50 * std::cos(static_cast<double>(y) * 0.005);
  return std::lround(waves) + random.below(4);
}

class CloudMaker {
 public:
  explicit CloudMaker(uint64_t seed) : random_(seed) {}

  void add(int64_t x, int64_t y, int64_t higher = 0) {
    cloud_.points.push_back({x, y, rough_height(x, y) + higher});
  }
  void scatter(uint32_t n, int64_t x, int64_t y, uint32_t width, uint32_t height) {
    for (uint32_t i = 0; i < n; ++i) {
      const int64_t dx = random_.below(width);
      add(x + dx, y + random_.below(height));
    }
  }
  PointCloud take() {
    shuffle(cloud_.points, random_);
    return std::move(cloud_);
  }

 private:
  Random random_;
  PointCloud cloud_;
};

struct CloudKind {
  std::string name;
  PointCloud cloud;
};

class CloudKinds {
 public:
  template <class Make>
  void add(const std::string& name, const Make& make) {
    CloudMaker maker(kinds_.size() + 1);
    make(maker);
    kinds_.push_back({name, maker.take()});
  }
  std::vector<CloudKind> take() { return std::move(kinds_); }

 private:
  std::vector<CloudKind> kinds_;
};

inline void add_crowds(CloudKinds& kinds) {
  kinds.add("uniform", [](CloudMaker& m) { m.scatter(500, 0, 0, 3000, 2000); });
  kinds.add("clusters", [](CloudMaker& m) {
    m.scatter(200, 0, 0, 150, 150);
    m.scatter(200, 2500, 1800, 150, 150);
    m.scatter(100, 100, 1900, 60, 60);
  });
  kinds.add("a grid, also on borders and corners", [](CloudMaker& m) {
    for (int64_t i = 0; i < 24 * 24; ++i) m.add(i % 24 * 10, i / 24 * 10);
  });
  kinds.add("every place", [](CloudMaker& m) {
    for (int64_t i = 0; i < 20 * 20; ++i) m.add(i % 20, i / 20);
  });
  kinds.add("duplicates", [](CloudMaker& m) {
    for (int64_t i = 0; i < 3 * 16 * 16; ++i) m.add(i % 16 * 8, i / 16 % 16 * 8, i % 2);
  });
  kinds.add("points on lines", [](CloudMaker& m) {
    for (int64_t i = 0; i <= 100; ++i) {
      m.add(i * 10, 0);
      m.add(i * 10, 500);
      m.add(500, i * 10);
      m.add(i * 10, i * 10);
    }
  });
  kinds.add("a frame", [](CloudMaker& m) {
    m.scatter(150, 0, 0, 2000, 100);
    m.scatter(150, 0, 1900, 2000, 100);
    m.scatter(150, 0, 0, 100, 2000);
    m.scatter(150, 1900, 0, 100, 2000);
  });
}

inline void add_long_hulls(CloudKinds& kinds) {
  kinds.add("a slope that grazes tiles", [](CloudMaker& m) {
    for (int64_t i = 0; i < 300; ++i) m.add(i * 7, i * 7 + i % 3);
    m.add(300, 280);
  });
  kinds.add("a needle", [](CloudMaker& m) {
    for (int64_t i = 0; i < 120; ++i) m.add(i * 500, i * 3);
    m.add(59900, 357);
    m.add(1, 0);
  });
  kinds.add("one triangle", [](CloudMaker& m) {
    m.add(0, 0);
    m.add(200001, 70003);
    m.add(90007, 150001);
  });
  kinds.add("a triangle whose corners lie in tiles of their own", [](CloudMaker& m) {
    m.add(65534, 65537);
    m.add(0, 65534);
    m.add(131001, 65535);
    m.add(65536, 65540);
    m.add(65530, 0);
  });
  kinds.add("beyond 16 bits",
            [](CloudMaker& m) { m.scatter(400, -100000, 50000, 200000, 300000); });
  kinds.add("towns far apart", [](CloudMaker& m) {
    m.scatter(150, 0, 0, 1000, 1000);
    m.scatter(150, 120000, 40000, 1000, 1000);
    m.scatter(150, 10000, 70000, 1000, 1000);
  });
}

inline std::vector<CloudKind> cloud_kinds() {
  CloudKinds kinds;
  add_crowds(kinds);
  add_long_hulls(kinds);
  return kinds.take();
}

// About 2^31 steps long.
inline PointCloud long_cloud() {
  CloudMaker maker(77);
  maker.add(0, 0);
  maker.add(INT32_MAX, 5000);
  for (int64_t i = 0; i < 12; ++i) maker.scatter(2, i * 170000000, 0, 99999999, 5000);
  return maker.take();
}

// Every point, or those that a bound needs.
inline PackOptions point_options(int64_t bound, uint32_t max_vertices) {
  PackOptions options{{}, {}, max_vertices, 0};
  if (bound == 0) return options;
  options.lattice.max_error = Decimal{bound, 0};
  options.simplify.bounded = true;
  options.simplify.search = Search::kFast;
  return options;
}

}  // namespace microtin::tests

#endif
