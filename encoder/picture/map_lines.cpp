// SPDX-License-Identifier: MIT
// Finds contours triangle by triangle, and draws lines.
#include "encoder/picture/map_lines.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>

#include "encoder/base/error.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"

namespace microtin::picture {

// Cuts each triangle at the levels between its vertices, and joins the pieces at the edges.

namespace {

constexpr size_t kMostPieces = 5'000'000;
constexpr uint32_t kNone = UINT32_MAX;

// An edge at a level: lower vertex number first.
struct Crossing {
  int64_t level;
  uint32_t a, b;

  bool operator==(const Crossing& other) const {
    return level == other.level && a == other.a && b == other.b;
  }
};

struct CrossingHash {
  size_t operator()(const Crossing& c) const {
    const uint64_t edge = uint64_t{c.a} << 32 | c.b;
    return static_cast<size_t>(
        (edge ^ static_cast<uint64_t>(c.level) << 20) * 0x9E3779B97F4A7C15U >> 16);
  }
};

// A crossing, and the crossings that pieces of its line lead to: one at a border, else two.
struct Joint {
  Crossing at;
  std::array<uint32_t, 2> next;
};

class Cutter {
 public:
  Cutter(const SurfaceModel& model, Decimal interval) : model_(model) {
    const Axis& z = model.placement.z;
    step_ = Wide{z.numerator} * power_of_ten(interval.decimals);
    offset_ = Wide{z.offset} * power_of_ten(interval.decimals);
    interval_ = Wide{interval.mantissa} * static_cast<Wide>(z.denominator);
    for (const auto& triangle : model.triangles) cut(triangle);
  }

  std::vector<Contour> lines() {
    std::vector<Contour> all;
    for (const bool closed : {false, true}) {  // those with ends first: from their ends
      for (uint32_t joint = 0; joint < joints_.size(); ++joint) {
        const bool is_end = joints_[joint].next[1] == kNone;
        if (!followed_[joint] && is_end != closed) all.push_back(follow(joint, closed));
      }
    }
    return all;
  }

 private:
  // The highest level below a height: |offset + z * step| < 2^63 * 10^18 is a Wide.
  int64_t level_below(int64_t z) const {
    const Wide level = ceil_divide(offset_ + z * step_, interval_) - 1;
    if (magnitude(level) > INT32_MAX)
      throw Error("the interval of contours is too small; use a larger one");
    return static_cast<int64_t>(level);
  }

  void cut(const std::array<uint32_t, 3>& triangle) {
    std::array<int64_t, 3> below{};
    for (size_t i = 0; i < 3; ++i) below[i] = level_below(model_.vertices[triangle[i]][2]);
    const auto [low, high] = std::minmax_element(below.begin(), below.end());
    for (int64_t level = *low + 1; level <= *high; ++level) {
      std::array<uint32_t, 2> ends{};
      size_t count = 0;
      for (size_t i = 0; i < 3; ++i) {  // two of the three edges are crossed
        const size_t j = (i + 1) % 3;
        if ((below[i] < level) == (below[j] < level)) continue;
        ends[count++] = joint_at(
            {level, std::min(triangle[i], triangle[j]), std::max(triangle[i], triangle[j])});
      }
      connect(ends[0], ends[1]);
      connect(ends[1], ends[0]);
    }
  }

  uint32_t joint_at(const Crossing& at) {
    const auto [found, is_new] = numbers_.emplace(at, static_cast<uint32_t>(joints_.size()));
    if (is_new) {
      if (joints_.size() == kMostPieces)
        throw Error("the interval of contours is too small; use a larger one");
      joints_.push_back({at, {kNone, kNone}});
      followed_.push_back(false);
    }
    return found->second;
  }

  void connect(uint32_t from, uint32_t to) {
    std::array<uint32_t, 2>& next = joints_[from].next;
    next[next[0] == kNone ? 0 : 1] = to;
  }

  // Both triangles at an edge find the same place.
  Spot place(const Crossing& at) const {
    const auto &a = model_.vertices[at.a], &b = model_.vertices[at.b];
    const Wide above = at.level * interval_ - offset_ - a[2] * step_;
    const double t = static_cast<double>(above) /
                     (static_cast<double>(b[2] - a[2]) * static_cast<double>(step_));
    const auto along = [&](size_t axis) {
      return static_cast<double>(a[axis]) + t * static_cast<double>(b[axis] - a[axis]);
    };
    return {along(0), along(1)};
  }

