// SPDX-License-Identifier: MIT
#include "tests/bench/training/outcomes.hpp"

#include <algorithm>

#include "decoder/state.hpp"
#include "encoder/base/error.hpp"
#include "shared/header.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

// Reads a stream's decisions.
struct RecordingCoder : RangeDecoder {
  std::vector<uint32_t> decisions;

  bool bit(uint32_t probability, bool) {
    const bool one = RangeDecoder::bit(probability, false);
    decisions.push_back(one ? 1 : 0);
    return one;
  }
  uint32_t uniform(uint32_t count, uint32_t) {
    decisions.push_back(RangeDecoder::uniform(count, 0));
    return decisions.back();
  }
  uint32_t uniform_or_escape(uint32_t count, uint32_t) {
    decisions.push_back(RangeDecoder::uniform_or_escape(count, 0));
    return decisions.back();
  }
};

// Makes recorded decisions again, and tells which adaptive bit learned from each: the only one that
// is not as adaptive bits are kept here.
class ReplayingCoder : public RangeDecoder {
 public:
  ReplayingCoder(const std::vector<uint32_t>& decisions, Models& models)
      : next_(decisions.data()), bits_(reinterpret_cast<AdaptiveBit*>(&models)) {
    std::fill_n(bits_, kStarts, kKept);
  }

  bool bit(uint32_t, bool) {
    attribute();
    return *next_++ != 0;
  }
  uint32_t uniform(uint32_t, uint32_t) { return *next_++; }
  uint32_t uniform_or_escape(uint32_t, uint32_t) { return *next_++; }

  const Outcomes& outcomes() {
    attribute();
    return outcomes_;
  }

 private:
  static_assert(sizeof(Models) == kStarts * sizeof(AdaptiveBit), "an array of bits");
  static constexpr AdaptiveBit kKept = {kProbabilityOne / 2, kProbabilityOne / 2};

  void attribute() {
    for (size_t i = 0; i < kStarts; ++i) {
      if (bits_[i].fast == kKept.fast) continue;
      outcomes_[i].push_back(bits_[i].fast > kKept.fast);
      bits_[i] = kKept;
      return;
    }
  }

  const uint32_t* next_;
  AdaptiveBit* bits_;
  Outcomes outcomes_;
};

// A decoder of a stream that has read the header.
class Started {
 public:
  explicit Started(const std::vector<uint8_t>& stream) {
    microtin_stream_info info;
    microtin_read_stream_info(stream.data(), stream.size(), &info);
    mesh_.resize(info.mesh_bytes / 8 + 1);
    decoder_.resize(info.decoder_bytes / 8 + 1);
    microtin_mesh* mesh = nullptr;
    microtin_decoder* decoder = nullptr;
    microtin_mesh_init(mesh_.data(), 8 * mesh_.size(), &mesh);
    microtin_decoder_init(decoder_.data(), 8 * decoder_.size(), mesh, &decoder);
    microtin_decoder_feed(decoder, stream.data(), info.header_bytes, &header_bytes_, 0);
    reconstruction_ = &decoder->reconstruction;
  }

  size_t header_bytes() const { return header_bytes_; }
  Reconstruction& reconstruction() { return *reconstruction_; }

 private:
  std::vector<uint64_t> mesh_, decoder_;
  size_t header_bytes_ = 0;
  Reconstruction* reconstruction_ = nullptr;
};

template <class Coder>
void decode_section(Reconstruction& r, Coder& coder) {
  StepOutcome outcome = StepOutcome::kStep;
  while (outcome == StepOutcome::kStep || outcome == StepOutcome::kPhaseEnd) {
    outcome = step(r, coder);
  }
  if (outcome != StepOutcome::kSectionEnd) throw Error("a stream of our own is malformed");
}

std::vector<uint32_t> decisions_of(std::vector<uint8_t> stream) {
  Started decoder(stream);
  RecordingCoder coder;
  uint8_t* next = stream.data() + decoder.header_bytes();
  while (decoder.reconstruction().stage != Stage::kComplete) {
    bool legal = true;
    coder.payload_left = 0;
    while (take_length(&coder.payload_left, *next++, &legal)) continue;
    coder.window.next = next;
    coder.window.left = coder.payload_left;
    next += coder.payload_left + kCheckBytes;
    coder.begin();
    decode_section(decoder.reconstruction(), coder);
  }
  return coder.decisions;
}

}  // namespace

Outcomes outcomes_of(const std::vector<uint8_t>& stream) {
  const std::vector<uint32_t> decisions = decisions_of(stream);
  Started decoder(stream);
  Reconstruction& r = decoder.reconstruction();
  ReplayingCoder coder(decisions, r.models);
  while (r.stage != Stage::kComplete) decode_section(r, coder);
  return coder.outcomes();
}

}  // namespace microtin::bench
