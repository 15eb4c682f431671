// SPDX-License-Identifier: MIT
// Letters made of strokes.
#include "encoder/picture/lettering.hpp"

#include <array>

namespace microtin::picture {
namespace {

// A character's lines, with | between them. A line is a run of points: a digit for x, one for y, or
// a and b for -1 and -2. One that begins with ~ is rounded: its points but the ends pull the curve,
// which is closed if the ends are one.
struct Glyph {
  char character;
  int width;
  std::string_view lines;
};

constexpr std::array<Glyph, 44> kGlyphs = {{
    {'0', 4, "~0040470700"},
    {'1', 4, "152720"},
    {'2', 4, "~0507474400|0040"},
    {'3', 4, "~0607474414|~1444400001"},
    {'4', 4, "30370242"},
    {'5', 4, "470704|~0445400001"},
    {'6', 4, "~37070040440402"},
    {'7', 4, "074710"},
    {'8', 4, "~0040440400|~0444470704"},
    {'9', 4, "~10404707034345"},
    {'a', 4, "~0040450500|4540"},
    {'b', 4, "~0040450500|0700"},
    {'c', 4, "~444505004041"},
    {'d', 4, "~0040450500|4740"},
    {'e', 4, "~434505004041|0343"},
    {'f', 3, "~371714|1410|0535"},
    {'g', 4, "~0040450500|4540|~404b0b"},
    {'h', 4, "0700|~03054543|4340"},
    {'i', 0, "0500|0707"},
    {'j', 1, "1510|~101b0b|1717"},
    {'k', 3, "0700|3502|1330"},
    {'l', 0, "0700"},
    {'m', 6, "0500|~03053533|3330|~33356563|6360"},
    {'n', 4, "0500|~03054543|4340"},
    {'o', 4, "~0040450500"},
    {'p', 4, "~0040450500|050b"},
    {'q', 4, "~0040450500|454b"},
    {'r', 3, "0500|~030535"},
    {'s', 4, "~4445050342400001"},
    {'t', 3, "1712|~121030|0535"},
    {'u', 4, "0502|~02004042|4540"},
    {'v', 4, "052045"},
    {'w', 6, "0510355065"},
    {'x', 4, "0540|0045"},
    {'y', 4, "0520|451b"},
    {'z', 4, "05450040"},
    {'.', 0, "0000"},
    {',', 0, "000a"},
    {':', 0, "0000|0404"},
    {'+', 4, "0343|2521"},
    {'-', 3, "0333"},
    {'/', 3, "0037"},
    {'(', 1, "~1705021b"},
    {')', 1, "~0715120b"},
}};

constexpr double kGap = 2, kBlank = 3;

const Glyph* glyph_of(char character) {
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.character == character) return &glyph;
  }
  return nullptr;
}

double advance_of(const Glyph* glyph) {
  return glyph != nullptr ? glyph->width + kGap : kBlank;
}

// Enough for eight points that are cut three times.
struct Polyline {
  std::array<Spot, 64> points{};
  size_t size = 0;

  void add(Spot spot) { points[size++] = spot; }
  Spot last() const { return points[size - 1]; }
};

Polyline points_of(std::string_view line) {
  Polyline polyline;
  for (size_t i = 0; i + 1 < line.size(); i += 2) {
    const char y = line[i + 1];
    polyline.add({line[i] - '0' + 0.0, y < 'a' ? y - '0' + 0.0 : 'a' - y - 1.0});
  }
  return polyline;
}

Spot between(Spot a, Spot b, double t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

// Cuts the corners (Chaikin): again and again, that comes to a quadratic B-spline.
Polyline rounded(const Polyline& line) {
  const Spot first = line.points[0], last = line.last();
  const bool closed = first.x == last.x && first.y == last.y;
  Polyline cut;
  if (!closed) cut.add(first);
  for (size_t i = 0; i + 1 < line.size; ++i) {
    const Spot a = line.points[i], b = line.points[i + 1];
    if (closed || i != 0) cut.add(between(a, b, 0.25));
    if (closed || i + 2 != line.size) cut.add(between(a, b, 0.75));
  }
  cut.add(closed ? cut.points[0] : last);
  return cut;
}

// Where letters go: from here, in this direction, so large.
struct Script {
  Spot start, along;
  double unit;

  Spot on_canvas(Spot p) const {
    return {start.x + unit * p.x * along.x + unit * p.y * along.y,
            start.y + unit * p.x * along.y - unit * p.y * along.x};
  }
};

Polyline polyline_of(std::string_view line) {
  constexpr int kCuts = 3;
  const bool round = line.front() == '~';
  Polyline polyline = points_of(line.substr(round ? 1 : 0));
  for (int i = 0; round && i < kCuts; ++i) polyline = rounded(polyline);
  return polyline;
}

}  // namespace

double text_width(std::string_view text) {
  double width = 0;
  for (const char c : text) width += advance_of(glyph_of(c));
  return std::max(0.0, width - kGap);
}

void draw_text(Canvas& canvas, std::string_view text, Spot start, double unit, Colour colour,
               Spot along, double pen) {
  Script script{start, along, unit};
  for (const char c : text) {
    const Glyph* const glyph = glyph_of(c);
    for (std::string_view rest = glyph != nullptr ? glyph->lines : ""; !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('|'));
      const Polyline strokes = polyline_of(line);
      for (size_t i = 0; i + 1 < strokes.size; ++i) {
        canvas.stroke(script.on_canvas(strokes.points[i]), script.on_canvas(strokes.points[i + 1]),
                      pen * unit, colour);
      }
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    }
    script.start = script.on_canvas({advance_of(glyph), 0});
  }
}

}  // namespace microtin::picture
