// SPDX-License-Identifier: MIT
// A second core, on machines that have one.
#ifndef MICROTIN_TOOLCHAINS_SECOND_CORE_HPP
#define MICROTIN_TOOLCHAINS_SECOND_CORE_HPP

// Lets the second core run a function, which never returns. Call it once.
void start_second_core(void (*run)());

#endif
