// SPDX-License-Identifier: MIT
// Sentences for the decoder's statuses.
#include "encoder/base/status_text.hpp"

namespace microtin::base {

const char* describe(microtin_status status) {
  switch (status) {
    case MICROTIN_DONE:
      return "complete";
    case MICROTIN_NEED_INPUT:
      return "more bytes are needed";
    case MICROTIN_STEP_LIMIT:
      return "the step limit was reached";
    case MICROTIN_STOPPED:
      return "stopped after the phase asked for";
    case MICROTIN_BAD_MAGIC:
      return "not a microtin stream";
    case MICROTIN_UNSUPPORTED_VERSION:
      return "a version of the format, or a part of it, that this program does not know";
    case MICROTIN_TOO_BIG:
      return "more vertices than this build can hold";
    case MICROTIN_CHECKSUM:
      return "damaged: a checksum does not match";
    case MICROTIN_MALFORMED:
      return "malformed: a rule of the format is broken";
    case MICROTIN_TRUNCATED:
      return "cut off: the stream ends too early";
    case MICROTIN_MISALIGNED:
      return "misaligned workspace";
    case MICROTIN_WORKSPACE_TOO_SMALL:
      return "workspace too small";
    case MICROTIN_ARGUMENT:
      return "wrong argument";
    case MICROTIN_IO:
      return "reading failed";
    case MICROTIN_BAD_TILES:
      return "bad tiles";
  }
  return "unknown status";
}

}  // namespace microtin::base
