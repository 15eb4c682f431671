// SPDX-License-Identifier: MIT
// Lays out maps, legends and title, and draws them.
#include "encoder/picture/render.hpp"

#include <sstream>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "encoder/picture/map_lines.hpp"
#include "encoder/picture/maps.hpp"

namespace microtin::picture {
namespace {

constexpr Colour kPaper{1, 1, 1}, kNoTerrain{0.66, 0.66, 0.67}, kHatch{0.53, 0.53, 0.54};

// In units of the text.
constexpr double kMargin = 10, kLegendHeight = 36, kRampShare = 0.56, kBarAt = 0.66,
                 kTitleSize = 1.6;  // of other text

std::string unit_text(Unit unit) {
  const std::string symbol(symbol_of(unit));
  return symbol.empty() ? symbol : " " + symbol;
}

// The step of heights at the water level, if that is one.
std::optional<int64_t> water_step(const Metadata& metadata) {
  if (!metadata.water_level) return std::nullopt;
  const Axis& z = metadata.placement.z;
  const Wide tens = power_of_ten(metadata.water_level->decimals);
  const Wide distance = Wide{metadata.water_level->mantissa} * static_cast<Wide>(z.denominator) -
                        Wide{z.offset} * tens;
  const Wide step = static_cast<Wide>(z.numerator) * tens;
  if (distance % step != 0 || magnitude(distance / step) > INT16_MAX + 1) return std::nullopt;
  return static_cast<int64_t>(distance / step);
}

// Where everything goes.
struct Layout {
  double unit;  // pixels
  double room;  // for a map, pixels wide
  MapFrame relief, errors;
  uint32_t width, height;
};

// What stands above the map, in units.
double head_of(const Portrait& portrait) {
  return 2 * kMargin + kCapHeight + (portrait.title.empty() ? 0 : 20) +
         (portrait.coordinates ? kFrameRoom : 0);
}

Layout lay_out(const Portrait& portrait, const Ground& ground, uint32_t width, bool two) {
  constexpr double kTallest = 1.6, kNarrowestRoom = 250, kWide = 2.2;
  Layout layout{};
  layout.width = width;
  layout.unit = std::max(1.1, width / 760.0);
  const double margin = std::round(kMargin * layout.unit);
  const double numbers = std::round(portrait.coordinates ? kFrameRoom * layout.unit : 0);
  const double left = margin + numbers;
  const double head = std::round(head_of(portrait) * layout.unit);
  const double whole = width - left - margin, half = std::floor((whole - 2 * margin) / 2);
  const MapFrame large = fit_map(portrait.model, ground, whole, kTallest * whole);
  const bool beside =
      two && half >= kNarrowestRoom * layout.unit && large.box.width < kWide * large.box.height;
  layout.room = beside ? half : whole;
  MapFrame frame = fit_map(portrait.model, ground, layout.room, kTallest * layout.room);
  frame.box.left = left;
  frame.box.top = head;
  layout.relief = layout.errors = frame;
  const double panel = frame.box.height + std::round(kLegendHeight * layout.unit) + margin;
  if (beside) {
    layout.errors.box.left += half + 2 * margin;
  } else {
    layout.errors.box.top += panel + numbers;
  }
  layout.height = static_cast<uint32_t>((two && !beside ? layout.errors.box.top : head) + panel);
  return layout;
}

// What is not known: darker than snow and than an error of 0, hatched closely for small places.
void draw_background(Drawing& drawing, const MapFrame& frame, double unit) {
  const PixelBox& box = frame.box;
  drawing.fill(box, kNoTerrain);
  const double step = 4 * unit, pen = 0.8 * unit, inset = pen / 2;  // lines have round ends
  const auto lines = static_cast<uint32_t>((box.width + box.height) / step) + 1;
  for (uint32_t line = 0; line < lines; ++line) {
    const double foot = line * step - box.height;  // where it is at the bottom, to the right
    const double low = std::max(0.0, -foot) + inset;
    const double high = std::min(box.height, box.width - foot) - inset;
    if (low >= high) continue;
    const double bottom = box.top + box.height, left = box.left + foot;
    drawing.stroke({left + low, bottom - low}, {left + high, bottom - high}, pen, kHatch);
  }
}

// Smaller if it is too long.
void draw_line(Drawing& drawing, const std::string& text, Spot start, double unit, double room) {
  const double fitting = room / std::max(1.0, text_width(text));
  draw_text(drawing, text, start, std::min(unit, fitting), kInk);
}

std::string facts_of(const Portrait& portrait) {
  const auto count = [](uint64_t number) { return grouped(static_cast<double>(number), 0); };
  std::string text = count(portrait.vertices) + " vertices";
  if (portrait.tiles != 0) {
    text += " in " + count(portrait.tiles) + (portrait.tiles == 1 ? " tile" : " tiles");
  }
  text += ", " + count(portrait.bytes) + " bytes";
  if (const std::optional<Accuracy>& accuracy = portrait.metadata.accuracy) {
    const std::string unit = unit_text(portrait.metadata.vertical_unit);
    text += ", largest error " + rounded_text(real(accuracy->max_error)) + unit + ", rms " +
            rounded_text(real(accuracy->rms_error)) + unit;
  }
  return text;
}

void draw_head(Drawing& drawing, const Portrait& portrait, const Layout& layout) {
  const double left = (kMargin + (portrait.coordinates ? kFrameRoom : 0)) * layout.unit;
  const double room = layout.width - left - kMargin * layout.unit;
  double line = (kMargin + kCapHeight) * layout.unit;
  if (!portrait.title.empty()) {
    line += 4 * layout.unit;
    draw_line(drawing, portrait.title, {left, line}, kTitleSize * layout.unit, room);
    line += 16 * layout.unit;
  }
  draw_line(drawing, facts_of(portrait), {left, line}, layout.unit, room);
}

// The places of a legend under a map.
struct LegendPlaces {
  LegendPlaces(const MapFrame& frame, const Layout& layout)
      : line{frame.box.left, frame.box.top + frame.box.height + 13 * layout.unit},
        ramp{line.x, line.y + 6 * layout.unit},
        side{line.x + kBarAt * layout.room, ramp.y},
        width(kRampShare * layout.room),
        side_room((1 - kBarAt) * layout.room) {}

