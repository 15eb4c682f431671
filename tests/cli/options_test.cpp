// SPDX-License-Identifier: MIT
// Every option of every command makes a difference to what the command writes or prints, and shards
// made with different options do not join unless these make no difference. An option without a row
// fails.
#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/members.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

// The long options of a command, as its help lists them.
Names options_of(const Session& session, const std::string& command) {
  const std::string help = session.run(command + " --help").out;
  const std::regex line("\n  (?:-\\w, )?(--[a-z-]+)");
  Names names;
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    names.insert((*at)[1]);
  }
  names.erase("--help");
  return names;
}

// Waves with a hole of a post, one at the rim, and a lake at 50; `change` more somewhere.
std::string grid(double change = 0) {
  std::string text =
      "ncols 40\nnrows 30\nxllcenter 500\nyllcenter 700\ncellsize 2\nnodata_value -9\n";
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 40; ++column) {
      double z = 60 + 25 * std::sin(column * 0.31) * std::cos(row * 0.23) + (7 * column + row) % 3;
      if (row > 9 && row < 16 && column > 9 && column < 17) z = 50;
      if (row == 20 && column == 7) z += change;
      const bool is_void = (row < 4 && column > 34) || (row == 22 && column == 30);
      text += is_void ? "-9" : std::to_string(z).substr(0, 4);
      text += column < 39 ? ' ' : '\n';
    }
  }
  return text;
}

// 1 at the lone void and 0 elsewhere.
std::string mask() {
  std::string text = "ncols 40\nnrows 30\nxllcenter 500\nyllcenter 700\ncellsize 2\n";
  for (int i = 0; i < 30 * 40; ++i) {
    text += i == 22 * 40 + 30 ? '1' : '0';
    text += i % 40 < 39 ? ' ' : '\n';
  }
  return text;
}

const char* const kTower =
    R"({"type": "Feature", "properties": {"top": 190}, "geometry":
{"type": "Point", "coordinates": [537, 741]}})";

const char* const kRoute =
    R"({"type": "LineString", "coordinates": [[504, 704], [540, 730], [560, 716]]})";

// A tight bound for some posts.
std::string bounds() {
  return R"({"type": "Feature", "properties": {"max_error": 0.5}, "geometry": {"type": "Polygon",
"coordinates": [[[520, 710], [540, 710], [540, 730], [520, 710]]]}})";
}

// Points of LAS 1.2, of classes 2 and 5.
std::string las_scan() {
  std::string las(227, '\0');
  las.replace(0, 4, "LASF");
  las[24] = 1;
  las[25] = 2;
  las[94] = las[96] = '\xE3';
  las[105] = 20;
  las[107] = 100;
  for (const size_t axis : {0u, 1u, 2u}) {
    las.replace(131 + 8 * axis, 8, std::string("\0\0\0\0\0\0\xF0\x3F", 8));  // a scale of 1
  }
  for (int i = 0; i < 100; ++i) {
    std::string point(20, '\0');
    point[0] = static_cast<char>(i % 10);
    point[4] = static_cast<char>(i / 10);
    point[8] = static_cast<char>(i * i % 23);
    point[15] = i % 7 == 3 ? 5 : 2;
    las += point;
  }
  return las;
}

struct OptionRow {
  std::string command, option;
  std::string words;  // without the option
  std::string value;  // of the option
};

const char* const kProfile = "t.mtin 500 700 570 750";
const char* const kRender = "m.mtin -o m.png --width 300";

