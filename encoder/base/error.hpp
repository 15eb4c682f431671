// SPDX-License-Identifier: MIT
// What went wrong: the exceptions of the host tools, the files that they are about, and sentences
// for statuses.
#ifndef MICROTIN_ENCODER_BASE_ERROR_HPP
#define MICROTIN_ENCODER_BASE_ERROR_HPP

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::base {

// The name of a parameter, "max_error", in the text of an Error, marked so that `spelled` finds it.
std::string parameter(std::string_view name);

// How users of the library write a parameter: max_error, --max-error, MAX_ERROR.
using Spelling = std::function<std::string(const std::string& name)>;

// The text with its parameters as their users write them.
std::string spelled(std::string_view text, const Spelling& spelling);

// A sentence for the user: what went wrong, where (file, and line of the input if there is one),
// and what to do. On one line. what() has the parameters' own names; who builds another Error of
// this one takes text().
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& text);

  // With marked parameters, for `spelled`.
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// A guarantee of ours that does not hold, whatever the input. It is not an Error, so that no
// handler of errors takes it for one and continues.
struct InternalFault : std::logic_error {
  using std::logic_error::logic_error;
};

// The work is done and its output, if there is one, whole, but the report did not reach anybody.
struct ReportLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Runs `work`; its errors are about the file `path`, which they do not name themselves.
template <class Work>
auto with_file_context(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(path + ": " + error.text());
  }
}

// Runs `work` on what this program made itself: whatever is wrong with that is a fault of ours.
template <class Work>
auto on_our_own(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw InternalFault(error.what());
  }
}

// A sentence for a status of the decoder.
const char* describe(microtin_status status);

}  // namespace microtin::base

#endif
