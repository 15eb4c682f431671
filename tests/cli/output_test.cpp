// SPDX-License-Identifier: MIT
// Where output goes: standard descriptors that are closed or not read, names that lead elsewhere,
// inputs under other names. Nothing is lost but what could not be told, and the exit code says so.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/files/process.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

namespace fs = std::filesystem;

constexpr int kReportLost = 4;

// A session with a raster, points, and what is made of them.
struct MadeFiles : Session {
  MadeFiles() {
    REQUIRE(run("fractal --size 33 -o t.asc").code == 0);
    write("p.xyz", "0 0 0\n9 0 3\n0 9 7\n5 5 5\n");
    REQUIRE(run("encode t.asc --max-error 10 --fast -o t.mtin").code == 0);
    REQUIRE(run("encode t.asc --max-error 10 --tile-vertices 99 -o t.mtp").code == 0);
    REQUIRE(run("encode t.asc --max-error 10 --tile-vertices 99 --shard 0:9 -o s").code == 0);
    REQUIRE(run("merge s -o merged.mtp").code == 0);
  }

  // What is in the folder, with the content.
  std::vector<std::pair<std::string, std::string>> everything() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const auto& entry : fs::directory_iterator(folder())) {
      const std::string name = entry.path().filename();
      all.emplace_back(name, fs::is_regular_file(entry.path()) ? read(name) : "");
    }
    std::sort(all.begin(), all.end());
    return all;
  }
};

struct Output {
  std::string command, output, same_as;
};

// Pieces of a command, one behind the other.
std::string joined(std::initializer_list<std::string_view> pieces) {
  std::string text;
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

const std::vector<Output> kOutputs = {
    {"encode t.asc --max-error 10 --fast -o new.mtin", "new.mtin", "t.mtin"},
    {"encode t.asc --max-error 10 --tile-vertices 99 -o new.mtp", "new.mtp", "t.mtp"},
    {"encode t.asc --max-error 10 --tile-vertices 99 --shard 0:9 -o new", "new", "s"},
    {"merge s -o new.mtp", "new.mtp", "t.mtp"}};

const std::vector<std::string> kReports = {
    "info t.mtin",
    "info t.mtp --json",
    "verify t.mtin t.asc",
    "verify t.mtp t.asc",
    "--help",
    "encode --help",
    "help",
    "help encode",
    "plan t.asc --max-error 10 --tile-vertices 99 --shards 2"};

bool is_one_line(const std::string& text) {
  return text.find("microtin: ") == 0 && std::count(text.begin(), text.end(), '\n') == 1;
}

mode_t mode_of(const Session& session, const std::string& name) {
  struct stat status {};
  REQUIRE(stat((session.folder() + "/" + name).c_str(), &status) == 0);
  return status.st_mode & 07777;
}

}  // namespace

TEST_CASE("closed standard descriptors are held, and still fail") {
  for (int number = 0; number < 3; ++number) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      char byte = 0;
      close(number);
      const bool held = hold_closed_standard_files();
      const bool taken = open("/dev/null", O_RDWR) < 3;
      const ssize_t done = number == 0 ? read(number, &byte, 1) : ::write(number, &byte, 1);
      _exit(held && !taken && done < 0 && nobody_reads(errno) ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(status == 0);
  }
}

TEST_CASE("cli: a closed descriptor is not reused for a file, and a lost report has an exit code" *
          kSlow) {
  const MadeFiles made;
  for (const auto& [command, output, same_as] : kOutputs) {
    struct Closed {
      std::string how;
      int code;
      bool told;
    };
    for (const auto& [how, code, told] : {Closed{">&-", kReportLost, true},
                                          {"2>&-", 0, false},
                                          {"<&-", 0, false},
                                          {"<&- >&- 2>&-", kReportLost, false},
                                          {">/dev/null", 0, false},
                                          {"2>/dev/null", 0, false},
                                          {"</dev/null >/dev/null 2>/dev/null", 0, false}}) {
      const std::string words = joined({command, " ", how});
      CAPTURE(words);
      const Session::Result result = made.run(words);
      CHECK(result.code == code);
      CHECK(is_one_line(result.err) == told);
      CHECK(made.read(output) == made.read(same_as));
      fs::remove(made.folder() + "/" + output);
    }
  }
  const auto before = made.everything();
  for (const std::string& command : kReports) {
    CAPTURE(command);
    CHECK(made.run(command + " >&-").code == kReportLost);
    CHECK(is_one_line(made.run(command + " >&-").err));
    CHECK(made.run(command + " >/dev/null").code == 0);
  }
  CHECK(made.everything() == before);
}

