// SPDX-License-Identifier: MIT
// The decoder as WebAssembly. Every terrain is an instance with a memory of its own, which is freed
// with it. What builds the package puts MICROTIN_WASM, deflated in base64, and MICROTIN_VERSION here.

import { MicrotinError, TOO_BIG } from "./status.js";

let compiled;

async function compile() {
  const packed = Uint8Array.from(atob(MICROTIN_WASM), (character) => character.charCodeAt(0));
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  compiled = await WebAssembly.compile(await new Response(plain).arrayBuffer());
}

export const ready = compile();

export const version = MICROTIN_VERSION;

export class Instance {
  constructor() {
    if (!compiled) throw new Error("await ready first");
    this.calls = new WebAssembly.Instance(compiled).exports;
    this.end = this.calls.__heap_base.value;
    this.results = this.reserve(128);
  }

  // The address of so many bytes, aligned to eight.
  reserve(size) {
    const { memory } = this.calls;
    const start = Math.ceil(this.end / 8) * 8;
    const missing = start + size - memory.buffer.byteLength;
    if (missing > 0) this.#grow(memory, Math.ceil(missing / 65536));
    this.end = start + size;
    return start;
  }

  #grow(memory, pages) {
    try {
      memory.grow(pages);
    } catch (cause) {
      throw new MicrotinError(TOO_BIG, { cause });
    }
  }

  // Copies `size` bytes at `start` from another instance, to the same addresses.
  mirror(other, start, size) {
    if (this.end < start + size) this.reserve(start + size - this.end);
    this.put(start, other.array(Uint8Array, start, size));
  }

  // What it returns, with memory that is free again afterwards.
  borrow(size, use) {
    const { end } = this;
    const result = use(this.reserve(size));
    this.end = end;
    return result;
  }

  array(Type, start, length) {
    return new Type(this.calls.memory.buffer, start, length);
  }

  put(start, bytes) {
    this.array(Uint8Array, start, bytes.length).set(bytes);
  }

  get view() {
    return new DataView(this.calls.memory.buffer);
  }

  // The result that a call wrote behind a pointer.
  result(index = 0) {
    return this.view.getUint32(this.results + 4 * index, true);
  }
}
