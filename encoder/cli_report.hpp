// What the commands share: reading streams and printing reports.
#ifndef MICROTIN_ENCODER_CLI_REPORT_HPP
#define MICROTIN_ENCODER_CLI_REPORT_HPP

#include <string>
#include <vector>

#include "encoder/decimal.hpp"
#include "encoder/json.hpp"

namespace microtin {

// The bytes of a stream's file, or of standard input for "-".
std::vector<uint8_t> read_stream(const std::string& path);

// A number of JSON.
std::string number(Decimal value);

// 8 bits a byte, over the vertices.
double bits_per_vertex(size_t bytes, uint32_t vertices);

// Prints the report as JSON, or as a line "name: value" for each entry.
void print(const JsonObject& report, bool as_json);

}  // namespace microtin

#endif
