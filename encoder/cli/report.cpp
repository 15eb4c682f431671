// Reports as JSON or lines, on the terminal only if the output is safe.
#include "encoder/cli/report.hpp"

#include <cstdio>
#include <memory>
#include <utility>

#include "encoder/base/error_context.hpp"
#include "encoder/files/input_file.hpp"

namespace microtin::cli {

std::vector<uint8_t> read_stream(const std::string& path) {
  const std::string bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

std::optional<PackFile> open_pack(const std::string& path) {
  std::unique_ptr<ByteSource> bytes;
  if (is_regular_file(path)) bytes = open_file(path);
  if (!bytes || !is_pack(*bytes)) return std::nullopt;
  return about(path, [&] { return PackFile(std::move(bytes)); });
}

std::string number(Decimal value) {
  return json(std::stod(to_string(value)));
}

double bits_per_vertex(size_t bytes, uint32_t vertices) {
  return 8.0 * static_cast<double>(bytes) / vertices;
}

void deliver(OutputFile& out, const std::string& path, const std::string& text) {
  if (path == "-") {
    out.commit();
    std::fputs(text.c_str(), stderr);
    return;
  }
  OutputFile terminal("-");  // before the file is there: a failure leaves none
  terminal.write(text);
  terminal.commit();
  out.commit();
}

void print(const JsonObject& report, bool as_json) {
  OutputFile out("-");
  const char* separator = as_json ? "{\n" : "";
  for (const auto& [name, value] : report) {
    out.write(separator);
    out.write(as_json ? "  " + json(name) : name);
    out.write(": ");
    out.write(value);
    if (!as_json) out.write("\n");
    if (as_json) separator = ",\n";
  }
  if (as_json) out.write("\n}\n");
  out.commit();
}

}  // namespace microtin::cli
