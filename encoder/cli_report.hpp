// What the commands share: reading streams and printing reports.
#ifndef MICROTIN_ENCODER_CLI_REPORT_HPP
#define MICROTIN_ENCODER_CLI_REPORT_HPP

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "encoder/decimal.hpp"

namespace microtin {

using Report = nlohmann::ordered_json;

// The bytes of a stream's file, or of standard input for "-".
std::vector<uint8_t> read_stream(const std::string& path);

double number(Decimal value);

// 8 bits a byte, over the vertices.
double bits_per_vertex(size_t bytes, uint32_t vertices);

// Prints the report as JSON, or as a line "key: value" for each entry.
void print(const Report& report, bool as_json);

}  // namespace microtin

#endif
