// SPDX-License-Identifier: MIT
// What a header says, before anything is decoded.
#include "microtin/microtin.h"
#include "shared/crc32.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

// A size, or the largest where size_t is too narrow for it.
size_t saturated(unsigned long size) {
  const size_t most = ~static_cast<size_t>(0);
  return size < most ? static_cast<size_t>(size) : most;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_read_stream_info(const uint8_t* bytes, size_t size,
                                          microtin_stream_info* info) {
  if (info == nullptr || (bytes == nullptr && size != 0)) return MICROTIN_STATUS_ARGUMENT;
  info->header_bytes = 0;
  if (size < kIdentityBytes) return MICROTIN_STATUS_NEED_INPUT;
  const microtin_status known = check_identity(bytes);
  if (known != MICROTIN_STATUS_OK) return known;
  const uint8_t* next = bytes + kIdentityBytes;
  uint32_t length = 0;
  bool legal = true, more = true;
  while (more && next != bytes + size) more = take_length(&length, *next++, &legal);
  if (more) return MICROTIN_STATUS_NEED_INPUT;
  const uint32_t checked = static_cast<uint32_t>(next - bytes) + length;  // length < 2^31
  info->header_bytes = checked + kCheckBytes;
  if (size < info->header_bytes) return MICROTIN_STATUS_NEED_INPUT;
  if (crc32(0, bytes, static_cast<size_t>(info->header_bytes)) != kCheckedCrc) {
    return MICROTIN_STATUS_CHECKSUM;
  }
  Contract contract;
  microtin_axis axis[3];
  const microtin_status read = read_header(&next, bytes + checked, &contract, axis);
  if (!legal || read != MICROTIN_STATUS_OK) return legal ? read : MICROTIN_STATUS_MALFORMED;
  info->vertices = contract.vertices;
  info->version = kVersion;
  info->max_degree = static_cast<uint8_t>(contract.degree);
  info->coding = static_cast<uint8_t>(contract.coding);
  info->has_heights = contract.has_heights;
  info->has_voids = contract.has_voids;
  info->below = contract.below;
  info->above = contract.above;
  put_axes(axis, info);
  info->mesh_bytes = saturated(MICROTIN_MESH_BYTES(contract.vertices));
  info->decoder_bytes = saturated(MICROTIN_DECODER_BYTES(contract.vertices));
  return MICROTIN_STATUS_OK;
}
