// SPDX-License-Identifier: MIT
// The members of a struct, read from the header that declares it: a table with a row for each of
// them fails when the struct grows.
#ifndef MICROTIN_TESTS_SUPPORT_MEMBERS_HPP
#define MICROTIN_TESTS_SUPPORT_MEMBERS_HPP

#include <doctest/doctest.h>

#include <cctype>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {

using Names = std::set<std::string>;

// The text of a file of the repository, without comments.
inline std::string code_of(const std::string& path) {
  std::ifstream file(golden_folder() / "../../.." / path);
  REQUIRE_MESSAGE(file, path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const auto& [begin, end] : {std::pair("/*", "*/"), std::pair("//", "\n")}) {
    for (size_t at = 0; (at = text.find(begin)) != std::string::npos;) {
      text.erase(at, text.find(end, at) + (*end == 0x2a ? 2 : 0) - at);
    }
  }
  return text;
}

// The identifier at the end of a declarator, before brackets and an initializer.
inline std::string name_in(std::string declarator) {
  if (const size_t pointer = declarator.find("(*"); pointer != std::string::npos) {
    declarator = declarator.substr(pointer, declarator.find(')', pointer) - pointer);
  }
  const auto is_part = [](char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
  };
  size_t end = declarator.find_first_of("[{=");
  if (end == std::string::npos) end = declarator.size();
  while (end > 0 && !is_part(declarator[end - 1])) --end;
  size_t begin = end;
  while (begin > 0 && is_part(declarator[begin - 1])) --begin;
  return declarator.substr(begin, end - begin);
}

// The names of the members of a struct. A struct without functions and without nested structs.
inline Names members_of(const std::string& path, const std::string& name) {
  const std::string text = code_of(path);
  size_t at = text.find("struct " + name + " ");
  REQUIRE_MESSAGE(at != std::string::npos, name);
  at = text.find('{', at) + 1;
  Names names;
  std::string declarator;
  for (int depth = 0; depth >= 0; ++at) {
    const char c = text.at(at);
    if (c == '{' || c == '<' || c == '(') ++depth;
    if (c == '}' || c == '>' || c == ')') --depth;
    if (depth != 0 || (c != ',' && c != ';')) {
      declarator += c;
      continue;
    }
    names.insert(name_in(declarator));
    declarator.clear();
  }
  REQUIRE(!names.empty());
  return names;
}

inline Names united(Names names, const Names& more) {
  names.insert(more.begin(), more.end());
  return names;
}

inline Names without(Names names, const Names& less) {
  for (const std::string& name : less) names.erase(name);
  return names;
}

inline std::string text_of(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += name + ' ';
  return text;
}

}  // namespace microtin::tests

#endif
