// Output that appears complete or not at all.
#ifndef MICROTIN_ENCODER_FILES_OUTPUT_FILE_HPP
#define MICROTIN_ENCODER_FILES_OUTPUT_FILE_HPP

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/files/leftovers.hpp"
#include "encoder/layers.hpp"

namespace microtin::files {

// Writes to a temporary beside the target, which takes the target's place on commit() and
// disappears without it, also when a signal ends the program. "-" is standard output; devices and
// pipes are written directly. All throw Error naming the target.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void write(const std::vector<uint8_t>& bytes) {
    write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::string path_;       // as the user calls it
  std::string target_;     // behind links
  std::string temporary_;  // empty: written directly
  std::optional<Leftover> leftover_;
  std::FILE* file_ = nullptr;
};

// Throws Error if the output would take the place of the input.
void refuse_overwriting(const std::string& input, const std::string& output);

}  // namespace microtin::files

#endif
