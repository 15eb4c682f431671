// SPDX-License-Identifier: MIT
// Files that must not outlive the program, even if a signal ends it.
#ifndef MICROTIN_ENCODER_FILES_LEFTOVERS_HPP
#define MICROTIN_ENCODER_FILES_LEFTOVERS_HPP

#include <csignal>
#include <cstddef>
#include <string>

#include "encoder/layers.hpp"

namespace microtin::files {

// Lets SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU remove these files and then end the program as
// they do by default. A signal that is ignored stays so. On Windows, Ctrl-C, Ctrl-Break, and the
// end of the console or of the session do that.
void remove_leftovers_on_signals();

// Keeps these signals waiting in this thread, and in those that it starts meanwhile.
class SignalsHeld {
 public:
  SignalsHeld();
  ~SignalsHeld();
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

#ifndef _WIN32
 private:
  sigset_t before_;
#endif
};

// A file to be removed by these signals while this lives. Of up to eight at once; those beyond, and
// names longer than 4,095 bytes, are left behind.
class Leftover {
 public:
  explicit Leftover(const std::string& path);
  ~Leftover();
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

 private:
  std::size_t slot_;
};

// Calls `remove` for the name of each such file. A handler of signals may call it.
void for_each_leftover(void (*remove)(const char* path));

}  // namespace microtin::files

#endif
