// SPDX-License-Identifier: MIT
// Includes a test.
#include "tests/support/streams.hpp"