  Spot line, ramp, side;
  double width, side_room;
};

struct HeightRange {
  double low, high;
};

HeightRange heights_of(const Portrait& portrait, const Relief& relief) {
  const Axis& z = portrait.metadata.placement.z;
  return {offset_of(z) + step_of(z) * static_cast<double>(relief.lowest()),
          offset_of(z) + step_of(z) * static_cast<double>(relief.highest())};
}

// Nothing if there are no contours.
std::optional<Decimal> interval_of(const Portrait& portrait, const Relief& relief) {
  if (!portrait.contours) return std::nullopt;
  if (portrait.interval) return portrait.interval;
  const auto [low, high] = heights_of(portrait, relief);
  return round_interval(low, high);
}

void draw_relief_legend(Drawing& drawing, const Portrait& portrait, const Relief& relief,
                        const Ground& ground, const Layout& layout) {
  const std::string unit = unit_text(portrait.metadata.vertical_unit);
  const auto [low, high] = heights_of(portrait, relief);
  const LegendPlaces at(layout.relief, layout);
  std::string line = "height " + rounded_text(low) + " to " + rounded_text(high) + unit;
  if (const std::optional<Decimal> interval = interval_of(portrait, relief)) {
    line += ", contours every " + to_string(*interval) + unit;
  }
  draw_line(drawing, line, at.line, layout.unit, at.width);
  draw_ramp(drawing, at.ramp, at.width, layout.unit, low, high,
            [&relief](double relative) { return relief.palette().at(relative); });
  draw_scale_bar(drawing, at.side, 0.8 * at.side_room, layout.unit, layout.relief.x_step * ground.x,
                 ground.unit);
  if (!relief.has_water()) return;
  const double level = real(*portrait.metadata.water_level);
  draw_swatch(drawing, {at.side.x, at.line.y - kCapHeight * layout.unit}, layout.unit, kWater,
              "water " + rounded_text(level) + unit);
}

void draw_errors(Canvas& canvas, const Portrait& portrait, const Comparison& comparison,
                 const Layout& layout) {
  ErrorMap map(layout.errors, comparison.cell);
  const Verification found = comparison.verify([&](int64_t x, int64_t y, int64_t, double above) {
    map.add(static_cast<double>(x), static_cast<double>(y), above);
  });
  const std::optional<Accuracy>& accuracy = portrait.metadata.accuracy;
  const double largest = real(found.max_error);
  const double bound = accuracy && accuracy->bound ? real(*accuracy->bound) : 0;
  const double scale = std::max(largest, bound) > 0 ? std::max(largest, bound) : 1;
  map.draw(canvas, scale);
  const std::string unit = unit_text(portrait.metadata.vertical_unit);
  const LegendPlaces at(layout.errors, layout);
  draw_line(canvas, "decoded minus source" + (unit.empty() ? "" : "," + unit), at.line, layout.unit,
            at.width);
  draw_ramp(canvas, at.ramp, at.width, layout.unit, -scale, scale,
            [](double relative) { return error_colour(2 * relative - 1); });
  const auto draw_fact = [&](int line, const std::string& name, double value) {
    draw_line(canvas, name + " " + rounded_text(value) + unit,
              {at.side.x, at.line.y + 11.5 * layout.unit * line}, layout.unit, at.side_room);
  };
  draw_fact(0, "largest", largest);
  draw_fact(1, "rms", real(found.rms_error));
  if (bound > 0) draw_fact(2, "bound", bound);
}

void expect_letters(const std::string& title) {
  const std::string_view missing = missing_letter(title);
  if (missing.empty()) return;
  throw Error("the title has \"" + std::string(missing) +
              "\", which cannot be drawn; use Latin letters with Western accents, digits and "
              "common signs");
}

void expect_drawable(const Portrait& portrait, uint32_t width) {
  if (width < kNarrowest || width > kWidest) {
    throw Error("a picture is " + std::to_string(kNarrowest) + " to " + std::to_string(kWidest) +
                " pixels wide");
  }
  expect_letters(portrait.title);
  if (portrait.model.vertices.empty())
    throw Error("there is nothing to draw; the terrain needs a triangle");
}

// All but the ground: what is drawn the same on both kinds of pictures.
struct Sheet {
  Sheet(const Portrait& of, uint32_t width, bool two)
      : portrait(of),
        ground(ground_of(of.model, of.metadata.horizontal_unit)),
        layout(lay_out(of, ground, width, two)),
        relief(of.model, ground, water_step(of.metadata), of.palette),
        interval(interval_of(of, relief)) {
    if (!interval) return;
    contours = contours_of(of.model, *interval);
    lines = contour_lines(layout.relief, contours, of.palette, layout.unit);
  }

