// SPDX-License-Identifier: MIT
// The points of a chunk of LAZ, encoded for tests, from records of LAS.
#ifndef MICROTIN_TESTS_SUPPORT_LAZ_POINTS_HPP
#define MICROTIN_TESTS_SUPPORT_LAZ_POINTS_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/laz_encoder.hpp"

namespace microtin::tests {

template <class Number>
Number number_at(const std::string& record, size_t at) {
  Number number;
  std::memcpy(&number, record.data() + at, sizeof number);
  return number;
}

inline uint32_t byte_at(const std::string& record, size_t at) {
  return static_cast<uint8_t>(record[at]);
}

// Five values, of which the largest and the smallest give way in turn.
class FiveValues {
 public:
  int32_t median() const { return values_[2]; }

  void add(int32_t value) {
    const bool rises = largest_gives_way_ ? value >= median() : value > median();
    values_[largest_gives_way_ ? 4 : 0] = value;
    std::sort(values_.begin(), values_.end());
    largest_gives_way_ = !rises;
  }

 private:
  std::array<int32_t, 5> values_{};
  bool largest_gives_way_ = true;
};

// a - b, modulo 2^32 or 2^64.
inline int32_t wrapping_difference(int32_t a, int32_t b) {
  return static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b));
}
inline int64_t wrapping_difference(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) - static_cast<uint64_t>(b));
}

// x, y and z. Values are those of a record and of the one before.
class PlaceEncoder {
 public:
  explicit PlaceEncoder(size_t contexts, int32_t z) : medians_(contexts) { heights_.fill(z); }

  void encode(LazEncoder& xy, LazEncoder& z, const std::string& record, const std::string& last,
              size_t context, size_t level, bool is_only) {
    const uint32_t only = is_only ? 1 : 0;
    uint32_t width_context = only;
    for (size_t axis = 0; axis < 2; ++axis) {
      FiveValues& steps = medians_[context][axis];
      const int32_t step = wrapping_difference(number_at<int32_t>(record, 4 * axis),
                                               number_at<int32_t>(last, 4 * axis));
      integers_[axis].encode(xy, steps.median(), step, width_context);
      steps.add(step);
      width_context = only + std::min(integers_[0].width(), 20u) / 2 * 2;
    }
    const uint32_t mean = (integers_[0].width() + integers_[1].width()) / 2;
    const auto height = number_at<int32_t>(record, 8);
    integers_[2].encode(z, heights_[level], height, only + std::min(mean, 18u) / 2 * 2);
    heights_[level] = height;
  }

 private:
  std::array<IntegerEncoder, 3> integers_ = {IntegerEncoder(32, 2), IntegerEncoder(32, 22),
                                             IntegerEncoder(32, 20)};
  std::vector<std::array<FiveValues, 2>> medians_;
  std::array<int32_t, 8> heights_{};
};

// Times, whose bits are taken as integers. In layers a time that does not change has no symbol.
class TimeEncoder {
 public:
  TimeEncoder(int64_t first, bool is_layered)
      : shift_(is_layered ? 1 : 0), first_steps_(6 - shift_), multiples_(516 - shift_) {
    times_[0] = first;
  }

  void encode(LazEncoder& encoder, int64_t time) {
    if (const uint32_t further = further_of(time); further != 0) {
      if (steps_[current_] == 0) {
        encoder.symbol(first_steps_, 2 - shift_ + further);
      } else {
        encoder.symbol(multiples_, 512 - shift_ + further);
      }
      current_ = (current_ + further) % 4;
    }
    if (steps_[current_] == 0) {
      encode_first_step(encoder, time);
    } else {
      encode_multiple(encoder, time);
    }
    times_[current_] = time;
  }

 private:
  static bool is_near(int64_t difference) { return difference == static_cast<int32_t>(difference); }

  // How many sequences further a time is near the last one, if the current is not near. 0: stay.
  uint32_t further_of(int64_t time) const {
    for (uint32_t i = 0; i < 4; ++i) {
      if (is_near(wrapping_difference(time, times_[(current_ + i) % 4]))) return i;
    }
    return 0;
  }

  void encode_new(LazEncoder& encoder, int64_t time) {
    integers_.encode(encoder, static_cast<int32_t>(times_[current_] >> 32),
                     static_cast<int32_t>(time >> 32), 8);
    encoder.raw(static_cast<uint32_t>(time) & 0xFFFF, 16);
    encoder.raw(static_cast<uint32_t>(time) >> 16, 16);
    current_ = newest_ = (newest_ + 1) % 4;
    steps_[current_] = 0;
    extremes_[current_] = 0;
  }

