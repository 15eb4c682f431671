// SPDX-License-Identifier: MIT
#include "tests/bench/grids/autopilots.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/fractal.hpp"
#include "tests/bench/device/flight.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/grids/questions.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/autopilot_reader.hpp"

namespace microtin::bench {
namespace {

constexpr int32_t kMeasured = 16;   // one of this many heights, since counting takes long
constexpr int32_t kLookPosts = 32;  // from one look ahead to the next
constexpr size_t kBlocks = 12;      // in ArduPilot's memory; taken for INAV's, too
constexpr uint32_t kBlockBytes = 2048;

// Blocks of a grid, of which the least recently wanted makes room. Loading is a copy: what the
// firmware checks of a block is left out, to its advantage.
class GridAnswerer : public Answerer {
 public:
  GridAnswerer(const std::string& path, Autopilot autopilot, uint32_t spacing)
      : Answerer(path),
        autopilot_(autopilot),
        spacing_(spacing),
        firmware_(card.bytes(), autopilot, terrain::cell_of(path).value(), spacing) {}

  bool height(microtin_spot at, float* metres) override {
    const auto place = firmware_.place(at.latitude, at.longitude);
    const auto offset = static_cast<uint64_t>(firmware_.block(place) - card.bytes().data());
    if (!is_there(offset)) {
      wished_ = offset;
      return false;
    }
    const auto found = firmware_.height(place);
    if (found) *metres = *found;
    return true;
  }
  bool look(microtin_spot at) override {
    bool is_known = true;
    const auto stride = microtin_stride_along(static_cast<int32_t>(kBearing * 100),
                                              static_cast<int32_t>(spacing_ * 1000));
    for (uint32_t i = 0; i * spacing_ < static_cast<uint32_t>(kLookMetres); ++i) {
      at = microtin_spot_beside(at, stride.north, stride.east);
      float metres = 0;
      is_known = height(at, &metres) && is_known;
    }
    return is_known;
  }
  bool waits() const override { return wished_ != kNone; }
  bool has_work() const override { return waits(); }
  void serve() override {
    Slot& slot = *std::min_element(
        slots_, slots_ + kBlocks, [](const Slot& a, const Slot& b) { return a.wanted < b.wanted; });
    card.take(wished_, slot.bytes, kBlockBytes);
    slot.offset = wished_;
    slot.wanted = ++clock_;
    wished_ = kNone;
  }
  size_t ram() const override {
    return kBlocks * (autopilot_ == Autopilot::kInav ? size_t{1151} : size_t{1822});
  }

 private:
  static constexpr uint64_t kNone = ~uint64_t{0};
  struct Slot {
    uint64_t offset = kNone;
    uint32_t wanted = 0;
    uint8_t bytes[kBlockBytes] = {};
  };

  bool is_there(uint64_t offset) {
    for (Slot& slot : slots_) {
      if (slot.offset != offset) continue;
      slot.wanted = ++clock_;
      return true;
    }
    return false;
  }

  Autopilot autopilot_;
  uint32_t spacing_;
  Firmware firmware_;
  Slot slots_[kBlocks];
  uint64_t wished_ = kNone;
  uint32_t clock_ = 0;
};

// What the flight took; instructions of single calls.
struct Taken {
  double service = 0, height = 0, look = 0;
  Errors errors;
  uint32_t heights = 0;
};

class Flier {
 public:
  Flier(Raster source, std::string callgrind)
      : source_(std::move(source)), callgrind_(std::move(callgrind)) {}

  Taken fly(Answerer& answerer) const {
    const Flight flight(source_.width - 1, source_.height - 1);
    Taken taken;
    serve(answerer, taken);
    for (int32_t i = 0; i < flight.posts(); ++i) {
      const microtin_spot at = spot(flight.post(i));
      float metres = 0;
      while (!answerer.height(at, &metres)) serve(answerer, taken);
      if (i % kMeasured == 0) measure(taken.height, [&] { answerer.height(at, &metres); });
      add_error(flight.post(i), metres, taken);
      if (i % kLookPosts != 0) continue;
      answerer.look(at);  // what is missing is wished for
      serve(answerer, taken);
      measure(taken.look, [&] { answerer.look(at); });
      serve(answerer, taken);
    }
    taken.errors.rms = std::sqrt(taken.errors.rms / taken.heights);
    return taken;
  }

