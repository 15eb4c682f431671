// SPDX-License-Identifier: MIT
#include "tests/bench/grids/autopilots.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "decoder/adapters/ardupilot.h"
#include "decoder/adapters/inav.h"
#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/fractal.hpp"
#include "microtin/pack.h"
#include "tests/bench/device/flight.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/autopilot_flight.hpp"
#include "tests/support/autopilot_reader.hpp"

namespace microtin::bench {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kSector = 512, kSlots = 4, kSteps = 200;
constexpr int32_t kMeasured = 16;    // one of this many heights, since counting takes long
constexpr int32_t kLookPosts = 32;   // from one look ahead to the next
constexpr float kLookMetres = 1920;  // as far as INAV looks
constexpr float kBearing = 63, kClimb = 0.1F;
constexpr size_t kBlocks = 12;  // in ArduPilot's memory; taken for INAV's, too
constexpr uint32_t kBlockBytes = 2048;

Bytes bytes_of(const std::string& path) {
  const std::string text = read_file(path);
  return {text.begin(), text.end()};
}

// A file in sectors, of which the last one read is kept.
class Sectors {
 public:
  explicit Sectors(Bytes bytes) : bytes_(std::move(bytes)) {}

  const Bytes& bytes() const { return bytes_; }
  uint64_t asked() const { return asked_; }
  uint64_t read() const { return sectors_ * kSector; }
  uint32_t reads() const { return reads_; }

  int32_t take(uint64_t offset, uint8_t* buffer, size_t size) {
    ++reads_;
    if (offset >= bytes_.size()) return 0;
    const size_t count = std::min(size, bytes_.size() - static_cast<size_t>(offset));
    for (uint64_t s = offset / kSector; s <= (offset + count - 1) / kSector; ++s) {
      if (s != kept_) ++sectors_;
      kept_ = s;
    }
    asked_ += count;
    std::memcpy(buffer, bytes_.data() + offset, count);
    return static_cast<int32_t>(count);
  }

  static int32_t read_card(void* sectors, uint64_t offset, uint8_t* buffer, size_t size) {
    return static_cast<Sectors*>(sectors)->take(offset, buffer, size);
  }

 private:
  Bytes bytes_;
  uint64_t kept_ = ~uint64_t{0}, sectors_ = 0, asked_ = 0;
  uint32_t reads_ = 0;
};

// What answers an autopilot: at once, or not, and then waits to be served.
class Answerer {
 public:
  explicit Answerer(const std::string& path) : card(bytes_of(path)) {}
  virtual ~Answerer() = default;
  virtual bool height(microtin_spot at, float* metres) = 0;
  // Whether all of it is known.
  virtual bool look(microtin_spot at) = 0;
  // The vehicle's position, and home.
  virtual void here(microtin_spot) {}
  virtual void home(microtin_spot) {}
  virtual bool waits() const = 0;  // for serve(), which does a piece
  virtual void serve() = 0;
  virtual size_t ram() const = 0;

  Sectors card;
};

class PackAnswerer : public Answerer {
 public:
  PackAnswerer(const std::string& path, uint32_t slots)
      : Answerer(path), slots_(slots), capacity_(PackFile(card.bytes()).header().most_vertices) {
    space_.resize(MICROTIN_PACK_BYTES(slots, capacity_) / sizeof(uint64_t) + 1);
    if (microtin_pack_init(space_.data(), space_.size() * sizeof(uint64_t), slots, capacity_,
                           &pack) != MICROTIN_STATUS_OK) {
      throw Error(path + ": there is no room for it");
    }
    microtin_pack_align_reads(pack, kSector);
  }

  // The memory of a device, with numbers of 16 bits.
  size_t ram() const override {
    return MICROTIN_PACK_BYTES_FOR(slots_, capacity_, 16) + sizeof(microtin_spots);
  }

 protected:
  static bool waits(const microtin_spots& spots) { return microtin_spots_is_pending(&spots) != 0; }
  static void check(microtin_status status) {
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT &&
        status != MICROTIN_STATUS_OK && status != MICROTIN_STATUS_WORKSPACE_TOO_SMALL) {
      throw Error("the pack cannot be served");
    }
  }

  microtin_pack* pack = nullptr;

 private:
  uint32_t slots_, capacity_;
  std::vector<uint64_t> space_;
};

class Inav : public PackAnswerer {
 public:
  explicit Inav(const std::string& path, uint32_t slots = kSlots) : PackAnswerer(path, slots) {
    microtin_inav_init(&inav_, pack);
  }

