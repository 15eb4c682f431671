// SPDX-License-Identifier: MIT
// The points of a chunk of LAZ, out of its bytes. Formats 0 to 3 interleave all that points have:
// what microtin does not read is decoded to find what follows, but its values are not computed.
// Formats 6 to 10 have layers: those that microtin does not read are skipped.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/laz.hpp"

namespace microtin::importing {
namespace {

// About the median of the latest differences: five of them in order, of which the first and the
// last are replaced in turn.
class LazMedian {
 public:
  int32_t value() const { return sorted_[2]; }

  void add(int32_t value) {
    const bool is_above = replaces_last_ ? value >= sorted_[2] : value > sorted_[2];
    sorted_[replaces_last_ ? 4 : 0] = value;
    for (size_t i = 4; i > 0 && replaces_last_ && sorted_[i] < sorted_[i - 1]; --i) {
      std::swap(sorted_[i], sorted_[i - 1]);
    }
    for (size_t i = 0; i < 4 && !replaces_last_ && sorted_[i] > sorted_[i + 1]; ++i) {
      std::swap(sorted_[i], sorted_[i + 1]);
    }
    replaces_last_ = !is_above;
  }

 private:
  std::array<int32_t, 5> sorted_{};
  bool replaces_last_ = true;
};

int32_t wrapped_sum(int32_t value, uint32_t difference) {
  return static_cast<int32_t>(static_cast<uint32_t>(value) + difference);
}

// A coordinate's context: whether a pulse has one return only, and the even part of a width.
uint32_t width_context(uint32_t width, uint32_t largest, bool is_only) {
  return (std::min(width, largest) & ~1u) + (is_only ? 1 : 0);
}

// Coordinates are differences from the last point; x and y from their median, of a context; z from
// the last height of another context. The decoders of x and y, and of z, may be the same.
class LazPlaces {
 public:
  explicit LazPlaces(size_t contexts) : x_medians_(contexts), y_medians_(contexts) {}

  void begin(int32_t z) { heights_.fill(z); }

  void read_xy(LazDecoder& decoder, size_t context, bool is_only, ScanPoint& point) {
    read(decoder, x_, is_only ? 1 : 0, x_medians_[context], point.place[0]);
    read(decoder, y_, width_context(x_.width(), 20, is_only), y_medians_[context], point.place[1]);
  }

  void read_z(LazDecoder& decoder, size_t context, bool is_only, ScanPoint& point) {
    const uint32_t width = (x_.width() + y_.width()) / 2;
    int32_t& height = heights_[context];
    height = wrapped_sum(height, z_.difference(decoder, width_context(width, 18, is_only)));
    point.place[2] = height;
  }

 private:
  static void read(LazDecoder& decoder, LazIntegers& integers, uint32_t context, LazMedian& median,
                   int32_t& value) {
    const int32_t step = wrapped_sum(median.value(), integers.difference(decoder, context));
    median.add(step);
    value = wrapped_sum(value, static_cast<uint32_t>(step));
  }

  LazIntegers x_{32, 2}, y_{32, 22}, z_{32, 20};
  std::vector<LazMedian> x_medians_, y_medians_;
  std::array<int32_t, 8> heights_{};
};

// Times of formats 1 and 3: up to four sequences, of each of which a usual step is known or not.
// Differences of times are multiples of the step, and a rest. Which symbol follows does not depend
// on their values: a step that an encoder has found is never 0 again.
class LazTimes {
 public:
  void read(LazDecoder& decoder) {
    if (read_or_switch(decoder)) return;
    if (!read_or_switch(decoder)) throw Error("changes the sequence of times twice for one point");
  }

 private:
  static constexpr uint32_t kMost = 500, kLeast = 510, kUnchanged = 511, kNew = 512;

  static uint32_t context_of(uint32_t multiple) {
    if (multiple == 0) return 7;
    if (multiple == 1) return 1;
    if (multiple < 10) return 2;
    if (multiple < kMost) return 3;
    if (multiple == kMost) return 4;
    return multiple < kLeast ? 5 : 6;
  }

