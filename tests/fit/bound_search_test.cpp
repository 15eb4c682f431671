// SPDX-License-Identifier: MIT
// Looking for the bound that takes a number of bytes.
#include "encoder/fit/bound_search.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

double value_of(Decimal bound) {
  return std::stod(to_string(bound));
}

}  // namespace

TEST_CASE("bound search: a few trials find the bound of any power law") {
  for (const double power : {0.6, 1.0, 1.5, 2.5}) {
    for (const double guess : {0.001, 3.0, 400.0}) {
      CAPTURE(power);
      CAPTURE(guess);
      const double wanted = 12.5;
      const auto size_at = [&](double bound) { return 1e6 * std::pow(wanted / bound, power); };
      BoundSearch search({500, 0}, guess, 1e6);
      for (int i = 0; i < 8; ++i) {
        const Decimal bound = search.bound_for(1e6);
        search.add(bound, size_at(value_of(bound)));
      }
      CHECK(value_of(search.bound_for(1e6)) == doctest::Approx(wanted).epsilon(0.001));
    }
  }
}

TEST_CASE("bound search: bounds stay within their range") {
  BoundSearch search({500, 0}, 10, 1000);
  CHECK(value_of(search.bound_for(1000)) == 10);
  search.add({10, 0}, 1e9);
  CHECK(to_string(search.bound_for(1)) == "500");
  search.add({500, 0}, 1);
  search.forget_ends();
  CHECK(value_of(search.bound_for(1e30)) == doctest::Approx(0.0005));
}

TEST_CASE("bound search: larger bounds follow one that cannot be kept") {
  BoundSearch search({500, 0}, 10, 1000);
  Decimal bound = search.bound_for(1000);
  for (int i = 0; i < 20 && !(Decimal{500, 0} <= bound); ++i) {
    search.add(bound, std::nullopt);
    const Decimal next = search.bound_for(1000);
    CHECK_FALSE(next <= bound);
    bound = next;
  }
  CHECK(to_string(bound) == "500");
}

TEST_CASE("bound search: between a bound that takes too much and one that fits") {
  BoundSearch search({500, 0}, 10, 1000);
  search.add({10, 0}, 4000);
  search.add({20, 0}, 100);  // the line through both is steeper than any that is trusted
  const double between = value_of(search.bound_for(990));
  CHECK(between > 10);
  CHECK(between < 20);
  search.add({16, 0}, 1001);
  const double closer = value_of(search.bound_for(990));
  CHECK(closer > 16);
  CHECK(closer < 20);
  search.add({15, 0}, 900);  // the line bends: what was too small is not
  CHECK(value_of(search.bound_for(990)) < 15);
  search.forget_ends();
  CHECK(value_of(search.bound_for(1)) > 20);
}
