// SPDX-License-Identifier: MIT
// The program as its users meet it: in a folder of its own, by its command line.
#ifndef MICROTIN_TESTS_SUPPORT_SESSION_HPP
#define MICROTIN_TESTS_SUPPORT_SESSION_HPP

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {

// The program that was built with the tests; another one with faults, to see that they tell.
inline std::string program() {
  const char* const other = std::getenv("MICROTIN_PROGRAM");
  return other != nullptr ? other : built_program();
}

// Runs the program in a folder of its own.
class Session {
 public:
  struct Result {
    int code;
    std::string out;
    std::string err;
  };

  Result run(const std::string& arguments) const { return shell("microtin " + arguments); }

  // Runs commands of a shell, to which the program is `microtin`.
  Result shell(const std::string& commands) const {
    const std::string command = "cd '" + folder_.path() + "' && microtin() { '" + program() +
                                "' \"$@\"; } && { " + commands + "\n} 2>'" + error_path() + "'";
    std::FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    Result result{0, "", ""};
    char buffer[4096];
    while (const size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) {
      result.out.append(buffer, size);
    }
    const int status = pclose(pipe);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    result.err = content(error_path());
    std::filesystem::remove(error_path());
    return result;
  }

  // The one line of a failure, which leaves no file behind.
  std::string failure(const std::string& arguments, int code = 1) const {
    const std::vector<std::string> before = files();
    const Result result = run(arguments);
    CHECK_MESSAGE(result.code == code, arguments);
    CHECK_MESSAGE(std::count(result.err.begin(), result.err.end(), '\n') == 1, result.err);
    CHECK_MESSAGE(files() == before, arguments);
    const std::string prefix = "microtin: ";
    CHECK(result.err.substr(0, prefix.size()) == prefix);
    return result.err.substr(std::min(result.err.size(), prefix.size()));
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  std::string read(const std::string& name) const { return content(folder_ / name); }

  const std::string& folder() const { return folder_.path(); }

 private:
  std::string error_path() const { return errors_ / "err"; }

  static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path());
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryFolder folder_, errors_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace microtin::tests

#endif
