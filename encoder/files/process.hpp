// SPDX-License-Identifier: MIT
// A process and its system: standard files, descriptors, arguments, memory; and signals, which
// remove files that must not outlive the program.
#ifndef MICROTIN_ENCODER_FILES_PROCESS_HPP
#define MICROTIN_ENCODER_FILES_PROCESS_HPP

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::files {

// Takes the numbers of those that are closed, so that no file that is opened later gets one of
// them. Reading from them and writing to them still fails as if they were closed, which tells
// them from /dev/null. On Windows, where no other file gets these numbers, it makes the standard
// files carry bytes, and the console show UTF-8. Returns whether it could.
bool hold_closed_standard_files();

// Makes writing to a closed pipe, or beyond a limit of the system, an error like others.
void make_signals_errors();

// Whether an error of writing (an errno) says that nobody reads: the descriptor is closed, or the
// other end of the pipe.
bool nobody_reads(int error);

// As many as the system allows this process, instead of the 1,024 that it usually begins with:
// each cell of a folder stays open, and each shard.
void allow_many_open_files();

// Whether standard error is a terminal.
bool errors_go_to_terminal();

// The arguments of main in UTF-8, the name of the program first.
std::vector<std::string> program_arguments(int argc, const char* const* argv);

// The bytes of memory that this machine has, or 0 if they are not known.
uint64_t machine_memory();

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
