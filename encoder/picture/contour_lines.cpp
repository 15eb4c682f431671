// SPDX-License-Identifier: MIT
// Strokes contours, and looks for straight stretches for their numbers.
#include "encoder/picture/contour_lines.hpp"

#include <string>

#include "encoder/picture/cover.hpp"
#include "encoder/picture/legend.hpp"
#include "encoder/picture/lettering.hpp"

namespace microtin::picture {
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

}  // namespace microtin::picture
