// SPDX-License-Identifier: MIT
// Fractions behind written decimals, and axes made of them.
#include "encoder/exact/fraction.hpp"

#include <doctest/doctest.h>

#include "encoder/base/error.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

std::string meaning(const std::string& text) {
  const Fraction f = meaning_of(parse_decimal(text, 12).value());
  return std::to_string(static_cast<int64_t>(f.numerator)) + "/" +
         std::to_string(static_cast<int64_t>(f.denominator));
}

std::string text_of(const Axis& axis) {
  return std::to_string(axis.offset) + "+" + std::to_string(axis.numerator) + "k/" +
         std::to_string(axis.denominator);
}

}  // namespace

TEST_CASE("a decimal that looks like a simple fraction means it") {
  CHECK(meaning("0.000833333333") == "1/1200");
  CHECK(meaning("0.00083333333333333") == "1/1200");
  CHECK(meaning("0.000277777778") == "1/3600");
  CHECK(meaning("9.25925925925926e-05") == "1/10800");
  CHECK(meaning("0.008333333333") == "1/120");
  CHECK(meaning("0.3333") == "1/3");
  CHECK(meaning("-105.550416666667") == "-253321/2400");
}

TEST_CASE("a cell size means a reciprocal only if no place moves noticeably") {
  const auto means = [](const std::string& text) {
    return reciprocal_meant(parse_decimal(text, 12).value()).has_value();
  };
  CHECK(means("0.000833333333"));
  CHECK(means("0.00083333333333333"));
  CHECK(means("9.25925925925926e-05"));
  CHECK_FALSE(means("0.333"));
  CHECK_FALSE(means("0.08333"));
  CHECK_FALSE(means("4.988744589"));  // about 5762/1155
  CHECK_FALSE(means("0.5"));
  CHECK_FALSE(means("0.0001"));
  CHECK_FALSE(means("30"));
}

TEST_CASE("a corner means a fraction only if it stays where it is") {
  const auto denominator = [](const std::string& text) {
    return static_cast<int64_t>(
        meaning_within(parse_decimal(text, 12).value(), {1, 120000}).denominator);
  };
  CHECK(denominator("-105.550416666667") == 2400);
  CHECK(denominator("7.333333333") == 3);
  CHECK(denominator("7.333") == 1000);
}

TEST_CASE("other decimals mean themselves") {
  CHECK(meaning("10") == "10/1");
  CHECK(meaning("0") == "0/1");
  CHECK(meaning("0.1") == "1/10");
  CHECK(meaning("0.33") == "33/100");
  CHECK(meaning("30.25") == "121/4");
  CHECK(meaning("0.3048006") == "1524003/5000000");
  CHECK(meaning("29.999999999999") == "29999999999999/1000000000000");
  CHECK(meaning("-5274357.669") == "-5274357669/1000");
}

TEST_CASE("the simplest fraction rounds to the decimals written") {
  for (const char* text : {"0.1", "4.988744589", "3.14159265", "1000.001", "0.999999", "17"}) {
    const Decimal written = parse_decimal(text).value();
    const Fraction f = simplest_fraction(written);
    const Wide scale = power_of_ten(written.decimals);
    CHECK(magnitude(2 * (f.numerator * scale - written.mantissa * f.denominator)) <= f.denominator);
  }
}

TEST_CASE("axes are exact where 40 bits allow it") {
  CHECK(text_of(make_axis({7, 1}, {1, 1200})) == "8400+1k/1200");
  CHECK(text_of(make_axis({1, 2400}, {1, 1200})) == "1+2k/2400");
  CHECK(text_of(make_axis({-273357178, 1000}, {5, 1})) == "-136678589+2500k/500");
  // The step stays exact; the offset moves by less than 10^-12.
  const Axis axis = make_axis({-105550416666684, 1000000000000}, {1, 1200});
  CHECK(axis.numerator * 1200 == axis.denominator);
  CHECK(axis.denominator < kAxisLimit);
  const double moved =
      static_cast<double>((Wide{axis.offset} * 1000000000000 +
                           Wide{105550416666684} * static_cast<Wide>(axis.denominator)));
  CHECK(std::abs(moved / static_cast<double>(axis.denominator)) < 1);
}

TEST_CASE("axes beyond the format are refused") {
  CHECK_THROWS_AS(make_axis({0, 1}, {0, 1}), Error);
  CHECK_THROWS_AS(make_axis({0, 1}, {Wide{1} << 40, 1}), Error);
  CHECK_THROWS_AS(make_axis({0, 1}, {1, Wide{1} << 40}), Error);
  CHECK_THROWS_AS(make_axis({Wide{1} << 62, 1}, {1, 1000}), Error);
  CHECK_THROWS_AS(reduced_axis(Wide{1} << 63, 1, 1), Error);
  CHECK(text_of(reduced_axis(Wide{1} << 63, 2, 2)) == "4611686018427387904+1k/1");
  const Decimal largest{999999999999999999, 0}, smallest{1, kPlaceDecimals};
  CHECK_THROWS_AS(axis_of_cells(smallest, largest, (int64_t{1} << 33) - 1), Error);
}
