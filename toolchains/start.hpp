// SPDX-License-Identifier: MIT
// What start.cpp and a machine's own code give each other.
#ifndef MICROTIN_TOOLCHAINS_START_HPP
#define MICROTIN_TOOLCHAINS_START_HPP

// Sets up the memory, runs the program and ends the emulation. Called with a stack and nothing
// else.
extern "C" [[noreturn]] void start();

// Ends the emulation with an exit code. Written for each machine.
[[noreturn]] void exit_emulator(int code);

// The exit code of a program that the processor stopped.
constexpr int kFault = 125;

#endif
