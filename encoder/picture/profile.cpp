// SPDX-License-Identifier: MIT
// Lays out a profile and draws it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "encoder/picture/render.hpp"

namespace microtin::picture {
namespace {

using encoder::LineOfSight;
using encoder::Profile;
using encoder::ProfilePlace;
using encoder::Sight;

constexpr Colour kBackground{1, 1, 1}, kSoil{0.80, 0.74, 0.62}, kGround{0.42, 0.33, 0.22},
    kAbsent{0.86, 0.86, 0.87}, kFree{0.13, 0.50, 0.28}, kInTheWay{0.78, 0.16, 0.14},
    kDoubtful{0.45, 0.45, 0.48}, kZone{0.30, 0.47, 0.74};

// In units of the text.
constexpr double kLeft = 44, kRight = 12, kTop = 26, kBottom = 26, kTick = 3;

Colour colour_of(Sight sight) {
  return sight == Sight::kClear ? kFree : sight == Sight::kBlocked ? kInTheWay : kDoubtful;
}

// From a length above 0, also where all heights are one.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool is_empty() const { return low > high; }
  void widen() {
    const double room = std::max((high - low) * 0.06, 1.0);
    low -= room;
    high += room;
  }
};

class ProfileSheet {
 public:
  ProfileSheet(const ProfilePicture& picture, uint32_t width)
      : picture_(picture), profile_(picture.profile), width_(width) {
    unit_ = std::max(1.1, width / 760.0);
    height_ = static_cast<uint32_t>(std::max(0.45 * width, 120.0));
    box_ = {std::round(kLeft * unit_), std::round(kTop * unit_), 0, 0};
    box_.width = std::max(1.0, width - box_.left - std::round(kRight * unit_));
    box_.height = std::max(1.0, height_ - box_.top - std::round(kBottom * unit_));
    spread_ = spread();
  }

  uint32_t height() const { return height_; }

  // Below the ground: parts of the line whose heights are known, as curves of pixels.
  std::vector<std::vector<Spot>> grounds() const {
    std::vector<std::vector<Spot>> curves;
    for (size_t i = 1; i < profile_.places.size(); ++i) {
      const ProfilePlace &a = profile_.places[i - 1], &b = profile_.places[i];
      if (!b.is_known_before) continue;
      if (curves.empty() || !profile_.places[i - 1].is_known_before) curves.emplace_back();
      for (const double part : parts(a.distance, b.distance)) {
        const double distance = a.distance * (1 - part) + b.distance * part;
        curves.back().push_back(
            spot(distance, a.height * (1 - part) + b.height * part + bulge(distance)));
      }
    }
    return curves;
  }

  double floor() const { return box_.top + box_.height; }

  void draw_back(Drawing& drawing) const {
    for (size_t i = 1; i < profile_.places.size(); ++i) {
      if (profile_.places[i].is_known_before) continue;
      const double left = spot(profile_.places[i - 1].distance, 0).x;
      const double right = spot(profile_.places[i].distance, 0).x;
      drawing.fill({left, box_.top, right - left, box_.height}, kAbsent);
    }
  }

  void draw_front(Drawing& drawing) const {
    for (const auto& curve : grounds()) draw_curve(drawing, curve, 1.4, kGround);
    drawing.outline(box_, std::max(1.0, 0.6 * unit_), kInk);
    draw_distances(drawing);
    draw_heights(drawing);
    draw_title(drawing);
    if (picture_.sight && !std::isnan(picture_.sight->from) && !std::isnan(picture_.sight->to)) {
      draw_sight(drawing, *picture_.sight);
    }
  }

 private:
  static double ray_at(const LineOfSight& sight, double part) {
    return sight.from * (1 - part) + sight.to * part;
  }
  double bulge(double distance) const {
    return picture_.sight ? earth_bulge(profile_, picture_.options, distance) : 0;
  }
  double radius(double distance) const {
    return fresnel_radius(profile_, picture_.options, distance);
  }