TEST_CASE("cli: output and input on closed descriptors") {
  const MadeFiles made;
  CHECK(made.run("decode t.mtin -o - >&-").code == 1);
  CHECK(made.run("encode p.xyz -o - >&-").code == 1);
  CHECK(made.failure("encode - -o new.mtin <&-") == "-: cannot be read: Bad file descriptor\n");
  const Session::Result unheard = made.run("encode t.asc --max-error 10 --fast -o - 2>&-");
  CHECK(unheard.code == kReportLost);
  CHECK(unheard.out == made.read("t.mtin"));
  CHECK(made.run("decode gone.mtin -o - 2>&-").code == 1);
  made.write("other.xyz", "0 0 9999\n20 0 3\n0 20 7\n");
  CHECK(made.run("verify t.mtin other.xyz >&-").code == 1);  // it fails, whoever reads that
}

TEST_CASE("cli: the output is complete even if its report cannot be printed" * kSlow) {
  const MadeFiles made;
  for (const auto& [command, output, same_as] : kOutputs) {
    const std::string& words = command;
    CAPTURE(words);
    const Session::Result result =
        made.shell("{ sleep 0.1; microtin " + command + "; echo $? >code; } | true");
    CHECK(made.read("code") == "4\n");
    fs::remove(made.folder() + "/code");
    CHECK(is_one_line(result.err));
    CHECK(made.read(output) == made.read(same_as));
    fs::remove(made.folder() + "/" + output);
  }
  for (const std::string& command : kReports) {
    CAPTURE(command);
    made.shell("{ sleep 0.1; microtin " + command + "; echo $? >code; } | true");
    CHECK(made.read("code") == "4\n");
    fs::remove(made.folder() + "/code");
  }
  made.shell("{ sleep 0.1; microtin decode t.mtin -o -; echo $? >code; } | true");
  CHECK(made.read("code") == "1\n");
  for (const auto& [name, content] : made.everything()) CHECK_FALSE(contains(name, ".part-"));
}

TEST_CASE("cli: what a killed process left does not keep one of the same number from writing") {
  const MadeFiles made;
  for (const Output& o : kOutputs) {
    const std::string left = "touch " + o.output + ".part-$$ " + o.output + ".part-$$-0 " +
                             o.output + ".streams-$$; exec '" + program() + "' ";
    const Session::Result result = made.shell(left + o.command);
    CHECK_MESSAGE(result.code == 0, result.err);
    CHECK(made.read(o.output) == made.read(o.same_as));
    fs::remove(made.folder() + "/" + o.output);
  }
}

