// SPDX-License-Identifier: MIT
// What callers pass: every number and every piece of bytes goes through one of these.

// Any number, also NaN and the infinite ones, which lie outside every terrain.
export function checkNumber(name, value) {
  if (typeof value !== "number") throw new TypeError(`${name} must be a number, not ${describe(value)}`);
  return value;
}

export function checkInteger(name, value, least, most) {
  checkNumber(name, value);
  if (!(Number.isInteger(value) && value >= least && value <= most)) {
    throw new RangeError(`${name} must be an integer from ${least} to ${most}, not ${value}`);
  }
  return value;
}

// By its tag, since bytes may come from another window.
export function checkBytes(name, value) {
  if (!ArrayBuffer.isView(value) || value[Symbol.toStringTag] !== "Uint8Array") {
    throw new TypeError(`${name} must be a Uint8Array, not ${describe(value)}`);
  }
  return value;
}

function describe(value) {
  return value === null ? "null" : value?.constructor?.name ?? typeof value;
}
