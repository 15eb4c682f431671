// SPDX-License-Identifier: MIT
// The push decoder: header, sections, steps.
#include "decoder/state.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

template <class Size>
Size smaller(Size a, Size b) {
  return a < b ? a : b;
}

static_assert(kHeaderMostBytes <= sizeof(ByteWindow::bytes), "a header fits up to its notes");

// Bytes that must be at hand before an item can be handled as a whole, if its payload has so many.
constexpr uint8_t kItemBytes[] MICROTIN_IN_FLASH = {kIdentityBytes, 1, kHeaderMostBytes, 4,
                                                    kStepBytes,     1, kCheckBytes};

uint32_t bytes_needed(const microtin_decoder& d) {
  const uint32_t most = read_table(kItemBytes + static_cast<uint8_t>(d.item));
  const bool is_framed = d.item >= Item::kHeader && d.item <= Item::kRest;
  return is_framed ? smaller(d.coder.payload_left, most) : most;
}

// Whatever is wrong is told once the check ahead has passed: before, it is damage.
MICROTIN_OUT_OF_LINE void note_malformed(microtin_decoder& d) {
  d.verdict = MICROTIN_MALFORMED;
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
  if (known != MICROTIN_DONE) return known;
  expect_length(d);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_length(microtin_decoder& d) {
  bool legal = true;
  const bool more = take_length(&d.coder.payload_left, d.coder.window.take(), &legal);
  if (!legal) note_malformed(d);
  if (!more) d.item = d.in_header ? Item::kHeader : Item::kPayloadStart;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_header(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  const uint8_t* end = window.next;
  const microtin_status known =
      read_header(&end, end + smaller(d.coder.payload_left, kHeaderMostBytes),
                  &d.reconstruction.contract, d.mesh->axis);
  if (known != MICROTIN_DONE) d.verdict = known;
  const uint32_t size = static_cast<uint32_t>(end - window.next);
  window.skip(size);
  d.coder.payload_left -= size;
  d.item = Item::kRest;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_payload(microtin_decoder& d, bool legal) {
  if (!legal || d.coder.payload_left != 0) note_malformed(d);
  d.item = Item::kRest;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_payload_start(microtin_decoder& d) {
  d.coder.begin();
  d.item = Item::kStep;
  const bool legal = d.verdict == MICROTIN_DONE && !d.coder.overrun;
  return legal ? MICROTIN_NEED_INPUT : end_payload(d, false);
}

// Whether the phase after which decoding is to stop is complete.
bool is_far_enough(const microtin_decoder& d) {
  return d.stop_phase != 0 && d.reconstruction.phase >= d.stop_phase;
}

// As many steps as surely find their bytes at hand.
microtin_status handle_steps(microtin_decoder& d, uint32_t* steps_left) {
  while (*steps_left != 0) {
    --*steps_left;
    const StepOutcome outcome = step(d.reconstruction, d.coder);
    if (outcome == StepOutcome::kMalformed || d.coder.overrun) return end_payload(d, false);
    if (outcome == StepOutcome::kSectionEnd) return end_payload(d, true);
    if (outcome == StepOutcome::kPhaseEnd && d.reconstruction.stage == Stage::kPhase &&
        is_far_enough(d)) {
      return MICROTIN_STOPPED;
    }
    if (d.coder.window.left < kStepBytes) return MICROTIN_NEED_INPUT;
  }
  return MICROTIN_STEP_LIMIT;
}

// Takes what is at hand of the bytes that are not read.
microtin_status handle_rest(microtin_decoder& d) {
  const uint32_t taken = smaller(static_cast<uint32_t>(d.coder.window.left), d.coder.payload_left);
  d.coder.window.skip(taken);
  d.coder.payload_left -= taken;
  if (d.coder.payload_left == 0) d.item = Item::kCheck;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_header(microtin_decoder& d) {
  const uint32_t vertices = d.reconstruction.contract.vertices;
  if (vertices > d.capacity || vertices > d.mesh->capacity) return MICROTIN_TOO_BIG;
  start(d.reconstruction);
  d.in_header = false;
  d.mesh->is_placed = true;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_section(microtin_decoder& d) {
  d.mesh->verified_vertices = d.mesh->mesh.vertices;
  if (d.reconstruction.stage == Stage::kComplete) {
    d.mesh->has_voids = d.reconstruction.contract.has_voids;
    return MICROTIN_DONE;
  }
  return is_far_enough(d) ? MICROTIN_STOPPED : MICROTIN_NEED_INPUT;
}

// Of all since the last check.
microtin_status handle_check(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  window.skip(kCheckBytes);
  window.settle();
  const bool passes = window.crc == kCheckedCrc;
  window.crc = 0;
  if (!passes) return MICROTIN_CHECKSUM;
  if (d.verdict != MICROTIN_DONE) return d.verdict;
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
  microtin_status status = MICROTIN_NEED_INPUT;
  while (status == MICROTIN_NEED_INPUT) {
    while (window.left < bytes_needed(d)) {
      if (*used == size) return MICROTIN_NEED_INPUT;
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

// How many vertices a workspace holds, of which `fixed` bytes and `per_four` bytes for four,
// rounded up, are needed.
MICROTIN_ONE_COPY microtin_status capacity_of(const void* workspace, size_t size, uint32_t fixed,
                                              uint32_t per_four, uint32_t* capacity) {
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint32_t most = MICROTIN_MAX_VERTICES, enough = fixed + per_four * ((most + 3) / 4);
  const uint32_t bytes = size < enough ? static_cast<uint32_t>(size) : enough;
  *capacity = bytes < fixed ? 0 : smaller((bytes - fixed) * 4 / per_four, most);
  return *capacity < 3 ? MICROTIN_WORKSPACE_TOO_SMALL : MICROTIN_DONE;
}

// A size, or the largest where size_t is too narrow for it.
size_t saturated(unsigned long size) {
  const size_t most = ~static_cast<size_t>(0);
  return size < most ? static_cast<size_t>(size) : most;
}

constexpr uint32_t kMeshFixed = MICROTIN_MESH_BYTES(0);
constexpr uint32_t kMeshPerFour = MICROTIN_MESH_BYTES(4) - kMeshFixed;
constexpr uint32_t kDecoderFixed = MICROTIN_DECODER_BYTES(0);
constexpr uint32_t kDecoderPerFour = MICROTIN_DECODER_BYTES(4) - kDecoderFixed;

static_assert(uint64_t{kMeshPerFour} * (MICROTIN_MAX_VERTICES + 3) <= UINT32_MAX &&
                  kDecoderPerFour <= kMeshPerFour,
              "products of capacity_of fit");

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh) {
  if (workspace == nullptr || mesh == nullptr) return MICROTIN_ARGUMENT;
  *mesh = nullptr;
  uint32_t capacity = 0;
  const microtin_status status = capacity_of(workspace, size, kMeshFixed, kMeshPerFour, &capacity);
  if (status != MICROTIN_DONE) return status;
  microtin_mesh& m = *static_cast<microtin_mesh*>(workspace);
  // Widest numbers first, so that everything is aligned.
  const size_t half_edges = 6 * static_cast<size_t>(capacity);
  m.mesh.origin = reinterpret_cast<Index*>(&m + 1);
  m.mesh.twin = m.mesh.origin + half_edges;
  m.mesh.place = reinterpret_cast<Point*>(m.mesh.twin + half_edges);
  m.mesh.z = reinterpret_cast<int16_t*>(m.mesh.place + capacity);
  m.voids = reinterpret_cast<uint8_t*>(m.mesh.z + capacity);
  m.capacity = capacity;
  empty_mesh(m);
  *mesh = &m;
  return MICROTIN_DONE;
}

microtin_status microtin_decoder_init(void* workspace, size_t size, microtin_mesh* mesh,
                                      microtin_decoder** decoder) {
  if (workspace == nullptr || mesh == nullptr || decoder == nullptr) return MICROTIN_ARGUMENT;
  *decoder = nullptr;
  uint32_t capacity = 0;
  const microtin_status status =
      capacity_of(workspace, size, kDecoderFixed, kDecoderPerFour, &capacity);
  if (status != MICROTIN_DONE) return status;
  microtin_decoder& d = *static_cast<microtin_decoder*>(workspace);
  d.mesh = mesh;
  d.capacity = capacity;
  d.status = MICROTIN_NEED_INPUT;
  d.stop_phase = 0;
  d.verdict = MICROTIN_DONE;
  d.item = Item::kIdentity;
  d.in_header = true;
  d.coder.window.next = d.coder.window.bytes;
  d.coder.window.left = 0;
  d.coder.window.crc = 0;
  d.coder.window.used = 0;
  Reconstruction& r = d.reconstruction;
  r.mesh = &mesh->mesh;
  r.voids = mesh->voids;
  r.queue = reinterpret_cast<Index*>(&d + 1);
  r.marks = reinterpret_cast<uint8_t*>(r.queue + capacity);
  r.residual = reinterpret_cast<Residual*>(r.marks + mark_bytes(capacity));
  r.phase = 0;
  empty_mesh(*mesh);
  *decoder = &d;
  return MICROTIN_DONE;
}

void microtin_stop_after_phase(microtin_decoder* decoder, uint32_t phase) {
  decoder->stop_phase = phase;
}

microtin_status microtin_feed(microtin_decoder* decoder, const uint8_t* bytes, size_t size,
                              uint32_t step_limit, size_t* used) {
  if (decoder == nullptr || used == nullptr || (bytes == nullptr && size != 0)) {
    return MICROTIN_ARGUMENT;
  }
  *used = 0;
  if (decoder->status != MICROTIN_NEED_INPUT) return decoder->status;
  const microtin_status status = feed(*decoder, bytes, size, step_limit, used);
  if (status != MICROTIN_STEP_LIMIT) decoder->status = status;
  return status;
}

microtin_status microtin_finish(microtin_decoder* decoder) {
  if (decoder == nullptr) return MICROTIN_ARGUMENT;
  if (decoder->status == MICROTIN_NEED_INPUT) decoder->status = MICROTIN_TRUNCATED;
  return decoder->status;
}

uint32_t microtin_phase(const microtin_decoder* decoder) {
  return decoder->reconstruction.phase;
}

uint64_t microtin_bytes_used(const microtin_decoder* decoder) {
  return decoder->coder.window.taken();
}

microtin_status microtin_peek(const uint8_t* bytes, size_t size, microtin_info* info) {
  if (info == nullptr || (bytes == nullptr && size != 0)) return MICROTIN_ARGUMENT;
  info->header_bytes = 0;
  if (size < kIdentityBytes) return MICROTIN_NEED_INPUT;
  const microtin_status known = check_identity(bytes);
  if (known != MICROTIN_DONE) return known;
  const uint8_t* next = bytes + kIdentityBytes;
  uint32_t length = 0;
  bool legal = true, more = true;
  while (more && next != bytes + size) more = take_length(&length, *next++, &legal);
  if (more) return MICROTIN_NEED_INPUT;
  const uint32_t checked = static_cast<uint32_t>(next - bytes) + length;  // length < 2^31
  info->header_bytes = checked + kCheckBytes;
  if (size < info->header_bytes) return MICROTIN_NEED_INPUT;
  if (crc32(0, bytes, static_cast<size_t>(info->header_bytes)) != kCheckedCrc) {
    return MICROTIN_CHECKSUM;
  }
  Contract contract;
  microtin_axis axis[3];
  const microtin_status read = read_header(&next, bytes + checked, &contract, axis);
  if (!legal || read != MICROTIN_DONE) return legal ? read : MICROTIN_MALFORMED;
  info->vertices = contract.vertices;
  info->version = kVersion;
  info->degree = static_cast<uint8_t>(contract.degree);
  info->decoding = static_cast<uint8_t>(contract.decoding);
  info->has_heights = contract.has_heights;
  info->has_voids = contract.has_voids;
  put_axes(axis, info);
  info->mesh_bytes = saturated(MICROTIN_MESH_BYTES(contract.vertices));
  info->decoder_bytes = saturated(MICROTIN_DECODER_BYTES(contract.vertices));
  return MICROTIN_DONE;
}