TEST_CASE("cli: no command writes over any of its inputs, by whatever name" * kSlow) {
  const MadeFiles made;
  made.shell(
      "mkdir folder; for f in t.asc t.mtin t.mtp s p.xyz; do ln $f hard-$f; ln -s $f soft-$f; "
      "ln -s ../$f folder/$f; done; cp t.asc m.asc; ln -s m.asc soft-m.asc; ln m.asc "
      "hard-m.asc; ln -s ../m.asc folder/m.asc; cp s s2");
  const auto before = made.everything();
  const std::string mask = " --max-error 10 --water-level 0 --water-mask m.asc";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"encode t.asc", "t.asc"},
      {"encode p.xyz --tile-vertices 99", "p.xyz"},
      {"encode t.asc --tile-vertices 99", "t.asc"},
      {"encode t.asc --tile-vertices 99 --shard 0:0", "t.asc"},
      {"encode t.asc" + mask, "m.asc"},
      {"encode t.asc --tile-vertices 99" + mask, "m.asc"},
      {"encode t.asc --tile-vertices 99 --shard 0:0" + mask, "m.asc"},
      {"merge s2 s", "s"},
      {"decode t.mtin --cell 1", "t.mtin"},
      {"decode t.mtp", "t.mtp"},
      {"embed t.mtin", "t.mtin"},
      {"render t.mtin", "t.mtin"},
      {"render t.mtin --source t.asc", "t.asc"},
      {"render t.mtp --source t.asc", "t.asc"},
      {"render t.mtp --source t.asc --water-level 0 --water-mask m.asc", "m.asc"}};
  for (const auto& [command, input] : cases) {
    for (const std::string& name : {input, "./" + input, "hard-" + input, "soft-" + input,
                                    "folder/" + input, made.folder() + "/" + input}) {
      CHECK(made.failure(joined({command, " -o ", name})) ==
            name + ": is also an input; choose another output\n");
    }
    CHECK(made.failure(joined({command, " -o - >>", input})) ==
          "standard output: is also an input; choose another output\n");
    CHECK(made.failure(joined({command, " -o new >>", input})) ==
          "standard output: is also an input; choose another output\n");
  }
  CHECK(made.failure("encode - -o p.xyz <p.xyz") ==
        "p.xyz: is also an input; choose another output\n");
  CHECK(made.failure("encode /dev/stdin -o p.xyz <p.xyz") ==
        "p.xyz: is also an input; choose another output\n");
  for (const std::string command : {"info t.mtin >>t.mtin", "verify t.mtin t.asc >>t.asc",
                                    "plan t.asc --tile-vertices 99 >>t.asc"}) {
    CHECK(made.failure(command) == "standard output: is also an input; choose another output\n");
  }
  CHECK(made.everything() == before);
}

TEST_CASE("cli: suffixes may be in capitals") {
  const MadeFiles made;
  REQUIRE(made.run("encode t.asc --max-error 10 --fast -o U.MTIN").code == 0);
  CHECK(made.read("U.MTIN") == made.read("t.mtin"));
  REQUIRE(made.run("encode t.asc --max-error 10 --tile-vertices 99 -o U.MTP").code == 0);
  CHECK(made.read("U.MTP") == made.read("t.mtp"));
  for (const auto& [output, begin] : std::initializer_list<std::pair<const char*, const char*>>{
           {"U.ASC", "ncols"}, {"U.PLY", "ply"}, {"U.GLB", "glTF"}}) {
    REQUIRE(made.run("decode t.mtin -o " + std::string(output)).code == 0);
    CHECK(made.read(output).rfind(begin, 0) == 0);
  }
  REQUIRE(made.run("render t.mtin -o U.SVG").code == 0);
  CHECK(contains(made.read("U.SVG"), "<svg"));
  CHECK(contains(made.failure("render t.mtin -o U.GIF"), "not a kind of picture"));
  for (const char* words : {"t.mtin -o U.html", "t.mtin -o U.png --source t.asc"}) {
    CHECK(contains(made.failure(joined({"render ", words, " --first-bytes 9"})), "leave it out"));
  }
  for (const char* bytes : {"9", "99999999"}) {
    CHECK(contains(made.failure(joined({"render t.mtp -o U.png --first-bytes ", bytes})),
                   "is a pack"));
  }
  CHECK(contains(made.failure("render t.mtin -o U.png --first-bytes 9"), "nothing to draw"));
}

