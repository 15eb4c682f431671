// SPDX-License-Identifier: MIT
// Draws reliefs and maps of errors, pixel by pixel.
#include "encoder/picture/maps.hpp"

#include <limits>
#include <map>
#include <set>

#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

// Light from the north-west on normals, colours by height, lines of triangles.

namespace {

constexpr Colour kLine{0.13, 0.17, 0.24}, kShadow{0.25, 0.29, 0.42}, kWhite{1, 1, 1};

double smooth_step(double low, double high, double t) {
  const double u = std::clamp((t - low) / (high - low), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

// How dark lines are at a place from the left (0) to the right (1).
double line_strength(double place) {
  return 0.55 * smooth_step(0.3, 0.7, place);
}

// A triangle in pixels, with a rule that gives a place on an edge to one of its two sides only.
class Outline {
 public:
  Outline(const std::array<uint32_t, 3>& corners, const std::array<Spot, 3>& spots)
      : corners_(corners), spots_(spots), area_(side(spots[0], spots[1], spots[2])) {}

  // The weights of the corners at a place, if that is inside.
  std::optional<std::array<double, 3>> weights(Spot p) const {
    std::array<double, 3> weights{};
    for (size_t i = 0; i < 3; ++i) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3;
      // Both triangles at an edge compute the same numbers.
      const bool turned = corners_[a] > corners_[b];
      const double raw = turned ? -side(spots_[b], spots_[a], p) : side(spots_[a], spots_[b], p);
      weights[i] = raw / area_;
      if (weights[i] < 0 || (raw == 0 && turned)) return std::nullopt;
    }
    return weights;
  }

  // The columns that a row of pixels may touch: first, and one behind the last.
  std::pair<double, double> columns(double row) const {
    double left = 1e9, right = -1e9;
    for (size_t i = 0; i < 3; ++i) {
      const Spot a = spots_[i], b = spots_[(i + 1) % 3];
      const auto [low, high] = std::minmax(a.y, b.y);
      if (high < row || low > row + 1) continue;
      for (const double y : {std::max(low, row), std::min(high, row + 1)}) {
        const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
        left = std::min({left, x, a.y == b.y ? b.x : x});
        right = std::max({right, x, a.y == b.y ? b.x : x});
      }
    }
    return {left, right};
  }

  double top() const { return std::min({spots_[0].y, spots_[1].y, spots_[2].y}); }
  double bottom() const { return std::max({spots_[0].y, spots_[1].y, spots_[2].y}); }

 private:
  static double side(Spot a, Spot b, Spot p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  }

  std::array<uint32_t, 3> corners_;
  std::array<Spot, 3> spots_;
  double area_;
};

// Where a pixel is looked at.
constexpr std::array<Spot, 4> kLooks = {
    {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}};

struct Sum {
  uint16_t r, g, b, looks;
};

void add(Sum& sum, Colour colour, uint16_t looks) {
  const auto scaled = [looks](double c) {
    return static_cast<uint16_t>(std::lround(std::clamp(c, 0.0, 1.0) * 255 * looks));
  };
  sum.r = static_cast<uint16_t>(sum.r + scaled(colour.r));
  sum.g = static_cast<uint16_t>(sum.g + scaled(colour.g));
  sum.b = static_cast<uint16_t>(sum.b + scaled(colour.b));
  sum.looks = static_cast<uint16_t>(sum.looks + looks);
}

std::array<Spot, 3> spots_of(const SurfaceModel& model, const std::array<uint32_t, 3>& triangle,
                             const MapFrame& frame) {
  std::array<Spot, 3> spots{};
  for (size_t i = 0; i < 3; ++i) {
    const auto& vertex = model.vertices[triangle[i]];
    spots[i] = frame.spot(static_cast<double>(vertex[0]), static_cast<double>(vertex[1]));
  }
  return spots;
}

// Calls visit(pixel, weights, looks) for what a triangle covers: the pixel's number in the frame,
// the mean weights of the corners there, and how many looks see the triangle.
template <class Visit>
void for_each_pixel_in(const Outline& outline, const MapFrame& frame, const Visit& visit) {
  const double bottom = std::min(outline.bottom(), frame.box.height);
  for (auto row = static_cast<uint32_t>(std::max(0.0, outline.top())); row < bottom; ++row) {
    const auto [left, right] = outline.columns(row);
    const double end = std::min(right, frame.box.width);
    for (auto column = static_cast<uint32_t>(std::max(0.0, left)); column < end; ++column) {
      std::array<double, 3> mean{};
      uint16_t looks = 0;
      for (const Spot look : kLooks) {
        const auto weights = outline.weights({column + look.x, row + look.y});
        if (!weights) continue;
        ++looks;
        for (size_t i = 0; i < 3; ++i) mean[i] += (*weights)[i];
      }
      if (looks == 0) continue;
      for (double& weight : mean) weight /= looks;
      visit(size_t{row} * frame.columns() + column, mean, looks);
    }
  }
}

}  // namespace

Relief::Relief(const SurfaceModel& model, const Ground& ground, std::optional<int64_t> water,
               PaletteKind palette)
    : model_(model),
      water_(water),
      lowest_(model.vertices.front()[2]),
      highest_(lowest_),
      palette_(palette, 0, 0) {
  for (const auto& vertex : model.vertices) {
    lowest_ = std::min(lowest_, vertex[2]);
    highest_ = std::max(highest_, vertex[2]);
  }
  const Axis& z = model.placement.z;
  palette_ = {palette, offset_of(z) + step_of(z) * static_cast<double>(lowest_),
              offset_of(z) + step_of(z) * static_cast<double>(highest_)};
  find_normals(ground);
}

bool Relief::has_water() const {
  return std::any_of(model_.triangles.begin(), model_.triangles.end(),
                     [this](const Triangle& triangle) { return is_water(triangle); });
}

bool Relief::is_water(const Triangle& triangle) const {
  return water_ && std::all_of(triangle.begin(), triangle.end(),
                               [this](uint32_t v) { return model_.vertices[v][2] == *water_; });
}

// Visits the upward normal, as long as twice the area, and the vertices of each triangle.
template <class Visit>
void Relief::for_each_normal(const Ground& ground, const Visit& visit) const {
  const auto from = [&](const Triangle& triangle, size_t corner) {
    const auto &a = model_.vertices[triangle[0]], &b = model_.vertices[triangle[corner]];
    return Vector{ground.x * static_cast<double>(b[0] - a[0]),
                  ground.y * static_cast<double>(b[1] - a[1]), static_cast<double>(b[2] - a[2])};
  };
  for (const Triangle& triangle : model_.triangles) {
    const Vector a = from(triangle, 1), b = from(triangle, 2);
    visit(cross_product(a, b), triangle);
  }
}

// Heights are scaled so that the mean slope is a pleasant one, whatever the units.
void Relief::find_normals(const Ground& ground) {
  constexpr double kMeanSlope = 0.45;
  double area = 0, slopes = 0;
  for_each_normal(ground, [&](const Vector& normal, const Triangle&) {
    area += normal.z;
    slopes += std::hypot(normal.x, normal.y);
  });
  if (slopes > 0) slope_scale_ = kMeanSlope * area / slopes;
  normals_.assign(model_.vertices.size(), {0, 0, 0});
  for_each_normal(ground, [&](const Vector& normal, const Triangle& triangle) {
    for (const uint32_t v : triangle) {
      Vector& sum = normals_[v];
      sum = {sum.x + slope_scale_ * normal.x, sum.y + slope_scale_ * normal.y, sum.z + normal.z};
    }
  });
}

Colour Relief::colour(const Triangle& triangle, const std::array<double, 3>& weights) const {
  if (is_water(triangle)) return kWater;
  constexpr Vector kLight{-0.53, 0.53, 0.66};
  Vector normal{0, 0, 0};
  double height = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Vector& n = normals_[triangle[i]];
    normal = {normal.x + weights[i] * n.x, normal.y + weights[i] * n.y,
              normal.z + weights[i] * n.z};
    height += weights[i] * static_cast<double>(model_.vertices[triangle[i]][2] - lowest_);
  }
  const double length = std::hypot(normal.x, normal.y, normal.z);
  const double light = (normal.x * kLight.x + normal.y * kLight.y + normal.z * kLight.z) /
                       (length * kLight.z);  // 1 on level ground
  const Colour base = palette_.at(height / std::max(1.0, static_cast<double>(highest_ - lowest_)));
  if (light >= 1) return mix(base, kWhite, std::min(1.0, (light - 1) * 0.9));
  return mix(base, kShadow, std::min(0.85, (1 - light) * 0.75));
}

