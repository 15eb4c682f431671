// SPDX-License-Identifier: MIT
// Tests and fuzz targets find the names of all layers; which they may include is checked apart.
#ifndef MICROTIN_TESTS_SUPPORT_LAYERS_HPP
#define MICROTIN_TESTS_SUPPORT_LAYERS_HPP

#include "encoder/layers.hpp"

namespace microtin::tests {
using namespace cli;
}  // namespace microtin::tests

#endif