  double kilometres() const {
    const Flight flight(source_.width - 1, source_.height - 1);
    const microtin_spot from = spot(flight.post(0)), to = spot(flight.post(flight.posts() - 1));
    constexpr double kMetres = 0.0111319;
    return std::hypot((to.latitude - from.latitude) * kMetres,
                      (to.longitude - from.longitude) * kMetres *
                          std::cos(from.latitude * 1e-7 * 3.14159265 / 180)) /
           1000;
  }

 private:
  void measure(double& longest, const Work& work) const {
    longest = std::max(longest, instructions({work}, callgrind_)[0]);
  }

  void serve(Answerer& answerer, Taken& taken) const {
    while (answerer.waits()) measure(taken.service, [&] { answerer.serve(); });
  }

  microtin_spot spot(Post post) const {
    const auto place = [](const Axis& axis, int32_t steps) {
      return static_cast<int32_t>(std::lround((offset_of(axis) + step_of(axis) * steps) * 1e7));
    };
    return {place(source_.y, post.y), place(source_.x, post.x)};
  }

  void add_error(Post post, float metres, Taken& taken) const {
    const int64_t z =
        source_.heights[static_cast<size_t>(post.y) * source_.width + static_cast<size_t>(post.x)];
    if (z == kVoidHeight) return;
    const double there = static_cast<double>(z) * std::pow(10, -source_.decimals);
    const double error = std::abs(static_cast<double>(metres) - there);
    taken.errors.largest = std::max(taken.errors.largest, error);
    taken.errors.rms += error * error;
    ++taken.heights;
  }

  Raster source_;
  std::string callgrind_;
};

Raster raster_of_cell(const std::string& path) {
  const Source source = import_terrain(path);
  const auto* raster = std::get_if<Raster>(&source);
  if (raster == nullptr) throw Error(path + ": is not a raster");
  return *raster;
}

}  // namespace

void write_cell(const std::string& path) {
  constexpr uint32_t kPosts = 1201, kSize = 2049;
  const std::vector<int16_t> heights = fractal_heights(kSize, 1);
  std::string bytes;
  for (uint32_t row = kPosts; row-- > 0;) {
    for (uint32_t column = 0; column < kPosts; ++column) {
      const int16_t z = heights[size_t{row} * kSize + column];
      bytes += static_cast<char>(z >> 8 & 255);
      bytes += static_cast<char>(z & 255);
    }
  }
  OutputFile out(path);
  out.write(bytes);
  out.commit();
}

void print_autopilots(const AutopilotFiles& files) {
  const Flier flier(raster_of_cell(files.terrain), files.callgrind);
  print_head(
      "A flight of " + number(flier.kilometres(), 1) + " km: instructions of this machine",
      {"", "bytes on the card", "RAM", "bytes asked for, in sectors",
       "longest call: service or load", "... height", "... look ahead", "error: largest, rms, m"});
  const auto fly = [&](const std::string& name, Answerer& answerer) {
    const Taken taken = flier.fly(answerer);
    print_row({name, number(answerer.card.bytes().size()), number(answerer.ram()),
               std::to_string(answerer.card.asked()) + ", " + std::to_string(answerer.card.read()),
               number(taken.service, 0), number(taken.height, 0), number(taken.look, 0),
               number(taken.errors.largest, 1) + ", " + number(taken.errors.rms, 2)});
  };
  Inav inav(files.pack);
  ArduPilot ardupilot(files.pack);
  GridAnswerer ter(files.inav, Autopilot::kInav, exporting::kInavSpacing);
  GridAnswerer dat_30(files.ardupilot_30, Autopilot::kArduPilot, 30);
  GridAnswerer dat_100(files.ardupilot_100, Autopilot::kArduPilot, 100);
  fly("pack, INAV's adapter", inav);
  fly("pack, ArduPilot's adapter", ardupilot);
  fly("INAV's .TER, 30 m", ter);
  fly("ArduPilot's .DAT, 30 m", dat_30);
  fly("ArduPilot's .DAT, 100 m", dat_100);
  const DegreeCell cell = terrain::cell_of(files.ardupilot_100).value();
  print_questions_head();
  GridAnswerer asked(files.ardupilot_100, Autopilot::kArduPilot, 100);
  print_questions("ArduPilot's .DAT, 100 m, 12 blocks", "-", asked, cell, files.callgrind);
  print_pack_questions(files.pack, files.small_pack, cell, files.callgrind);
}

}  // namespace microtin::bench
