// SPDX-License-Identifier: MIT
// The questions of an autopilot in flight: how many have an answer, and what answering them takes.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_QUESTIONS_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_QUESTIONS_HPP

#include <algorithm>
#include <string>

#include "encoder/terrain/degrees.hpp"
#include "tests/bench/grids/answerers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/autopilot_flight.hpp"

namespace microtin::bench {

// Puts the questions of a flight to an answerer; one service in 64 that has work is counted.
class Asker {
 public:
  Asker(Answerer& answerer, std::string callgrind)
      : answerer_(answerer), callgrind_(std::move(callgrind)) {}

  void here(microtin_spot at) { answerer_.here(at); }
  bool height(microtin_spot at) {
    float metres = 0;
    return answerer_.height(at, &metres);
  }
  bool ahead(microtin_spot at, float) { return answerer_.look(at); }
  void serve() {
    if (!answerer_.has_work()) return;
    if (++services_ % 64 != 0) {
      answerer_.serve();
    } else {
      longest_ = std::max(longest_, instructions({[&] { answerer_.serve(); }}, callgrind_)[0]);
    }
  }
  double longest() const { return longest_; }

 private:
  Answerer& answerer_;
  std::string callgrind_;
  uint32_t services_ = 0;
  double longest_ = 0;
};

inline void print_questions_head() {
  print_head("The questions of an autopilot in flight: percent that is known",
             {"terrain", "work units a service", "RAM", "own place", "home", "nine places around",
              "ahead", "all", "reads", "longest service, instructions"});
}

// A row of that table: a flight (tests/support/autopilot_flight.hpp) over a cell, by an answerer.
inline void print_questions(const std::string& name, const std::string& steps, Answerer& answerer,
                            DegreeCell cell, const std::string& callgrind) {
  const microtin_spot corner = {cell.latitude * 10000000, cell.longitude * 10000000};
  Asker asker(answerer, callgrind);
  answerer.home({corner.latitude + 6250000, corner.longitude + 1250000});
  const tests::FlightShares known = tests::flight_over_cell(corner).fly(asker);
  print_row({name, steps, number(answerer.ram()), number(known.own.percent(), 2),
             number(known.home.percent(), 2), number(known.surrounding.percent(), 2),
             number(known.ahead.percent(), 2), number(known.percent_of_all(), 2),
             number(answerer.card.reads()), number(asker.longest(), 0)});
}

// The rows of packs: `large` has tiles of up to 1,000 vertices, `small` of up to 150.
inline void print_pack_questions(const std::string& large, const std::string& small,
                                 DegreeCell cell, const std::string& callgrind) {
#ifdef MICROTIN_ADAPTERS_COMPACT
  const std::string form = "compact, ";
#else
  const std::string form = "meshes, ";
#endif
  for (const uint32_t slots : {4u, 9u, 16u}) {
    for (const uint32_t steps : {20u, 200u}) {
      ArduPilot ardupilot(slots == 16 ? small : large, {slots, steps});
      print_questions(form + std::to_string(slots) + " slots, ArduPilot's adapter",
                      std::to_string(steps), ardupilot, cell, callgrind);
    }
    Inav inav(slots == 16 ? small : large, {slots, 20});
    print_questions(form + std::to_string(slots) + " slots, INAV's adapter", "20", inav, cell,
                    callgrind);
  }
}

}  // namespace microtin::bench

#endif
