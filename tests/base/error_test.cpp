// SPDX-License-Identifier: MIT
// Errors name parameters, and each door spells these in its own way.
#include "encoder/base/error.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/support/join.hpp"

namespace microtin::base {
namespace {

std::string option_of(const std::string& name) {
  return "<" + name + ">";
}

std::string spelled(const std::string& text) {
  return base::spelled(text, option_of);
}

}  // namespace

TEST_CASE("errors: parameters are spelled, and all other text is kept") {
  CHECK(spelled(parameter("max_error") + " is above " + parameter("z_step")) ==
        "<max_error> is above <z_step>");
  CHECK(spelled("max_error") == "max_error");
  CHECK(spelled("").empty());
}

TEST_CASE("errors: a lone mark in the name of a file is kept") {
  const std::string mark = parameter("a").substr(0, 1);
  for (const std::string& name : {mark, tests::join({mark, mark}), tests::join({"a", mark, "b"}),
                                  tests::join({mark, "B", mark})}) {
    CHECK(spelled(tests::join({name, ": ", parameter("band")})) == tests::join({name, ": <band>"}));
  }
}

TEST_CASE("errors: the library's name is the parameter's own, also with the name of a file") {
  try {
    with_file_context("a.asc", [] { throw Error(parameter("xy_step") + " is too fine"); });
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(std::string(error.what()) == "a.asc: xy_step is too fine");
    CHECK(spelled(error.text()) == "a.asc: <xy_step> is too fine");
  }
}

}  // namespace microtin::base
