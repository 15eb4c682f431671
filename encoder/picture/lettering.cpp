// SPDX-License-Identifier: MIT
// Letters made of strokes.
#include <array>
#include <utility>

#include "encoder/base/text.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {
namespace {

using namespace std::string_view_literals;

constexpr char32_t kDotless = 0x131;  // i

// A character's lines, with | between them. A line is a run of points: a digit for x, one for y, or
// a and b for -1 and -2. One that begins with ~ is rounded: its points but the ends pull the curve,
// which is closed if the ends are one.
struct Glyph {
  char32_t character;
  int width;
  std::string_view lines;
};

constexpr std::array<Glyph, 85> kGlyphs = {{
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
    {'A', 6, "003760|1252"},
    {'B', 4, "0700|~072737442404|~042444402000"},
    {'C', 4, "~464707004041"},
    {'D', 4, "0700|~072747402000"},
    {'E', 4, "47070040|0434"},
    {'F', 4, "470700|0434"},
    {'G', 4, "~464707004043|4323"},
    {'H', 4, "0700|4740|0444"},
    {'I', 0, "0700"},
    {'J', 3, "3732|~32300002"},
    {'K', 4, "0700|4703|1440"},
    {'L', 4, "070040"},
    {'M', 6, "0007326760"},
    {'N', 5, "00075057"},
    {'O', 5, "~0050570700"},
    {'P', 4, "0007|~072747432303"},
    {'Q', 5, "~0050570700|3250"},
    {'R', 4, "0007|~072747432303|2340"},
    {'S', 4, "~4647070443400001"},
    {'T', 4, "0747|2720"},
    {'U', 4, "0702|~02004042|4247"},
    {'V', 4, "072047"},
    {'W', 6, "0710365067"},
    {'X', 4, "0740|0047"},
    {'Y', 4, "072347|2320"},
    {'Z', 4, "07470040"},
    {'.', 0, "0000"},
    {',', 0, "000a"},
    {':', 0, "0000|0404"},
    {'+', 4, "0343|2521"},
    {'-', 3, "0333"},
    {'/', 3, "0037"},
    {'(', 1, "~1705021b"},
    {')', 1, "~0715120b"},
    {';', 0, "000a|0404"},
    {'!', 0, "0702|0000"},
    {'?', 4, "~060747432322|2020"},
    {'&', 5, "~401617373603002043"},
    {kDotless, 0, "0500"},
    {'=', 4, "0242|0444"},
    {'_', 4, "0a4a"},
    {'\'', 0, "0705"},
    {'"', 2, "0705|2725"},
    {0xB0, 2, "~0525270705"},
    {0xC6, 7, "0037|77373070|3464|1232"},
    {0xD8, 5, "~0050570700|0057"},
    {0xDF, 4, "~000307373414|~14444010"},
    {0xE6, 6, "~0030350500|3530|~636535306061|3363"},
    {0xF8, 4, "~0040450500|0045"},
}};

constexpr double kGap = 2, kBlank = 3;

// Latin letters from U+00C0 on: what they are made of, for capitals and for small ones.
constexpr std::string_view kBases = "AAAAAA\0CEEEEIIII\0NOOOOO\0\0UUUUY\0Y"sv;
constexpr std::string_view kMarks = "`'^~:o ,`'^:`'^: ~`'^~:  `'^:' :"sv;
constexpr char32_t kFirstMarked = 0xC0, kFirstSmall = 0xE0;

// Four units wide; where y is 0, the letter ends, a unit below.
constexpr std::array<std::pair<char, std::string_view>, 7> kMarkLines = {{{'`', "1220"},
                                                                          {'\'', "2032"},
                                                                          {'^', "002240"},
                                                                          {'~', "~00123042"},
                                                                          {':', "1111|3131"},
                                                                          {'o', "~1030321210"},
                                                                          {',', "~20301b0b"}}};

const Glyph* glyph_of(char32_t character) {
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.character == character) return &glyph;
  }
  return nullptr;
}

std::string_view lines_of(char mark) {
  for (const auto& [name, lines] : kMarkLines) {
    if (name == mark) return lines;
  }
  return {};
}

// A letter and the mark on it.
struct Shape {
  const Glyph* glyph = nullptr;  // none: a blank
  std::string_view mark;
  double mark_x = 0, mark_y = 0;
};

Shape marked(char32_t character) {
  const bool small = character >= kFirstSmall;
  const size_t index = character - (small ? kFirstSmall : kFirstMarked);
  const char base = kBases[index];
  if (base == '\0') return {};
  const char mark = kMarks[index];
  const bool dotted = small && base == 'I';
  const char32_t letter = dotted ? kDotless : static_cast<char32_t>(base) + (small ? 0x20 : 0);
  const Glyph* const glyph = glyph_of(letter);
  const double above = small ? 6.2 : 8.2;
  return {glyph, lines_of(mark), glyph->width / 2.0 - 2, mark == ',' ? 0 : above};
}

Shape shape_of(char32_t character) {
  const Glyph* const glyph = glyph_of(character);
  if (glyph != nullptr) return {glyph, {}};
  return character >= kFirstMarked && character <= 0xFF ? marked(character) : Shape();
}

// A character of UTF-8 that character_bytes() has measured; 0 for one byte that is none.
char32_t code_of(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first < 0x80 ? first : 0;
  char32_t code = first & (0x7Fu >> character.size());
  for (const char next : character.substr(1))
    code = code << 6 | (static_cast<unsigned char>(next) & 0x3Fu);
  return code;
}

// The first character of a text that is not empty, which loses it.
std::string_view take_character(std::string_view& text) {
  const std::string_view first = text.substr(0, std::max<size_t>(1, character_bytes(text)));
  text.remove_prefix(first.size());
  return first;
}

double advance_of(const Shape& shape) {
  return shape.glyph != nullptr ? shape.glyph->width + kGap : kBlank;
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

void draw_lines(Drawing& drawing, std::string_view lines, const Script& script, Spot shift,
                double pen, Colour colour) {
  const auto place = [&](Spot p) { return script.on_canvas({p.x + shift.x, p.y + shift.y}); };
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('|'));
    const Polyline strokes = polyline_of(line);
    for (size_t i = 0; i + 1 < strokes.size; ++i) {
      drawing.stroke(place(strokes.points[i]), place(strokes.points[i + 1]), pen * script.unit,
                     colour);
    }
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
}

}  // namespace

double text_width(std::string_view text) {
  double width = 0;
  while (!text.empty()) width += advance_of(shape_of(code_of(take_character(text))));
  return std::max(0.0, width - kGap);
}

std::string_view missing_letter(std::string_view text) {
  while (!text.empty()) {
    const std::string_view character = take_character(text);
    if (character != " " && shape_of(code_of(character)).glyph == nullptr) return character;
  }
  return {};
}

void draw_text(Drawing& drawing, std::string_view text, Spot start, double unit, Colour colour,
               Spot along, double pen) {
  Script script{start, along, unit};
  while (!text.empty()) {
    const Shape shape = shape_of(code_of(take_character(text)));
    if (shape.glyph != nullptr) {
      draw_lines(drawing, shape.glyph->lines, script, {0, 0}, pen, colour);
      draw_lines(drawing, shape.mark, script, {shape.mark_x, shape.mark_y}, pen, colour);
    }
    script.start = script.on_canvas({advance_of(shape), 0});
  }
}

}  // namespace microtin::picture
