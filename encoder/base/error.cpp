// SPDX-License-Identifier: MIT
// A sentence for each status.
#include "encoder/base/error.hpp"

namespace microtin::base {

const char* describe(microtin_status status) {
  switch (status) {
    case MICROTIN_STATUS_OK:
      return "complete";
    case MICROTIN_STATUS_NEED_INPUT:
      return "more bytes are needed";
    case MICROTIN_STATUS_STEP_LIMIT:
      return "the step limit was reached";
    case MICROTIN_STATUS_STOPPED:
      return "stopped after the phase asked for";
    case MICROTIN_STATUS_BAD_MAGIC:
      return "not a microtin stream";
    case MICROTIN_STATUS_UNSUPPORTED_VERSION:
      return "a version of the format, or a part of it, that this program does not know";
    case MICROTIN_STATUS_TOO_BIG:
      return "more vertices than this build can hold";
    case MICROTIN_STATUS_CHECKSUM:
      return "damaged: a checksum does not match";
    case MICROTIN_STATUS_MALFORMED:
      return "malformed: a rule of the format is broken";
    case MICROTIN_STATUS_TRUNCATED:
      return "cut off: the stream ends too early";
    case MICROTIN_STATUS_MISALIGNED:
      return "misaligned workspace";
    case MICROTIN_STATUS_WORKSPACE_TOO_SMALL:
      return "workspace too small";
    case MICROTIN_STATUS_ARGUMENT:
      return "wrong argument";
    case MICROTIN_STATUS_IO:
      return "reading failed";
    case MICROTIN_STATUS_BAD_TILES:
      return "bad tiles";
    case MICROTIN_STATUS_OUT_OF_RANGE:
      return "a number out of range";
    case MICROTIN_STATUS_NOT_FOUND:
      return "not found";
    case MICROTIN_STATUS_WRONG_PACK_KIND:
      return "a pack with slots of the other kind";
    case MICROTIN_STATUS_REJECTED:
      return "rejected";
    case MICROTIN_STATUS_NO_MEMORY:
      return "out of memory";
    case MICROTIN_STATUS_CANCELLED:
      return "cancelled";
    case MICROTIN_STATUS_INTERNAL:
      return "an internal fault of microtin";
  }
  return "unknown status";
}

}  // namespace microtin::base
