// SPDX-License-Identifier: MIT
// Lists of cells, what is absent, and runs that go on where another one stopped.
#include <doctest/doctest.h>

#include <string>

#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// An .hgt cell of 5 x 5 posts of one height, of which one is void.
std::string cell(char height) {
  std::string bytes;
  for (int i = 0; i < 25; ++i) bytes += i == 12 ? std::string("\x80\0", 2) : std::string{0, height};
  return bytes;
}

// Two cells on a diagonal: two of the four are in no file.
struct Cells : Session {
  Cells() {
    std::filesystem::create_directory(folder() + "/data");
    write("data/N50E006.hgt", cell(9));
    write("data/N51E007.hgt", cell(8));
  }

  std::string height(const std::string& file, const std::string& place) const {
    return run("height " + file + " " + place).out;
  }
};

}  // namespace

TEST_CASE("cells: a list names files and folders, relative to its own") {
  const Cells session;
  REQUIRE(session.run("encode data -o a.mtp").code == 0);
  session.write("data/list", "# Europe\n\n  N50E006.hgt\r\nN51E007.hgt\n");
  session.write("list",
                "\xEF\xBB\xBF"
                "data");
  for (const std::string list : {"data/list", "list"}) {
    REQUIRE(session.run("encode --cells " + list + " -o b.mtp").code == 0);
    CHECK(session.read("b.mtp") == session.read("a.mtp"));
    CHECK(session.run("verify b.mtp --cells " + list).code == 0);
  }
  session.write("rest", "data/N51E007.hgt\n");
  REQUIRE(session.run("encode data/N50E006.hgt --cells rest -o c.mtp").code == 0);
  CHECK(session.read("c.mtp") == session.read("a.mtp"));
  session.write("none", "# nothing\n");
  session.write("bad", "data\nsea N50\n");
  CHECK(session.failure("encode --cells none -o d.mtp") ==
        "none: names no file; write one on each line\n");
  CHECK(session.failure("encode --cells bad -o d.mtp") ==
        "bad, line 2: 'N50' is not a cell of one degree; write it as N50W010\n");
  session.write("mac", "# one\rdata\r\rsea\tN50E007\r");
  CHECK(session.run("encode --cells mac --water-level 0 -o d.mtp").code == 0);
  CHECK(contains(session.failure("encode --cells mac -o d.mtp"),
                 "mac: marks cells as sea, which need its height; set --water-level"));
  session.write("metres.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4\n");
  session.write("metres", "metres.asc\nsea N50E007\n");
  CHECK(contains(session.failure("encode --cells metres --water-level 0 --units metre -o d.mtp"),
                 "metres: marks cells of degrees as sea"));
  CHECK(contains(session.failure("encode -o d.mtp", 2), "TERRAIN is required"));
  CHECK(contains(session.failure("encode --cells missing -o d.mtp"), "missing: "));
}

TEST_CASE("cells: what is absent is not an ocean unless somebody says so" * kSlow) {
  const Cells session;
  session.write("list", "data\nsea N50E007\n");
  for (const std::string file : {"t.mtin", "t.mtp"}) {
    const std::string encode = "encode -o " + file + ' ', verify = "verify " + file + ' ';
    const auto heights = [&](const std::string& options) {
      const Session::Result made = session.run(encode + options);
      REQUIRE_MESSAGE(made.code == 0, made.err);
      CHECK(session.run(verify + options).code == 0);
      // A void post of a cell, an absent cell in the south-east, and one in the north-west.
      return session.height(file, "6.5 50.5") + session.height(file, "7.5 50.5") +
             session.height(file, "6.5 51.5");
    };
    CHECK(heights("data") == "void\nvoid\nvoid\n");
    CHECK(heights("data --water-level 0") == "0\nvoid\nvoid\n");
    CHECK(heights("data --water-level 0 --absent void") == "0\nvoid\nvoid\n");
    CHECK(heights("data --water-level 0 --absent sea") == "0\n0\n0\n");
    CHECK(heights("--cells list --water-level 0") == "0\n0\nvoid\n");
  }
  CHECK(session.run("encode data --absent sea -o u.mtp").code == 2);
}

