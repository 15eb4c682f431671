// SPDX-License-Identifier: MIT
// Memory that runs out and files that fail, at every call in turn: each command ends with an error
// of one line and without a file, or as if nothing had been.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/faults/injected.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

int microtin_main(int argc, char** argv);  // the program's, renamed

namespace microtin::faults {

using namespace tests;

namespace {

using Words = std::vector<std::string>;

// Counters in memory that child processes share, so that the parent learns what they counted.
Counters& shared_counters() {
  void* const page =
      mmap(nullptr, sizeof(Counters), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  REQUIRE(page != MAP_FAILED);
  return *new (page) Counters();
}

// A folder with what the commands read, and what became of it.
class Stage {
 public:
  using Files = std::map<std::string, std::vector<uint8_t>>;
  struct Result {
    int status;  // as wait() tells
    std::string error;
    Files files;
  };

  Stage() {
    const std::string grid =
        "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 2\nnodata_value -1\n"
        "1 2 3 4\n5 9 7 8\n-1 -1 3 9\n";
    const std::string points = "0 0 1\n10.5 0 2\n0 10 3\n4 4 9\n";
    write_file(folder_ / "t.asc", {grid.begin(), grid.end()});
    write_file(folder_ / "p.xyz", {points.begin(), points.end()});
    for (const Words& words :
         {Words{"encode", "t.asc", "-o", "t.mtin"},
          Words{"encode", "t.asc", "--tile-vertices", "16", "--tile-size", "3", "-o", "t.mtp"},
          Words{"encode", "t.asc", "--tile-vertices", "16", "--tile-size", "3", "--shard", "0:0",
                "-o", "t.shard"}}) {
      const Result encoded = run(words);
      REQUIRE_MESSAGE(encoded.status == 0, encoded.error);
    }
  }

  // Runs the program in a child process. New files are taken away again.
  Result run(const Words& words, const Counters& faults = {}) {
    counters_ = faults;
    const std::string errors = errors_ / "err";
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) run_as_child(words, errors);
    Result result{};
    REQUIRE(waitpid(child, &result.status, 0) == child);
    const std::vector<uint8_t> text = bytes_of_file(errors);
    result.error.assign(text.begin(), text.end());
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      result.files[name] = bytes_of_file(entry.path());
      if (name.find("new") == 0) std::filesystem::remove(entry.path());
    }
    return result;
  }

  const Counters& counters() const { return counters_; }

  void write(const std::string& name, const std::vector<uint8_t>& bytes) const {
    write_file(folder_ / name, bytes);
  }
  std::vector<uint8_t> read(const std::string& name) const { return bytes_of_file(folder_ / name); }

 private:
  [[noreturn]] void run_as_child(Words words, const std::string& errors) {
    const bool ready = chdir(folder_.path().c_str()) == 0 &&
                       dup2(open("out", O_WRONLY | O_CREAT | O_TRUNC, 0600), 1) >= 0 &&
                       dup2(open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2) >= 0;
    if (!ready) _exit(99);
    words.insert(words.begin(), "microtin");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    inject(&counters_);
    const int code = microtin_main(static_cast<int>(words.size()), argv.data());
    inject(nullptr);
    _exit(code);
  }

