// SPDX-License-Identifier: MIT
// The push decoder: header, sections, steps.
#include "decoder/state.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

static_assert(kHeaderMostBytes <= sizeof(ByteWindow::bytes), "a header fits up to its notes");

// Bytes that must be at hand before an item can be handled as a whole; less if its payload is
// shorter.
constexpr uint8_t kItemBytes[] MICROTIN_IN_FLASH = {kIdentityBytes, 1, kHeaderMostBytes, 4,
                                                    kStepBytes,     1, kCheckBytes};

uint32_t bytes_needed(const microtin_decoder& d) {
  const uint32_t most = read_table(kItemBytes + static_cast<uint8_t>(d.item));
  const bool is_framed = d.item >= Item::kHeader && d.item <= Item::kRest;
  return is_framed ? smaller(d.coder.payload_left, most) : most;
}

// A fault is reported once the check ahead has passed: before that, it is damage.
MICROTIN_OUT_OF_LINE void note_malformed(microtin_decoder& d) {
  d.verdict = MICROTIN_STATUS_MALFORMED;
}

// The length of the header, or of a section, comes next.
void expect_length(microtin_decoder& d) {
  d.coder.payload_left = 0;
  d.item = Item::kLength;
}

microtin_status handle_identity(microtin_decoder& d) {
  const uint8_t* const identity = d.coder.window.next;
  d.coder.window.skip(kIdentityBytes);
  const microtin_status known = check_identity(identity);
  if (known != MICROTIN_STATUS_OK) return known;
  expect_length(d);
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_length(microtin_decoder& d) {
  bool legal = true;
  const bool more = take_length(&d.coder.payload_left, d.coder.window.take(), &legal);
  if (!legal) note_malformed(d);
  if (!more) d.item = d.in_header ? Item::kHeader : Item::kPayloadStart;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_header(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  const uint8_t* end = window.next;
  const microtin_status known =
      read_header(&end, end + smaller(d.coder.payload_left, kHeaderMostBytes),
                  &d.reconstruction.contract, d.mesh->axis);
  if (known != MICROTIN_STATUS_OK) d.verdict = known;
  const uint32_t size = static_cast<uint32_t>(end - window.next);
  window.skip(size);
  d.coder.payload_left -= size;
  d.item = Item::kRest;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status end_payload(microtin_decoder& d, bool legal) {
  if (!legal || d.coder.payload_left != 0) note_malformed(d);
  d.item = Item::kRest;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_payload_start(microtin_decoder& d) {
  d.coder.begin();
  d.item = Item::kStep;
  const bool legal = d.verdict == MICROTIN_STATUS_OK && !d.coder.overrun;
  return legal ? MICROTIN_STATUS_NEED_INPUT : end_payload(d, false);
}

// Whether the phase after which decoding is to stop is complete.
bool is_far_enough(const microtin_decoder& d) {
  return d.stop_phase != 0 && d.reconstruction.phase >= d.stop_phase;
}

// How often the work unit counts that inserted the vertex of this number: two and three times in
// turn, since it takes about 2.5 times the instructions of another one. So a limit bounds the time
// of a call well.
constexpr uint32_t count_of_insertion(uint32_t vertex) {
  return 3 - (vertex & 1u);
}

// As many steps as surely find their bytes at hand.
microtin_status handle_steps(microtin_decoder& d, uint32_t* steps_left) {
  while (*steps_left != 0) {
    --*steps_left;
    const uint32_t placed = d.mesh->mesh.vertices;
    const StepOutcome outcome = step(d.reconstruction, d.coder);
    if (d.mesh->mesh.vertices != placed) {
      *steps_left -= smaller(*steps_left, count_of_insertion(placed) - 1);
    }
    if (outcome == StepOutcome::kMalformed || d.coder.overrun) return end_payload(d, false);
    if (outcome == StepOutcome::kSectionEnd) return end_payload(d, true);
    if (outcome == StepOutcome::kPhaseEnd && d.reconstruction.stage == Stage::kPhase &&
        is_far_enough(d)) {
      return MICROTIN_STATUS_STOPPED;
    }
    if (d.coder.window.left < kStepBytes) return MICROTIN_STATUS_NEED_INPUT;
  }
  return MICROTIN_STATUS_STEP_LIMIT;
}

// Takes what is at hand of the bytes that are not read.
microtin_status handle_rest(microtin_decoder& d) {
  const uint32_t taken = smaller(static_cast<uint32_t>(d.coder.window.left), d.coder.payload_left);
  d.coder.window.skip(taken);
  d.coder.payload_left -= taken;
  if (d.coder.payload_left == 0) d.item = Item::kCheck;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status end_header(microtin_decoder& d) {
  const uint32_t vertices = d.reconstruction.contract.vertices;
  if (vertices > d.capacity || vertices > d.mesh->capacity) return MICROTIN_STATUS_TOO_BIG;
  start(d.reconstruction);
  d.in_header = false;
  d.mesh->is_placed = true;
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status end_section(microtin_decoder& d) {
  d.mesh->verified_vertices = d.mesh->mesh.vertices;
  if (d.reconstruction.stage == Stage::kComplete) {
    d.mesh->has_voids = d.reconstruction.contract.has_voids;
    d.mesh->below = d.reconstruction.contract.below;
    d.mesh->above = d.reconstruction.contract.above;
    return MICROTIN_STATUS_OK;
  }
  return is_far_enough(d) ? MICROTIN_STATUS_STOPPED : MICROTIN_STATUS_NEED_INPUT;
}

// Compares the check of all bytes since the last check.
microtin_status handle_check(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  window.skip(kCheckBytes);
  window.settle();
  const bool passes = window.crc == kCheckedCrc;
  window.crc = 0;
  if (!passes) return MICROTIN_STATUS_CHECKSUM;
  if (d.verdict != MICROTIN_STATUS_OK) return d.verdict;
  expect_length(d);
  return d.in_header ? end_header(d) : end_section(d);
}

// NEED_INPUT means: go on.
MICROTIN_ONE_COPY microtin_status handle_item(microtin_decoder& d, uint32_t* steps_left) {
  switch (d.item) {
    case Item::kIdentity:
      return handle_identity(d);
    case Item::kLength:
      return handle_length(d);
    case Item::kHeader:
      return handle_header(d);
    case Item::kPayloadStart:
      return handle_payload_start(d);
    case Item::kStep:
      return handle_steps(d, steps_left);
    case Item::kRest:
      return handle_rest(d);
    case Item::kCheck:
      break;
  }
  return handle_check(d);
}

microtin_status feed(microtin_decoder& d, const uint8_t* bytes, size_t size, uint32_t step_limit,
                     size_t* used) {
  ByteWindow& window = d.coder.window;
  uint32_t steps_left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT) {
    while (window.left < bytes_needed(d)) {
      if (*used == size) return MICROTIN_STATUS_NEED_INPUT;
      *used += window.fill(bytes + *used, size - *used);
    }
    status = handle_item(d, &steps_left);
  }
  // What is left came in this call, as no item asks for more than the stream has, but for what an
  // earlier call brought.
  const size_t returned = smaller<size_t>(window.left, *used);
  window.left -= returned;
  *used -= returned;
  return status;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

void microtin_decoder_stop_after_phase(microtin_decoder* decoder, uint32_t phase) {
  decoder->stop_phase = phase;
}

microtin_status microtin_decoder_feed(microtin_decoder* decoder, const uint8_t* bytes, size_t size,
                                      size_t* used, uint32_t step_limit) {
  if (decoder == nullptr || used == nullptr || (bytes == nullptr && size != 0)) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  *used = 0;
  if (decoder->status != MICROTIN_STATUS_NEED_INPUT) return decoder->status;
  const microtin_status status = feed(*decoder, bytes, size, step_limit, used);
  if (status != MICROTIN_STATUS_STEP_LIMIT) decoder->status = status;
  return status;
}

microtin_status microtin_decoder_finish(microtin_decoder* decoder) {
  if (decoder == nullptr) return MICROTIN_STATUS_ARGUMENT;
  if (decoder->status == MICROTIN_STATUS_NEED_INPUT) decoder->status = MICROTIN_STATUS_TRUNCATED;
  return decoder->status;
}

uint32_t microtin_decoder_phase(const microtin_decoder* decoder) {
  return decoder->reconstruction.phase;
}

uint64_t microtin_decoder_bytes_used(const microtin_decoder* decoder) {
  return decoder->coder.window.taken();
}