  Range spread() const {
    Range range;
    for (const ProfilePlace& place : profile_.places) {
      if (!std::isnan(place.height)) range.add(place.height + bulge(place.distance));
    }
    if (picture_.sight && !std::isnan(picture_.sight->from) && !std::isnan(picture_.sight->to)) {
      constexpr double kParts = 64;
      for (int i = 0; i <= kParts; ++i) {
        const double ray = ray_at(*picture_.sight, i / kParts);
        const double zone = radius(profile_.length * i / kParts);
        range.add(ray - zone);
        range.add(ray + zone);
      }
    }
    if (range.is_empty()) range.add(0);
    range.widen();
    return range;
  }

  Spot spot(double distance, double height) const {
    const double along = profile_.length > 0 ? distance / profile_.length : 0;
    const double up = (height - spread_.low) / (spread_.high - spread_.low);
    return {box_.left + along * box_.width, box_.top + (1 - up) * box_.height};
  }

  // Fractions of a part of the line, so near each other that the Earth looks round.
  std::vector<double> parts(double begin, double end) const {
    const double pixels = spot(end, 0).x - spot(begin, 0).x;
    const int count = 1 + static_cast<int>(std::min(pixels / 4, double{box_.width}));
    std::vector<double> fractions;
    for (int i = 0; i <= count; ++i) fractions.push_back(static_cast<double>(i) / count);
    return fractions;
  }

  void draw_curve(Drawing& drawing, const std::vector<Spot>& curve, double pen,
                  Colour colour) const {
    for (size_t i = 1; i < curve.size(); ++i) {
      drawing.stroke(curve[i - 1], curve[i], pen * std::sqrt(unit_), colour);
    }
  }

  // The zone on both sides of the ray, or on the lower one.
  void draw_zone(Drawing& drawing, const LineOfSight& sight, double share, double pen) const {
    constexpr double kParts = 128;
    std::vector<Spot> curve;
    for (int i = 0; i <= kParts; ++i) {
      const double distance = profile_.length * i / kParts;
      curve.push_back(spot(distance, ray_at(sight, i / kParts) + share * radius(distance)));
    }
    draw_curve(drawing, curve, pen, kZone);
  }

  void draw_sight(Drawing& drawing, const LineOfSight& sight) const {
    if (picture_.options.frequency > 0) {
      draw_zone(drawing, sight, 1, 0.8);
      draw_zone(drawing, sight, -1, 0.8);
      draw_zone(drawing, sight, -picture_.options.zone_share, 1.4);
    }
    const Spot from = spot(0, sight.from), to = spot(profile_.length, sight.to);
    draw_curve(drawing, {from, to}, 1.6, colour_of(sight.line));
    const bool is_zone = std::isnan(sight.first_obstruction);
    const double first = is_zone ? sight.first_zone_obstruction : sight.first_obstruction;
    if (std::isnan(first)) return;
    const double part = profile_.length > 0 ? first / profile_.length : 0;
    const double share = is_zone ? picture_.options.zone_share : 0;
    const Spot at = spot(first, ray_at(sight, part) - share * radius(first));
    draw_curve(drawing,
               {{at.x - 3 * unit_, at.y - 3 * unit_}, {at.x + 3 * unit_, at.y + 3 * unit_}}, 1.6,
               kInTheWay);
    draw_curve(drawing,
               {{at.x - 3 * unit_, at.y + 3 * unit_}, {at.x + 3 * unit_, at.y - 3 * unit_}}, 1.6,
               kInTheWay);
  }

  // Calls visit(value, text) for the round numbers between `low` and `high`, which lie at least
  // `apart` from each other.
  template <class Visit>
  static void for_round(double low, double high, double apart, const Visit& visit) {
    if (!(high > low) || !(apart > 0)) return;
    double step = round_length(apart);
    while (step < apart) step = round_length(step * 2.5);
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
      visit(k * step, grouped(k * step, decimals_for(step)));
    }
  }

