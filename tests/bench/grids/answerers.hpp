// SPDX-License-Identifier: MIT
// What answers the questions of an autopilot: files on a card, and the adapters over a pack.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_ANSWERERS_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_ANSWERERS_HPP

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "decoder/adapters/ardupilot.h"
#include "decoder/adapters/inav.h"
#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/pack/file.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kSector = 512;
constexpr float kLookMetres = 1920;  // as far as INAV looks
constexpr float kBearing = 63, kClimb = 0.1F;

inline Bytes bytes_of(const std::string& path) {
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
  virtual bool waits() const = 0;                 // for serve(), which does a piece
  virtual bool has_work() const { return true; }  // perhaps, also if nothing waits
  virtual void serve() = 0;
  virtual size_t ram() const = 0;

  Sectors card;
};

// The slots of a pack, and the work units of a service.
struct Service {
  uint32_t slots = 4, steps = 200;
};

// A pack that the adapters serve: with compact slots if MICROTIN_ADAPTERS_COMPACT is defined.
class PackAnswerer : public Answerer {
 public:
  PackAnswerer(const std::string& path, const Service& service)
      : Answerer(path), steps(service.steps), slots_(service.slots) {
    const PackHeader header = PackFile(card.bytes()).header();
    capacity_ = header.most_vertices;
    tile_bytes_ = header.compact_bytes;
    if (init() != MICROTIN_STATUS_OK) throw Error(path + ": there is no room for it");
    microtin_pack_align_reads(pack, kSector);
  }

  // The memory of a device, with indices of 16 bits.
  size_t ram() const override {
#ifdef MICROTIN_ADAPTERS_COMPACT
    const size_t bytes = MICROTIN_COMPACT_PACK_BYTES_FOR(slots_, capacity_, tile_bytes_, 16);
#else
    const size_t bytes = MICROTIN_PACK_BYTES_FOR(slots_, capacity_, 16);
#endif
    return bytes + sizeof(microtin_spots);
  }

 protected:
  static bool waits(const microtin_spots& spots) {
    return microtin_spots_is_pending(&spots) != 0;
  }
  static void check(microtin_status status) {
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT &&
        status != MICROTIN_STATUS_OK && status != MICROTIN_STATUS_WORKSPACE_TOO_SMALL) {
      throw Error("the pack cannot be served");
    }
  }

  microtin_pack* pack = nullptr;
  const uint32_t steps;

 private:
  microtin_status init() {
#ifdef MICROTIN_ADAPTERS_COMPACT
    const auto bytes = static_cast<uint32_t>(MICROTIN_COMPACT_BYTES(capacity_));
    space_.resize(MICROTIN_COMPACT_PACK_BYTES(slots_, capacity_, bytes) / sizeof(uint64_t) + 1);
    return microtin_compact_pack_init(space_.data(), space_.size() * sizeof(uint64_t), slots_,
                                      capacity_, bytes, &pack);
#else
    space_.resize(MICROTIN_PACK_BYTES(slots_, capacity_) / sizeof(uint64_t) + 1);
    return microtin_pack_init(space_.data(), space_.size() * sizeof(uint64_t), slots_, capacity_,
                              &pack);
#endif
  }

  uint32_t slots_, capacity_ = 0, tile_bytes_ = 0;
  std::vector<uint64_t> space_;
};

class Inav : public PackAnswerer {
 public:
  explicit Inav(const std::string& path, const Service& service = {})
      : PackAnswerer(path, service) {
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
  void serve() override { check(microtin_inav_load(&inav_, steps, Sectors::read_card, &card)); }

 private:
  microtin_inav inav_{};
};

class ArduPilot : public PackAnswerer {
 public:
  explicit ArduPilot(const std::string& path, const Service& service = {})
      : PackAnswerer(path, service) {
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
    check(microtin_ardupilot_load(&terrain_, steps, Sectors::read_card, &card));
  }
  size_t ram() const override {  // with its block, which only those need who want a grid
    return PackAnswerer::ram() - sizeof(microtin_spots) + sizeof(microtin_ardupilot);
  }

 private:
  microtin_ardupilot terrain_{};
};

}  // namespace microtin::bench

#endif
