// SPDX-License-Identifier: MIT
// Includes the encoder.
#include "encoder/exact/wide.hpp"
