// SPDX-License-Identifier: MIT
// Printing reports.
#ifndef MICROTIN_ENCODER_CLI_REPORT_HPP
#define MICROTIN_ENCODER_CLI_REPORT_HPP

#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/export/json.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/surface_model.hpp"

namespace microtin::cli {

// A number of JSON.
std::string number(Decimal value);

// 8 bits a byte, over the vertices.
double bits_per_vertex(size_t bytes, uint32_t vertices);

// Commits a command's output and tells of it on the terminal: on standard output, or on standard
// error if the output itself goes there. Throws Error, and leaves no file, if either fails; throws
// ReportLost, and leaves the file, if nobody reads.
void deliver(OutputFile& out, const std::string& path, const std::string& text);

// Writes to standard output. Returns false if nobody reads; throws Error if it fails otherwise.
bool tell(const std::string& text);

// The same for commands that do no more. Throws ReportLost if nobody reads.
void print(const std::string& text);

// Says on standard error, in one line, what a user should know of an output that is complete.
void warn(const std::string& text);

// Warns that a picture or a scene may be too high or too low, if units are not known.
void warn_of_units(const std::string& path, const SurfaceModel& model);

// The report as JSON, or as a line "name: value" for each entry.
std::string text_of(const JsonObject& report, bool as_json);

}  // namespace microtin::cli

#endif
