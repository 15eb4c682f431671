// SPDX-License-Identifier: MIT
// The tables of costs; each prints one.
#ifndef MICROTIN_TESTS_BENCH_SPEED_HPP
#define MICROTIN_TESTS_BENCH_SPEED_HPP

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/measure.hpp"

namespace microtin::bench {

using Measure = std::function<std::vector<double>(const std::vector<Work>&)>;

// Costs per vertex of decoding each stream file, in `unit`.
void print_decode_speed(const std::vector<std::string>& paths, const Measure& measure,
                        const std::string& unit);

void print_encode_speed();

// Points a second of reading made scans, as LAS and as LAZ, and files.
void print_scan_speed(const std::vector<std::string>& paths);

// Writes the streams that make the curve of bits against instructions into a folder.
void write_curve_streams(const std::string& folder);

// Writes these, and all others that are measured.
void write_streams(const std::string& folder);

}  // namespace microtin::bench

#endif