TEST_CASE("cells: a terrain has more files than a process may have open") {
  const Session session;
  std::filesystem::create_directory(session.folder() + "/data");
  for (int i = 0; i < 180; ++i) {
    session.write("data/N0" + std::to_string(i / 90) + "E0" + std::to_string(10 + i % 90) + ".hgt",
                  cell(static_cast<char>(i % 90)));
  }
  REQUIRE(session.run("encode data --max-error 9 --fast -o a.mtp").code == 0);
  const Session::Result few =
      session.shell("ulimit -n 160 && microtin encode data --max-error 9 --fast -o b.mtp");
  CHECK_MESSAGE(few.code == 0, few.err);
  CHECK(session.read("a.mtp") == session.read("b.mtp"));
}

TEST_CASE("resume: a run goes on where another one stopped, and makes the same pack" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 257 --seed 3 -o t.asc").code == 0);
  const std::string options = "encode t.asc --units metre --max-error 10 --tile-size 32 --fast ";
  REQUIRE(session.run(options + "-o whole.mtp").code == 0);
  REQUIRE(session.run(options + "--shard 0:63 -o all").code == 0);
  const std::string all = session.read("all"), whole = session.read("whole.mtp");
  // A log is the beginning of a shard; whatever it holds of a tile that is not whole goes.
  for (const size_t size :
       {size_t{0}, size_t{3}, size_t{60}, all.size() / 3, all.size() - 1, all.size()}) {
    CAPTURE(size);
    session.write("log", all.substr(0, size));
    const Session::Result made = session.run(options + "--resume log -o t.mtp");
    REQUIRE_MESSAGE(made.code == 0, made.err);
    CHECK(session.read("t.mtp") == whole);
    CHECK(!std::filesystem::exists(session.folder() + "/log"));
  }
  std::string damaged = all.substr(0, all.size() / 2);
  damaged[damaged.size() - 5] = static_cast<char>(damaged[damaged.size() - 5] ^ 1);
  session.write("log", damaged);
  REQUIRE(session.run(options + "--resume log -o t.mtp").code == 0);
  CHECK(session.read("t.mtp") == whole);
  session.write("log", all);
  const std::string other = "encode t.asc --units metre --max-error 11 --tile-size 32 --fast ";
  CHECK(session.failure(other + "--resume log -o u.mtp") ==
        "t.asc: log: holds tiles of another terrain, or made with other options; remove it\n");
  CHECK(session.read("log") == all);
  CHECK(contains(session.failure("encode t.asc --units metre --fast --resume log -o u.mtin"),
                 "--resume is for packs"));
}

TEST_CASE("resume: the file of finished tiles is neither an input nor the output") {
  const Session session;
  REQUIRE(session.run("fractal --size 17 -o t.asc").code == 0);
  const std::string encode = "encode t.asc --tile-vertices 60 -o t.mtp --resume ";
  CHECK(contains(session.failure(encode + "t.mtp"), "t.mtp: is also the output"));
  CHECK(contains(session.failure(encode + "./t.mtp"), "./t.mtp: is also the output"));
  CHECK(contains(session.failure(encode + "t.asc"), "t.asc: is also an input"));
  REQUIRE(session.run(encode + "log").code == 0);
  CHECK(contains(session.failure(encode + "t.mtp"), "t.mtp: is also the output"));
}

TEST_CASE("resume: a run that is killed has kept its tiles, and a shard goes on too" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 513 --seed 3 -o t.asc").code == 0);
  const std::string options =
      "encode t.asc --units metre --max-error 5 --tile-size 32 --z-step 2 --fast ";
  REQUIRE(session.run(options + "--shard 10:200 -o whole").code == 0);
  // Stopped when the log has some tiles.
  session.shell("'" + program() + "' " + options +
                "--shard 10:200 --resume log -o part & pid=$!; "
                "until [ $(stat -c %s log 2>/dev/null || echo 0) -gt 9000 ]; do sleep 0.02; done; "
                "kill -9 $pid; wait $pid");
  REQUIRE(std::filesystem::exists(session.folder() + "/log"));
  CHECK(session.read("log").size() > 9000);
  CHECK(session.read("whole").substr(0, 9000) == session.read("log").substr(0, 9000));
  REQUIRE(session.run(options + "--shard 10:200 --resume log -o part").code == 0);
  CHECK(session.read("part") == session.read("whole"));
}

}  // namespace microtin::tests