void Relief::draw_ground(Canvas& canvas, const MapFrame& frame) const {
  std::vector<Sum> sums(size_t{frame.columns()} * frame.rows());
  for (const Triangle& triangle : model_.triangles) {
    const Outline outline(triangle, spots_of(model_, triangle, frame));
    for_each_pixel_in(outline, frame,
                      [&](size_t pixel, const std::array<double, 3>& weights, uint16_t looks) {
                        add(sums[pixel], colour(triangle, weights), looks);
                      });
  }
  const auto left = static_cast<uint32_t>(frame.box.left),
             top = static_cast<uint32_t>(frame.box.top);
  for (size_t pixel = 0; pixel < sums.size(); ++pixel) {
    const Sum& sum = sums[pixel];
    if (sum.looks == 0) continue;
    const double all = 255.0 * sum.looks;
    canvas.blend(left + static_cast<uint32_t>(pixel % frame.columns()),
                 top + static_cast<uint32_t>(pixel / frame.columns()),
                 {sum.r / all, sum.g / all, sum.b / all}, sum.looks / 4.0);
  }
}

// Short lines are faint, so that small triangles do not hide the ground.
void Relief::draw_lines(Canvas& canvas, const MapFrame& frame, double line_width) const {
  Cover cover(frame.box);
  for (const Triangle& triangle : model_.triangles) {
    const std::array<Spot, 3> spots = spots_of(model_, triangle, frame);
    for (size_t i = 0; i < 3; ++i) {
      const Spot a = spots[i], b = spots[(i + 1) % 3];
      cover.stroke(a, b, line_width,
                   smooth_step(line_width, 7 * line_width, std::hypot(b.x - a.x, b.y - a.y)));
    }
  }
  cover.blend(canvas, kLine,
              [&](uint32_t column) { return line_strength(column / frame.box.width); });
}