  void draw_distances(Drawing& drawing) const {
    const bool far = profile_.length >= 10000;
    const double size = far ? 1000 : 1;
    const double end = profile_.length / size;
    const double y = floor();
    for_round(0, end, 70 * unit_ / box_.width * end, [&](double at, const std::string& text) {
      const double x = spot(at * size, 0).x;
      drawing.fill({x - 0.4 * unit_, y, 0.8 * unit_, kTick * unit_}, kInk);
      draw_text(drawing, text, {x - unit_ * text_width(text) / 2, y + 12 * unit_}, unit_, kInk);
    });
    const std::string name = far ? "km" : "m";
    draw_text(drawing, name, {box_.left + box_.width - unit_ * text_width(name), y + 22 * unit_},
              unit_, kInk);
  }

  void draw_heights(Drawing& drawing) const {
    const double apart = 26 * unit_ / box_.height * (spread_.high - spread_.low);
    for_round(spread_.low, spread_.high, apart, [&](double at, const std::string& text) {
      const double y = spot(0, at).y;
      drawing.fill({box_.left - kTick * unit_, y - 0.4 * unit_, kTick * unit_, 0.8 * unit_}, kInk);
      draw_text(drawing, text,
                {box_.left - (kTick + 3 + text_width(text)) * unit_, y + 3.5 * unit_}, unit_, kInk);
    });
  }

  void draw_title(Drawing& drawing) const {
    const std::string symbol(symbol_of(picture_.vertical));
    std::string text = "heights" + (symbol.empty() ? symbol : " in " + symbol);
    if (picture_.sight) {
      text += std::string(", line of sight ") + name_of(picture_.sight->line);
      if (picture_.options.frequency > 0) {
        text += ", " + rounded_text(100 * picture_.options.zone_share) +
                " per cent of the Fresnel zone " + name_of(picture_.sight->zone);
      }
    }
    const double fit = std::min(1.0, (width_ - 2 * 10 * unit_) / (unit_ * text_width(text)));
    draw_text(drawing, text, {10 * unit_, 16 * unit_}, unit_ * fit, kInk);
  }

  const ProfilePicture& picture_;
  const Profile& profile_;
  uint32_t width_, height_;
  double unit_;
  PixelBox box_{};
  Range spread_;
};

// In whole columns of pixels, which begin and end with the curve.
void fill_below(Canvas& canvas, const std::vector<Spot>& curve, double floor) {
  size_t next = 1;
  for (double left = curve.front().x; left < curve.back().x;) {
    const double right = std::min(curve.back().x, std::floor(left) + 1);
    const double middle = (left + right) / 2;
    while (curve[next].x < middle) ++next;
    const Spot a = curve[next - 1], b = curve[next];
    const double part = b.x > a.x ? (middle - a.x) / (b.x - a.x) : 0;
    const double top = a.y * (1 - part) + b.y * part;
    canvas.fill({left, top, right - left, floor - top}, kSoil);
    left = right;
  }
}

}  // namespace

std::vector<uint8_t> profile_png(const ProfilePicture& picture, uint32_t width) {
  const ProfileSheet sheet(picture, width);
  Canvas canvas(width, sheet.height(), kBackground);
  sheet.draw_back(canvas);
  for (const auto& curve : sheet.grounds()) fill_below(canvas, curve, sheet.floor());
  sheet.draw_front(canvas);
  return png(canvas.rgb(), canvas.width(), canvas.height());
}

std::string profile_svg(const ProfilePicture& picture, uint32_t width) {
  const ProfileSheet sheet(picture, width);
  Svg svg(width, sheet.height(), kBackground);
  sheet.draw_back(svg);
  for (std::vector<Spot> area : sheet.grounds()) {
    const double right = area.back().x, left = area.front().x;
    area.push_back({right, sheet.floor()});
    area.push_back({left, sheet.floor()});
    svg.area(area, kSoil);
  }
  sheet.draw_front(svg);
  return svg.take();
}

}  // namespace microtin::picture
