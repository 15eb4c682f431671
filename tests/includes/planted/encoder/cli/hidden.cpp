// SPDX-License-Identifier: MIT
// The command line includes what the product hides.
#include "encoder/pack/file.hpp"