  TemporaryFolder folder_, errors_;
  Counters& counters_ = shared_counters();
};

bool is_one_line(const std::string& text) {
  return text.find("microtin: ") == 0 && std::count(text.begin(), text.end(), '\n') == 1 &&
         text.back() == '\n';
}

// Whether the command failed with a message and without a file of its own, whole or in part.
bool is_clean_failure(const Stage::Result& result) {
  return WIFEXITED(result.status) && WEXITSTATUS(result.status) == 1 && is_one_line(result.error) &&
         std::none_of(result.files.begin(), result.files.end(),
                      [](const auto& file) { return file.first.find("new") == 0; });
}

struct Outcome {
  uint64_t faults = 0, failures = 0, unclean = 0;
};

// Lets every `stride`-th of what `counter` counts fail, from the one numbered `begin` on.
Outcome fail_each(Stage& stage, const Words& words, Counter Counters::*counter, bool lasting,
                  uint64_t begin, uint64_t stride) {
  const Stage::Result whole = stage.run(words);
  CHECK_MESSAGE(whole.status == 0, whole.error);
  Outcome outcome;
  const uint64_t asked = (stage.counters().*counter).asked;
  for (uint64_t first = begin; first <= asked; first += stride) {
    Counters faults;
    (faults.*counter).first = first;
    (faults.*counter).lasting = lasting;
    const Stage::Result result = stage.run(words, faults);
    const bool failed = result.status != 0;
    ++outcome.faults;
    outcome.failures += failed;
    if (failed ? is_clean_failure(result) : result.files == whole.files) continue;
    ++outcome.unclean;
    CAPTURE(first);
    CAPTURE(result.status);
    CHECK_MESSAGE(false, result.error);
    if (outcome.unclean > 5) break;
  }
  return outcome;
}

constexpr uint64_t kStride = kIsSanitized ? 40 : 1;

// Pictures ask for memory thousands of times, in few places.
uint64_t sparseness(const Words& words) {
  return words[0] == "render" || words.back() == "new.svg" ? 199 : 1;
}

const std::vector<Words> kCommands = {
    {"encode", "t.asc", "-o", "new.mtin", "--max-error", "1"},
    {"encode", "p.xyz", "-o", "new.mtin"},
    {"encode", "p.xyz", "-o", "-"},
    {"encode", "p.xyz", "-o", "new.mtp", "--tile-vertices", "16"},
    {"encode", "t.asc", "-o", "new.mtp", "--tile-vertices", "16", "--tile-size", "3"},
    {"encode", "t.asc", "-o", "new.shard", "--tile-vertices", "16", "--tile-size", "3", "--shard",
     "0:0"},
    {"plan", "t.asc", "--tile-vertices", "16", "--tile-size", "3"},
    {"merge", "t.shard", "-o", "new.mtp"},
    {"verify", "t.mtp", "t.asc"},
    {"decode", "t.mtin", "-o", "new.ply"},
    {"decode", "t.mtin", "-o", "new.obj"},
    {"decode", "t.mtin", "-o", "new.asc"},
    {"decode", "t.mtin", "-o", "new.glb"},
    {"decode", "t.mtin", "-o", "-", "--lattice"},
    {"info", "t.mtin"},
    {"verify", "t.mtin", "t.asc", "--json"},
    {"encode", "t.asc", "-o", "new.mtin", "--max-error", "9", "--water-level", "0"},
    {"render", "t.mtin", "-o", "new.png", "--width", "200"},
    {"render", "t.mtin", "-o", "new.png", "--width", "200", "--source", "t.asc"},
    {"fractal", "-o", "new.asc", "--size", "5"},
    {"profile", "t.mtp", "1", "3", "7", "3", "--from-height", "2"},
    {"profile", "t.mtin", "1", "3", "7", "3", "-o", "new.csv"},
    {"profile", "t.mtin", "1", "3", "7", "3", "-o", "new.svg"},
};

void check(Stage& stage, const Words& words, Counter Counters::*counter, bool lasting,
           uint64_t begin, uint64_t stride) {
  const Outcome outcome = fail_each(stage, words, counter, lasting, begin, stride);
  CHECK(outcome.failures > 0);
  MESSAGE(words[0] << " " << words[1] << " " << words.back() << ": " << outcome.faults
                   << " faults, " << outcome.failures << " errors");
}

// How often memory is surely asked for before the program looks at its arguments.
uint64_t requests_at_start(Stage& stage) {
  REQUIRE(stage.run({"--version"}).status == 0);
  return stage.counters().memory.asked * 9 / 10;
}

// The program starts alike for every command, so what it asks for then is refused in one of them.
void check_memory(bool lasting, uint64_t stride) {
  Stage stage;
  const uint64_t started = requests_at_start(stage);
  uint64_t begin = 1;
  for (const Words& words : kCommands) {
    check(stage, words, &Counters::memory, lasting, begin, stride * sparseness(words));
    begin = started;
  }
}

}  // namespace

TEST_CASE("memory refused at each request in turn: an error of one line, and no file") {
  check_memory(false, kStride);
}

TEST_CASE("memory refused from each request on: an error of one line, and no file") {
  check_memory(true, 7 * kStride);
}

TEST_CASE("file functions failing at each call in turn: an error of one line, and no file") {
  Stage stage;
  for (const Words& words : kCommands) check(stage, words, &Counters::files, false, 1, 1);
}

namespace {

void write_text(const Stage& stage, const std::string& name, const std::string& text) {
  stage.write(name, {text.begin(), text.end()});
}

// A pack whose header says that a tile has 2^24 vertices, with bytes enough for these.
void write_forged_pack(const Stage& stage) {
  constexpr size_t kMostVertices = 28, kBytes = 16384;
  Bytes pack = stage.read("t.mtp");
  put_number(pack, kMostVertices, kMaxVertices, 4);
  repair_checks(pack);
  pack.resize(kBytes);
  stage.write("forged.mtp", pack);
}

// A sheet of four posts.
std::string sheet(const std::string& x, const std::string& y) {
  return "ncols 2\nnrows 2\nxllcenter " + x + "\nyllcenter " + y + "\ncellsize 1\n1 2\n3 4\n";
}

void write_forged_sources(const Stage& stage) {
  write_text(stage, "forged.asc",
             "ncols 2147483647\nnrows 2147483647\nxllcenter 0\nyllcenter 0\ncellsize 1\n1 2 3\n");
  write_text(stage, "forged.ply",
             "ply\nformat ascii 1.0\nelement vertex 4294967295\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n1 2 3\n");
  write_text(stage, "west.asc", sheet("0", "0"));
  write_text(stage, "east.asc", sheet("65000", "65000"));
  write_text(stage, "far.asc", sheet("2000000000", "2000000000"));
}

}  // namespace

