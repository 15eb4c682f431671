// SPDX-License-Identifier: MIT
#include "tests/bench/paper/figures.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/inputs.hpp"
#include "tests/bench/paper/jump_and_walk.hpp"
#include "tests/bench/paper/length_code.hpp"
#include "tests/bench/paper/systems.hpp"

namespace microtin::bench {
namespace {

using Figures = std::vector<std::pair<std::string, uint64_t>>;

void add_figures(const std::string& input, const std::vector<Point>& points, const System& system,
                 Figures& figures) {
  const std::string name = input + (system.independent_sets ? "_algorithm1" : "_algorithm2") +
                           "_D" + std::to_string(system.degree) + "_";
  const Sequence sequence = sequence_of(points, system);
  figures.emplace_back(name + "bits", length_code_bits(sequence));
  figures.emplace_back(name + "first_batch", sequence.batches.back());
  const auto count = [&](Traversal traversal) {
    return rebuild(sequence, {system.independent_sets, traversal});
  };
  figures.emplace_back(name + "in_circle", count(Traversal::kAllNeighbours).in_circle);
  figures.emplace_back(name + "uncertified", count(Traversal::kUncertified).in_circle);
  if (!system.independent_sets) {
    figures.emplace_back(name + "by_sides", count(Traversal::kSidedness).in_circle);
    figures.emplace_back(name + "sidedness", count(Traversal::kSidedness).sidedness);
  }
  const Check found = check(points, system);
  figures.emplace_back(name + "phases", found.phases);
  figures.emplace_back(name + "violations", found.violations);
  figures.emplace_back(name + "wrong_phases", found.wrong_phases);
}

Figures paper_figures() {
  Figures figures;
  for (const uint32_t vertices : {5000u, 80000u}) {
    const std::string input = "uniform_" + std::to_string(vertices);
    const std::vector<Point> points = uniform_places(vertices, 0);
    for (const uint32_t degree : {6u, 9u}) {
      add_figures(input, points, {"", Walk::kTriangles, degree}, figures);
      add_figures(input, points, {"", std::nullopt, degree}, figures);
    }
    figures.emplace_back(input + "_MSZ_in_circle", jump_and_walk(points, 0));
  }
  for (const Family& family : families()) {
    std::string name = family.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    add_figures(name + "_20000", family.points(20000), {"", Walk::kTriangles, 6}, figures);
    add_figures(name + "_20000", family.points(20000), {"", std::nullopt, 6}, figures);
  }
  return figures;
}

}  // namespace

void record_figures(const std::string& path) {
  std::ostringstream text;
  for (const auto& [name, value] : paper_figures()) text << name << " " << value << "\n";
  OutputFile file(path);
  file.write(text.str());
  file.commit();
}

void check_figures(const std::string& path) {
  std::map<std::string, uint64_t> recorded;
  std::istringstream text(read_file(path));
  std::string name;
  for (uint64_t value = 0; text >> name >> value;) recorded[name] = value;
  const Figures figures = paper_figures();
  size_t differences = figures.size() == recorded.size() ? 0 : 1;
  for (const auto& figure : figures) {
    const auto found = recorded.find(figure.first);
    if (found != recorded.end() && found->second == figure.second) continue;
    ++differences;
    std::printf("%s: %s recorded, now %s\n", figure.first.c_str(),
                found == recorded.end() ? "not" : std::to_string(found->second).c_str(),
                std::to_string(figure.second).c_str());
  }
  if (differences != 0) throw Error(path + " records other figures");
  std::printf("%zu figures as recorded\n", figures.size());
}

}  // namespace microtin::bench
