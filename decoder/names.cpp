// SPDX-License-Identifier: MIT
// Names of statuses and results for people to read, and the versions.
#include "microtin/microtin.h"
#include "shared/format.hpp"
#include "shared/pack_format.hpp"
#include "shared/tables.hpp"

namespace microtin {
namespace {

#if !defined(MICROTIN_NO_NAMES)

constexpr int kFirstError = MICROTIN_STATUS_BAD_MAGIC;

// The last entry of each is for what has no name.
constexpr char kStatuses[][20] MICROTIN_IN_FLASH = {"OK", "NEED_INPUT", "STEP_LIMIT", "STOPPED",
                                                    "?"};
constexpr char kErrors[][20] MICROTIN_IN_FLASH = {
    "BAD_MAGIC",  "UNSUPPORTED_VERSION", "TOO_BIG",  "CHECKSUM", "MALFORMED", "TRUNCATED",
    "MISALIGNED", "WORKSPACE_TOO_SMALL", "ARGUMENT", "IO",       "BAD_TILES", "OUT_OF_RANGE",
    "NOT_FOUND",  "WRONG_PACK_KIND",     "?"};
constexpr char kResults[][16] MICROTIN_IN_FLASH = {
    "OK",       "OUTSIDE",         "VOID",      "NOT_LOADED", "UNVERIFIED", "STEP_LIMIT",
    "BAD_TILE", "WRONG_PACK_KIND", "NO_MARGIN", "?"};

template <size_t Count, size_t Bytes>
const char* entry(const char (&names)[Count][Bytes], int number) {
  const size_t i = static_cast<size_t>(number);
  return names[i < Count ? i : Count - 1];
}

#endif

}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_version_number() {
  return static_cast<uint32_t>(MICROTIN_VERSION_MAJOR) << 16 | MICROTIN_VERSION_MINOR << 8 |
         MICROTIN_VERSION_PATCH;
}

uint8_t microtin_stream_format_version() {
  return kVersion;
}

uint8_t microtin_pack_format_version() {
  return kPackVersion;
}

#if defined(MICROTIN_NO_NAMES)

const char* microtin_status_name(microtin_status) {
  return "";
}

const char* microtin_query_result_name(microtin_query_result) {
  return "";
}

#else

const char* microtin_status_name(microtin_status status) {
  const int number = status;
  return number < kFirstError ? entry(kStatuses, number) : entry(kErrors, number - kFirstError);
}

const char* microtin_query_result_name(microtin_query_result result) {
  return entry(kResults, result);
}

#endif
