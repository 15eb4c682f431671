// SPDX-License-Identifier: MIT
// Decimals: reading, rounding, writing.
#include "encoder/exact/decimal.hpp"

#include <doctest/doctest.h>

#include <random>

#include "encoder/exact/lattice_map.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

std::string reread(const std::string& text, int max_decimals = kMaxDecimals) {
  const std::optional<Decimal> value = parse_decimal(text, max_decimals);
  return value ? to_string(*value) : "nothing";
}

}  // namespace

TEST_CASE("decimals are read in all their forms") {
  const char* const cases[][2] = {{"12", "12"},
                                  {"-0.25", "-0.25"},
                                  {"+7.30e-1", "0.73"},
                                  {".5", "0.5"},
                                  {"5.", "5"},
                                  {"-0", "0"},
                                  {"0e999", "0"},
                                  {"0.000", "0"},
                                  {"007.5", "7.5"},
                                  {"1.726645996093750000e+03", "1726.64599609375"},
                                  {"12E2", "1200"},
                                  {"1000000000000000000000e-20", "10"},
                                  {"0.0000000000001e13", "1"},
                                  {"999999999999999999", "999999999999999999"}};
  for (const auto& c : cases) CHECK_MESSAGE(reread(c[0], 12) == c[1], c[0]);
}

TEST_CASE("what is not a number, or too large, is refused") {
  for (const char* text : {"",      "-",
                           "+",     ".",
                           "-.",    "e5",
                           ".e5",   "1e",
                           "1e+",   "1e+-5",
                           "1e 5",  " 1",
                           "1 ",    "1,5",
                           "1.2.3", "--1",
                           "+-1",   "0x10",
                           "nan",   "NaN",
                           "inf",   "-Infinity",
                           "1f",    "1e99999999999",
                           "1e19",  "12345678901234567890",
                           "1e18"}) {
    CHECK_MESSAGE(reread(text) == "nothing", text);
  }
}

TEST_CASE("superfluous decimals are rounded to nearest, ties away from zero") {
  CHECK(reread("0.1234567895") == "0.12345679");
  CHECK(reread("0.1234567894999") == "0.123456789");
  CHECK(reread("-0.0000000005") == "-0.000000001");
  CHECK(reread("0.0000000004999") == "0");
  CHECK(reread("0.00000000005") == "0");
  CHECK(reread("9.9999999999") == "10");
  CHECK(reread("2.5", 0) == "3");
  CHECK(reread("-2.5", 0) == "-3");
  CHECK(reread("1234567890123.45678949", 18) == "1234567890123.45679");  // 18 digits in all
}

TEST_CASE("to_string and parse_decimal are inverse") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto mantissa =
        static_cast<int64_t>(random() % 2000000000000000000u) - 1000000000000000000;
    const Decimal value =
        make_decimal(mantissa >> (random() % 60), static_cast<int>(random() % 19));
    const std::optional<Decimal> back = parse_decimal(to_string(value), 18);
    REQUIRE(back);
    CHECK(back->mantissa == value.mantissa);
    CHECK(back->decimals == value.decimals);
  }
  CHECK(to_string({std::numeric_limits<int64_t>::min(), 0}) == "-9223372036854775808");
  CHECK(to_string({-5, 3}) == "-0.005");
}

TEST_CASE("a decimal's binary number is the nearest") {
  CHECK(real({0, 0}) == 0);
  CHECK(real({-25, 2}) == -0.25);
  CHECK(real({3683392158, 9}) == 3.683392158);
  CHECK(real({123456789012345678, 9}) == 123456789.012345678);
  CHECK(real({999999999999999999, 0}) == 999999999999999999.0);
  CHECK(real({9007199254740993, 9}) == 9007199.254740993);  // its mantissa is no binary number
}

TEST_CASE("decimals compare by value") {
  CHECK(Decimal{5, 1} <= Decimal{1, 0});
  CHECK_FALSE(Decimal{11, 1} <= Decimal{1, 0});
  CHECK(Decimal{-2, 0} <= Decimal{-19, 1});
  CHECK(Decimal{10, 1} == Decimal{1, 0});
  CHECK_FALSE(Decimal{1, 18} == Decimal{0, 0});
}

TEST_CASE("coordinates have all their decimals, or twelve") {
  CHECK(CoordinateText({0, 1, 1})(-3) == "-3");
  CHECK(CoordinateText({5274357669, 5, 1000})(2) == "5274357.679");
  CHECK(CoordinateText({5274357669, 5, 1000})(-1054871533) == "0.004");
  CHECK(CoordinateText({-1, 1, 8})(0) == "-0.125");
  CHECK(CoordinateText({6, 3, 12})(1) == "0.75");  // 3/4, though 12 is no power of ten
  CHECK(CoordinateText({0, 1, 1200})(1) == "0.000833333333");
  CHECK(CoordinateText({0, 1, 1200})(-1200) == "-1");
  CHECK(CoordinateText({0, 2, 3})(1) == "0.666666666667");
  CHECK(CoordinateText({(int64_t{1} << 40) - 2, 1, (int64_t{1} << 40) - 1})(0) == "0.999999999999");
  CHECK(CoordinateText({-1, 1, (int64_t{1} << 40) - 1})(0) == "-0.000000000001");
  CHECK(CoordinateText({std::numeric_limits<int64_t>::min(), 1, 1})(0) == "-9223372036854775808");
}
