// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "encoder/terrain/degrees.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

TEST_CASE("degree cell: a file is named after its south-west corner") {
  const auto is = [](const char* path, int latitude, int longitude) {
    const auto cell = cell_of(path);
    return cell && cell->latitude == latitude && cell->longitude == longitude;
  };
  CHECK(is("a/N43E007.TER", 43, 7));
  CHECK(is("s01w180.dat", -1, -180));
  CHECK(is("N43E007.SRTMGL3.hgt", 43, 7));
  CHECK(is("N43E007_nasa.hgt", 43, 7));
  CHECK(is("S90E179", -90, 179));
  for (const char* const name : {"N43E07.TER", "area.DAT", "N90E000.TER", "N00E180.TER",
                                 "S91E000.DAT", "N+3E007.hgt", "N-3E007.hgt", ".hgt", ""}) {
    CAPTURE(name);
    CHECK(!cell_of(name));
  }
}

}  // namespace microtin::tests
