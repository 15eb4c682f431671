// The paper's tables, measured again; each prints one, or more that belong together.
#ifndef MICROTIN_BENCH_PAPER_TABLES_HPP
#define MICROTIN_BENCH_PAPER_TABLES_HPP

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace microtin::bench {

void print_compression();   // Table 2
void print_running_time();  // Table 3
void print_tests();         // Table 4
void print_fractions();     // section 4
void print_claims();        // Lemma 1 and Theorem 1

// What does not depend on the machine, under names without blanks.
using Figures = std::vector<std::pair<std::string, uint64_t>>;
Figures paper_figures();

}  // namespace microtin::bench

#endif
