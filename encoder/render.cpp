#include "encoder/render.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "encoder/error.hpp"
#include "encoder/png.hpp"
#include "encoder/tint.hpp"

namespace microtin {
namespace {

double smooth_step(double low, double high, double t) {
  const double u = std::clamp((t - low) / (high - low), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

// Light comes from the north-west.
constexpr Vector kWater{0.47, 0.66, 0.76};
constexpr Vector kLine{0.13, 0.17, 0.24};
constexpr Vector kShadow{0.25, 0.29, 0.42};
constexpr Vector kLight{-0.53, 0.53, 0.66};

// A mesh with what shading needs: vertices as vectors, one normal for each.
class Relief {
 public:
  explicit Relief(const microtin_mesh* mesh) : mesh_(mesh) {
    for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
      uint16_t x, y;
      int16_t z;
      microtin_vertex(mesh, v, &x, &y, &z);
      places_.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    if (places_.empty()) throw Error("there is nothing to draw");
    low_ = high_ = places_.front();
    for (const Vector& p : places_) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    find_normals();
  }

  const microtin_mesh* mesh() const { return mesh_; }
  Vector low() const { return low_; }
  Vector high() const { return high_; }

  // The colour of the triangle at p, without its lines.
  Vector colour(const std::array<uint32_t, 3>& triangle, Vector p) const {
    const auto [a, b, c] = triangle;
    const double whole = area(places_[a], places_[b], places_[c]);
    const double wb = area(places_[c], places_[a], p) / whole;
    const double wc = area(places_[a], places_[b], p) / whole;
    const Vector normal =
        normalised((1 - wb - wc) * normals_[a] + wb * normals_[b] + wc * normals_[c]);
    const double light = dot(normal, kLight) / kLight.z;  // 1 on level ground
    const bool water = places_[a].z == low_.z && places_[b].z == low_.z && places_[c].z == low_.z;
    const double relative = (p.z - low_.z) / std::max(1.0, high_.z - low_.z);
    const Vector base = water ? kWater : tint(relative);
    if (light >= 1) return mix(base, {1, 1, 1}, std::min(1.0, (light - 1) * 0.9));
    return mix(base, kShadow, std::min(0.85, (1 - light) * 0.75));
  }

  // The distance from p to the nearest edge of the triangle around it.
  double edge_distance(const std::array<uint32_t, 3>& triangle, Vector p) const {
    double nearest = 1e9;
    for (size_t i = 0; i < 3; ++i) {
      const Vector a = places_[triangle[i]], b = places_[triangle[(i + 1) % 3]];
      nearest = std::min(nearest, area(a, b, p) / std::hypot(b.x - a.x, b.y - a.y));
    }
    return nearest;
  }

 private:
  // Twice the area of (a, b, c) seen from above.
  static double area(Vector a, Vector b, Vector c) { return cross_product(b - a, c - a).z; }

  // Heights are scaled so that the mean slope is a pleasant one, whatever the units.
  void find_normals() {
    constexpr double kMeanSlope = 0.45;
    double ground = 0, slopes = 0;
    for_each_triangle([&](Vector normal, const uint32_t*) {
      ground += normal.z;
      slopes += std::hypot(normal.x, normal.y);
    });
    const double scale = slopes > 0 ? kMeanSlope * ground / slopes : 1;
    normals_.assign(places_.size(), {0, 0, 0});
    for_each_triangle([&](Vector normal, const uint32_t* v) {
      const Vector scaled{scale * normal.x, scale * normal.y, normal.z};
      for (int i = 0; i < 3; ++i) normals_[v[i]] = normals_[v[i]] + scaled;
    });
  }

  // Visits the upward normal, as long as twice the area, and the vertices of each real triangle.
  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    for (uint32_t t = 0; t < microtin_triangle_count(mesh_); ++t) {
      uint32_t v[3];
      if (microtin_triangle(mesh_, t, v) != MICROTIN_REAL) continue;
      const Vector a = places_[v[0]];
      visit(cross_product(places_[v[1]] - a, places_[v[2]] - a), v);
    }
  }

  const microtin_mesh* mesh_;
  std::vector<Vector> places_, normals_;
  Vector low_, high_;
};

// Colours the pixel of `size` lattice units around a place, triangle lines at the given strength.
void paint(const Relief& relief, Vector place, double size, double lines, uint32_t& hint,
           uint8_t* rgba) {
  int32_t z = 0;
  const auto x = static_cast<int32_t>(place.x * 256), y = static_cast<int32_t>(place.y * 256);
  if (microtin_height_at(relief.mesh(), x, y, 0, &hint, &z) != MICROTIN_HEIGHT) return;
  place.z = z / 65536.0;
  std::array<uint32_t, 3> triangle;
  if (microtin_triangle(relief.mesh(), hint, triangle.data()) != MICROTIN_REAL) return;
  const double line = std::clamp(1.1 - relief.edge_distance(triangle, place) / size, 0.0, 1.0);
  const Vector colour = mix(relief.colour(triangle, place), kLine, lines * line);
  rgba[0] = static_cast<uint8_t>(std::lround(colour.x * 255));
  rgba[1] = static_cast<uint8_t>(std::lround(colour.y * 255));
  rgba[2] = static_cast<uint8_t>(std::lround(colour.z * 255));
  rgba[3] = 255;
}

}  // namespace

std::vector<uint8_t> render_png(const microtin_mesh* mesh, uint32_t width) {
  constexpr uint32_t kLargest = 16384;
  const Relief relief(mesh);
  const double scale = (relief.high().x - relief.low().x) / width;  // lattice units per pixel
  const double rows = std::max(1.0, std::round((relief.high().y - relief.low().y) / scale));
  if (width == 0 || width > kLargest || rows > kLargest) {
    throw Error("a picture has 1 to 16384 pixels in width and height");
  }
  const auto height = static_cast<uint32_t>(rows);
  std::vector<uint8_t> rgba(size_t{4} * width * height);
  uint32_t hint = 0;
  for (uint32_t row = 0; row < height; ++row) {
    for (uint32_t column = 0; column < width; ++column) {
      const Vector place{relief.low().x + (column + 0.5) * scale,
                         relief.high().y - (row + 0.5) * scale, 0};
      const double lines = 0.55 * smooth_step(0.3, 0.7, static_cast<double>(column) / width);
      paint(relief, place, scale, lines, hint, &rgba[4 * (size_t{row} * width + column)]);
    }
  }
  return png(rgba, width, height);
}

}  // namespace microtin
