// SPDX-License-Identifier: MIT
// Where the tests find the golden files, the program and the terrains that are not part of the
// project. Only paths.cpp is compiled with these paths, so moving a checkout compiles one file
// again.
#ifndef MICROTIN_TESTS_SUPPORT_PATHS_HPP
#define MICROTIN_TESTS_SUPPORT_PATHS_HPP

#include <filesystem>
#include <string>

namespace microtin::tests {

// The folder tests/golden/1.0: golden files, which never change.
std::filesystem::path golden_folder();

// The path of a file in tests/golden/1.0.
std::string golden(const std::string& name);

// The folder of terrains that are not part of the project; empty if it is absent.
std::filesystem::path data_folder();

// The program that was built with the tests.
std::string built_program();

}  // namespace microtin::tests

#endif
