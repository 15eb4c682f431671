// SPDX-License-Identifier: MIT
// Floating-point numbers in text.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "encoder/base/text.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

TEST_CASE("real numbers are read to the nearest double") {
  CHECK(real_number("0") == 0.0);
  CHECK(real_number("-0.25") == -0.25);
  CHECK(real_number(".5") == 0.5);
  CHECK(real_number("5.") == 5.0);
  CHECK(real_number("1e5") == 1e5);
  CHECK(real_number("0e999") == 0.0);
  CHECK(real_number("0.1") == 0.1);
  CHECK(real_number("-3.4028234663852886E+38") == -3.4028234663852886e38);
  CHECK(real_number("9007199254740993") == 9007199254740992.0);  // 2^53 + 1: ties to even
  CHECK(real_number("2.2250738585072011e-308") == 2.2250738585072011e-308);
  CHECK(real_number("4.9e-324") == 4.9e-324);
}

TEST_CASE("real numbers can be infinite or none") {
  for (const char* text : {"inf", "-inf", "INF", "infinity", "Infinity"}) {
    const std::optional<double> value = real_number(text);
    REQUIRE_MESSAGE(value.has_value(), text);
    CHECK_MESSAGE(std::isinf(*value), text);
  }
  for (const char* text : {"nan", "NaN", "-nan"}) {
    const std::optional<double> value = real_number(text);
    REQUIRE_MESSAGE(value.has_value(), text);
    CHECK_MESSAGE(std::isnan(*value), text);
  }
}

TEST_CASE("other text is no real number") {
  for (const char* text :
       {"",      " ",    "-",        "+1",    " 1",     "\t1",    "1 ",      "--1",
        "- 1",   "0x10", "0X1p3",    "1,5",   "1e",     "e5",     ".",       "1.2.3",
        "metre", "1m",   "infinite", "1e999", "-1e999", "1e-999", "-1e-999", "0.001e-999"}) {
    CHECK_MESSAGE(!real_number(text).has_value(), text);
  }
  CHECK(!real_number(std::string("1\0", 2)).has_value());
}
