// SPDX-License-Identifier: MIT
// A terrain, and its decoding from a stream.

import { axesAt, notesAt, toLattice } from "./header.js";
import { Instance, ready } from "./instance.js";
import { DONE, MicrotinError, NEED_INPUT, STEP_LIMIT, TRUNCATED } from "./status.js";

const REAL = 0, VOID = 1;
const UNVERIFIED = 1;
const INFO_BYTES = 96, INFO_VERTICES = 0, INFO_AXES = 16, INFO_MESH_BYTES = 88,
  INFO_DECODER_BYTES = 92; // where they are in microtin_info
const CHUNK = 65536;
const STEPS = 1 << 16;

// Vertices and triangles of a mesh, 0 if there is none, whose lattice begins at (x0, y0) of the axes'.
export function meshArrays(instance, mesh, axes, x0 = 0, y0 = 0) {
  const { calls } = instance;
  const count = mesh && calls.microtin_vertex_count(mesh);
  const positions = new Float32Array(3 * count);
  instance.borrow(12 * count, (at) => {
    if (count) calls.vertices(mesh, at);
    const lattice = instance.array(Int32Array, at, 3 * count);
    for (let i = 0; i < 3 * count; i += 3) {
      positions[i] = lattice[i] * axes.x.step;
      positions[i + 1] = lattice[i + 1] * axes.y.step;
      positions[i + 2] = axes.z.start + lattice[i + 2] * axes.z.step;
    }
  });
  const triangles = (kind) => instance.borrow(24 * count + 12, (at) =>
    instance.array(Uint32Array, at, count && 3 * calls.triangles(mesh, kind, at)).slice());
  return {
    origin: [axes.x.start + x0 * axes.x.step, axes.y.start + y0 * axes.y.step],
    positions,
    indices: triangles(REAL),
    voids: triangles(VOID),
  };
}

export class Terrain {
  #instance;
  #mesh;
  #axes;
  #arrays;
  #hint;

  constructor(instance, mesh, header, axes) {
    this.#instance = instance;
    this.#mesh = mesh;
    this.#axes = axes;
    this.#hint = instance.reserve(8);
    this.header = header;
    this.bytes = 0;
    this.done = false;
  }

  get #now() {
    const count = this.vertexCount;
    if (this.#arrays?.count !== count || this.#arrays.done !== this.done) {
      const arrays = meshArrays(this.#instance, this.#mesh, this.#axes);
      this.#arrays = { ...arrays, count, done: this.done };
    }
    return this.#arrays;
  }

  get vertexCount() {
    return this.#instance.calls.microtin_vertex_count(this.#mesh);
  }
  get origin() {
    return this.#now.origin;
  }
  get positions() {
    return this.#now.positions;
  }
  get indices() {
    return this.#now.indices;
  }
  get voids() {
    return this.#now.voids;
  }
  get digest() {
    return BigInt.asUintN(64, this.#instance.calls.microtin_digest(this.#mesh));
  }

  heightAt(x, y) {
    const { calls, view } = this.#instance;
    const [i, j] = [toLattice(this.#axes.x, x), toLattice(this.#axes.y, y)];
    const most = 65535 * 256;
    if (!(i >= 0 && i <= most && j >= 0 && j <= most)) return NaN;
    const answer = calls.microtin_height_at(this.#mesh, i, j, UNVERIFIED, this.#hint, this.#hint + 4);
    return answer ? NaN : this.#axes.z.start + (view.getInt32(this.#hint + 4, true) / 65536) * this.#axes.z.step;
  }
}

export class Decoder {
  #instance = new Instance();
  #head = new Uint8Array(0);
  #decoder = 0;
  #mesh = 0;
  #chunk = 0;
  #fed = 0;

  terrain = undefined;

  // Yields the terrain each time that a section, one phase or the first few, has passed its check.
  *push(bytes) {
    if (!this.terrain) {
      const head = new Uint8Array(this.#head.length + bytes.length);
      head.set(this.#head);
      head.set(bytes, this.#head.length);
      this.#head = head;
      if (!this.#begin(head)) return;
      bytes = head;
    }
    for (let i = 0; i < bytes.length && !this.terrain.done; i += CHUNK) {
      yield* this.#feed(bytes.subarray(i, i + CHUNK));
    }
  }

  finish() {
    if (!this.terrain?.done) throw new MicrotinError(TRUNCATED);
    return this.terrain;
  }

  // Whether the header is complete, which then makes a terrain.
  #begin(head) {
    const instance = this.#instance;
    const start = instance.end;
    const at = instance.reserve(head.length);
    const info = instance.reserve(INFO_BYTES);
    instance.put(at, head);
    const status = instance.calls.microtin_peek_32(at, head.length, info);
    if (status > NEED_INPUT) throw new MicrotinError(status);
    if (status === DONE) this.#layOut(info, notesAt(instance, at, head.length), start);
    else instance.end = start;
    return status === DONE;
  }

  #layOut(info, notes, start) {
    const instance = this.#instance;
    const { view, calls } = instance;
    const number = (at) => view.getUint32(info + at, true);
    const [meshBytes, decoderBytes] = [number(INFO_MESH_BYTES), number(INFO_DECODER_BYTES)];
    const axes = axesAt(view, info + INFO_AXES);
    const header = { vertices: number(INFO_VERTICES), axes, ...notes };
    instance.end = start;
    const workspace = instance.reserve(meshBytes);
    calls.microtin_mesh_init_32(workspace, meshBytes, instance.results);
    this.#mesh = instance.result();
    this.terrain = new Terrain(instance, this.#mesh, header, axes);
    this.#chunk = instance.reserve(CHUNK);
    calls.microtin_decoder_init_32(instance.reserve(decoderBytes), decoderBytes, this.#mesh, instance.results);
    this.#decoder = instance.result();
  }

  *#feed(bytes) {
    const instance = this.#instance;
    const { calls } = instance;
    let verified = calls.verified_vertices(this.#mesh);
    instance.put(this.#chunk, bytes);
    let status = STEP_LIMIT;
    for (let used = 0; status === STEP_LIMIT; ) {
      status = calls.feed_section(this.#decoder, this.#chunk + used, bytes.length - used, STEPS, instance.results);
      used += instance.result();
      if (status > STEP_LIMIT) throw new MicrotinError(status);
      this.terrain.bytes = this.#fed + used;
      this.terrain.done = status === DONE;
      if (calls.verified_vertices(this.#mesh) !== verified || this.terrain.done) {
        verified = calls.verified_vertices(this.#mesh);
        yield this.terrain;
      }
    }
    this.#fed += bytes.length;
  }
}

export function decode(bytes) {
  const decoder = new Decoder();
  for (const _ of decoder.push(bytes)); // to the end
  return decoder.finish();
}

// The bytes of a Response, a ReadableStream, a Blob, or anything that yields Uint8Arrays.
async function* chunksOf(source) {
  const stream = source.body ?? source.stream?.() ?? source;
  if (stream[Symbol.asyncIterator] || stream[Symbol.iterator]) {
    yield* stream;
    return;
  }
  const reader = stream.getReader(); // not every browser iterates over streams
  try {
    for (let piece; !(piece = await reader.read()).done; ) yield piece.value;
  } finally {
    reader.cancel().catch(() => {});
  }
}

export async function* decodeStream(source) {
  await ready;
  const decoder = new Decoder();
  for await (const bytes of chunksOf(source)) {
    yield* decoder.push(bytes);
    if (decoder.terrain?.done) return;
  }
  decoder.finish();
}
