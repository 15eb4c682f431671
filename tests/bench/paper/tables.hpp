// SPDX-License-Identifier: MIT
// The paper's tables, measured again; each prints one, or more that belong together.
#ifndef MICROTIN_TESTS_BENCH_PAPER_TABLES_HPP
#define MICROTIN_TESTS_BENCH_PAPER_TABLES_HPP

namespace microtin::bench {

void print_compression();   // Table 2
void print_running_time();  // Table 3
void print_tests();         // Table 4
void print_fractions();     // section 4
void print_claims();        // Lemma 1 and Theorem 1
void print_other_claims();  // what no table of the paper shows

}  // namespace microtin::bench

#endif
