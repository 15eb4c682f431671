// SPDX-License-Identifier: MIT
// Marks test cases that take more than some 0.4 s: `ctest -L quick` leaves them out.
#ifndef MICROTIN_TESTS_SUPPORT_SLOW_HPP
#define MICROTIN_TESTS_SUPPORT_SLOW_HPP

#include <doctest/doctest.h>

namespace microtin::tests {

const doctest::test_suite kSlow("slow");

}  // namespace microtin::tests

#endif
