// SPDX-License-Identifier: MIT
// Files that cannot be read or written: each ends with exit code 1, one line that names the file,
// and no file left behind. tests/faults lets every call fail in turn.
#include <doctest/doctest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/session.hpp"

using namespace microtin::tests;

namespace {

// Lets files grow to so many bytes, in this process and those that it starts.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &old_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
};

// What `work` returns in a process for which modes hold, also if it is the superuser's.
template <class Work>
std::string without_privileges(const Work& work) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::string text = "may still write anywhere";
    if (geteuid() != 0 || prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE) == 0) text = work();
    _exit(::write(ends[1], text.data(), text.size()) >= 0 ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char buffer[256];
  while (const ssize_t size = read(ends[0], buffer, sizeof buffer)) {
    REQUIRE(size > 0);
    text.append(buffer, static_cast<size_t>(size));
  }
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return text;
}

const char* const kPoints = "0 0 0\n9 0 3\n0 9 7\n5 5 5\n";

}  // namespace

TEST_CASE("cli: a file that may not grow is an error, not a signal") {
  const Session session;
  session.write("ok.xyz", kPoints);
  REQUIRE(session.run("encode ok.xyz -o ok.mtin").code == 0);
  REQUIRE(session.run("fractal --size 65 -o large.asc").code == 0);
  const FileSizeLimit limit(200);  // enough for messages
  CHECK(session.failure("fractal --size 65 -o new.asc") ==
        "new.asc: cannot be written: File too large\n");
  CHECK(session.failure("encode large.asc -o new.mtin") ==
        "new.mtin: cannot be written: File too large\n");
  CHECK(session.failure("render ok.mtin -o new.png") ==
        "new.png: cannot be written: File too large\n");
}

TEST_CASE("cli: an existing file outlives an output that fails") {
  const Session session;
  session.write("large.asc", "precious");
  const FileSizeLimit limit(200);
  CHECK(contains(session.failure("fractal --size 65 -o large.asc"), "File too large"));
  CHECK(session.read("large.asc") == "precious");
}

TEST_CASE("cli: reports that cannot be printed leave no stream") {
  const Session session;
  session.write("ok.xyz", kPoints);
  CHECK(session.failure("encode ok.xyz -o new.mtin > /dev/full") ==
        "-: cannot be written: No space left on device\n");
  REQUIRE(session.run("encode ok.xyz -o ok.mtin").code == 0);
  CHECK(contains(session.failure("info ok.mtin > /dev/full"), "No space left"));
  CHECK(contains(session.failure("verify ok.mtin ok.xyz > /dev/full"), "No space left"));
}

TEST_CASE("cli: input that opens but cannot be read") {
  const Session session;
  const std::string unreadable = "/proc/self/mem";  // there is nothing at its beginning
  CHECK(session.failure("decode " + unreadable + " -o new.xyz") ==
        unreadable + ": cannot be read: Input/output error\n");
  session.write("ok.xyz", kPoints);
  std::filesystem::create_symlink(unreadable, session.folder() + "/mem.xyz");
  CHECK(session.failure("encode mem.xyz -o new.mtin") ==
        "mem.xyz: cannot be read: Input/output error\n");
  std::filesystem::create_symlink("gone.xyz", session.folder() + "/link.xyz");
  CHECK(contains(session.failure("encode link.xyz -o new.mtin"), "link.xyz: cannot be read: "));
}

TEST_CASE("cli: folders that take no file") {
  const Session session;
  session.write("ok.xyz", kPoints);
  for (const std::string output : {"/proc/new.mtin", "ok.xyz/new.mtin", "none/new.mtin"}) {
    CHECK(session.failure("encode ok.xyz -o " + output).find(output + ": cannot be written: ") ==
          0);
  }
  chmod(session.folder().c_str(), 0500);
  const std::string refusal =
      without_privileges([&] { return session.run("encode ok.xyz -o new.mtin").err; });
  CHECK(refusal == "microtin: new.mtin: cannot be written: Permission denied\n");
  chmod(session.folder().c_str(), 0700);
  CHECK_FALSE(std::filesystem::exists(session.folder() + "/new.mtin"));
}

TEST_CASE("cli: control characters of names are escaped before they are printed") {
  const Session session;
  CHECK(session.failure("encode 'no\x1b[31m\nr\xC3\xA9.xyz' -o new.mtin") ==
        "no\\x1b[31m\\x0ar\xC3\xA9.xyz: cannot be read: No such file or directory\n");
  // DEL, U+009B as UTF-8 and as a byte, half a character; U+00C0 ends with a byte of that kind
  CHECK(session.failure("encode 'a\x7f\xC2\x9b\x9b\xC3\xC3\x80.xyz' -o new.mtin") ==
        "a\\x7f\\xc2\\x9b\\x9b\\xc3\xC3\x80.xyz: cannot be read: No such file or directory\n");
  CHECK(session.failure("encode '--\xC2\x9b' -o new.mtin", 2).find('\x9b') == std::string::npos);
}

TEST_CASE("cli: control characters of notes are escaped before they are printed") {
  const Session session;
  session.write("ok.xyz", kPoints);
  for (const std::string kind : {"ok.mtin", "ok.mtp --tile-vertices 100"}) {
    REQUIRE(session
                .run("encode ok.xyz -o " + kind +
                     " --lineage 'a\x7f\xC2\x9b\x1b\x9b\xC3\x80' --source-name '\xC2\x80\xC2\x9f'")
                .code == 0);
    for (const std::string form : {"", " --json"}) {
      const std::string told = session.run("info " + kind.substr(0, kind.find(' ')) + form).out;
      CHECK(contains(told, "\"a\\u007f\\u009b\\u001b\xEF\xBF\xBD\xC3\x80\""));
      CHECK(contains(told, "\"\\u0080\\u009f\""));
    }
  }
}
