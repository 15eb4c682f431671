// SPDX-License-Identifier: MIT
// Drawings of lines: read back by a reader of paths of their own.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/render.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

using namespace microtin;
using namespace microtin::tests;

namespace {

struct Stretch {
  Spot from, to;
};

// All straight pieces of the paths whose elements begin so.
std::vector<Stretch> pieces_of(const std::string& svg, const std::string& beginning) {
  std::vector<Stretch> pieces;
  for (size_t at = svg.find("<path " + beginning); at != std::string::npos;
       at = svg.find("<path " + beginning, at + 1)) {
    const char* c = svg.c_str() + svg.find(" d=\"", at) + 4;
    Spot pen{0, 0}, start{0, 0};
    while (*c != '"') {
      const char command = *c++;
      if (command == 'z') {
        pieces.push_back({pen, start});
        pen = start;
        continue;
      }
      char* end = nullptr;
      const double dx = std::strtod(c, &end);
      const double dy = std::strtod(end, &end);
      REQUIRE(end != c);
      c = end;
      const Spot to{pen.x + dx, pen.y + dy};
      if (command == 'm') start = to;
      if (command == 'l') pieces.push_back({pen, to});
      pen = to;
    }
  }
  return pieces;
}

bool is_near(Spot a, Spot b) {
  return std::abs(a.x - b.x) < 0.051 && std::abs(a.y - b.y) < 0.051;
}

Portrait portrait_of(uint32_t side) {
  Portrait portrait;
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      portrait.model.vertices.push_back({x, y, static_cast<int64_t>(x * x + 2 * y)});
      if (x + 1 == side || y + 1 == side) continue;
      const uint32_t v = y * side + x;
      portrait.model.triangles.push_back({v, v + 1, v + side});
      portrait.model.triangles.push_back({v + 1, v + side + 1, v + side});
    }
  }
  return portrait;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("svg: lines and areas are where they were drawn, to a tenth of a pixel") {
  constexpr Colour kRed{1, 0, 0}, kBlue{0, 0, 1};
  Random random(3);
  const auto place = [&] {
    return Spot{random.below(2000) * 0.057 - 10, random.below(2000) * 0.031};
  };
  Svg svg(100, 60, {1, 1, 1});
  std::vector<Stretch> lines, edges;
  for (int i = 0; i < 50; ++i) {
    const Spot a = place(), b = i % 3 == 0 && !lines.empty() ? lines.back().to : place(),
               c = place();
    svg.line({b, a, c}, 1.5, kRed, 0.5);
    lines.push_back({b, a});
    lines.push_back({a, c});
    svg.area({a, b, c}, kBlue);
    svg.area({c, b, a}, kBlue);
    for (const Stretch& edge : {Stretch{a, b}, {b, c}, {c, a}, {c, b}, {b, a}, {a, c}})
      edges.push_back(edge);
  }
  const std::string text = svg.take();
  const auto check = [&](const std::string& beginning, const std::vector<Stretch>& drawn) {
    const std::vector<Stretch> read = pieces_of(text, beginning);
    REQUIRE(read.size() == drawn.size());
    for (size_t i = 0; i < read.size(); ++i) {
      CHECK(is_near(read[i].from, drawn[i].from));
      CHECK(is_near(read[i].to, drawn[i].to));
    }
  };
  check("stroke=\"#ff0000\" stroke-width=\"1.50\" stroke-opacity=\"0.50\"", lines);
  check("fill=\"#0000ff\"", edges);
}

TEST_CASE("svg: a terrain's drawing has all its triangles, its edges and its contours") {
  constexpr uint32_t kSide = 12;
  Portrait portrait = portrait_of(kSide);
  const std::string with = render_svg(portrait, 400);
  CHECK(pieces_of(with, "fill=").size() == 3 * portrait.model.triangles.size());
  const std::string wire = "stroke=\"#212b3d\"";
  CHECK(pieces_of(with, wire).size() == 2 * kSide * (kSide - 1) + (kSide - 1) * (kSide - 1));
  portrait.mesh = false;
  portrait.contours = true;
  portrait.interval = Decimal{20, 0};
  const std::string without = render_svg(portrait, 400);
  CHECK(pieces_of(without, wire).empty());
  CHECK(pieces_of(without, "stroke=\"#5c381a\"").size() >
        pieces_of(with, "stroke=\"#5c381a\"").size() + 50);
  for (const std::string& text : {with, without}) {
    CHECK(text.compare(0, 5, "<svg ") == 0);
    CHECK(text.compare(text.size() - 7, 7, "</svg>\n") == 0);
    CHECK(count(text, "<path") + count(text, "<rect") == count(text, "/>"));
    CHECK(count(text, "\"") % 2 == 0);
  }
}

TEST_CASE("svg: sizes stay modest, and too many triangles are refused") {
  const Portrait portrait = portrait_of(200);
  const auto triangles = static_cast<double>(portrait.model.triangles.size());
  CHECK(static_cast<double>(render_svg(portrait, 1000).size()) < 60 * triangles + 100'000);
  CHECK_THROWS_WITH_AS(render_svg(portrait_of(318), 400),
                       "it has 200978 triangles; an .svg file has at most 200000: draw a .png, or "
                       "encode with a larger bound",
                       Error);
  CHECK_THROWS_AS(render_svg(Portrait(), 400), Error);
  CHECK_THROWS_AS(render_svg(portrait, kNarrowest - 1), Error);
}
