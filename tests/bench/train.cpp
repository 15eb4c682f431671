#include "tests/bench/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "decoder/state.hpp"
#include "encoder/encode.hpp"
#include "encoder/error.hpp"
#include "encoder/fractal.hpp"
#include "tests/bench/inputs.hpp"

namespace microtin::bench {
namespace {

constexpr double kGain = 2;  // how much further than it ended a start moves

// Where adaptive bits end, over the streams that used them.
class Ends {
 public:
  void add(const Tin& tin) {
    const std::vector<uint8_t> stream = encode(tin, {}, {Effort().degree, kMaxLevels});
    const std::vector<AdaptiveBit> bits = bits_after(stream);
    for (size_t i = 0; i < bits.size(); ++i) {
      const AdaptiveBit start = adaptive_bit(table_start(static_cast<uint32_t>(i)));
      if (bits[i].fast == start.fast && bits[i].slow == start.slow) continue;
      sum_[i] += probability_of(bits[i]);
      ++streams_[i];
    }
  }

  void print() const {
    for (size_t i = 0; i < kStarts; ++i) {
      const double start = table_start(static_cast<uint32_t>(i));
      double moved = start;
      if (streams_[i] != 0) moved += kGain * (sum_[i] / streams_[i] / 256 - 0.5 - start);
      const auto entry = std::clamp<long>(std::lround(moved), 0, 255);
      std::printf("%s%ld,%s", i % 16 == 0 ? "    " : " ", entry, i % 16 == 15 ? "\n" : "");
    }
    if (kStarts % 16 != 0) std::printf("\n");
  }

 private:
  static std::vector<AdaptiveBit> bits_after(const std::vector<uint8_t>& stream) {
    microtin_info info;
    if (microtin_peek(stream.data(), stream.size(), &info) != MICROTIN_DONE) throw Error("peek");
    std::vector<uint64_t> mesh_space(info.mesh_bytes / 8 + 1);
    std::vector<uint64_t> decoder_space(info.decoder_bytes / 8 + 1);
    microtin_mesh* mesh = nullptr;
    microtin_decoder* decoder = nullptr;
    microtin_mesh_init(mesh_space.data(), 8 * mesh_space.size(), &mesh);
    microtin_decoder_init(decoder_space.data(), 8 * decoder_space.size(), mesh, &decoder);
    size_t used = 0;
    if (microtin_feed(decoder, stream.data(), stream.size(), 0, &used) != MICROTIN_DONE) {
      throw Error("decode");
    }
    std::vector<AdaptiveBit> bits(kStarts);
    std::memcpy(bits.data(), &decoder->reconstruction.models, sizeof(Models));
    return bits;
  }

  std::array<double, kStarts> sum_{};
  std::array<double, kStarts> streams_{};
};

Raster fractal(uint64_t seed) {
  constexpr uint32_t kSize = 129;
  Raster raster;
  raster.width = raster.height = kSize;
  for (const int16_t z : fractal_heights(kSize, seed)) raster.heights.push_back(z);
  return raster;
}

LatticeOptions bounded(const char* error, const char* step) {
  LatticeOptions options;
  options.max_error = parse_decimal(error);
  options.z_step = parse_decimal(step);
  return options;
}

Ends ends_of_everything() {
  Ends ends;
  for (const Dataset& dataset : rasters()) {
    const Raster raster = read_raster(dataset);
    const auto vertices =
        static_cast<double>(simplified(raster, dataset.options).tin.vertices.size());
    for (const double size : {1000.0, 250.0}) {
      for (const Raster& tile : tiles_of(raster, vertices / size)) {
        ends.add(simplified(tile, dataset.options).tin);
      }
    }
  }
  for (const Dataset& dataset : clouds())
    ends.add(simplified(read_cloud(dataset), dataset.options).tin);
  for (uint64_t seed = 100; seed < 130; ++seed) {
    ends.add(simplified(fractal(seed), bounded("12", "10")).tin);
    ends.add(simplified(fractal(seed), bounded("4", "1")).tin);
    for (const uint32_t count : {300u, 3000u}) ends.add(uniform_tin(count, seed));
  }
  return ends;
}

}  // namespace

void print_start_probabilities() {
  const Ends ends = ends_of_everything();
  std::printf(
      "%s%u;\n\n%s",
      R"(// Where the adaptive bits start, in the order of Models: the probability of a one is
// (entry + 1/2) / 256. Written by `tests/bench/run train`.
#ifndef MICROTIN_SHARED_START_PROBABILITIES_HPP
#define MICROTIN_SHARED_START_PROBABILITIES_HPP

#include "shared/tables.hpp"

namespace microtin {

constexpr uint32_t kStarts = )",
      kStarts, R"(// clang-format off
constexpr uint8_t kStartTable[kStarts] MICROTIN_IN_FLASH = {
)");
  ends.print();
  std::printf(R"(};
// clang-format on

inline uint32_t table_start(uint32_t i) {
  return read_table(kStartTable + i);
}

}  // namespace microtin

#endif
)");
}

}  // namespace microtin::bench
