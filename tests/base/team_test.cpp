// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "encoder/base/work.hpp"

namespace microtin::tests {

TEST_CASE("team: every piece is done once, by threads that are its own") {
  for (std::size_t threads = 0; threads <= 5; ++threads) {
    base::Team team(threads);
    CHECK(team.size() == std::max<std::size_t>(threads, 1));
    for (std::size_t count : {0u, 1u, 2u, 7u, 100u}) {
      for (int round = 0; round < 50; ++round) {
        std::vector<std::atomic<int>> done(count);
        std::atomic<bool> is_known{true};
        team.for_each(count, [&](std::size_t i, std::size_t worker) {
          ++done[i];
          if (worker >= team.size()) is_known = false;
        });
        for (const std::atomic<int>& times : done) REQUIRE(times == 1);
        REQUIRE(is_known);
      }
    }
  }
}

TEST_CASE("team: no two pieces of one worker at the same time") {
  base::Team team(4);
  std::vector<std::atomic<int>> at_work(team.size());
  std::atomic<int> collisions{0};
  for (int round = 0; round < 200; ++round) {
    team.for_each(16, [&](std::size_t, std::size_t worker) {
      if (++at_work[worker] != 1) ++collisions;
      --at_work[worker];
    });
  }
  CHECK(collisions == 0);
}

TEST_CASE("team: the exception of the smallest piece that failed, then it works again") {
  base::Team team(3);
  for (int round = 0; round < 50; ++round) {
    std::string message;
    try {
      team.for_each(20, [](std::size_t i, std::size_t) {
        if (i % 2 == 0) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    REQUIRE(message == "0");
    std::atomic<std::size_t> sum{0};
    team.for_each(20, [&](std::size_t i, std::size_t) { sum += i; });
    REQUIRE(sum == 190);
  }
}

}  // namespace microtin::tests