  void encode_first_step(LazEncoder& encoder, int64_t time) {
    const int64_t difference = wrapping_difference(time, times_[current_]);
    if (difference == 0 && shift_ == 0) return encoder.symbol(first_steps_, 0);
    if (!is_near(difference)) {
      encoder.symbol(first_steps_, 2 - shift_);
      return encode_new(encoder, time);
    }
    encoder.symbol(first_steps_, 1 - shift_);
    integers_.encode(encoder, 0, static_cast<int32_t>(difference), 0);
    steps_[current_] = static_cast<int32_t>(difference);
    extremes_[current_] = 0;
  }

  void encode_multiple(LazEncoder& encoder, int64_t time) {
    const int64_t difference = wrapping_difference(time, times_[current_]);
    if (difference == 0 && shift_ == 0) return encoder.symbol(multiples_, 511);
    if (!is_near(difference)) {
      encoder.symbol(multiples_, 512 - shift_);
      return encode_new(encoder, time);
    }
    const int32_t step = steps_[current_], now = static_cast<int32_t>(difference);
    const double quotient = std::round(static_cast<double>(now) / step);
    const int32_t factor = static_cast<int32_t>(std::clamp(quotient, -10.0, 500.0));
    const uint32_t context = factor == 0     ? 7
                             : factor == 1   ? 1
                             : factor == 500 ? 4
                             : factor >= 10  ? 3
                             : factor > 1    ? 2
                             : factor > -10  ? 5
                                             : 6;
    encoder.symbol(multiples_, static_cast<uint32_t>(factor >= 0 ? factor : 500 - factor));
    const auto predicted = static_cast<uint32_t>(factor) * static_cast<uint32_t>(step);
    integers_.encode(encoder, static_cast<int32_t>(predicted), now, context);
    if (factor == 1) extremes_[current_] = 0;
    const bool is_extreme = factor == 0 || factor == 500 || factor == -10;
    if (!is_extreme || ++extremes_[current_] <= 3) return;
    steps_[current_] = now;
    extremes_[current_] = 0;
  }

  uint32_t shift_;
  SymbolShares first_steps_, multiples_;
  IntegerEncoder integers_{32, 9};
  std::array<int64_t, 4> times_{};
  std::array<int32_t, 4> steps_{};
  std::array<int, 4> extremes_{};
  uint32_t current_ = 0, newest_ = 0;
};

// Red, green and blue, six bytes from a place of the record on.
class ColourEncoder {
 public:
  void encode(LazEncoder& encoder, const std::string& record, const std::string& last, size_t at) {
    const auto now = [&](size_t i) { return static_cast<int>(byte_at(record, at + i)); };
    const auto before = [&](size_t i) { return static_cast<int>(byte_at(last, at + i)); };
    uint32_t changed = 0;
    for (size_t i = 0; i < 6; ++i) changed |= (now(i) != before(i) ? 1u : 0u) << i;
    const bool is_grey = record.substr(at, 2) == record.substr(at + 2, 2) &&
                         record.substr(at, 2) == record.substr(at + 4, 2);
    if (!is_grey) changed |= 64;
    encoder.symbol(changed_, changed);
    const auto put = [&](size_t i, int predicted) {
      if ((changed >> i & 1) == 0) return;
      encoder.symbol(bytes_[i], static_cast<uint8_t>(now(i) - std::clamp(predicted, 0, 255)));
    };
    for (const size_t i : {0u, 1u}) put(i, before(i));
    for (const size_t i : {0u, 1u}) {
      if (is_grey) break;
      const int red = now(i) - before(i), green = now(i + 2) - before(i + 2);
      put(i + 2, before(i + 2) + red);
      put(i + 4, before(i + 4) + (red + green) / 2);
    }
  }

 private:
  SymbolShares changed_{128};
  std::vector<SymbolShares> bytes_{6, SymbolShares(256)};
};

inline const char* const kReturnTable[] = {"FEDCBA98", "E0136AA9", "D1247BBA", "C3458CCB",
                                           "B6789DDC", "AABCDEED", "9ABCDEFE", "89ABCDEF"};
