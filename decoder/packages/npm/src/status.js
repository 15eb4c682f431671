// SPDX-License-Identifier: MIT
// Errors, with the decoder's status.

const STATUSES = {
  16: ["BAD_MAGIC", "not a microtin file"],
  17: ["UNSUPPORTED_VERSION", "of an unknown version, or with an unknown part"],
  18: ["TOO_BIG", "too large"],
  19: ["CHECKSUM", "damaged"],
  20: ["MALFORMED", "breaks a rule of the format"],
  21: ["TRUNCATED", "ends too early"],
  25: ["IO", "reading failed"],
};
export const OK = 0, NEED_INPUT = 1, STEP_LIMIT = 2;
export const TOO_BIG = 18, CHECKSUM = 19, TRUNCATED = 21, WORKSPACE_TOO_SMALL = 23, ARGUMENT = 24, IO = 25, BAD_TILES = 26, NOT_FOUND = 28;

export class MicrotinError extends Error {
  constructor(code, { where = "", cause } = {}) {
    const [status, text] = STATUSES[code] ?? ["INTERNAL", `status ${code}`];
    const why = cause?.message ? `${text}: ${cause.message}` : text;
    super(where ? `${where}: ${why}` : why, { cause });
    this.name = "MicrotinError";
    this.status = status;
  }
}