void Relief::draw_facets(Svg& svg, const MapFrame& frame) const {
  constexpr double kTones = 40;  // of each colour, so that many triangles have the same
  std::map<std::array<int, 3>, std::vector<const Triangle*>> by_tone;
  for (const Triangle& triangle : model_.triangles) {
    const Colour c = colour(triangle, {1.0 / 3, 1.0 / 3, 1.0 / 3});
    const auto tone = [](double part) { return static_cast<int>(std::lround(part * kTones)); };
    by_tone[{tone(c.r), tone(c.g), tone(c.b)}].push_back(&triangle);
  }
  for (const auto& [tone, triangles] : by_tone) {
    const Colour colour{tone[0] / kTones, tone[1] / kTones, tone[2] / kTones};
    for (const Triangle* const triangle : triangles) {
      const std::array<Spot, 3> spots = spots_of(model_, *triangle, frame);
      svg.area({frame.in_picture(spots[0]), frame.in_picture(spots[1]), frame.in_picture(spots[2])},
               colour);
    }
  }
}

void Relief::draw_wires(Svg& svg, const MapFrame& frame, double line_width) const {
  constexpr double kStrength = 0.3;
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const Triangle& triangle : model_.triangles) {
    for (size_t i = 0; i < 3; ++i) edges.insert(std::minmax(triangle[i], triangle[(i + 1) % 3]));
  }
  for (const auto& [a, b] : edges) {
    const std::array<Spot, 3> spots = spots_of(model_, {a, b, b}, frame);
    svg.line({frame.in_picture(spots[0]), frame.in_picture(spots[1])}, line_width, kLine,
             kStrength);
  }
}

// Colours each place by its error, and finds the largest.

namespace {

constexpr std::array<Colour, 3> kBelow = {
    {{0.96, 0.96, 0.95}, {0.50, 0.68, 0.84}, {0.10, 0.27, 0.53}}};
constexpr std::array<Colour, 3> kAbove = {
    {{0.96, 0.96, 0.95}, {0.92, 0.60, 0.45}, {0.62, 0.09, 0.12}}};
constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

// The pixels with their middles in a range, at least the one that the range is in.
std::pair<uint32_t, uint32_t> pixels(double middle, double reach, uint32_t count) {
  const auto within = [count](double at) {
    return static_cast<uint32_t>(std::clamp<double>(at, 0, count));
  };
  constexpr double kSlack = 1e-6;  // rounding must not part neighbours
  const uint32_t first = within(std::ceil(middle - reach - 0.5 - kSlack));
  const uint32_t end = within(std::ceil(middle + reach - 0.5 + kSlack));
  if (first < end) return {first, end};
  const uint32_t own = std::min(within(std::floor(middle)), count - 1);
  return {own, own + 1};
}

double whole_steps(double cell) {
  return std::max(1.0, std::ceil(cell - 1e-9));
}

}  // namespace

Colour error_colour(double relative) {
  const auto& colours = relative < 0 ? kBelow : kAbove;
  const double at = 2 * std::min(1.0, std::abs(relative));
  return at < 1 ? mix(colours[0], colours[1], at) : mix(colours[1], colours[2], at - 1);
}

ErrorMap::ErrorMap(const MapFrame& frame, Spot cell)
    : frame_(frame),
      reach_{whole_steps(cell.x) / frame.x_step / 2, whole_steps(cell.y) / frame.y_step / 2},
      errors_(size_t{frame.columns()} * frame.rows(), kNotMeasured) {}

void ErrorMap::add(double x, double y, double above) {
  const Spot spot = frame_.spot(x, y);
  const auto [left, right] = pixels(spot.x, reach_.x, frame_.columns());
  const auto [top, bottom] = pixels(spot.y, reach_.y, frame_.rows());
  const auto error = static_cast<float>(above);
  for (uint32_t row = top; row < bottom; ++row) {
    for (uint32_t column = left; column < right; ++column) {
      float& old = errors_[size_t{row} * frame_.columns() + column];
      if (!(std::abs(old) >= std::abs(error))) old = error;
    }
  }
}

void ErrorMap::draw(Canvas& canvas, double scale) const {
  for (uint32_t row = 0; row < frame_.rows(); ++row) {
    for (uint32_t column = 0; column < frame_.columns(); ++column) {
      const double error = errors_[size_t{row} * frame_.columns() + column];
      if (std::isnan(error)) continue;
      canvas.blend(static_cast<uint32_t>(frame_.box.left) + column,
                   static_cast<uint32_t>(frame_.box.top) + row, error_colour(error / scale), 1);
    }
  }
}

}  // namespace microtin::picture
