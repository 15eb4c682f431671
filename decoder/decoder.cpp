// The push decoder: header, sections, steps.
#include "decoder/state.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

size_t smaller(size_t a, size_t b) {
  return a < b ? a : b;
}

// Bytes that must be at hand before the next item can be handled as a whole.
size_t bytes_needed(const microtin_decoder& d) {
  switch (d.item) {
    case Item::kIdentity:
      return kIdentityBytes;
    case Item::kDimensions:
      return dimensions_bytes(d.flags);
    case Item::kBlockHead:
      return smaller(kBlockHeadBytes, d.blocks_left);
    case Item::kPlacement:
      return d.block_left;
    case Item::kSkippedBlock:
    case Item::kSectionHead:
      return 1;
    case Item::kPayloadStart:
      return smaller(d.section_bytes, 4);
    case Item::kStep:
      return smaller(d.coder.payload_left, kStepBytes);
    case Item::kHeaderCheck:
    case Item::kSectionCheck:
      break;
  }
  return kCheckBytes;
}

void take_bytes(microtin_decoder& d, uint8_t* bytes, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) bytes[i] = d.window.take();
}

// Whether the four bytes that follow are the check of all since the last one.
bool check_passes(microtin_decoder& d) {
  d.window.settle();
  const uint32_t expected = d.window.crc;
  uint8_t bytes[kCheckBytes];
  take_bytes(d, bytes, kCheckBytes);
  d.window.settle();
  d.window.crc = 0;
  return read_u32(bytes) == expected;
}

Item after_block(const microtin_decoder& d) {
  return d.blocks_left == 0 ? Item::kHeaderCheck : Item::kBlockHead;
}

// Whatever is wrong with the dimensions or a block is told once the header's check has passed:
// before, it is damage. The blocks behind it do not count.
MICROTIN_OUT_OF_LINE void refuse_header(microtin_decoder& d, microtin_status status) {
  d.header_status = status;
  d.block_left = d.blocks_left;
  d.blocks_left = 0;
  d.item = d.block_left == 0 ? Item::kHeaderCheck : Item::kSkippedBlock;
}