  void begin(Drawing& drawing) const {
    draw_head(drawing, portrait, layout);
    draw_background(drawing, layout.relief, layout.unit);
  }

  void end(Drawing& drawing) const {
    const MapFrame& frame = layout.relief;
    draw_marked_lines(drawing, frame, portrait.model, portrait.lines, layout.unit);
    if (interval) {
      label_contours(drawing, frame, contours, lines, *interval, layout.unit,
                     portrait.north_arrow ? north_arrow_of(frame.box, layout.unit) : std::nullopt);
    }
    draw_frame(drawing, frame);
    if (portrait.north_arrow) draw_north_arrow(drawing, frame.box, layout.unit);
    draw_relief_legend(drawing, portrait, relief, ground, layout);
  }

  void draw_frame(Drawing& drawing, const MapFrame& frame) const {
    if (!portrait.coordinates) return;
    draw_coordinates(drawing, frame, portrait.model.placement, portrait.metadata.horizontal_unit,
                     layout.unit);
  }

  double wire() const { return 0.8 * std::sqrt(layout.unit); }

  const Portrait& portrait;
  Ground ground;
  Layout layout;
  Relief relief;
  std::optional<Decimal> interval;
  std::vector<Contour> contours;
  std::vector<ContourLine> lines;
};

}  // namespace

std::string world_file(const Portrait& portrait, uint32_t width, bool with_comparison) {
  const SurfaceModel& model = portrait.model;
  const Ground ground = ground_of(model, portrait.metadata.horizontal_unit);
  const MapFrame frame = lay_out(portrait, ground, width, with_comparison).relief;
  const Axis &x = model.placement.x, &y = model.placement.y;
  const double dx = frame.x_step * step_of(x), dy = frame.y_step * step_of(y);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text.precision(15);
  text << dx << "\n0\n0\n"
       << -dy << '\n'
       << offset_of(x) + step_of(x) * frame.west + (0.5 - frame.box.left) * dx << '\n'
       << offset_of(y) + step_of(y) * frame.north - (0.5 - frame.box.top) * dy << '\n';
  return text.str();
}

std::vector<uint8_t> render_png(const Portrait& portrait, uint32_t width,
                                const Comparison* comparison) {
  expect_drawable(portrait, width);
  const Sheet sheet(portrait, width, comparison != nullptr);
  const Layout& layout = sheet.layout;
  Canvas canvas(layout.width, layout.height, kPaper);
  sheet.begin(canvas);
  sheet.relief.draw_ground(canvas, layout.relief);
  if (portrait.mesh) sheet.relief.draw_lines(canvas, layout.relief, sheet.wire());
  draw_contours(canvas, layout.relief, sheet.lines);
  sheet.end(canvas);
  if (comparison != nullptr) {
    draw_background(canvas, layout.errors, layout.unit);
    draw_errors(canvas, portrait, *comparison, layout);
    sheet.draw_frame(canvas, layout.errors);
  }
  return png(canvas.rgb(), canvas.width(), canvas.height());
}

std::string render_svg(const Portrait& portrait, uint32_t width) {
  expect_drawable(portrait, width);
  const size_t triangles = portrait.model.triangles.size();
  if (triangles > kMostSvgTriangles) {
    throw Error("it has " + std::to_string(triangles) + " triangles; an .svg file has at most " +
                std::to_string(kMostSvgTriangles) + ": draw a .png, or encode with a larger bound");
  }
  const Sheet sheet(portrait, width, false);
  const Layout& layout = sheet.layout;
  Svg svg(layout.width, layout.height, kPaper);
  sheet.begin(svg);
  sheet.relief.draw_facets(svg, layout.relief);
  if (portrait.mesh) sheet.relief.draw_wires(svg, layout.relief, sheet.wire() / 2);
  for (const ContourLine& line : sheet.lines) {
    std::vector<Spot> places;
    for (const Spot place : line.places) places.push_back(layout.relief.in_picture(place));
    svg.line(places, line.width, colour_of(line), line.strength);
  }
  sheet.end(svg);
  return svg.take();
}

}  // namespace microtin::picture