TEST_CASE("cli: other names of standard output are standard output" * kSlow) {
  const MadeFiles made;
  made.shell("ln -s /dev/stdout link; ln -s link link2");
  for (const std::string command :
       {"encode t.asc --max-error 10 --fast", "merge s", "decode t.mtin", "embed t.mtin",
        "encode t.asc --max-error 10 --tile-vertices 99", "render t.mtin --width 200"}) {
    const Session::Result dash = made.run(command + " -o -");
    for (const std::string name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1",
                                   "/proc/self/../self/fd/1", "/proc/thread-self/fd/1", "link2"}) {
      CAPTURE(command);
      CAPTURE(name);
      made.write("log", "precious\n");
      const Session::Result result = made.run(joined({command, " -o ", name, " >>log"}));
      CHECK(result.code == 0);
      CHECK(result.err == dash.err);
      CHECK(made.read("log") == "precious\n" + dash.out);
    }
  }
  made.write("log", "precious\n");
  CHECK(made.run("encode t.asc --max-error 10 --fast -o /dev/fd/3 3>>log").code == 0);
  CHECK(made.read("log") == "precious\n" + made.read("t.mtin"));
  CHECK(contains(made.failure("encode t.asc -o /dev/fd/9"), "/dev/fd/9: cannot be written: "));
  CHECK(fs::is_symlink(made.folder() + "/link"));
  CHECK(fs::is_symlink("/dev/stdout"));
}

TEST_CASE("cli: output goes where a link leads, also if there is nothing yet" * kSlow) {
  const MadeFiles made;
  made.shell("mkdir folder; ln -s folder/new1 one; ln -s one two; ln -s '" + made.folder() +
             "/folder/new2' absolute; ln -s ring1 ring2; ln -s ring2 ring1; ln -s none/new deep");
  for (const auto& [command, output, same_as] : kOutputs) {
    const std::string words = command.substr(0, command.rfind("new"));
    const std::string pack = contains(output, ".mtp") ? " --tile-vertices 99" : "";
    for (const auto& [link, target] :
         {std::pair("two", "folder/new1"), {"absolute", "folder/new2"}}) {
      const std::string through = words + link;
      CAPTURE(through);
      for (int i = 0; i < 2; ++i) CHECK(made.run(through).code == 0);  // then it is there
      CHECK(made.read(target) == made.read(same_as));
      CHECK(fs::is_symlink(made.folder() + "/" + link));
      fs::remove(made.folder() + "/" + target);
      CHECK(made.run(words + link + " --nonsense").code == 2);
      CHECK_FALSE(fs::exists(made.folder() + "/" + target));
    }
    CHECK(contains(made.failure(words + "ring1"), "ring1: Too many levels of symbolic links"));
    CHECK(contains(made.failure(words + "deep"), "deep: cannot be written: No such file"));
  }
  CHECK(fs::is_symlink(made.folder() + "/one"));
}

TEST_CASE("cli: a file that is replaced keeps its mode") {
  const MadeFiles made;
  for (const auto& [command, output, same_as] : kOutputs) {
    for (const mode_t mode : {0600u, 0640u, 0666u, 0755u}) {
      made.write(output, "old");
      chmod((made.folder() + "/" + output).c_str(), mode);
      REQUIRE(made.run(command).code == 0);
      CHECK(mode_of(made, output) == mode);
      CHECK(made.read(output) == made.read(same_as));
    }
    fs::remove(made.folder() + "/" + output);
    made.shell("umask 027; microtin " + command);
    CHECK(mode_of(made, output) == 0640);
    fs::remove(made.folder() + "/" + output);
  }
}

TEST_CASE("cli: devices and pipes are written, not replaced") {
  const MadeFiles made;
  made.shell(
      "mkfifo pipe; cat pipe >got & microtin encode t.asc --max-error 10 --fast -o pipe; wait");
  CHECK(made.read("got") == made.read("t.mtin"));
  CHECK(fs::is_fifo(made.folder() + "/pipe"));
  CHECK(made.run("encode t.asc --max-error 10 --fast -o /dev/null").code == 0);
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("cli: the help lists the exit codes") {
  const Session session;
  const std::string help = session.run("--help").out;
  for (const char* const code : {"0 done", "1 failed", "2 wrong usage", "3 internal fault",
                                 "4 output complete, but the report"}) {
    CHECK(contains(help, code));
  }
}

TEST_CASE("cli: the program alone prints its help on standard error, as wrong usage") {
  const Session session;
  const Session::Result alone = session.run("");
  CHECK(alone.code == 2);
  CHECK(alone.out.empty());
  CHECK(alone.err == session.run("--help").out);
}

}  // namespace microtin::tests
