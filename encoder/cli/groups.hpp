// SPDX-License-Identifier: MIT
// The groups of commands on the help page of the program, and the usual group of options.
#ifndef MICROTIN_ENCODER_CLI_GROUPS_HPP
#define MICROTIN_ENCODER_CLI_GROUPS_HPP

namespace microtin::cli {

inline constexpr const char* kEncode = "Encode a terrain";
inline constexpr const char* kLookAt = "Look at a stream or a pack";
inline constexpr const char* kConvert = "Convert a stream or a pack";
inline constexpr const char* kShards = "Encode a pack on many machines";
inline constexpr const char* kOthers = "Others";

inline constexpr const char* kOptions = "Options";

}  // namespace microtin::cli

#endif
