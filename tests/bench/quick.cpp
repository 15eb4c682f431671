#include "tests/bench/quick.hpp"

#include <cstdio>
#include <map>
#include <sstream>

#include "encoder/error.hpp"
#include "encoder/input_file.hpp"
#include "encoder/output_file.hpp"
#include "tests/bench/paper/tables.hpp"

namespace microtin::bench {

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
