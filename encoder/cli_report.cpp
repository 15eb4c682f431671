#include "encoder/cli_report.hpp"

#include "encoder/input_file.hpp"
#include "encoder/output_file.hpp"

namespace microtin {

std::vector<uint8_t> read_stream(const std::string& path) {
  const std::string bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

double number(Decimal value) {
  return std::stod(to_string(value));
}

double bits_per_vertex(size_t bytes, uint32_t vertices) {
  return 8.0 * static_cast<double>(bytes) / vertices;
}

void print(const Report& report, bool as_json) {
  // Texts in a stream need not be UTF-8.
  const auto text = [](const Report& value, int indent) {
    return value.dump(indent, ' ', false, Report::error_handler_t::replace);
  };
  OutputFile out("-");
  if (as_json) {
    out.write(text(report, 2) + '\n');
  } else {
    for (const auto& [key, value] : report.items()) out.write(key + ": " + text(value, -1) + '\n');
  }
  out.commit();
}

}  // namespace microtin
