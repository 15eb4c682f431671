// SPDX-License-Identifier: MIT
// Looking for the smallest bound that a number of bytes allows.
#include "encoder/fit/byte_budget.hpp"

#include <doctest/doctest.h>

#include "tests/support/layers.hpp"

using namespace microtin::tests;

TEST_CASE("byte budget: bounds shrink evenly, to a tenth every 96") {
  CHECK(to_string(bound_at({500, 0}, 0)) == "500");
  CHECK(to_string(bound_at({500, 0}, 96)) == "50");
  CHECK(to_string(bound_at({125, 2}, 192)) == "0.0125");
  for (uint32_t rung = 0; rung + 1 < 400; ++rung) {
    CHECK(bound_at({8849, 0}, rung + 1) <= bound_at({8849, 0}, rung));
  }
}

TEST_CASE("byte budget: the last rung that fits, whatever the rough guess") {
  for (const uint32_t last : {0u, 1u, 47u, 48u, 49u, 333u, kRungs - 1}) {
    for (const uint32_t guess : {0u, 40u, 335u, kRungs - 1}) {
      const auto found =
          last_rung([&](uint32_t r) { return r <= guess; }, [&](uint32_t r) { return r <= last; });
      REQUIRE(found);
      CHECK(*found == last);
    }
  }
  const auto never = [](uint32_t) { return false; };
  CHECK_FALSE(last_rung(never, never));
}
