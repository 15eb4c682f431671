// SPDX-License-Identifier: MIT
// The command decode where it writes an ESRI ASCII grid.
#ifndef MICROTIN_ENCODER_CLI_DECODE_GRID_HPP
#define MICROTIN_ENCODER_CLI_DECODE_GRID_HPP

#include "encoder/cli/commands.hpp"
#include "encoder/layers.hpp"

namespace microtin::cli {

void decode_to_grid(const DecodeRequest& request);

}  // namespace microtin::cli

#endif
