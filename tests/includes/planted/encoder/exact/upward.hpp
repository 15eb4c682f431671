// SPDX-License-Identifier: MIT
// Includes a layer that comes after its own, and one that comes before.
#include "encoder/base/error.hpp"
#include "encoder/fit/simplify.hpp"