microtin_status handle_identity(microtin_decoder& d) {
  uint8_t bytes[kIdentityBytes];
  take_bytes(d, bytes, kIdentityBytes);
  const microtin_status known = check_identity(bytes);
  if (known != MICROTIN_DONE) return known;
  d.flags = bytes[5];
  d.effort = bytes[6];
  d.item = Item::kDimensions;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_dimensions(microtin_decoder& d) {
  uint8_t bytes[kDimensionsMostBytes];
  take_bytes(d, bytes, dimensions_bytes(d.flags));
  const bool legal = read_contract(d.flags, d.effort, bytes, &d.contract, &d.blocks_left);
  d.header_status = MICROTIN_DONE;
  d.item = after_block(d);
  if (!legal) refuse_header(d, MICROTIN_MALFORMED);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_block_head(microtin_decoder& d) {
  uint8_t bytes[kBlockHeadBytes] = {0, 0, 0};
  const uint32_t size = static_cast<uint32_t>(smaller(kBlockHeadBytes, d.blocks_left));
  take_bytes(d, bytes, size);
  d.blocks_left -= size;
  d.block_left = read_u16(bytes + 1);
  const bool placement = bytes[0] == kBlockPlacement;
  if (size < kBlockHeadBytes || d.block_left > d.blocks_left ||
      (placement && d.block_left > kPlacementMostBytes)) {
    refuse_header(d, MICROTIN_MALFORMED);
  } else if ((bytes[0] & kMustUnderstand) != 0) {
    refuse_header(d, MICROTIN_UNSUPPORTED_VERSION);
  } else {
    d.blocks_left -= d.block_left;
    d.item = Item::kSkippedBlock;
    if (d.block_left == 0) d.item = after_block(d);
    if (placement) d.item = Item::kPlacement;
  }
  return MICROTIN_NEED_INPUT;
}

// Out of line: its buffer would be on the stack of every step.
MICROTIN_OUT_OF_LINE microtin_status handle_placement(microtin_decoder& d) {
  uint8_t bytes[kPlacementMostBytes];
  take_bytes(d, bytes, d.block_left);
  d.item = after_block(d);
  if (!read_placement(bytes, d.block_left, d.mesh->axis)) refuse_header(d, MICROTIN_MALFORMED);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_skipped_block(microtin_decoder& d) {
  const uint32_t count = static_cast<uint32_t>(smaller(d.window.left, d.block_left));
  for (uint32_t i = 0; i < count; ++i) d.window.take();
  d.block_left -= count;
  if (d.block_left == 0) d.item = after_block(d);
  return MICROTIN_NEED_INPUT;
}

void begin_section(microtin_decoder& d) {
  d.section_bytes = 0;
  d.section_shift = 0;
  d.item = Item::kSectionHead;
}

microtin_status handle_header_check(microtin_decoder& d) {
  if (!check_passes(d)) return MICROTIN_CHECKSUM;
  if (d.header_status != MICROTIN_DONE) return d.header_status;
  if (d.contract.vertices > d.capacity || d.contract.vertices > d.mesh->capacity) {
    return MICROTIN_TOO_BIG;
  }
  start(d.reconstruction, d.contract);
  begin_section(d);
  return MICROTIN_NEED_INPUT;
}

// The payload's length: seven bits a byte, low ones first, the top bit set if more follow.
microtin_status handle_section_head(microtin_decoder& d) {
  const uint8_t byte = d.window.take();
  if (d.section_shift == 28 && byte > 15) return MICROTIN_MALFORMED;
  if (d.section_shift != 0 && byte == 0) return MICROTIN_MALFORMED;  // not the shortest form
  d.section_bytes |= static_cast<uint32_t>(byte & 127u) << d.section_shift;
  d.section_shift = static_cast<uint8_t>(d.section_shift + 7);
  if (byte < 128) d.item = Item::kPayloadStart;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_payload_start(microtin_decoder& d) {
  d.coder.begin(d.section_bytes);
  d.item = Item::kStep;
  return d.coder.overrun ? MICROTIN_MALFORMED : MICROTIN_NEED_INPUT;
}

// Whether the phase after which decoding is to stop is complete.
bool is_far_enough(const microtin_decoder& d) {
  return d.stop_phase != 0 && d.reconstruction.phase >= d.stop_phase;
}

microtin_status handle_step(microtin_decoder& d) {
  const Progress progress = step(d.reconstruction, d.coder);
  if (progress == Progress::kMalformed || d.coder.overrun) return MICROTIN_MALFORMED;
  if (progress == Progress::kSectionEnd) {
    if (d.coder.payload_left != 0) return MICROTIN_MALFORMED;
    d.item = Item::kSectionCheck;
  } else if (progress == Progress::kPhaseEnd && d.reconstruction.stage == Stage::kPhase &&
             is_far_enough(d)) {
    return MICROTIN_STOPPED;
  }
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_section_check(microtin_decoder& d) {
  if (!check_passes(d)) return MICROTIN_CHECKSUM;
  d.mesh->verified_vertices = d.mesh->mesh.vertices;
  if (d.reconstruction.stage == Stage::kComplete) {
    d.mesh->has_voids = d.contract.has_voids;
    return MICROTIN_DONE;
  }
  if (is_far_enough(d)) return MICROTIN_STOPPED;
  begin_section(d);
  return MICROTIN_NEED_INPUT;
}

// NEED_INPUT means: go on.
microtin_status handle_item(microtin_decoder& d) {
  switch (d.item) {
    case Item::kIdentity:
      return handle_identity(d);
    case Item::kDimensions:
      return handle_dimensions(d);
    case Item::kBlockHead:
      return handle_block_head(d);
    case Item::kPlacement:
      return handle_placement(d);
    case Item::kSkippedBlock:
      return handle_skipped_block(d);
    case Item::kHeaderCheck:
      return handle_header_check(d);
    case Item::kSectionHead:
      return handle_section_head(d);
    case Item::kPayloadStart:
      return handle_payload_start(d);
    case Item::kStep:
      return handle_step(d);
    case Item::kSectionCheck:
      break;
  }
  return handle_section_check(d);
}

// Handles items from the window while their bytes are at hand and steps are left; `enough` bytes
// used up also end the loop.
microtin_status run(microtin_decoder& d, uint32_t* steps_left, size_t enough) {
  const size_t available = d.window.left;
  while (available - d.window.left < enough || bytes_needed(d) == 0) {
    if (d.window.left < bytes_needed(d)) return MICROTIN_NEED_INPUT;
    if (d.item == Item::kStep) {
      if (*steps_left == 0) return MICROTIN_STEP_LIMIT;
      --*steps_left;
    }
    const microtin_status status = handle_item(d);
    if (status != MICROTIN_NEED_INPUT) return status;
  }
  return MICROTIN_NEED_INPUT;
}

// Decodes from the bytes kept from earlier calls, topped up from `bytes`, until the kept ones are
// used up. *used counts the bytes taken from `bytes`.
microtin_status run_staged(microtin_decoder& d, const uint8_t* bytes, size_t size,
                           uint32_t* steps_left, size_t* used) {
  const size_t kept = d.staged_bytes;
  const size_t added = smaller(size, sizeof d.staged - kept);
  for (size_t i = 0; i < added; ++i) d.staged[kept + i] = bytes[i];
  d.window.open(d.staged, kept + added);
  const microtin_status status = run(d, steps_left, kept);
  d.window.settle();
  const size_t consumed = kept + added - d.window.left;
  if (consumed >= kept) {
    d.staged_bytes = 0;
    *used = consumed - kept;
    return status;
  }
  // The rest of the kept bytes stays; the added ones go back, unless all are needed.
  const bool starved = status == MICROTIN_NEED_INPUT;
  const size_t rest = kept - consumed + (starved ? added : 0);
  for (size_t i = 0; i < rest; ++i) d.staged[i] = d.staged[consumed + i];
  d.staged_bytes = static_cast<uint8_t>(rest);
  *used = starved ? added : 0;
  return status;
}

microtin_status feed(microtin_decoder& d, const uint8_t* bytes, size_t size, uint32_t step_limit,
                     size_t* used) {
  uint32_t steps_left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  size_t taken = 0;
  if (d.staged_bytes != 0) {
    const microtin_status status = run_staged(d, bytes, size, &steps_left, &taken);
    *used = taken;
    if (status != MICROTIN_NEED_INPUT || d.staged_bytes != 0) return status;
  }
  d.window.open(bytes + taken, size - taken);
  const microtin_status status = run(d, &steps_left, ~static_cast<size_t>(0));
  d.window.settle();
  *used = size - d.window.left;
  if (status != MICROTIN_NEED_INPUT) return status;
  // Fewer than one item needs: keep them.
  d.staged_bytes = static_cast<uint8_t>(d.window.left);
  for (size_t i = 0; i < d.window.left; ++i) d.staged[i] = d.window.next[i];
  *used = size;
  return status;
}

// The largest capacity whose workspace, of `fixed` bytes and `per_four` bytes for four vertices,
// rounded up, fits in `size` bytes.
uint32_t capacity_of(size_t size, uint32_t fixed, uint32_t per_four) {
  if (size < fixed) return 0;
  const size_t fours = (size - fixed) / per_four, rest = (size - fixed) % per_four;
  if (fours >= MICROTIN_MAX_VERTICES / 4) return static_cast<uint32_t>(MICROTIN_MAX_VERTICES);
  return static_cast<uint32_t>(4 * fours) + static_cast<uint32_t>(rest) * 4 / per_four;
}

bool misaligned(const void* workspace) {
  return reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0;
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

void empty_mesh(microtin_mesh& m) {
  m.mesh.vertices = 0;
  m.mesh.triangles = 0;
  m.verified_vertices = 0;
  m.has_voids = false;
  for (int i = 0; i < 3; ++i) m.axis[i] = microtin_axis{0, 1, 1};
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh) {
  if (workspace == nullptr || mesh == nullptr) return MICROTIN_ARGUMENT;
  *mesh = nullptr;
  if (misaligned(workspace)) return MICROTIN_MISALIGNED;
  const uint32_t capacity = capacity_of(size, kMeshFixed, kMeshPerFour);
  if (capacity < 3) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_mesh& m = *static_cast<microtin_mesh*>(workspace);
  // Widest numbers first, so that everything is aligned.
  const size_t half_edges = static_cast<size_t>(6) * capacity;
  m.mesh.origin = reinterpret_cast<Index*>(&m + 1);
  m.mesh.twin = m.mesh.origin + half_edges;
  m.mesh.x = reinterpret_cast<uint16_t*>(m.mesh.twin + half_edges);
  m.mesh.y = m.mesh.x + capacity;
  m.mesh.z = reinterpret_cast<int16_t*>(m.mesh.y + capacity);
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
  if (misaligned(workspace)) return MICROTIN_MISALIGNED;
  const uint32_t capacity = capacity_of(size, kDecoderFixed, kDecoderPerFour);
  if (capacity < 3) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_decoder& d = *static_cast<microtin_decoder*>(workspace);
  d.mesh = mesh;
  d.capacity = capacity;
  d.status = MICROTIN_NEED_INPUT;
  d.stop_phase = 0;
  d.item = Item::kIdentity;
  d.staged_bytes = 0;
  d.window.crc = 0;
  d.window.used = 0;
  d.coder.window = &d.window;
  Reconstruction& r = d.reconstruction;
  r.mesh = &mesh->mesh;
  r.voids = mesh->voids;
  r.queue = reinterpret_cast<Index*>(&d + 1);
  r.marks = reinterpret_cast<uint8_t*>(r.queue + capacity);
  r.residual = reinterpret_cast<Residual*>(r.marks + (capacity + 3) / 4);
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
  return decoder->window.used;
}

microtin_status microtin_peek(const uint8_t* bytes, size_t size, microtin_info* info) {
  if (info == nullptr || (bytes == nullptr && size != 0)) return MICROTIN_ARGUMENT;
  info->header_bytes = 0;
  if (size < kIdentityBytes) return MICROTIN_NEED_INPUT;
  const microtin_status known = check_identity(bytes);
  if (known != MICROTIN_DONE) return known;
  const uint32_t blocks = kIdentityBytes + dimensions_bytes(bytes[5]);
  if (size < blocks) return MICROTIN_NEED_INPUT;
  Contract contract;
  uint32_t block_bytes = 0;
  const bool legal =
      read_contract(bytes[5], bytes[6], bytes + kIdentityBytes, &contract, &block_bytes);
  const uint32_t checked = blocks + block_bytes;
  info->header_bytes = checked + kCheckBytes;
  if (size < info->header_bytes) return MICROTIN_NEED_INPUT;
  if (crc32(0, bytes, checked) != read_u32(bytes + checked)) return MICROTIN_CHECKSUM;
  microtin_axis axis[3] = {{0, 1, 1}, {0, 1, 1}, {0, 1, 1}};
  if (!legal) return MICROTIN_MALFORMED;
  for (uint32_t at = blocks; at < checked;) {
    if (checked - at < kBlockHeadBytes) return MICROTIN_MALFORMED;
    const uint8_t type = bytes[at];
    const uint32_t length = read_u16(bytes + at + 1);
    at += kBlockHeadBytes;
    if (length > checked - at) return MICROTIN_MALFORMED;
    if ((type & kMustUnderstand) != 0) return MICROTIN_UNSUPPORTED_VERSION;
    if (type == kBlockPlacement && !read_placement(bytes + at, length, axis)) {
      return MICROTIN_MALFORMED;
    }
    at += length;
  }
  info->vertices = contract.vertices;
  info->version = kVersion;
  info->degree = static_cast<uint8_t>(contract.degree);
  info->levels = static_cast<uint8_t>(contract.levels);
  info->has_heights = contract.has_heights;
  info->has_voids = contract.has_voids;
  info->x = axis[0];
  info->y = axis[1];
  info->z = axis[2];
  info->mesh_bytes = saturated(MICROTIN_MESH_BYTES(contract.vertices));
  info->decoder_bytes = saturated(MICROTIN_DECODER_BYTES(contract.vertices));
  return MICROTIN_DONE;
}
