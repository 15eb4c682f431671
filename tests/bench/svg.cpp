// SPDX-License-Identifier: MIT
#include "tests/bench/svg.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "encoder/files/output.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

constexpr double kWidth = 440, kHeight = 330;                       // of a panel
constexpr double kLeft = 70, kRight = 20, kTop = 40, kBottom = 50;  // its margins
constexpr double kLegend = 40;                                      // height below the panels
const char* const kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
constexpr size_t kColourCount = std::size(kColours);

std::string text(double x, double y, const std::string& anchor, const std::string& content,
                 const std::string& more = "") {
  std::ostringstream out;
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\" " << more
      << ">" << content << "</text>\n";
  return out.str();
}

std::string line(double x0, double y0, double x1, double y1, const std::string& colour) {
  std::ostringstream out;
  out << "<line x1=\"" << x0 << "\" y1=\"" << y0 << "\" x2=\"" << x1 << "\" y2=\"" << y1
      << "\" stroke=\"" << colour << "\"/>\n";
  return out.str();
}

// 1, 2 or 5 times a power of ten, so that about five of it make `most`.
double tick_step(double most) {
  const double rough = most / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

std::string rounded(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string count(double value) {
  if (value >= 1e6) return rounded(value / 1e6) + "M";
  if (value >= 1e3) return rounded(value / 1e3) + "k";
  return rounded(value);
}

class Drawing {
 public:
  Drawing(const Panel& panel, double x, double y) : panel_(panel), x_(x), y_(y) {
    for (const Curve& curve : panel.curves) {
      for (const auto& [px, py] : curve.points) {
        least_ = std::min(least_, px);
        most_ = std::max(most_, px);
        highest_ = std::max(highest_, 1.1 * py);
      }
    }
  }

  std::string svg() const { return axes() + curves(); }

 private:
  double at_x(double x) const {
    return x_ + kLeft + (kWidth - kLeft - kRight) * std::log(x / least_) / std::log(most_ / least_);
  }
  double at_y(double y) const {
    return y_ + kHeight - kBottom - (kHeight - kTop - kBottom) * y / highest_;
  }

  std::string axes() const {
    const double left = at_x(least_), right = at_x(most_), bottom = at_y(0);
    std::string out = text((left + right) / 2, y_ + 24, "middle", panel_.title,
                           "font-size=\"15\" font-weight=\"bold\"");
    const double step = tick_step(highest_);
    for (int i = 0; i * step <= highest_; ++i) {
      const double y = i * step;
      out += line(left, at_y(y), right, at_y(y), y == 0 ? "#000" : "#ddd");
      out += text(left - 6, at_y(y) + 4, "end", count(y));
    }
    for (int i = static_cast<int>(std::ceil(std::log10(least_))); i <= std::log10(most_); ++i) {
      const double x = std::pow(10, i);
      out += line(at_x(x), bottom, at_x(x), bottom + 5, "#000");
      out += text(at_x(x), bottom + 19, "middle", count(x));
    }
    out += text((left + right) / 2, bottom + 38, "middle", panel_.x_label);
    const double middle = (at_y(0) + at_y(highest_)) / 2;
    std::ostringstream turn;
    turn << "transform=\"rotate(-90 " << x_ + 18 << " " << middle << ")\"";
    return out + text(x_ + 18, middle, "middle", panel_.y_label, turn.str());
  }

  std::string curves() const {
    std::ostringstream out;
    for (size_t i = 0; i < panel_.curves.size(); ++i) {
      const char* const colour = kColours[i % kColourCount];
      out << "<polyline fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"2\" points=\"";
      for (const auto& [x, y] : panel_.curves[i].points) out << at_x(x) << "," << at_y(y) << " ";
      out << "\"/>\n";
      for (const auto& [x, y] : panel_.curves[i].points) {
        out << "<circle cx=\"" << at_x(x) << "\" cy=\"" << at_y(y) << "\" r=\"3\" fill=\"" << colour
            << "\"/>\n";
      }
    }
    return out.str();
  }

  const Panel& panel_;
  double x_, y_;
  double least_ = 1e300, most_ = 0, highest_ = 0;
};

std::string legend(const std::vector<Curve>& curves, double width, double y) {
  std::string out;
  for (size_t i = 0; i < curves.size(); ++i) {
    const double x =
        kLeft + (width - kLeft) * static_cast<double>(i) / static_cast<double>(curves.size());
    out += line(x, y, x + 24, y, std::string(kColours[i % kColourCount]) + "\" stroke-width=\"3");
    out += text(x + 30, y + 4, "start", curves[i].name);
  }
  return out;
}

}  // namespace

void write_plot(const std::string& path, const std::vector<Panel>& panels) {
  const double columns = static_cast<double>(std::min<size_t>(2, panels.size()));
  const size_t row_count = (panels.size() + 1) / 2;
  const auto rows = static_cast<double>(row_count);
  const double width = columns * kWidth, height = rows * kHeight + kLegend;
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << " " << height
      << "\" font-family=\"sans-serif\" font-size=\"13\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (size_t i = 0; i < panels.size(); ++i) {
    const size_t column = i % 2, row = i / 2;
    const double x = static_cast<double>(column) * kWidth, y = static_cast<double>(row) * kHeight;
    out << Drawing(panels[i], x, y).svg();
  }
  out << legend(panels.front().curves, width, rows * kHeight + kLegend / 2) << "</svg>\n";
  OutputFile file(path);
  file.write(out.str());
  file.commit();
}

}  // namespace microtin::bench