const std::vector<OptionRow> kOptionRows = {
    {"encode", "--max-error", "t.asc -o o.mtin", "2"},
    {"encode", "--max-vertices", "t.asc -o o.mtin", "99"},
    {"encode", "--max-bytes", "t.asc --fast -o o.mtin", "300"},
    {"encode", "--tile-vertices", "t.asc --max-error 2 -o o.mtp", "60"},
    {"encode", "--tile-size", "t.asc --max-error 2 --tile-vertices 90 -o o.mtp", "9"},
    {"encode", "--device-ram", "t.asc -o o.mtin", "9000"},
    {"encode", "--error-map", "t.asc --max-error 2 -o o.mtin", "bounds.geojson"},
    {"encode", "--breaklines", "t.asc --max-error 2 -o o.mtin", "route.geojson"},
    {"encode", "--for", "t.asc --device-ram 60000 -o o.mtin", "inav"},
    {"encode", "--never-below", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--bound-at", "p.xyz --max-error 2 --xy-step 0.05 -o o.mtin", "lattice"},
    {"encode", "--duplicates", "p.xyz --max-error 2 -o o.mtin", "lowest"},
    {"encode", "--fast", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--best", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--z-step", "t.asc --max-error 2 -o o.mtin", "0.7"},
    {"encode", "--xy-step", "t.asc --max-error 2 -o o.mtin", "0.5"},
    {"encode", "--max-degree", "t.asc --max-error 2 -o o.mtin", "6"},
    {"encode", "--coding", "t.asc --max-error 2 -o o.mtin", "quick"},
    {"encode", "--area", "t.asc --max-error 2 -o o.mtin", "bounds.geojson"},
    {"encode", "--obstacles", "t.asc --max-error 99 -o o.mtin", "tower.geojson"},
    {"encode", "--route", "t.asc --max-error 2 --route-width 9 -o o.mtin", "route.geojson"},
    {"encode", "--route-edge-error",
     "t.asc --max-error 2 --route route.geojson --route-width 9 -o o.mtin", "9"},
    {"encode", "--route-width", "t.asc --max-error 2 --route route.geojson -o o.mtin", "9"},
    {"encode", "--classes", "s.las -o o.mtin", "all"},
    {"encode", "--fill-voids", "t.asc --max-error 2 -o o.mtin", "1"},
    {"encode", "--water-level", "t.asc --max-error 2 -o o.mtin", "50"},
    {"encode", "--cells", "t.asc -o o.mtin", "list"},
    {"encode", "--absent", "t.asc apart.asc --water-level 50 -o o.mtin", "sea"},
    {"encode", "--resume", "t.asc -o o.mtin", "log"},  // refused
    {"encode", "--water-mask", "t.asc --max-error 2 --water-level 50 -o o.mtin", "mask.asc"},
    {"encode", "--epsg", "t.asc --max-error 2 -o o.mtin", "25832"},
    {"encode", "--units", "t.asc --max-error 2 -o o.mtin", "foot"},
    {"encode", "--depths", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--gridded", "g.xyz --max-error 2 -o o.mtin", ""},
    {"encode", "--surface", "t.asc --max-error 2 -o o.mtin", "ground"},
    {"encode", "--source-name", "t.asc --max-error 2 -o o.mtin", "survey"},
    {"encode", "--date", "t.asc --max-error 2 -o o.mtin", "2026"},
    {"encode", "--lineage", "t.asc --max-error 2 -o o.mtin", "thinned"},
    {"encode", "--digest", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--phases", "t.asc --max-error 2 -o o.mtin", ""},
    {"encode", "--attribution", "t.asc --max-error 2 -o o.mtin", "survey"},
    {"encode", "--license", "t.asc --max-error 2 -o o.mtin", "CC0-1.0"},
    {"encode", "--valid", "t.asc --max-error 2 -o o.mtin", "2024/.."},
    {"encode", "--epoch", "t.asc --max-error 2 -o o.mtin", "2020.5"},
    {"encode", "--source-accuracy", "t.asc --max-error 2 -o o.mtin", "'LE90 4'"},
    {"encode", "--shard", "t.asc --max-error 2 --tile-vertices 60 -o o.mtp", "0:1"},
    {"encode", "--output", "", ""},
    {"plan", "--shards", "t.asc --max-error 2 --tile-vertices 60", "2"},
    {"update", "--tile-vertices", "s.mtp peak.asc -o o.mtp", "16"},
    {"update", "--best", "m.mtp peak.asc --tile-vertices 300 -o o.mtp", ""},
    {"update", "--error-map", "bounded.mtp t.asc -o o.mtp", "bounds.geojson"},
    {"update", "--bound-at", "m.mtp peak.asc --tile-vertices 300 -o o.mtp", "everywhere"},
    {"update", "--breaklines", "m.mtp t.asc --tile-vertices 300 -o o.mtp", "route.geojson"},
    {"update", "--obstacles", "tower.mtp t.asc --tile-vertices 300 -o o.mtp", "tower.geojson"},
    {"update", "--fill-voids", "s.mtp t.asc --tile-vertices 300 -o o.mtp", "1"},
    {"update", "--date", "s.mtp t.asc -o o.mtp", "2026"},
    {"merge", "--output", "", ""},
    {"decode", "--output", "", ""},
    {"decode", "--cell", "t.mtin -o o.asc", "1"},
    {"decode", "--extent", "t.mtin -o o.asc", "510,710,520,720"},
    {"decode", "--like", "t.mtin -o o.asc", "part.asc"},
    {"decode", "--lattice", "t.mtin -o o.xyz", ""},
    {"decode", "--force", "", ""},  // a gigabyte: tests/cli/decode_grid_test.cpp
    {"embed", "--output", "", ""},
    {"height", "--lattice", "t.mtin 20 20", ""},
    {"height", "--device", "t.mtin 520.0038 720.0038", ""},
    {"profile", "--output", "", ""},
    {"profile", "--samples", "t.mtin 500 700 570 750", "3"},
    {"profile", "--width", "t.mtin 500 700 570 750 -o o.png", "300"},
    {"profile", "--json", "t.mtin 500 700 570 750", ""},
    {"profile", "--from-height", kProfile, "9"},
    {"profile", "--to-height", kProfile, "9"},
    {"profile", "--from-altitude", kProfile, "99"},
    {"profile", "--to-altitude", kProfile, "99"},
    {"profile", "--earth-factor", "t.mtin 500 700 570 750 --to-height 5", "flat"},
    {"profile", "--frequency", "t.mtin 500 700 570 750 --to-height 5", "868"},
    {"profile", "--zone-share",
     "t.mtin 500 700 570 750 --to-altitude 98.5 --from-altitude 98.5 "
     "--frequency 1",
     "10"},
    {"profile", "--safe", "t.mtin 500 700 570 750 --to-height 5", ""},
    {"info", "--json", "t.mtin", ""},
    {"check", "--json", "t.mtin", ""},
    {"diff", "--json", "s.mtp s.mtp", ""},
    {"verify", "--json", "t.mtin t.asc", ""},
    {"verify", "--area", "m.mtin t.asc", "bounds.geojson"},
    {"verify", "--obstacles", "tower.mtin t.asc", "tower.geojson"},
    {"verify", "--route-edge-error", "r.mtin t.asc --route route.geojson --route-width 9", "9"},
    {"verify", "--route", "m.mtin t.asc --route-width 9", "route.geojson"},
    {"verify", "--route-width", "m.mtin t.asc --route route.geojson", "9"},
    {"verify", "--classes", "s.mtin s.las", "2"},
    {"verify", "--epsg", "m.mtin t.asc", "32633:5715"},
    {"verify", "--units", "m.mtin t.asc", ":cm"},
    {"verify", "--depths", "m.mtin t.asc", ""},
    {"verify", "--gridded", "t.mtin g.xyz", ""},
    {"verify", "--never-below", "m.mtin t.asc", ""},
    {"verify", "--error-map", "bounded.mtp t.asc", "bounds.geojson"},
    {"verify", "--breaklines", "m.mtin t.asc", "route.geojson"},
    {"verify", "--fill-voids", "m.mtin t.asc", "1"},
    {"verify", "--water-level", "m.mtin t.asc", "50"},
    {"verify", "--cells", "t.mtin t.asc", "list"},
    {"verify", "--absent", "seas.mtin t.asc apart.asc --water-level 50", "sea"},
    {"verify", "--water-mask", "lake.mtin t.asc --water-level 50", "mask.asc"},
    {"fractal", "--output", "", ""},
    {"fractal", "--size", "-o o.asc", "9"},
    {"fractal", "--seed", "-o o.asc --size 9", "2"},
    {"render", "--output", "", ""},
    {"render", "--width", "m.mtin -o m.png", "300"},
    {"render", "--no-mesh", kRender, ""},
    {"render", "--palette", "sea.mtin -o o.png --width 300", "sea"},
    {"render", "--contours", kRender, "5"},
    {"render", "--coordinates", kRender, ""},
    {"render", "--title", kRender, "Hills"},
    {"render", "--first-bytes", kRender, "90"},
    {"render", "--north-arrow", kRender, ""},
    {"render", "--world-file", kRender, ""},
    {"render", "--source", kRender, "t.asc"},
    {"render", "--area", "m.mtin -o o.png --width 300 --source t.asc", "bounds.geojson"},
    {"render", "--route", "m.mtin -o o.png --width 300 --source t.asc --route-width 9",
     "route.geojson"},
    {"render", "--route-width", "m.mtin -o o.png --width 300 --source t.asc --route route.geojson",
     "9"},
    {"render", "--classes", "s.mtin -o o.png --width 300 --source s.las", "2"},
    {"render", "--epsg", "m.mtin -o o.png --width 300 --source t.asc", "32633:5715"},
    {"render", "--units", "m.mtin -o o.png --width 300 --source t.asc", ":cm"},
    {"render", "--depths", "m.mtin -o o.png --width 300 --source t.asc", ""},
    {"render", "--gridded", "filled.mtin -o m.png --width 300 --source p.xyz", ""},
    {"render", "--force", "", ""},  // 2^24 vertices: tests/cli/decode_grid_test.cpp
    {"render", "--fill-voids", "filled.mtin -o o.png --width 300 --source t.asc", "99"},
    {"render", "--water-level", "lake.mtin -o m.png --width 300 --source t.asc", "50"},
    {"render", "--cells", "seas.mtin -o o.png --width 300 --source t.asc", "far"},
    {"render", "--absent",
     "seas.mtin -o o.png --width 300 --source t.asc --source apart.asc --water-level 50", "sea"},
    {"render", "--water-mask", "water.mtin -o o.png --width 300 --source t.asc --water-level 50",
     "mask.asc"},
};

// All that a command says and leaves behind.
std::string all_of(const Session& session, const std::string& words) {
  const Session::Result made = session.run(words);
  std::string all = std::to_string(made.code) + made.out + made.err;
  for (const char* name : {"o.mtin", "o.mtp", "o.asc", "o.xyz", "o.png", "m.png", "m.pgw"}) {
    all += std::string("\n") + name + "\n" + session.read(name);
    std::filesystem::remove(session.folder() + "/" + name);
  }
  return all;
}

// The files that the rows name.
void write_inputs(const Session& session) {
  session.write("t.asc", grid());
  session.write("peak.asc", grid(30));
  session.write("mask.asc", mask());
  session.write("bounds.geojson", bounds());
  session.write("route.geojson", kRoute);
  session.write("tower.geojson", kTower);
  session.write("s.las", las_scan());
  session.write("part.asc",
                "ncols 2\nnrows 2\nxllcenter 510\nyllcenter 710\ncellsize 4\n1 2 3 4\n");
  const auto beside = [](const std::string& x) {
    return "ncols 2\nnrows 2\nxllcenter " + x + "\nyllcenter 700\ncellsize 2\n61 62 63 64\n";
  };
  session.write("beside.asc", beside("580"));
  session.write("apart.asc", beside("590"));
  session.write("list", "beside.asc\n");
  session.write("far", "apart.asc\n");
  std::string points = "10 10 3\n10 10 4\n";
  for (int i = 0; i < 200; ++i) {
    points += std::to_string(i * 7919 % 1000) + '.' + std::to_string(10 + i % 89) + ' ' +
              std::to_string(i * 104729 % 997) + " " + std::to_string(i % 9) + '\n';
  }
  session.write("p.xyz", points);
  session.write("sea.xyz", "0 0 -9\n9 0 5\n0 9 3\n9 9 -4\n");
  for (const char* words :
       {"t.asc -o t.mtin", "t.asc --max-error 2 -o m.mtin", "s.las -o s.mtin --classes all",
        "t.asc --tile-size 9 -o s.mtp", "t.asc --max-error 1 --tile-size 20 -o m.mtp",
        "t.asc --max-error 99 --obstacles tower.geojson -o tower.mtin",
        "t.asc --max-error 99 --obstacles tower.geojson -o tower.mtp",
        "t.asc --max-error 2 --route route.geojson --route-width 9 --route-edge-error 9 -o r.mtin",
        "t.asc --max-error 1 -o fine.mtin", "sea.xyz -o sea.mtin",
        "t.asc apart.asc --water-level 50 --absent sea -o seas.mtin",
        "t.asc --max-error 2 --fill-voids 99 -o filled.mtin",
        "t.asc --max-error 2 --error-map bounds.geojson --tile-vertices 60 -o bounded.mtp",
        "t.asc --max-error 2 --water-level 50 -o water.mtin",
        "t.asc --max-error 2 --water-level 50 --water-mask mask.asc -o lake.mtin"}) {
    REQUIRE(session.run(std::string("encode ") + words).code == 0);
  }
  REQUIRE(session.run("decode t.mtin -o g.xyz").code == 0);
}

}  // namespace

TEST_CASE("options: each of every command makes a difference" * kSlow) {
  const Session session;
  write_inputs(session);
  int number = 0;
  for (const OptionRow& row : kOptionRows) {
    if (row.words.empty() || (kIsSanitized && ++number % 8 != 0)) continue;
    CAPTURE(row.command);
    CAPTURE(row.option);
    std::string words = row.command;
    words.append(" ").append(row.words);
    const std::string without = all_of(session, words);
    CHECK(without != all_of(session, words + " " + row.option + " " + row.value));
  }
}

namespace {

// The number or word that the help page prints as an option's default; empty if there is none, or
// words that describe it.
std::string default_of(const Session& session, const std::string& command,
                       const std::string& option) {
  const std::string help = session.run(command + " --help").out;
  const size_t begin = help.find("\n  " + option + ' ');
  if (begin == std::string::npos) return "";
  const std::string entry = help.substr(begin, help.find("\n  -", begin + 1) - begin);
  const std::regex numbers(R"(default:\s+([0-9]+)\b)"),
      words(R"( \S+\|\S+\s[^]*default:\s+(\w+)\))");
  std::smatch found;
  const bool is_literal =
      std::regex_search(entry, found, numbers) || std::regex_search(entry, found, words);
  return is_literal ? found[1].str() : "";
}

}  // namespace

TEST_CASE("options: the default of the help page makes no difference" * kSlow) {
  const Session session;
  write_inputs(session);
  Names compared;
  for (const OptionRow& row : kOptionRows) {
    const std::string usual = default_of(session, row.command, row.option);
    if (usual.empty()) continue;
    CAPTURE(row.command);
    CAPTURE(row.option);
    compared.insert(row.option);
    if (kIsSanitized && compared.size() % 8 != 0) continue;
    std::string words = row.command;
    words.append(" ").append(row.words);
    const std::string without = all_of(session, words);
    CHECK(without == all_of(session, words.append(" ").append(row.option + " " + usual)));
  }
  CHECK(text_of(compared) ==
        text_of(Names{"--absent", "--bound-at", "--coding", "--duplicates", "--fill-voids",
                      "--palette", "--seed", "--shards", "--size", "--surface", "--tile-vertices",
                      "--width", "--zone-share"}));
}

TEST_CASE("options: none is without a row") {
  const Session session;
  for (const char* command : {"encode", "merge", "decode", "embed", "height", "profile", "info",
                              "check", "diff", "verify", "fractal", "render"}) {
    CAPTURE(command);
    Names known;
    for (const OptionRow& row : kOptionRows) {
      if (row.command == command) known.insert(row.option);
    }
    // These are in a program with GDAL alone, and checked by tests/import/gdal_test.cpp.
    const Names options = without(options_of(session, command), {"--allow-vrt", "--band"});
    CHECK(text_of(options) == text_of(known));
  }
  const Names encode = without(options_of(session, "encode"), {"--output", "--resume", "--shard"});
  CHECK(text_of(options_of(session, "plan")) == text_of(united(encode, {"--shards"})));
  // Each of update is also one of encode, and read by the same code.
  CHECK(text_of(without(options_of(session, "update"), options_of(session, "encode"))) == "");
}

namespace {

// Options that differ from those of kCommon, or add to them.
const std::vector<std::string> kOfShards = {
    "--max-error 11",
    "--tile-vertices 121",
    "--tile-size 9",
    "--z-step 0.6",
    "--never-below",
    "--error-map bounds.geojson",
    "--bound-at lattice",
    "--bound-at everywhere",
    "--obstacles tower.geojson",
    "--breaklines route.geojson",
    "--fast",
    "--duplicates lowest",
    "--best",
    "--max-degree 6",
    "--max-degree 20",
    "--coding quick",
    "--coding dense",
    "--area bounds.geojson",
    "--route route.geojson --route-width 9",
    "--route route.geojson --route-width 9 --route-edge-error 30",
    "--fill-voids 1",
    "--epsg 25832",
    "--water-level 50",
    "--units foot",
    "--depths",
    "--date 2026",
    "--lineage thinned",
    "--water-level 50 --water-mask mask.asc",
    "--source-name s",
    "--surface top",
    "--attribution a",
    "--license MIT",
    "--valid ../2025",
    "--epoch 2020",
    "--source-accuracy 'RMSE 1'",
};

// Rules for points, which say nothing of a raster.
const std::set<std::string> kWithoutEffect = {"", "--bound-at lattice", "--duplicates lowest"};

// With which no shard of posts is made, or which say which shard.
const Names kNotOfShards = {"--digest",  "--phases",     "--max-vertices", "--max-bytes",
                            "--xy-step", "--device-ram", "--output",       "--shard",
                            "--classes", "--gridded",    "--for"};

const std::vector<std::string> kCommon = {"--max-error 12", "--z-step 0.5", "--tile-vertices 120",
                                          "--tile-size 10"};

std::string name_of(const std::string& option) {
  return option.substr(0, option.find(' '));
}

// The common options, of which one may be another.
std::string with(const std::string& option) {
  std::string words;
  for (const std::string& common : kCommon) {
    if (name_of(common) != name_of(option)) words += " " + common;
  }
  return words + " " + option;
}

}  // namespace

TEST_CASE("options: shards with another option do not join" * kSlow) {
  const Session session;
  session.write("t.asc", grid());
  session.write("u.asc", grid(0.1));
  session.write("mask.asc", mask());
  session.write("bounds.geojson", bounds());
  session.write("route.geojson", kRoute);
  session.write("tower.geojson", kTower);
  const auto encode = [&](const std::string& words) {
    const Session::Result made = session.run("encode " + words);
    CHECK_MESSAGE(made.code == 0, (words + made.err));
  };
  encode("t.asc" + with("") + " --shard 0:5 -o first");
  encode("t.asc" + with("") + " -o base.mtp");
  const auto joins = [&](const std::string& words) {
    CAPTURE(words);
    encode(words + " -o other.mtp");
    encode(words + " --shard 6:11 -o rest");
    const bool is_joined = session.run("merge first rest -o merged.mtp").code == 0;
    if (is_joined) {
      CHECK((session.read("merged.mtp") == session.read("base.mtp")));
      CHECK((session.read("merged.mtp") == session.read("other.mtp")));
    }
    return is_joined;
  };
  CHECK(joins("t.asc" + with("")));
  CHECK(!joins("u.asc" + with("")));
  for (const std::string& option : kOfShards) {
    CAPTURE(option);
    CHECK(joins("t.asc" + with(option)) == (kWithoutEffect.count(option) != 0));
  }
}

TEST_CASE("options: none is without a row in the table of shards") {
  const Session session;
  Names known = kNotOfShards;
  for (const std::string& option : kOfShards) known.insert(name_of(option));
  for (const char* const name :
       {"--absent", "--cells", "--resume", "--route-edge-error", "--route-width", "--water-mask"}) {
    known.insert(name);
  }
  CHECK(text_of(without(options_of(session, "encode"), {"--allow-vrt", "--band"})) ==
        text_of(known));
}
