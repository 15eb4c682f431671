// SPDX-License-Identifier: MIT
// Where the bytes of a pack come from: pieces of a file, kept so that none is read twice.

import { checkBytes, checkInteger } from "./check.js";
import { IO, MicrotinError } from "./status.js";

const AHEAD = 4096; // bytes, at least, of what is not a stream

// Readers return bytes, from `offset` on if `start` is not given, and the file's size if it is known.

// By HTTP range requests. A server without ranges sends the whole file.
function rangesOf(url) {
  return async (offset, size) => {
    const response = await fetch(url, { headers: { Range: `bytes=${offset}-${offset + size - 1}` } });
    const { headers, status } = response;
    const range = /^bytes (?:(\d+)-(\d+)|\*)\/(\d+|\*)$/i.exec(headers.get("Content-Range"));
    const total = Number(range?.[3]) || undefined;
    if (status === 416 && !(offset < total)) return { bytes: new Uint8Array(0), total };
    if (status !== 200 && status !== 206) throw new Error(`${url}: ${status} ${response.statusText}`);
    const bytes = new Uint8Array(await response.arrayBuffer());
    if (status === 200) return { bytes, start: 0, total: bytes.length };
    checkPart(response, range, bytes.length, offset, size);
    return { bytes: bytes.subarray(0, size), total };
  };
}

// The body of a 206 must be what its Content-Range says, which servers of other origins may hide.
function checkPart({ headers, url }, range, length, offset, size) {
  const isHidden = headers.get("Content-Range") === null && !/^multipart/i.test(headers.get("Content-Type"));
  const [from, to, total] = (range ?? []).slice(1).map(Number);
  const isRight = isHidden ? length <= size : from === offset && to - from + 1 === length && !(to >= total);
  if (length === 0 || !isRight) {
    const asked = `${offset}-${offset + size - 1}`, got = headers.get("Content-Range");
    throw new Error(`${url}: answered bytes ${asked} with ${length} bytes of "${got}"`);
  }
}

// Reads with a caller's function, which may use its buffer again.
function readerOfFunction(read) {
  return async (offset, size) => {
    const bytes = checkBytes("what the read function returns", await read(offset, size));
    if (bytes.length > size) throw new RangeError(`the read function returned ${bytes.length} bytes instead of ${size}`);
    return { bytes: bytes.slice() };
  };
}

function readerOf(source) {
  if (typeof source === "function") return readerOfFunction(source);
  if (typeof source === "string" || source instanceof URL) return rangesOf(source);
  if (source instanceof Blob) {
    return async (offset, size) =>
      ({ bytes: new Uint8Array(await source.slice(offset, offset + size).arrayBuffer()), total: source.size });
  }
  checkBytes("a pack that is no URL, Blob or function", source);
  return async (offset, size) => ({ bytes: source.subarray(offset, offset + size), total: source.length });
}

export class Source {
  #read;
  #pieces = []; // ascending, none overlaps another
  #kept = 0; // bytes
  #most; // to be kept
  #clock = 0;

  bytes = 0; // read so far
  size = undefined; // of the file, if known

  constructor(source, cacheBytes) {
    this.#read = readerOf(source);
    checkInteger("cacheBytes", cacheBytes, 0, Number.MAX_SAFE_INTEGER);
    this.#most = ArrayBuffer.isView(source) ? Infinity : cacheBytes; // pieces of what is in memory take none
  }

  // What is known from `offset` on, at most `size` bytes; undefined if nothing is.
  known(offset, size) {
    const piece = this.#pieces[this.#behind(offset) - 1];
    if (!piece || offset >= piece.start + piece.bytes.length) return undefined;
    piece.used = ++this.#clock;
    return piece.bytes.subarray(offset - piece.start, offset - piece.start + size);
  }

  // Which piece is the first that begins behind a place.
  #behind(offset) {
    let [low, high] = [0, this.#pieces.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.#pieces[middle].start > offset) high = middle;
      else low = middle + 1;
    }
    return low;
  }

  // Reads bytes from `offset`, which are not known, up to `end` at most, or a few if that is 0. Empty behind the file's
  // end. What fails may be tried again.
  async read(offset, end) {
    const at = this.#behind(offset);
    const size = Math.min(end > offset ? end - offset : AHEAD, (this.#pieces[at]?.start ?? Infinity) - offset);
    let part;
    try {
      part = await this.#read(offset, size);
      this.#checkSize(part, offset);
    } catch (cause) {
      throw new MicrotinError(IO, { cause });
    }
    const { bytes, start = offset } = part;
    this.bytes += bytes.length;
    this.#keep(start, bytes, start < offset ? 0 : at);
    return bytes.subarray(offset - start);
  }

  #checkSize({ bytes, total }, offset) {
    if (total !== undefined && total !== (this.size ?? total)) {
      throw new Error(`the file had ${this.size} bytes, and now has ${total}`);
    }
    this.size = total ?? this.size;
    if (bytes.length === 0 && offset < this.size) throw new Error(`no bytes at ${offset} of ${this.size}`);
  }

  // Puts a piece at its place; instead of all others if it is the whole file.
  #keep(start, bytes, at) {
    if (bytes.length === 0) return;
    if (bytes.length === this.size) [this.#pieces, this.#kept, at] = [[], 0, 0];
    this.#pieces.splice(at, 0, { start, bytes, used: ++this.#clock });
    this.#kept += bytes.length;
    while (this.#kept > this.#most && this.#pieces.length > 1) this.#forgetOldest();
  }

  #forgetOldest() {
    const oldest = this.#pieces.reduce((a, b) => (b.used < a.used ? b : a));
    this.#pieces.splice(this.#pieces.indexOf(oldest), 1);
    this.#kept -= oldest.bytes.length;
  }

  // The first `size` bytes, or all up to the file's end.
  first(size) {
    return this.bytesAt(0, size);
  }

  // `size` bytes from `offset` on, or all up to the file's end.
  async bytesAt(offset, size) {
    const all = new Uint8Array(size);
    let length = 0;
    for (let part; length < size; length += part.length) {
      const at = offset + length, end = offset + size;
      part = (this.known(at, end - at) ?? await this.read(at, end)).subarray(0, end - at);
      if (part.length === 0) break;
      all.set(part, length);
    }
    return all.subarray(0, length);
  }
}