  // False: the time belongs to another sequence, which is now the current one.
  bool read_or_switch(LazDecoder& decoder) {
    if (has_step_[current_]) return read_multiple(decoder);
    const uint32_t symbol = decoder.symbol(first_steps_);
    if (symbol == 1) {
      has_step_[current_] = differences_.difference(decoder, 0) != 0;
    } else if (symbol == 2) {
      begin_sequence(decoder);
    } else if (symbol > 2) {
      current_ = (current_ + symbol - 2) % 4;
    }
    return symbol <= 2;
  }

  // The symbols stand for 0 .. 500 steps, -1 .. -10, none, a new sequence, and three others.
  bool read_multiple(LazDecoder& decoder) {
    const uint32_t symbol = decoder.symbol(multiples_);
    if (symbol < kUnchanged) {
      differences_.difference(decoder, context_of(symbol));
    } else if (symbol == kNew) {
      begin_sequence(decoder);
    } else if (symbol > kNew) {
      current_ = (current_ + symbol - kNew) % 4;
    }
    return symbol <= kNew;
  }

  void begin_sequence(LazDecoder& decoder) {
    differences_.difference(decoder, 8);  // the time's high 32 bits
    decoder.raw(16);
    decoder.raw(16);
    newest_ = current_ = (newest_ + 1) % 4;
    has_step_[current_] = false;
  }

  LazModel first_steps_{6}, multiples_{516};
  LazIntegers differences_{32, 9};
  std::array<bool, 4> has_step_{};
  uint32_t current_ = 0, newest_ = 0;
};

// Colours of formats 2 and 3: which of six bytes change, and whether it is more than a grey.
class LazColours {
 public:
  void read(LazDecoder& decoder) {
    constexpr size_t kRed = 2, kGrey = 64;
    constexpr std::array<size_t, 6> kOrder = {0, 1, 2, 4, 3, 5};
    const uint32_t changed = decoder.symbol(changed_);
    for (size_t i = 0; i < ((changed & kGrey) != 0 ? kOrder.size() : kRed); ++i) {
      if ((changed >> kOrder[i] & 1) != 0) decoder.symbol(bytes_[kOrder[i]]);
    }
  }

 private:
  LazModel changed_{128};
  std::vector<LazModel> bytes_{6, LazModel(256)};
};

// A digit for each number of returns (row) and return: those of pulses of up to five returns differ
// from each other, the others share theirs.
constexpr std::array<std::string_view, 8> kReturnContexts = {
    "FEDCBA98", "E0136AA9", "D1247BBA", "C3458CCB", "B6789DDC", "AABCDEED", "9ABCDEFE", "89ABCDEF"};

uint32_t digit_of(std::string_view row, uint32_t column) {
  const char digit = row[column];
  return static_cast<uint32_t>(digit <= '9' ? digit - '0' : digit - 'A' + 10);
}

uint32_t distance(uint32_t a, uint32_t b) {
  return a < b ? b - a : a - b;
}

// Points of formats 0 to 3.
class InterleavedPoints {
 public:
  InterleavedPoints(std::string_view bytes, const LazRecord& record, const ScanPoint& first)
      : decoder_(bytes.substr(record.bytes)),
        record_(record),
        point_(first),
        returns_(static_cast<uint8_t>(bytes[14])),
        flags_(static_cast<uint8_t>(bytes[15])),
        user_byte_(static_cast<uint8_t>(bytes[17])),
        extra_(record.extra_bytes, LazModel(256)) {}

  const ScanPoint& next() {
    read_attributes();
    const uint32_t number = returns_ & 7, count = returns_ >> 3 & 7;
    const bool is_only = count == 1;
    places_.read_xy(decoder_, digit_of(kReturnContexts[count], number), is_only, point_);
    places_.read_z(decoder_, distance(count, number), is_only, point_);
    if (record_.has_time) times_.read(decoder_);
    if (record_.has_colour) colours_.read(decoder_);
    for (LazModel& byte : extra_) decoder_.symbol(byte);
    point_.class_code = flags_ & 31;
    point_.is_withheld = (flags_ & 128) != 0;
    return point_;
  }

