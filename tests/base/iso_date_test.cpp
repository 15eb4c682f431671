// SPDX-License-Identifier: MIT
// Dates.
#include <doctest/doctest.h>

#include "encoder/base/text.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

TEST_CASE("years, months and days that there are") {
  for (const char* text : {"2026", "0000", "2026-11", "2026-11-21", "2024-02-29", "2000-02-29",
                           "2026-01-31", "2026-12-31", "2026-04-30", "2019/2021", "2019-05/2021",
                           "2019/2019-05", "2021-03-04/2021-03-04"}) {
    CHECK_MESSAGE(is_iso_date(text), text);
  }
}

TEST_CASE("a validity may be open on one side") {
  for (const char* text : {"2026", "2024-01/2025", "2024-01/..", "../2025-06-30"}) {
    CHECK_MESSAGE(is_iso_validity(text), text);
  }
  for (const char* text : {"", "..", "../..", "/..", "2024/", "2024/...", "2025/2024", "../2024-13",
                           "2024/../2025", "x/.."}) {
    CHECK_MESSAGE(!is_iso_validity(text), text);
  }
}

TEST_CASE("days of a year have dates") {
  CHECK(iso_date(2026, 1) == "2026-01-01");
  CHECK(iso_date(2026, 59) == "2026-02-28");
  CHECK(iso_date(2026, 60) == "2026-03-01");
  CHECK(iso_date(2024, 60) == "2024-02-29");
  CHECK(iso_date(2024, 366) == "2024-12-31");
  CHECK(iso_date(2026, 365) == "2026-12-31");
  CHECK(iso_date(2026, 366) == "2026");
  CHECK(iso_date(2026, 0) == "2026");
  CHECK(iso_date(999, 1).empty());
  CHECK(iso_date(10000, 1).empty());
}

TEST_CASE("others are none") {
  for (const char* text : {"",
                           "26",
                           "2026-",
                           "2026-13",
                           "2026-00",
                           "2026-1",
                           "2026-11-0",
                           "2026-11-00",
                           "2026-11-31",
                           "2026-02-29",
                           "1900-02-29",
                           "2026/11/21",
                           "2026-11/21",
                           "21.11.2026",
                           "2026-11-21T00",
                           "2026-1a",
                           "2021/2019",
                           "2021-03/2021-02-28",
                           "2019/",
                           "/2021",
                           "2019/2020/2021",
                           "2019/2021-13",
                           "20x6",
                           "2026-11- 1",
                           "+026"}) {
    CHECK_MESSAGE(!is_iso_date(text), text);
  }
}
