// SPDX-License-Identifier: MIT
#include "tests/bench/curves.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

constexpr double kLeft = 60, kRight = 20, kTop = 20, kBottom = 50;  // margins
constexpr const char* kColours[] = {"#1f6f8b", "#c0562b", "#5a7d2a"};

// A logarithmic axis from one place of the picture to another.
class Axis {
 public:
  Axis(double from, double to) : from_(from), to_(to) {}

  void include(double value) {
    low_ = std::min(low_, std::log(value));
    high_ = std::max(high_, std::log(value));
  }

  double at(double value) const {
    return from_ + (to_ - from_) * (std::log(value) - low_) / (high_ - low_);
  }

  // 1, 2, 5, 10, ... within.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    for (int exponent = -3; exponent < 9; ++exponent) {
      const double power = std::pow(10.0, exponent);
      for (const double tick : {power, 2 * power, 5 * power}) {
        if (std::log(tick) >= low_ - 1e-9 && std::log(tick) <= high_ + 1e-9) ticks.push_back(tick);
      }
    }
    return ticks;
  }

 private:
  double from_, to_;
  double low_ = std::numeric_limits<double>::max(), high_ = std::numeric_limits<double>::lowest();
};

void text(std::ostream& out, double x, double y, const std::string& anchor,
          const std::string& content, const std::string& colour = "#333") {
  out << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "' fill='" << colour
      << "'>" << content << "</text>\n";
}

std::string label(double tick) {
  std::ostringstream out;
  if (tick >= 1000) {
    out << tick / 1000 << "k";
  } else {
    out << tick;
  }
  return out.str();
}

void line(std::ostream& out, double x0, double y0, double x1, double y1) {
  out << "<path d='M" << x0 << ' ' << y0 << 'L' << x1 << ' ' << y1 << "' stroke='#ddd'/>\n";
}

void draw(std::ostream& out, const Series& series, const Axis& x, const Axis& y,
          const std::string& colour) {
  out << "<path fill='none' stroke-width='2' stroke='" << colour << "' d='";
  for (std::size_t i = 0; i < series.line.size(); ++i) {
    out << (i == 0 ? 'M' : 'L') << x.at(series.line[i].x) << ' ' << y.at(series.line[i].y);
  }
  out << "'/>\n";
  for (const Mark& mark : series.marks) {
    out << "<circle r='4' cx='" << x.at(mark.x) << "' cy='" << y.at(mark.y) << "' fill='" << colour
        << "'/>\n";
    text(out, x.at(mark.x) + 6, y.at(mark.y) - 4, "start", mark.text, colour);
  }
}

}  // namespace

std::string Chart::svg(double left) const {
  Axis x(left + kLeft, left + kWidth - kRight), y(kHeight - kBottom, kTop);
  for (const Series& series : series_) {
    for (const Place& p : series.line) {
      x.include(p.x);
      y.include(p.y);
    }
    for (const Mark& m : series.marks) y.include(m.y);
  }
  std::ostringstream out;
  for (const double tick : x.ticks()) {
    line(out, x.at(tick), kTop, x.at(tick), kHeight - kBottom);
    text(out, x.at(tick), kHeight - kBottom + 16, "middle", label(tick));
  }
  for (const double tick : y.ticks()) {
    line(out, left + kLeft, y.at(tick), left + kWidth - kRight, y.at(tick));
    text(out, left + kLeft - 6, y.at(tick) + 4, "end", label(tick));
  }
  text(out, left + kWidth / 2, kHeight - 12, "middle", "bytes against " + x_title_);
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const std::string colour = kColours[i % 3];
    draw(out, series_[i], x, y, colour);
    text(out, left + kLeft + 8, kHeight - kBottom - 12 - 16 * static_cast<double>(i), "start",
         series_[i].name, colour);
  }
  return out.str();
}

void write_charts(const std::string& path, const std::vector<Chart>& charts) {
  std::ofstream out(path);
  const double width = Chart::kWidth * static_cast<double>(charts.size());
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='"
      << Chart::kHeight << "' font-family='sans-serif' font-size='12'>\n"
      << "<rect width='100%' height='100%' fill='white'/>\n";
  for (std::size_t i = 0; i < charts.size(); ++i) {
    out << charts[i].svg(Chart::kWidth * static_cast<double>(i));
  }
  out << "</svg>\n";
  if (!out.flush()) throw Error(path + ": cannot be written");
}

}  // namespace microtin::bench