 private:
  static std::vector<LazModel> models_of_bytes() { return {256, LazModel(256)}; }

  void read_attributes() {
    const uint32_t changed = decoder_.symbol(changed_);
    const auto read_byte = [&](std::vector<LazModel>& models, uint32_t& byte) {
      byte = decoder_.symbol(models[byte]);
    };
    if ((changed & 32) != 0) read_byte(returns_models_, returns_);
    const uint32_t context = digit_of(kReturnContexts[returns_ >> 3 & 7], returns_ & 7);
    if ((changed & 16) != 0) intensities_.difference(decoder_, std::min(context, 3u));
    if ((changed & 8) != 0) read_byte(flags_models_, flags_);
    if ((changed & 4) != 0) decoder_.symbol(angles_[returns_ >> 6 & 1]);
    if ((changed & 2) != 0) read_byte(user_models_, user_byte_);
    if ((changed & 1) != 0) sources_.difference(decoder_, 0);
  }

  LazDecoder decoder_;
  const LazRecord& record_;
  ScanPoint point_;
  // Bytes 14, 15 and 17 of the record, each of which is also the context of the next.
  uint32_t returns_, flags_, user_byte_;
  LazModel changed_{64};
  std::vector<LazModel> returns_models_ = models_of_bytes(), flags_models_ = models_of_bytes(),
                        user_models_ = models_of_bytes(), angles_{2, LazModel(256)}, extra_;
  LazIntegers intensities_{16, 4}, sources_{16, 1};
  LazPlaces places_{16};
  LazTimes times_;
  LazColours colours_;
};

// As kReturnContexts, for up to 15 returns.
constexpr std::array<std::string_view, 16> kRecentReturnContexts = {
    "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};

// What the points of one scanner channel share.
struct LazChannel {
  explicit LazChannel(const ScanPoint& first) : point(first) { places.begin(first.place[2]); }

  ScanPoint point;
  uint32_t number = 0, count = 0;  // of returns
  uint32_t flags = 0;              // six bits: synthetic, key, withheld, overlap, direction, edge
  bool has_new_time = false;
  std::vector<LazModel> changed{8, LazModel(128)}, counts{16, LazModel(16)},
      numbers{16, LazModel(16)}, classes{64, LazModel(256)}, flag_models{64, LazModel(64)};
  LazModel channel{3}, number_in_pulse{13};
  LazPlaces places{12};
};

// Points of formats 6 to 10.
class LayeredPoints {
 public:
  LayeredPoints(std::string_view bytes, uint32_t count, const LazRecord& record,
                const ScanPoint& first) {
    open_layers(bytes, count, record);
    const uint32_t flags = static_cast<uint8_t>(bytes[15]);
    current_ = flags >> 4 & 3;
    channels_[current_] = std::make_unique<LazChannel>(first);
    LazChannel& channel = *channels_[current_];
    const uint32_t returns = static_cast<uint8_t>(bytes[14]);
    channel.number = returns & 15;
    channel.count = returns >> 4;
    channel.flags = (flags & 15) | flags >> 6 << 4;
  }

  const ScanPoint& next() {
    const uint32_t changed = read_changes();
    LazChannel& channel = *channels_[current_];
    LazDecoder& xy = *layers_[kXy];
    channel.has_new_time = (changed & 16) != 0;
    read_returns(channel, changed);
    const uint32_t count = channel.count, number = channel.number;
    ScanPoint& point = channel.point;
    const uint32_t context =
        2 * digit_of(kRecentReturnContexts[count], number) + (channel.has_new_time ? 1 : 0);
    channel.places.read_xy(xy, context, count == 1, point);
    if (layers_[kZ]) {
      const uint32_t level = std::min(distance(count, number), 7u);
      channel.places.read_z(*layers_[kZ], level, count == 1, point);
    }
    if (layers_[kClasses]) {
      const uint32_t is_single = number == 1 && number >= count ? 1 : 0;
      LazModel& model = channel.classes[2u * (point.class_code & 31u) + is_single];
      point.class_code = static_cast<uint8_t>(layers_[kClasses]->symbol(model));
    }
    if (layers_[kFlags]) {
      channel.flags = layers_[kFlags]->symbol(channel.flag_models[channel.flags]);
      point.is_withheld = (channel.flags & 4) != 0;
    }
    return point;
  }

 private:
  enum : size_t { kXy, kZ, kClasses, kFlags, kLayersRead };

  // The first record precedes the number of points, the sizes of all layers, and the layers.
  void open_layers(std::string_view bytes, uint32_t count, const LazRecord& record) {
    const std::string name;
    const ByteReader reader(name, bytes);
    const uint64_t sizes = uint64_t{record.bytes} + 4;
    uint64_t at = sizes + 4 * uint64_t{record.layers};
    if (bytes.size() < at) throw Error("ends before its layers");
    if (reader.number<uint32_t>(record.bytes) != count) {
      throw Error("has another number of points than the table of chunks states");
    }
    for (size_t layer = 0; layer < record.layers; ++layer) {
      const auto size = reader.number<uint32_t>(sizes + 4 * layer);
      if (size > bytes.size() - at) throw Error("ends before its layers do");
      if (size != 0 && layer < kLayersRead) layers_[layer].emplace(reader.bytes(at, size));
      at += size;
    }
    if (!layers_[kXy]) throw Error("has no layer of x and y");
  }

  // Which values change, of the last point's channel, and a change of the channel itself.
  uint32_t read_changes() {
    LazChannel& last = *channels_[current_];
    const size_t context = (last.number == 1 ? 1u : 0u) | (last.number >= last.count ? 2u : 0u) |
                           (last.has_new_time ? 4u : 0u);
    const uint32_t changed = layers_[kXy]->symbol(last.changed[context]);
    if ((changed & 64) == 0) return changed;
    current_ = (current_ + layers_[kXy]->symbol(last.channel) + 1) % 4;
    std::unique_ptr<LazChannel>& channel = channels_[current_];
    if (channel != nullptr) return changed;
    channel = std::make_unique<LazChannel>(last.point);
    channel->number = last.number;
    channel->count = last.count;
    channel->flags = last.flags;
    return changed;
  }

  void read_returns(LazChannel& channel, uint32_t changed) {
    LazDecoder& xy = *layers_[kXy];
    if ((changed & 4) != 0) channel.count = xy.symbol(channel.counts[channel.count]);
    uint32_t& number = channel.number;
    switch (changed & 3) {
      case 1:
        number = (number + 1) % 16;
        break;
      case 2:
        number = (number + 15) % 16;
        break;
      case 3:
        number = channel.has_new_time ? xy.symbol(channel.numbers[number])
                                      : (number + xy.symbol(channel.number_in_pulse) + 2) % 16;
        break;
      default:
        break;
    }
  }

  std::array<std::optional<LazDecoder>, kLayersRead> layers_;
  std::array<std::unique_ptr<LazChannel>, 4> channels_;
  uint32_t current_ = 0;
};

template <class Points>
void append_points(Points points, uint32_t count, std::vector<ScanPoint>& list) {
  while (list.size() < count) list.push_back(points.next());
}

}  // namespace

std::vector<ScanPoint> unpack_chunk(std::string_view bytes, uint32_t count,
                                    const LazRecord& record) {
  if (bytes.size() < record.bytes) throw Error("ends before its first point");
  const std::string name;
  std::vector<ScanPoint> points;
  points.reserve(std::min<size_t>(count, bytes.size()));
  points.push_back(scan_point_at(ByteReader(name, bytes), 0, record.point_format));
  if (count == 1) return points;
  const ScanPoint first = points.front();
  if (record.layers != 0) {
    append_points(LayeredPoints(bytes, count, record, first), count, points);
  } else {
    append_points(InterleavedPoints(bytes, record, first), count, points);
  }
  return points;
}

}  // namespace microtin::importing
