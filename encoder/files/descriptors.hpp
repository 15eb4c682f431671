// SPDX-License-Identifier: MIT
// What a process gets from its system: standard files, more descriptors, arguments, and memory.
#ifndef MICROTIN_ENCODER_FILES_DESCRIPTORS_HPP
#define MICROTIN_ENCODER_FILES_DESCRIPTORS_HPP

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

}  // namespace microtin::files

#endif
