// SPDX-License-Identifier: MIT
// What each peer delivers, in how many bytes, and what decoding costs; each prints one table.
#ifndef MICROTIN_TESTS_BENCH_PEERS_PEER_COSTS_HPP
#define MICROTIN_TESTS_BENCH_PEERS_PEER_COSTS_HPP

#include <string>

namespace microtin::bench {

void print_peer_costs();                                // sizes, times and memory
void print_peer_instructions(const std::string& file);  // under callgrind, see measure.hpp

}  // namespace microtin::bench

#endif
