// SPDX-License-Identifier: MIT
// What pictures say in words and numbers.
#include <doctest/doctest.h>

#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

constexpr Colour kPaper{1, 1, 1};

uint64_t inked(const Canvas& canvas) {
  uint64_t count = 0;
  for (size_t i = 0; i < canvas.rgb().size(); i += 3) count += canvas.rgb()[i] < 128;
  return count;
}

uint64_t ink_of(const char* text) {
  Canvas canvas(60, 60, kPaper);
  draw_text(canvas, text, {20, 40}, 3, {0, 0, 0});
  return inked(canvas);
}

}  // namespace

TEST_CASE("legend: numbers") {
  CHECK(grouped(0, 0) == "0");
  CHECK(grouped(999, 0) == "999");
  CHECK(grouped(1234567, 0) == "1,234,567");
  CHECK(grouped(-1234.5, 2) == "-1,234.50");
  CHECK(grouped(-123, 0) == "-123");
  CHECK(grouped(-0.001, 1) == "0.0");
  CHECK(rounded_text(11.98046875) == "11.98");
  CHECK(rounded_text(12) == "12");
  CHECK(rounded_text(0.5) == "0.5");
  CHECK(rounded_text(12345.67) == "12,346");
  CHECK(rounded_text(-0.00022) == "-0.00022");
  CHECK(rounded_text(0.123456) == "0.1235");
  CHECK(rounded_text(-1e-16) == "0");
  CHECK(rounded_text(0) == "0");
}

TEST_CASE("legend: round lengths") {
  for (const double exponent : {0.001, 1.0, 1000.0}) {
    CHECK(round_length(1 * exponent) == doctest::Approx(1 * exponent));
    CHECK(round_length(1.99 * exponent) == doctest::Approx(1 * exponent));
    CHECK(round_length(2.01 * exponent) == doctest::Approx(2 * exponent));
    CHECK(round_length(4.9 * exponent) == doctest::Approx(2 * exponent));
    CHECK(round_length(9.9 * exponent) == doctest::Approx(5 * exponent));
  }
}

TEST_CASE("legend: every character that is written leaves ink, others a blank") {
  std::string letters =
      "0123456789abcdefghijklmnopqrstuvwxyz.,:+-/()ABCDEFGHIJKLMNOPQRSTUVWXYZ;!?&=_'\"";
  for (const char letter : letters) {
    const char one[] = {letter, '\0'};
    CHECK_MESSAGE(ink_of(one) > 0, one);
    CHECK(missing_letter(one).empty());
  }
  CHECK(ink_of(" ") == 0);
  for (const char* const none : {"\xE2\x82\xAC", "\xC3\x97", "\xC5\xBE", "\xFF", "\n", "#"}) {
    CHECK(ink_of(none) == 0);
    CHECK(missing_letter(std::string("a ") + none + " b") == none);
  }
  CHECK(text_width("") == 0);
  CHECK(text_width("11") > text_width("1"));
}

TEST_CASE("legend: accents are on their letters, whose width they leave") {
  const std::pair<const char*, const char*> marked[] = {
      {"\xC3\xA9", "e"}, {"\xC3\xA4", "a"}, {"\xC3\x84", "A"}, {"\xC3\xBF", "y"}, {"\xC3\xA7", "c"},
      {"\xC3\x91", "N"}, {"\xC3\xA5", "a"}, {"\xC3\xAE", "i"}, {"\xC3\x9D", "Y"}};
  for (const auto& pair : marked) {
    CHECK(missing_letter(pair.first).empty());
    CHECK(text_width(pair.first) == text_width(pair.second));
    CHECK_MESSAGE(ink_of(pair.first) > ink_of(pair.second), pair.second);
  }
  CHECK(text_width("\xC3\x9F") > 0);  // a letter of its own
}

TEST_CASE("legend: text runs along its direction") {
  Canvas across(80, 80, kPaper), up(80, 80, kPaper);
  draw_text(across, "L7e", {20, 60}, 2, {0, 0, 0});
  draw_text(up, "L7e", {60, 60}, 2, {0, 0, 0}, {0, -1});
  for (uint32_t row = 0; row < 80; ++row) {
    for (uint32_t column = 0; column < 80; ++column) {
      const auto turned = 3 * (size_t{79 - column} * 80 + row);
      CHECK(std::abs(across.rgb()[3 * (size_t{row} * 80 + column)] - up.rgb()[turned]) <= 1);
    }
  }
}

TEST_CASE("legend: a scale bar has the length that its label states") {
  // 0.5 m a pixel, room for 150 m: 100 m in 200 pixels.
  Canvas canvas(400, 40, kPaper);
  draw_scale_bar(canvas, {10, 10}, 300, 1, 0.5, "m");
  const auto dark = [&](uint32_t column) {
    return canvas.rgb()[3 * (size_t{14} * 400 + column)] < 128;
  };
  CHECK(dark(30));   // the first quarter
  CHECK(!dark(80));  // the second
  CHECK(dark(130));
  CHECK(dark(210));  // the end
  CHECK(!dark(212));
}

TEST_CASE("map: degrees are as long as they are on the ground") {
  SurfaceModel model;
  model.placement.y = {600, 1, 10};  // 60 degrees north and more
  model.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 0, 0}};
  const microtin::picture::Ground ground = ground_of(model, Unit::kDegree);
  CHECK(ground.x == doctest::Approx(55800).epsilon(0.001));
  CHECK(ground.y == doctest::Approx(11141).epsilon(0.001));
  CHECK(std::string(ground.unit) == "m");
  CHECK(std::string(ground_of(model, Unit::kUnknown).unit) == "units");
  CHECK(std::string(ground_of(model, Unit::kFoot).unit) == "ft");
}

TEST_CASE("map: fits its room in whole pixels, undistorted") {
  SurfaceModel model;
  model.vertices = {{100, 50, 0}, {300, 50, 0}, {100, 150, 0}};
  const MapFrame wide = fit_map(model, {1, 1, "m"}, 80.7, 80.7);
  CHECK(wide.box.width == 80);
  CHECK(wide.box.height == 40);
  CHECK(wide.spot(100, 150).x == 0);
  CHECK(wide.spot(100, 150).y == 0);
  CHECK(wide.spot(300, 50).x == doctest::Approx(80));
  const MapFrame narrow = fit_map(model, {1, 1, "m"}, 1000, 7.9);
  CHECK(narrow.box.height == 7);
  CHECK(fit_map(model, {1, 1000, "m"}, 80, 80).box.width == 1);
}
