// SPDX-License-Identifier: MIT
// Where the bytes of a pack come from: pieces of a file, kept while they are likely to be wanted.

const PIECES = 64; // kept
export const AHEAD = 4096; // bytes, at least, of what is not a stream

// By HTTP range requests. A server that knows none sends all, once.
function rangesOf(url) {
  let whole;
  return async (offset, size) => {
    if (!whole) {
      const response = await fetch(url, { headers: { Range: `bytes=${offset}-${offset + size - 1}` } });
      if (response.status === 416) return new Uint8Array(0); // behind the end
      if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
      const bytes = new Uint8Array(await response.arrayBuffer());
      if (response.status === 206) return bytes;
      whole = bytes;
    }
    return whole.subarray(offset, offset + size);
  };
}

function readerOf(source) {
  if (typeof source === "function") return source;
  if (typeof source === "string" || source instanceof URL) return rangesOf(source);
  if (source instanceof Blob) {
    return async (offset, size) => new Uint8Array(await source.slice(offset, offset + size).arrayBuffer());
  }
  return async (offset, size) => source.subarray(offset, offset + size);
}

export class Source {
  #read;
  #pieces = [];

  bytes = 0; // read so far

  constructor(source) {
    this.#read = readerOf(source);
  }

  // What is known from `offset` on, at most `size` bytes; undefined if nothing is.
  known(offset, size) {
    const piece = this.#pieces.find(({ start, bytes }) => start <= offset && offset < start + bytes.length);
    return piece?.bytes.subarray(offset - piece.start, offset - piece.start + size);
  }

  // Reads the bytes from `offset` up to `end`, or a few if that is 0. Empty behind the file's end.
  async read(offset, end) {
    const bytes = await this.#read(offset, end > offset ? end - offset : AHEAD);
    this.bytes += bytes.length;
    if (bytes.length === 0) return bytes;
    this.#pieces.unshift({ start: offset, bytes });
    this.#pieces.length = Math.min(this.#pieces.length, PIECES);
    return bytes;
  }
}