inline const char* const kRecentReturnTable[] = {
    "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};

inline uint32_t table_entry(const char* row, uint32_t column) {
  return static_cast<uint32_t>(std::strtoul(std::string(1, row[column]).c_str(), nullptr, 16));
}

// Points of formats 0 to 3 that follow the first one, all into one encoder.
class InterleavedEncoder {
 public:
  InterleavedEncoder(const std::string& first, uint8_t point_format)
      : last_(first),
        time_at_(point_format == 1 || point_format == 3 ? 20 : 0),
        colour_at_(point_format == 2   ? 20
                   : point_format == 3 ? 28
                                       : 0),
        extra_at_(20u + (time_at_ != 0 ? 8u : 0u) + (colour_at_ != 0 ? 6u : 0u)),
        times_(time_at_ != 0 ? number_at<int64_t>(first, 20) : 0, false),
        extra_(first.size() - extra_at_, SymbolShares(256)) {}

  void add(const std::string& record) {
    const uint32_t returns = byte_at(record, 14), number = returns & 7, count = returns >> 3 & 7;
    const uint32_t context = table_entry(kReturnTable[count], number);
    add_attributes(record, context);
    const size_t level = count > number ? count - number : number - count;
    places_.encode(encoder_, encoder_, record, last_, context, level, count == 1);
    if (time_at_ != 0) times_.encode(encoder_, number_at<int64_t>(record, time_at_));
    if (colour_at_ != 0) colours_.encode(encoder_, record, last_, colour_at_);
    for (size_t i = 0; i < extra_.size(); ++i) {
      const size_t at = extra_at_ + i;
      encoder_.symbol(extra_[i], (byte_at(record, at) - byte_at(last_, at)) & 255);
    }
    last_ = record;
  }

  std::string finished() const { return encoder_.finished(); }

 private:
  void add_attributes(const std::string& record, uint32_t context) {
    const auto differs = [&](size_t at) { return record[at] != last_[at]; };
    const auto intensity = number_at<uint16_t>(record, 12);
    const bool has_intensity = intensity != intensities_[context];
    const bool has_source = record.substr(18, 2) != last_.substr(18, 2);
    const uint32_t changed = (differs(14) ? 32u : 0u) | (has_intensity ? 16u : 0u) |
                             (differs(15) ? 8u : 0u) | (differs(16) ? 4u : 0u) |
                             (differs(17) ? 2u : 0u) | (has_source ? 1u : 0u);
    encoder_.symbol(changed_, changed);
    const auto put = [&](std::vector<SymbolShares>& shares, size_t at) {
      if (differs(at)) encoder_.symbol(shares[byte_at(last_, at)], byte_at(record, at));
    };
    put(returns_, 14);
    if (has_intensity) {
      intensity_.encode(encoder_, intensities_[context], intensity, std::min(context, 3u));
      intensities_[context] = intensity;
    }
    put(flags_, 15);
    if (differs(16)) {
      encoder_.symbol(angles_[byte_at(record, 14) >> 6 & 1],
                      (byte_at(record, 16) - byte_at(last_, 16)) & 255);
    }
    put(users_, 17);
    if (!has_source) return;
    source_.encode(encoder_, number_at<uint16_t>(last_, 18), number_at<uint16_t>(record, 18), 0);
  }

  LazEncoder encoder_;
  std::string last_;
  size_t time_at_, colour_at_, extra_at_;  // 0: there is none
  SymbolShares changed_{64};
  std::vector<SymbolShares> returns_{256, SymbolShares(256)}, flags_ = returns_, users_ = returns_,
                                                              angles_{2, SymbolShares(256)};
  std::array<uint16_t, 16> intensities_{};
  IntegerEncoder intensity_{16, 4}, source_{16, 1};
  PlaceEncoder places_{16, 0};
  TimeEncoder times_;
  ColourEncoder colours_;
  std::vector<SymbolShares> extra_;
};

// Points of formats 6 to 10. Intensities, user bytes, colours, waves and bytes of the writer's own
// are left out: a decoder repeats the first point's, and the layers are empty or have filling that
// only a reader may have that skips them.
class LayeredEncoder {
 public:
  explicit LayeredEncoder(const std::string& first) : current_(channel_of(first)) {
    channels_[current_] = std::make_unique<Channel>(first);
  }

  void add(const std::string& record) {
    Channel& before = *channels_[current_];
    const uint32_t channel_code = channel_of(record);
    const bool is_new = channels_[channel_code] == nullptr;
    const std::string& last = is_new ? before.last : channels_[channel_code]->last;
    const bool has_time = differ(record, last, 22, 8), has_source = differ(record, last, 20, 2),
               has_angle = differ(record, last, 18, 2);
    const uint32_t number = byte_at(record, 14) & 15, count = byte_at(record, 14) >> 4,
                   last_number = byte_at(last, 14) & 15, last_count = byte_at(last, 14) >> 4;
    const uint32_t move = (number + 16 - last_number) % 16;
    const uint32_t move_code = move == 0 ? 0 : move == 1 ? 1 : move == 15 ? 2 : 3;
    const uint32_t changed = move_code | (count != last_count ? 4u : 0u) | (has_angle ? 8u : 0u) |
                             (has_time ? 16u : 0u) | (has_source ? 32u : 0u) |
                             (channel_code != current_ ? 64u : 0u);
    LazEncoder& xy = layers_[0];
    const uint32_t old_number = byte_at(before.last, 14) & 15,
                   old_count = byte_at(before.last, 14) >> 4;
    xy.symbol(before.changed[(old_number == 1 ? 1u : 0u) + (old_number >= old_count ? 2u : 0u) +
                             (before.has_time ? 4u : 0u)],
              changed);
    if (channel_code != current_) {
      xy.symbol(before.channel, (channel_code + 3 - current_) % 4);
      if (is_new) channels_[channel_code] = std::make_unique<Channel>(before.last);
    }
    current_ = channel_code;
    Channel& channel = *channels_[current_];
    if (count != last_count) xy.symbol(channel.counts[last_count], count);
    if (move_code == 3 && has_time) xy.symbol(channel.numbers[last_number], number);
    if (move_code == 3 && !has_time) xy.symbol(channel.moves, move - 2);
    channel.has_time = has_time;
    add_values(channel, record, number, count);
    if (has_angle) put_integer(channel.angles, 5, record, channel.last, 18, has_time ? 1 : 0);
    if (has_source) put_integer(channel.sources, 7, record, channel.last, 20, 0);
    if (has_time) channel.times.encode(layers_[8], number_at<int64_t>(record, 22));
    channel.last = record;
  }

  // Sizes and bytes of all layers; those that are left out have `filling` bytes each.
  std::string finished(uint32_t other_layers, uint32_t filling) const {
    std::string sizes, bytes;
    for (uint32_t i = 0; i < 9 + other_layers; ++i) {
      const bool is_filled = i == 4 || i == 6 || i >= 9;
      std::string layer = is_filled                       ? std::string(filling, '\x5A')
                          : i < 2 || layers_[i].is_used() ? layers_[i].finished()
                                                          : "";
      if ((i == 2 && !has_classes_) || (i == 3 && !has_flags_)) layer.clear();
      const auto size = static_cast<uint32_t>(layer.size());
      sizes += std::string(reinterpret_cast<const char*>(&size), 4);
      bytes += layer;
    }
    return sizes + bytes;
  }

 private:
  struct Channel {
    explicit Channel(const std::string& first)
        : last(first),
          places(12, number_at<int32_t>(first, 8)),
          times(number_at<int64_t>(first, 22), true) {}

    std::string last;
    bool has_time = false;
    PlaceEncoder places;
    TimeEncoder times;
    std::vector<SymbolShares> changed{8, SymbolShares(128)}, counts{16, SymbolShares(16)},
        numbers{16, SymbolShares(16)}, classes{64, SymbolShares(256)}, flags{64, SymbolShares(64)};
    SymbolShares channel{3}, moves{13};
    IntegerEncoder angles{16, 2}, sources{16, 1};
  };

  static uint32_t channel_of(const std::string& record) { return byte_at(record, 15) >> 4 & 3; }
  static uint32_t flags_of(const std::string& record) {
    return (byte_at(record, 15) & 15) | byte_at(record, 15) >> 6 << 4;
  }
  static bool differ(const std::string& a, const std::string& b, size_t at, size_t bytes) {
    return a.compare(at, bytes, b, at, bytes) != 0;
  }

  void put_integer(IntegerEncoder& integers, size_t layer, const std::string& record,
                   const std::string& last, size_t at, uint32_t context) {
    integers.encode(layers_[layer], number_at<int16_t>(last, at), number_at<int16_t>(record, at),
                    context);
  }

  void add_values(Channel& channel, const std::string& record, uint32_t number, uint32_t count) {
    const uint32_t context =
        2 * table_entry(kRecentReturnTable[count], number) + (channel.has_time ? 1 : 0);
    const uint32_t level = std::min(count > number ? count - number : number - count, 7u);
    channel.places.encode(layers_[0], layers_[1], record, channel.last, context, level, count == 1);
    const uint32_t last_class = byte_at(channel.last, 16);
    const uint32_t is_single = number == 1 && number >= count ? 1 : 0;
    layers_[2].symbol(channel.classes[2 * (last_class & 31) + is_single], byte_at(record, 16));
    layers_[3].symbol(channel.flags[flags_of(channel.last)], flags_of(record));
    has_classes_ = has_classes_ || byte_at(record, 16) != last_class;
    has_flags_ = has_flags_ || flags_of(record) != flags_of(channel.last);
  }

  std::array<LazEncoder, 9> layers_;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  uint32_t current_;
  bool has_classes_ = false, has_flags_ = false;
};

}  // namespace microtin::tests

#endif