TEST_CASE("a count that only a header states takes no memory") {
  constexpr uint64_t kMost = 1 << 25;
  Stage stage;
  write_forged_pack(stage);
  write_forged_sources(stage);
  const std::vector<Words> answered = {{"height", "forged.mtp", "3", "3"},
                                       {"height", "forged.mtp", "3", "3", "--device"},
                                       {"profile", "forged.mtp", "3", "3", "5", "4"},
                                       {"info", "forged.mtp"},
                                       {"decode", "forged.mtp", "-o", "new.asc"},
                                       {"decode", "forged.mtp", "-o", "new.ply"},
                                       {"render", "forged.mtp", "-o", "new.png"}};
  for (const Words& words : answered) {
    CAPTURE(words[0]);
    const Stage::Result result = stage.run(words);
    CHECK_MESSAGE(result.status == 0, result.error);
    CHECK(stage.counters().largest_request < kMost);
  }
  const std::vector<Words> refused = {
      {"encode", "forged.asc", "-o", "new.mtin"},
      {"encode", "forged.asc", "-o", "new.mtp"},
      {"encode", "forged.ply", "-o", "new.mtin"},
      {"encode", "west.asc", "east.asc", "-o", "new.mtin"},
      {"encode", "west.asc", "east.asc", "-o", "new.mtp", "--max-error", "1"},
      {"encode", "west.asc", "far.asc", "-o", "new.mtp", "--max-error", "1"},
      {"plan", "west.asc", "far.asc", "--tile-vertices", "16", "--max-error", "1"},
      {"verify", "t.mtp", "west.asc", "far.asc"},
      {"decode", "t.mtp", "--like", "forged.asc", "-o", "new.asc"}};
  for (const Words& words : refused) {
    CAPTURE(words[1] + " " + words[2]);
    const Stage::Result result = stage.run(words);  // a cloud's size is announced before
    CHECK_MESSAGE((WIFEXITED(result.status) && WEXITSTATUS(result.status) == 1), result.error);
    CHECK(stage.counters().largest_request < kMost);
  }
}

TEST_CASE("a decoder that disagrees with the encoder is an internal fault, and leaves no file") {
  constexpr int kInternal = 3;
  Stage stage;
  const std::vector<Words> commands = {
      {"encode", "t.asc", "-o", "new.mtin", "--max-error", "1"},
      {"encode", "t.asc", "-o", "new.mtin", "--max-bytes", "200"},
      {"encode", "p.xyz", "-o", "new.mtin", "--max-error", "1"},
      {"encode", "p.xyz", "-o", "new.mtp", "--tile-vertices", "16", "--max-error", "1"},
      {"encode", "t.asc", "-o", "new.mtp", "--tile-vertices", "16", "--max-error", "1"},
      {"encode", "t.asc", "-o", "new", "--tile-vertices", "16", "--max-error", "1", "--shard",
       "0:0"}};
  for (const Words& words : commands) {
    for (Counter Counters::*const counter : {&Counters::streams, &Counters::heights}) {
      CAPTURE(words[1] + " " + words[3]);
      const Stage::Result whole = stage.run(words);
      REQUIRE_MESSAGE(whole.status == 0, whole.error);
      const uint64_t asked = (stage.counters().*counter).asked;
      CHECK(asked > 0);
      // A search for a size begins with a trial that has no bound: what errors it finds are not
      // wrong.
      const bool is_search = words[4] == "--max-bytes" && counter == &Counters::heights;
      // The last heights of a pack of points are asked for only to know that there are some.
      const uint64_t last = counter == &Counters::heights && !is_search ? 1 : asked;
      for (const uint64_t first : {is_search ? asked : 1, last}) {
        Counters faults;
        (faults.*counter).first = first;
        const Stage::Result result = stage.run(words, faults);
        CAPTURE(result.error);
        CHECK(WEXITSTATUS(result.status) == kInternal);
        CHECK(result.error.find("microtin: internal fault, please report it: ") == 0);
        CHECK(is_one_line(result.error));
        CHECK(result.files.count(words[3]) == 0);
      }
    }
  }
}

}  // namespace microtin::faults