  Contour follow(uint32_t start, bool closed) {
    Contour line{joints_[start].at.level, {}};
    for (uint32_t at = start; at != kNone && !followed_[at];) {
      followed_[at] = true;
      line.places.push_back(place(joints_[at].at));
      const std::array<uint32_t, 2>& next = joints_[at].next;
      const bool first_is_done = next[0] == kNone || followed_[next[0]];
      at = first_is_done ? next[1] : next[0];
    }
    if (closed) line.places.push_back(line.places.front());
    return line;
  }

  const SurfaceModel& model_;
  Wide step_, offset_, interval_;  // of heights, all over one denominator
  std::vector<Joint> joints_;
  std::vector<bool> followed_;
  std::unordered_map<Crossing, uint32_t, CrossingHash> numbers_;
};

}  // namespace

std::optional<Decimal> round_interval(double low, double high) {
  constexpr int kLines = 10, kDecimals = kMaxDecimals;
  if (!(high > low)) return std::nullopt;
  const double interval = round_length((high - low) / kLines);
  const double mantissa = std::round(interval * static_cast<double>(power_of_ten(kDecimals)));
  return make_decimal(static_cast<int64_t>(std::clamp(mantissa, 1.0, 9e17)), kDecimals);
}

std::vector<Contour> contours_of(const SurfaceModel& model, Decimal interval) {
  return Cutter(model, interval).lines();
}

// Strokes contours, and looks for straight stretches for their numbers.

namespace {

constexpr Colour kOnLand{0.36, 0.22, 0.10}, kInSea{0.02, 0.08, 0.24};
constexpr double kLabelSize = 0.8;  // of the legend's text

using Line = std::vector<Spot>;  // in pixels, from the corner of the map

Line line_of(const Contour& contour, const MapFrame& frame) {
  Line line;
  for (const Spot place : contour.places) line.push_back(frame.spot(place.x, place.y));
  return line;
}

double distance(Spot a, Spot b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

double length_of(const Line& line) {
  double length = 0;
  for (size_t i = 0; i + 1 < line.size(); ++i) length += distance(line[i], line[i + 1]);
  return length;
}

struct Label {
  Spot middle, along;
};

// Keeps labels inside of the map, and apart.
class LabelRoom {
 public:
  LabelRoom(const MapFrame& frame, double apart) : frame_(frame), apart_(apart) {}

  void occupy(Spot place) { taken_.push_back(place); }

  // The straightest stretch of a line that is so long, if one is straight enough; takes its room.
  std::optional<Label> take(const Line& line, double length) {
    constexpr double kStraight = 0.93;
    double best = kStraight;
    std::optional<Label> found;
    if (length_of(line) < 3 * length) return found;  // it would hide the hill
    for (size_t first = 0, last = 0; last < line.size(); ++first) {
      double path = 0;
      for (last = first + 1; last < line.size() && path < length; ++last) {
        path += distance(line[last - 1], line[last]);
      }
      if (path < length) break;
      const Spot a = line[first], b = line[last - 1];
      const double chord = distance(a, b);
      if (chord / path <= best || !is_free(a, b, length)) continue;
      best = chord / path;
      found = label_on(a, b);
      if (best > 0.99) break;
    }
    if (found) occupy(found->middle);
    return found;
  }

 private:
  static Label label_on(Spot a, Spot b) {
    const double length = distance(a, b), sign = b.x < a.x ? -1 : 1;
    return {{(a.x + b.x) / 2, (a.y + b.y) / 2},
            {sign * (b.x - a.x) / length, sign * (b.y - a.y) / length}};
  }

  bool is_free(Spot a, Spot b, double length) const {
    const Spot middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
    const double edge = 0.6 * length;
    return middle.x > edge && middle.x < frame_.box.width - edge && middle.y > edge &&
           middle.y < frame_.box.height - edge &&
           std::all_of(taken_.begin(), taken_.end(),
                       [&](Spot other) { return distance(middle, other) > apart_; });
  }

  MapFrame frame_;
  double apart_;
  std::vector<Spot> taken_;
};

// With the decimals that all of multiples of `every` intervals need.
std::string height_of(int64_t level, Decimal interval, int64_t every) {
  const auto times = [interval](int64_t count) {
    return make_decimal(Wide{count} * interval.mantissa, interval.decimals);
  };
  return grouped(real(times(level)), times(every).decimals);
}

void draw_label(Drawing& drawing, const PixelBox& box, const std::string& text, const Label& label,
                double unit, Colour colour) {
  const double back = unit * text_width(text) / 2, down = unit * kCapHeight / 2;
  const Spot start{box.left + label.middle.x - back * label.along.x - down * label.along.y,
                   box.top + label.middle.y - back * label.along.y + down * label.along.x};
  draw_text(drawing, text, start, unit, kHalo, label.along, 3.2);
  draw_text(drawing, text, start, unit, colour, label.along, 1);
}

}  // namespace

Colour colour_of(const ContourLine& line) {
  return line.is_sea ? kInSea : kOnLand;
}

std::vector<ContourLine> contour_lines(const MapFrame& frame, const std::vector<Contour>& contours,
                                       PaletteKind palette, double unit) {
  const double thin = 0.55 * std::sqrt(unit);
  std::vector<ContourLine> lines;
  for (const Contour& contour : contours) {
    const bool heavy = is_index(contour);
    lines.push_back({line_of(contour, frame), (heavy ? 1.9 : 1) * thin, heavy ? 0.85 : 0.6,
                     palette == PaletteKind::kSea && contour.level < 0});
  }
  return lines;
}

void draw_contours(Canvas& canvas, const MapFrame& frame, const std::vector<ContourLine>& lines) {
  Cover land(frame.box), sea(frame.box);
  for (const ContourLine& line : lines) {
    for (size_t i = 0; i + 1 < line.places.size(); ++i) {
      (line.is_sea ? sea : land)
          .stroke(line.places[i], line.places[i + 1], line.width, line.strength);
    }
  }
  land.blend(canvas, kOnLand, [](uint32_t) { return 1; });
  sea.blend(canvas, kInSea, [](uint32_t) { return 1; });
}

void label_contours(Drawing& drawing, const MapFrame& frame, const std::vector<Contour>& contours,
                    const std::vector<ContourLine>& lines, Decimal interval, double unit,
                    std::optional<Spot> occupied) {
  const double size = kLabelSize * unit;
  const bool has_index = std::any_of(contours.begin(), contours.end(), is_index);
  LabelRoom room(frame, 60 * unit);
  if (occupied) room.occupy({occupied->x - frame.box.left, occupied->y - frame.box.top});
  for (size_t i = 0; i < contours.size(); ++i) {
    if (has_index && !is_index(contours[i])) continue;
    const std::string text = height_of(contours[i].level, interval, has_index ? kIndexContour : 1);
    const std::optional<Label> label = room.take(lines[i].places, size * (text_width(text) + 6));
    if (label) draw_label(drawing, frame.box, text, *label, size, colour_of(lines[i]));
  }
}

// Draws lines of a terrain.

namespace {

constexpr double kLineWidth = 1.6;  // units

Colour colour_of_line(LineClass kind) {
  switch (kind) {
    case LineClass::kRidge:
      return {0.43, 0.24, 0.10};
    case LineClass::kValley:
      return {0.13, 0.45, 0.40};
    case LineClass::kWater:
      return {0.07, 0.33, 0.72};
    case LineClass::kCliff:
      return {0.30, 0.30, 0.34};
    case LineClass::kDam:
      return {0.45, 0.12, 0.50};
    case LineClass::kWall:
    case LineClass::kBuilding:
      return {0.10, 0.10, 0.10};
    case LineClass::kRoad:
    case LineClass::kRailway:
      return {0.80, 0.33, 0.05};
    case LineClass::kRunway:
      return {0.72, 0.05, 0.20};
    case LineClass::kBorder:
      return {0.18, 0.42, 0.12};
    case LineClass::kOther:
      break;
  }
  return {0.78, 0.08, 0.08};
}

}  // namespace

void draw_marked_lines(Drawing& drawing, const MapFrame& frame, const SurfaceModel& model,
                       const std::vector<MarkedLine>& lines, double unit) {
  const auto spot_of = [&](uint32_t v) {
    const auto& place = model.vertices[v];
    return frame.in_picture(
        frame.spot(static_cast<double>(place[0]), static_cast<double>(place[1])));
  };
  for (const MarkedLine& line : lines) {
    for (std::size_t i = 1; i < line.vertices.size(); ++i) {
      drawing.stroke(spot_of(line.vertices[i - 1]), spot_of(line.vertices[i]), kLineWidth * unit,
                     colour_of_line(line.kind));
    }
  }
}

}  // namespace microtin::picture
