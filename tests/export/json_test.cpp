// SPDX-License-Identifier: MIT
#include "encoder/export/json.hpp"

#include <doctest/doctest.h>

#include <cstdint>

#include "tests/support/layers.hpp"

namespace microtin::tests {

TEST_CASE("json: numbers are the shortest that mean the same") {
  CHECK(json(0) == "0");
  CHECK(json(UINT64_MAX) == "18446744073709551615");
  CHECK(json(INT64_MIN) == "-9223372036854775808");
  CHECK(json(10.0) == "10.0");
  CHECK(json(-0.1) == "-0.1");
  CHECK(json(1e-7) == "1e-07");
  CHECK(json(1.0 / 1200) == "0.0008333333333333334");
}

TEST_CASE("json: texts are quoted, and UTF-8 whatever they were") {
  CHECK(json("a/b c~") == "\"a/b c~\"");
  CHECK(json("\"\\\n\x1b") == "\"\\\"\\\\\\u000a\\u001b\"");
  const std::string legal =
      "\xC2\xA0 \xDF\xBF \xE0\xA0\x80 \xED\x9F\xBF \xF0\x90\x80\x80 \xF4\x8F\xBF\xBF";
  CHECK(json(legal) == '"' + legal + '"');
  CHECK(json("\x7F \xC2\x80 \xC2\x9F \xC3\x80") == "\"\\u007f \\u0080 \\u009f \xC3\x80\"");
  const std::string bad = "\xEF\xBF\xBD";
  CHECK(json("\x80") == '"' + bad + '"');
  CHECK(json("\xC1\xBF") == '"' + bad + bad + '"');                      // too long for its code
  CHECK(json("\xE0\x9F\xBF") == '"' + bad + bad + bad + '"');            // likewise
  CHECK(json("\xED\xA0\x80") == '"' + bad + bad + bad + '"');            // half of a pair
  CHECK(json("\xF4\x90\x80\x80") == '"' + bad + bad + bad + bad + '"');  // beyond the last
  CHECK(json("\xF8") == '"' + bad + '"');
  CHECK(json("\xE2\x82") == '"' + bad + bad + '"');  // cut off
  CHECK(json("\xC3x") == '"' + bad + "x\"");
}

TEST_CASE("json: objects keep the order of their names") {
  CHECK(json(JsonObject{{"b", "1"}, {"a", json("x")}}) == R"({"b": 1, "a": "x"})");
}

}  // namespace microtin::tests
