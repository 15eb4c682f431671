// SPDX-License-Identifier: MIT
// What commands print: reports, and how far the work is.
#ifndef MICROTIN_ENCODER_CLI_REPORT_HPP
#define MICROTIN_ENCODER_CLI_REPORT_HPP

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/export/json.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/terrain/metadata.hpp"

namespace microtin::cli {

// A number of JSON.
std::string number(Decimal value);

// {"max_below": ..., "max_above": ...}
std::string json_of(const Distances& distances);

// Bounds that posts have of their own, and by how much those of their map are scaled.
std::string json_of(const StatedBounds& bounds);
std::string text_of(const StatedBounds& bounds);

std::string_view text_of(DuplicateRule rule);
std::string_view name_of(PlaceKind kind);
std::string_view name_of(PlaceBase base);
std::string_view name_of(SurfaceKind kind);
std::string_view name_of(BoundSide side);

// "2,9", or "0-6,8-255".
std::string list_of(const ClassSet& classes);

// 8 bits a byte, over the vertices.
double bits_per_vertex(size_t bytes, uint32_t vertices);

// Commits a command's output and tells of it on the terminal: on standard output, or on standard
// error if the output itself goes there. Throws Error, and leaves no file, if either fails; throws
// ReportLost, and leaves the file, if nobody reads.
void deliver(OutputFile& out, const std::string& path, const std::string& text);

// Writes to standard output. Returns false if nobody reads; throws Error if it fails otherwise.
bool try_print(const std::string& text);

// Prints the text of a command that does no more. Throws ReportLost if nobody reads.
void print(const std::string& text);

// The line for standard error that says what a user should know of an output, to be made before it
// is complete: memory may be short only before.
std::string warning(const std::string& text);

// The one that a picture or a scene may be too high or too low, if units are not known; else empty.
std::string warning_of_units(const std::string& path, const SurfaceModel& model);

// Throws Error if an output can take more than 1 GB, and says what else there is; if it is forced,
// tells its size on standard error.
void announce_size(const std::string& path, double most_bytes, bool forced,
                   const std::string& else_there_is = "");

// The vertices of a pack. Throws Error if it has more than a stream can have and that is not
// forced.
uint64_t most_vertices(const std::string& path, uint64_t vertices, bool forced);

// The report as JSON, or as a line "name: value" for each entry.
std::string text_of(const JsonObject& report, bool as_json);

// Draws how far the work is and, after a second, how many seconds are left, on standard error if
// that is a terminal. Wipes it off at the end.
class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();

  // Reports to the bar, which must outlive it.
  Progress progress();

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double done);

  bool on_terminal_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace microtin::cli

#endif