  bool height(microtin_spot at, float* metres) override {
    return microtin_inav_height(&inav_, at.latitude, at.longitude, metres);
  }
  bool look(microtin_spot at) override {
    microtin_inav_look found;
    return microtin_inav_lookahead(&inav_, at.latitude, at.longitude, kBearing, kLookMetres, kClimb,
                                   kClimb, &found) &&
           found.samples_missed == 0;
  }
  void here(microtin_spot at) override {
    microtin_inav_set_position(&inav_, at.latitude, at.longitude);
  }
  void home(microtin_spot at) override {
    microtin_inav_set_home(&inav_, at.latitude, at.longitude);
  }
  bool waits() const override { return PackAnswerer::waits(inav_.spots); }
  void serve() override { check(microtin_inav_load(&inav_, kSteps, Sectors::read_card, &card)); }

 private:
  microtin_inav inav_{};
};

class ArduPilot : public PackAnswerer {
 public:
  explicit ArduPilot(const std::string& path, uint32_t slots = kSlots) : PackAnswerer(path, slots) {
    microtin_ardupilot_init(&terrain_, pack, 100);
  }

  bool height(microtin_spot at, float* metres) override {
    return microtin_ardupilot_height_amsl(&terrain_, at.latitude, at.longitude, metres, false);
  }
  bool look(microtin_spot at) override {
    microtin_ardupilot_lookahead(&terrain_, at.latitude, at.longitude, kBearing, kLookMetres,
                                 kClimb);
    return terrain_.missed == 0;
  }
  void here(microtin_spot at) override {
    microtin_ardupilot_set_position(&terrain_, at.latitude, at.longitude);
  }
  void home(microtin_spot at) override {
    microtin_ardupilot_set_home(&terrain_, at.latitude, at.longitude);
  }
  bool waits() const override { return PackAnswerer::waits(terrain_.spots); }
  void serve() override {
    check(microtin_ardupilot_load(&terrain_, kSteps, Sectors::read_card, &card));
  }
  size_t ram() const override {  // with its block, which only those need who want a grid
    return PackAnswerer::ram() - sizeof(microtin_spots) + sizeof(microtin_ardupilot);
  }

 private:
  microtin_ardupilot terrain_{};
};

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

// Puts the questions of a flight to an answerer; one service in 64 that has work is counted.
class Asker {
 public:
  Asker(Answerer& answerer, std::string callgrind)
      : answerer_(answerer), callgrind_(std::move(callgrind)) {}

  void here(microtin_spot at) { answerer_.here(at); }
  bool height(microtin_spot at) {
    float metres = 0;
    return answerer_.height(at, &metres);
  }
  bool ahead(microtin_spot at, float) { return answerer_.look(at); }
  void serve() {
    if (!answerer_.waits()) return;
    if (++services_ % 64 != 0) {
      answerer_.serve();
    } else {
      longest_ = std::max(longest_, instructions({[&] { answerer_.serve(); }}, callgrind_)[0]);
    }
  }
  double longest() const { return longest_; }

 private:
  Answerer& answerer_;
  std::string callgrind_;
  uint32_t services_ = 0;
  double longest_ = 0;
};

// What is known of ArduPilot's questions in flight (tests/support/autopilot_flight.hpp).
void print_questions(const AutopilotFiles& files) {
  print_head("ArduPilot's questions in flight: percent that is known",
             {"", "RAM", "own place", "home", "nine places around", "ahead", "all", "reads",
              "longest service"});
  const DegreeCell cell = terrain::cell_of(files.ardupilot_100).value();
  const microtin_spot corner = {cell.latitude * 10000000, cell.longitude * 10000000};
  const auto fly = [&](const std::string& name, Answerer& answerer) {
    Asker asker(answerer, files.callgrind);
    answerer.home({corner.latitude + 6250000, corner.longitude + 1250000});
    const tests::FlightShares known = tests::flight_over_cell(corner).fly(asker);
    print_row({name, number(answerer.ram()), number(known.own.percent(), 2),
               number(known.home.percent(), 2), number(known.surrounding.percent(), 2),
               number(known.ahead.percent(), 2), number(known.percent_of_all(), 2),
               number(answerer.card.reads()), number(asker.longest(), 0)});
  };
  for (const uint32_t slots : {4u, 9u}) {
    ArduPilot ardupilot(files.pack, slots);
    fly("pack, ArduPilot's adapter, slots: " + std::to_string(slots), ardupilot);
    Inav inav(files.pack, slots);
    fly("pack, INAV's adapter, slots: " + std::to_string(slots), inav);
  }
  GridAnswerer dat(files.ardupilot_100, Autopilot::kArduPilot, 100);
  fly("ArduPilot's .DAT, 100 m, 12 blocks", dat);
}

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
  print_questions(files);
}

}  // namespace microtin::bench
