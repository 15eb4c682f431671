// SPDX-License-Identifier: MIT
// Reports as JSON or lines, on the terminal only if the output is safe; and a bar of progress.
#include "encoder/cli/report.hpp"

#include <cstdio>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/files/process.hpp"
#include "encoder/product/document.hpp"
#include "microtin/surface.hpp"

namespace microtin::cli {

std::string number(Decimal value) {
  return json(real(value));
}

std::string json_of(const Distances& distances) {
  return json(
      JsonObject{{"max_below", number(distances.below)}, {"max_above", number(distances.above)}});
}

namespace {

double scale_of(const StatedBounds& bounds) {
  const double whole = real(bounds.unscaled);
  return whole == 0 ? 1 : real(bounds.max_error) / whole;
}

}  // namespace

std::string json_of(const StatedBounds& bounds) {
  const BoundSpan& span = bounds.span;
  return json(JsonObject{{"bounded", json(span.bounded)},
                         {"unbounded", json(span.unbounded)},
                         {"least", number(span.least)},
                         {"largest", number(span.largest)},
                         {"max_ratio", number(span.ratio)},
                         {"elsewhere", number(bounds.max_error)},
                         {"scale", json(scale_of(bounds))}});
}

std::string text_of(const StatedBounds& bounds) {
  const BoundSpan& span = bounds.span;
  std::string text =
      "bounds of the error map: from " + to_string(span.least) + " to " + to_string(span.largest);
  if (!(bounds.max_error == bounds.unscaled)) {
    text += ", the map's times " + json(scale_of(bounds));
  }
  if (span.unbounded != 0) text += ", none at " + std::to_string(span.unbounded) + " heights";
  return text + "; errors are at most " + to_string(span.ratio) + " of them\n";
}

std::string_view text_of(DuplicateRule rule) {
  switch (rule) {
    case DuplicateRule::kUnknown:
      return "unknown";
    case DuplicateRule::kMiddle:
      return "middle of lowest and highest";
    case DuplicateRule::kLowest:
      return "lowest";
    case DuplicateRule::kHighest:
      return "highest";
    case DuplicateRule::kMean:
      return "mean";
    case DuplicateRule::kMedian:
      return "median";
  }
  return "unknown";
}

std::string_view name_of(PlaceKind kind) {
  constexpr std::string_view kNames[] = {"unknown", "overview", "obstacles", "geoid", "errors"};
  return kNames[static_cast<size_t>(kind)];
}

std::string_view name_of(PlaceBase base) {
  constexpr std::string_view kNames[] = {"unknown", "start", "end"};
  return kNames[static_cast<size_t>(base)];
}

std::string_view name_of(SurfaceKind kind) {
  return encoder::name_of(static_cast<encoder::SurfaceKind>(kind));  // the same numbers
}

std::string_view name_of(BoundSide side) {
  return encoder::name_of(static_cast<encoder::BoundSide>(side));  // the same numbers
}

std::string list_of(const ClassSet& classes) {
  std::string text;
  for (size_t first = 0; first < classes.size(); ++first) {
    if (!classes[first]) continue;
    size_t last = first;
    while (last + 1 < classes.size() && classes[last + 1]) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(first);
    if (last != first) text += "-" + std::to_string(last);
    first = last;
  }
  return text;
}

double bits_per_vertex(size_t bytes, uint32_t vertices) {
  return 8.0 * static_cast<double>(bytes) / vertices;
}

void deliver(OutputFile& out, const std::string& path, const std::string& text) {
  if (out.is_standard_output()) {
    out.commit();
    if (std::fputs(text.c_str(), stderr) < 0) throw ReportLost("the report cannot be printed");
    return;
  }
  const bool is_printed = try_print(text);  // before the file is there: a failure leaves none
  out.commit();
  if (!is_printed) throw ReportLost(path + ": is complete, but nobody reads the report");
}

bool try_print(const std::string& text) {
  try {
    OutputFile terminal("-");
    terminal.write(text);
    terminal.commit();
    return true;
  } catch (const NobodyReads&) {
    return false;
  }
}

void print(const std::string& text) {
  if (!try_print(text)) throw ReportLost("nobody reads the report");
}

std::string warning(const std::string& text) {
  return "microtin: warning: " + text + '\n';
}

std::string warning_of_units(const std::string& path, const SurfaceModel& model) {
  const bool plane = model.horizontal_unit == Unit::kUnknown;
  const bool up = model.vertical_unit == Unit::kUnknown || model.vertical_unit == Unit::kDegree;
  if (!plane && !up) return {};
  const std::string what = plane && up ? "units are"
                           : plane     ? "the unit of x and y is"
                                       : "the unit of heights is";
  return warning(path + ": " + what +
                 " not known and taken as metres; use --units when you encode");
}

void announce_size(const std::string& path, double most_bytes, bool forced,
                   const std::string& else_there_is) {
  constexpr double kGigabyte = 1e9;
  if (most_bytes <= kGigabyte) return;
  char size[64];
  std::snprintf(size, sizeof size, "up to %.1f GB", most_bytes / kGigabyte);
  if (!forced) {
    throw Error(path + ": would take " + size + "; use --force to write it" + else_there_is);
  }
  std::fputs(warning(path + " takes " + size).c_str(), stderr);
}

uint64_t most_vertices(const std::string& path, uint64_t vertices, bool forced) {
  if (vertices > product::kMostVerticesAtOnce && !forced) {
    throw Error(path + ": its tiles have " + std::to_string(vertices) +
                " vertices, which take about " + std::to_string(vertices / 6666667) +
                " GB of memory; use --force to read them");
  }
  return vertices;
}

std::string text_of(const JsonObject& report, bool as_json) {
  std::string text;
  for (const auto& [name, value] : report) {
    if (as_json) text += text.empty() ? "{\n  " : ",\n  ";
    text += as_json ? json(name) : name;
    text += ": ";
    text += value;
    if (!as_json) text += '\n';
  }
  if (as_json) text += "\n}\n";
  return text;
}

// Draws the bar, at most ten times a second.

ProgressBar::ProgressBar() : on_terminal_(errors_go_to_terminal()) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

Progress ProgressBar::progress() {
  if (!on_terminal_) return {};
  return Progress([this](double done) { draw(done); });
}

void ProgressBar::draw(double done) {
  constexpr std::size_t kWidth = 40;
  constexpr std::chrono::milliseconds kInterval(100);
  constexpr std::chrono::seconds kQuiet(1);
  const Clock::time_point now = Clock::now();
  if (now - last_ < kInterval || now - start_ < kQuiet || done <= 0) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto filled = static_cast<std::size_t>(done * kWidth);
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%, %.0f s left \033[K", bar.c_str(), 100 * done,
               elapsed / done - elapsed);
}

}  // namespace microtin::cli
