// SPDX-License-Identifier: MIT
// What a file promises of its heights: info states what verify measures, rounded up, and verify
// finds a file whose promise its source breaks.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/stream/header.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/join.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
using namespace microtin::terrain;
using microtin::stream::read_header;
using microtin::stream::with_metadata;
using nlohmann::json;

namespace {

// Waves with a void.
std::string waves() {
  std::string text =
      "ncols 40\nnrows 30\nxllcenter 500\nyllcenter 700\ncellsize 2\nnodata_value -9999\n";
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 40; ++column) {
      const double z = 60 + 25 * std::sin(column * 0.31) * std::cos(row * 0.23) + row * column % 3;
      text += row == 7 && column == 9 ? "-9999" : std::to_string(z).substr(0, 4);
      text += column < 39 ? ' ' : '\n';
    }
  }
  return text;
}

json json_report(const Session& session, const std::string& words) {
  const Session::Result made = session.run(words);
  CHECK_MESSAGE(made.code == 0, (words + made.err));
  return json::parse(made.out);
}

// The stated distance is the measured one, rounded up to sixteenths of a z step.
void expect_rounded_up(double stated, double measured, double z_step) {
  CHECK(stated >= measured);
  CHECK(stated < measured + z_step / 16 + 1e-6);
}

void change(const Session& session, const std::string& to,
            const std::function<void(Metadata&)>& change_metadata) {
  const std::vector<uint8_t> stream = bytes_of_file(session.folder() + "/t.mtin");
  Metadata metadata = read_header(stream).metadata;
  change_metadata(metadata);
  write_file(session.folder() + "/" + to, with_metadata(stream, metadata));
}

}  // namespace

TEST_CASE("promises: info states what verify measures everywhere, rounded up, also in tiles" *
          kSlow) {
  const Session session;
  session.write("t.asc", waves());
  for (const std::string words :
       {"--max-error 2", "--max-error 2 --xy-step 0.5", "--max-error 3 --never-below --z-step 0.7",
        "--max-bytes 300 --fast", "--max-error 2 --tile-vertices 60", "--tile-vertices 300", ""}) {
    CAPTURE(words);
    const std::string file = words.find("tile") == words.npos ? "t.mtin" : "t.mtp";
    CHECK(session.run(join({"encode t.asc --units metre -o ", file, " ", words})).code == 0);
    const json stated = json_report(session, "info --json " + file),
               found = json_report(session, "verify --json " + file + " t.asc --units metre");
    const double z_step = stated["steps"]["z"];
    for (const char* const side : {"max_below", "max_above"}) {
      CHECK(stated["at_samples"][side] == found[side]);
      expect_rounded_up(stated["everywhere"][side], found["everywhere"][side], z_step);
      if (file == "t.mtin") continue;
      double most = 0;
      for (const json& tile : stated["tiles"]) {
        most = std::max<double>(most, tile[std::string(side) + "_everywhere"]);
      }
      CHECK(most == stated["everywhere"][side].get<double>());
    }
    if (words.find("--max-bytes") == 0)
      CHECK(bytes_of_file(session.folder() + "/t.mtin").size() <= 300);
  }
}

TEST_CASE("promises: points, and lattices too fine to measure, state nothing between samples") {
  const Session session;
  session.write("p.xyz", "0 0 1\n9 0 2\n0 9 3\n9 9 5\n4 5 1\n");
  CHECK(session.run("encode p.xyz --units metre -o p.mtin").code == 0);
  const json stated = json_report(session, "info --json p.mtin");
  CHECK(!stated.contains("everywhere"));
  CHECK(stated.contains("at_samples"));
}

TEST_CASE("promises: verify finds each that the source breaks") {
  const Session session;
  session.write("t.asc", waves());
  REQUIRE(session.run("encode t.asc --units metre --max-error 2 -o t.mtin").code == 0);
  const Metadata kept = read_header(bytes_of_file(session.folder() + "/t.mtin")).metadata;
  REQUIRE(kept.everywhere.below > 0);
  REQUIRE(kept.everywhere.above > 0);
  struct Row {
    std::string said;  // empty: verify passes
    std::function<void(Metadata&)> change;
  };
  const Decimal less = {1, 6};
  for (const Row& row : std::vector<Row>{
           {"", [](Metadata&) {}},
           {"", [](Metadata& m) { m.everywhere = {}; }},
           {"", [](Metadata& m) { ++m.everywhere.below; }},
           {"", [](Metadata& m) { m.at_samples.reset(); }},
           {"", [](Metadata& m) { m.side = BoundSide::kNotStated; }},
           {"everywhere, the surface is below the source by up to ",
            [](Metadata& m) { --m.everywhere.below; }},
           {"everywhere, the surface is above the source by up to ",
            [](Metadata& m) { --m.everywhere.above; }},
           {"at its samples, the surface is below the source by up to ",
            [&](Metadata& m) { m.at_samples->below = less; }},
           {"at its samples, the surface is above the source by up to ",
            [&](Metadata& m) { m.at_samples->above = less; }},
           {"the surface is below the source, by ",
            [](Metadata& m) { m.side = BoundSide::kNeverBelow; }},
           {"the surface is above the source, by ",
            [](Metadata& m) { m.side = BoundSide::kNeverAbove; }},
       }) {
    CAPTURE(row.said);
    change(session, "f.mtin", row.change);
    const Session::Result verified = session.run("verify f.mtin t.asc --units metre");
    CHECK(verified.code == (row.said.empty() ? 0 : 1));
    CHECK(contains(verified.err, "f.mtin: " + row.said) == !row.said.empty());
  }
}

TEST_CASE("promises: verify names the tile whose margin the source breaks") {
  const Session session;
  session.write("t.asc", waves());
  const std::string words = "encode t.asc --units metre --max-error 2 --tile-vertices 60 -o t.mtp";
  REQUIRE(session.run(words).code == 0);
  const std::vector<uint8_t> bytes = bytes_of_file(session.folder() + "/t.mtp");
  const PackFile pack(bytes);
  std::vector<ForgedTile> tiles;
  std::optional<uint32_t> forged;
  for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(pack.entries()[tile].offset);
    std::vector<uint8_t> stream(begin, begin + pack.entries()[tile].size);
    Metadata notes = read_header(stream).metadata;
    if (!forged && notes.everywhere.below > 0 && notes.everywhere.below < pack.header().below) {
      forged = tile;
      --notes.everywhere.below;
    }
    tiles.push_back({with_metadata(stream, notes), pack.vertices(tile)});
  }
  REQUIRE(forged);
  Metadata metadata = pack.metadata();
  metadata.accuracy.reset();  // forged tiles have no errors, and those noted would be theirs
  write_file(session.folder() + "/f.mtp", forged_pack(pack.grid(), tiles, metadata));
  CHECK(session.run("verify t.mtp t.asc --units metre").code == 0);
  CHECK(contains(session.failure("verify f.mtp t.asc --units metre"),
                 "f.mtp: tile " + std::to_string(*forged) +
                     ": everywhere, the surface is below the source by up to "));
}
