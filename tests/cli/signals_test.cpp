// SPDX-License-Identifier: MIT
// A signal ends the program, and nothing of its output is left; a terminal shows the time left.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLongEnough(60);
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};

// The program in a process of its own, which runs while the test goes on.
class Running {
 public:
  Running(const Session& session, const std::vector<std::string>& words, int errors,
          bool ignores = false)
      : child_(fork()) {
    REQUIRE(child_ >= 0);
    if (child_ != 0) return;
    std::string path = program();
    std::vector<char*> argv{path.data()};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    // A shell starts what runs in its background with some ignored, nohup with another.
    for (const int one : kSignals) std::signal(one, SIG_DFL);
    if (ignores) std::signal(SIGINT, SIG_IGN);
    if (chdir(session.folder().c_str()) == 0 && dup2(open("/dev/null", O_WRONLY), 1) >= 0 &&
        dup2(errors, 2) >= 0) {
      execv(path.c_str(), argv.data());
    }
    _exit(99);
  }
  ~Running() {
    if (child_ > 0) end(SIGKILL);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const { kill(child_, signal); }

  // How the process ended, as wait() tells.
  int end(int signal) {
    int status = 0;
    kill(child_, signal);
    waitpid(child_, &status, 0);
    child_ = -1;
    return status;
  }

 private:
  pid_t child_;
};

bool holds_temporary(const Session& session) {
  for (const auto& entry : std::filesystem::directory_iterator(session.folder())) {
    if (contains(entry.path().string(), ".part-")) return true;
  }
  return false;
}

size_t files(const Session& session) {
  const std::filesystem::directory_iterator folder(session.folder());
  return static_cast<size_t>(std::distance(begin(folder), end(folder)));
}

// Until the output has begun.
void wait_for_temporary(const Session& session) {
  const auto start = Clock::now();
  while (!holds_temporary(session) && Clock::now() - start < kLongEnough) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  REQUIRE(holds_temporary(session));
}

const std::vector<std::string> kLongWork = {
    "encode", "t.asc", "--max-error", "1", "--best", "--tile-vertices", "500", "-o", "new.mtp"};

}  // namespace

TEST_CASE("cli: a signal ends the program and leaves no file") {
  const Session session;
  REQUIRE(session.run("fractal --size 129 -o t.asc").code == 0);
  session.write("new.mtp", "precious");
  const int nowhere = open("/dev/null", O_WRONLY);
  for (const int signal : kSignals) {
    CAPTURE(signal);
    Running running(session, kLongWork, nowhere);
    wait_for_temporary(session);
    const int status = running.end(signal);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == signal);
    CHECK(files(session) == 2);
    CHECK(session.read("new.mtp") == "precious");
  }
  close(nowhere);
}

TEST_CASE("cli: a signal that is ignored stays ignored") {
  const Session session;
  REQUIRE(session.run("fractal --size 129 -o t.asc").code == 0);
  const int nowhere = open("/dev/null", O_WRONLY);
  Running running(session, kLongWork, nowhere, true);
  wait_for_temporary(session);
  running.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK(holds_temporary(session));
  CHECK(WTERMSIG(running.end(SIGTERM)) == SIGTERM);
  close(nowhere);
}

TEST_CASE("cli: a terminal shows how much is done and how long it will take" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 129 -o t.asc").code == 0);
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE(terminal >= 0);
  REQUIRE(grantpt(terminal) == 0);
  REQUIRE(unlockpt(terminal) == 0);
  const int other_side = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  REQUIRE(other_side >= 0);
  Running running(session, {"encode", "t.asc", "--max-error", "1", "--best", "-o", "new.mtin"},
                  other_side);
  std::string shown;
  const auto start = Clock::now();
  fcntl(terminal, F_SETFL, O_NONBLOCK);
  while (!contains(shown, "s left") && Clock::now() - start < kLongEnough) {
    char buffer[256];
    const ssize_t size = read(terminal, buffer, sizeof buffer);
    if (size > 0) shown.append(buffer, static_cast<size_t>(size));
    if (size <= 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  CHECK(contains(shown, " %, "));
  CHECK(contains(shown, "s left"));
  running.end(SIGTERM);
  close(other_side);
  close(terminal);
}

}  // namespace microtin::tests
