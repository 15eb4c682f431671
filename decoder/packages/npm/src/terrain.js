// SPDX-License-Identifier: MIT
// A terrain, and its decoding from a stream.

import { checkBytes } from "./check.js";
import { noGradient, realGradient } from "./gradient.js";
import { axesAt, canHold, everywhereAt, notesAt, toLattice } from "./header.js";
import { Instance, ready } from "./instance.js";
import { placesAlong } from "./profile.js";
import { OK, IO, MicrotinError, NEED_INPUT, STEP_LIMIT, TRUNCATED } from "./status.js";

const REAL = 0, VOID = 1;
const HINT = 64; // in an instance's results: where heights keep theirs, and the height behind it
const INFO_BYTES = 104, INFO_VERTICES = 0, INFO_HEADER_BYTES = 4, INFO_MARGINS = 16, INFO_AXES = 24,
  INFO_MESH_BYTES = 96, INFO_DECODER_BYTES = 100; // where they are in microtin_stream_info
const CHUNK = 65536;
const STEPS = 1 << 16;
const MOST = 65535; // steps of a stream's lattice
const MOST_EMPTY = 1 << 16; // pieces of no bytes, one after another

// Vertices and triangles of a mesh, 0 if there is none, whose lattice begins at (x0, y0) of the axes'.
export function meshArrays(instance, mesh, axes, x0 = 0, y0 = 0) {
  const { calls } = instance;
  const count = mesh && calls.microtin_mesh_vertex_count(mesh);
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

let show; // what a terrain shows from now on: a mesh of which all vertices are verified

export class Terrain {
  #instance;
  #mesh;
  #arrays;

  static {
    show = (terrain, instance, mesh, state) => {
      terrain.#instance = instance;
      terrain.#mesh = mesh;
      terrain.#arrays = undefined;
      Object.assign(terrain, state);
    };
  }

  constructor(header) {
    this.header = header;
  }

  get #now() {
    return this.#arrays ??= meshArrays(this.#instance, this.#mesh, this.header.axes);
  }

  get vertexCount() {
    return this.#instance.calls.microtin_mesh_vertex_count(this.#mesh);
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
    return BigInt.asUintN(64, this.#instance.calls.microtin_mesh_digest(this.#mesh));
  }

  heightAt(x, y) {
    const { calls, results, view } = this.#instance;
    const { axes } = this.header;
    const [i, j] = [toLattice(axes.x, MOST, x), toLattice(axes.y, MOST, y)];
    if (Number.isNaN(i + j)) return NaN;
    const answer = calls.microtin_mesh_height_at(this.#mesh, i, j, results + HINT, results + HINT + 4, 0, 0);
    return answer ? NaN : axes.z.start + (view.getInt32(results + HINT + 4, true) / 65536) * axes.z.step;
  }

  gradientAt(x, y) {
    const { calls, results } = this.#instance;
    const { axes } = this.header;
    const [i, j] = [toLattice(axes.x, MOST, x), toLattice(axes.y, MOST, y)];
    if (Number.isNaN(i + j)) return noGradient();
    const [hint, at] = [results + HINT, results + HINT + 8];
    const answer = calls.microtin_mesh_gradient_at(this.#mesh, i, j, hint, at, 0, 0);
    return answer ? noGradient() : realGradient(this.#instance, at, this.header, y);
  }

  profile(x, y, xEnd, yEnd) {
    const instance = this.#instance, { axes } = this.header;
    const ends = [x, y, xEnd, yEnd].map((value, i) => toLattice(i % 2 ? axes.y : axes.x, MOST, value));
    return placesAlong(instance, axes, ends, (...at) => instance.calls.microtin_mesh_profile_next(this.#mesh, ...at, 0));
  }
}

export class Decoder {
  #instance = new Instance(); // decodes
  #shown; // has a copy of the last verified mesh while another grows
  #waiting = []; // pieces of the stream
  #used = 0; // bytes of the first one
  #bytes = 0; // used so far
  #failure;
  #decoder = 0;
  #mesh = 0;
  #meshBytes = 0;
  #chunk = 0;

  terrain = undefined;

  // Takes the bytes at once. The generator yields the terrain each time that a section, one phase or the first few,
  // has passed its check. All generators of a decoder go on where the last one stopped.
  push(bytes) {
    this.#waiting.push(checkBytes("a piece of a stream", bytes).slice());
    return this.#phases();
  }

  finish() {
    for (const _ of this.#phases()); // which are left
    if (!this.terrain?.done) throw new MicrotinError(TRUNCATED);
    return this.terrain;
  }

  *#phases() {
    while (this.#grow()) yield this.terrain;
  }

  // Decodes up to the end of a section; false if bytes are missing, or all is done. A failure is final.
  #grow() {
    if (this.#failure) throw this.#failure;
    try {
      while (this.#waiting.length > 0 && !this.terrain?.done && (this.terrain || this.#begin())) {
        if (this.#feed()) return true;
      }
    } catch (error) {
      this.#failure = error;
      throw error;
    }
    if (this.terrain?.done) this.#waiting = [];
    return false;
  }

  // Whether the header is complete and so many bytes are there that its vertices can follow, which makes a terrain.
  #begin() {
    const instance = this.#instance;
    const head = new Uint8Array(this.#waiting.reduce((sum, { length }) => sum + length, 0));
    let length = 0;
    for (const piece of this.#waiting) {
      head.set(piece, length);
      length += piece.length;
    }
    this.#waiting = [head];
    const start = instance.end;
    const at = instance.reserve(head.length);
    const info = instance.reserve(INFO_BYTES);
    instance.put(at, head);
    const status = instance.calls.microtin_read_stream_info_32(at, head.length, info);
    if (status > NEED_INPUT) throw new MicrotinError(status);
    const number = (place) => instance.view.getUint32(info + place, true);
    const isEnough = status === OK && canHold(head.length - number(INFO_HEADER_BYTES), number(INFO_VERTICES));
    if (isEnough) this.#layOut(info, notesAt(instance, at, head.length), start);
    else instance.end = start;
    return isEnough;
  }

  #layOut(info, notes, start) {
    const instance = this.#instance;
    const { view, calls } = instance;
    const number = (at) => view.getUint32(info + at, true);
    const decoderBytes = number(INFO_DECODER_BYTES);
    const axes = axesAt(view, info + INFO_AXES);
    const everywhere = everywhereAt(view, info + INFO_MARGINS, axes);
    const header = { vertices: number(INFO_VERTICES), axes, ...(everywhere && { everywhere }), ...notes };
    for (const phase of header.phases ?? []) phase.bytes += number(INFO_HEADER_BYTES);
    this.#meshBytes = number(INFO_MESH_BYTES);
    instance.end = start;
    const workspace = instance.reserve(this.#meshBytes);
    calls.microtin_mesh_init_32(workspace, this.#meshBytes, instance.results);
    this.#mesh = instance.result();
    this.#chunk = instance.reserve(CHUNK);
    calls.microtin_decoder_init_32(instance.reserve(decoderBytes), decoderBytes, this.#mesh, instance.results);
    this.#decoder = instance.result();
    const terrain = new Terrain(header);
    this.#show(terrain, false);
    this.terrain = terrain;
  }

  // The mesh as it is now: itself if no vertex will follow, else a copy.
  #show(terrain, done) {
    if (!done) {
      this.#shown ??= new Instance();
      this.#shown.mirror(this.#instance, this.#mesh, this.#meshBytes);
    }
    show(terrain, done ? this.#instance : this.#shown, this.#mesh, { bytes: this.#bytes, done });
    if (done) this.#shown = undefined;
  }

  // Decodes from the first piece. Whether one more section has passed its check, or the last one.
  #feed() {
    const instance = this.#instance;
    const { calls } = instance;
    const bytes = this.#waiting[0].subarray(this.#used, this.#used + CHUNK);
    const verified = calls.verified_vertices(this.#mesh);
    instance.put(this.#chunk, bytes);
    const status = calls.feed_section(this.#decoder, this.#chunk, bytes.length, STEPS, instance.results);
    const used = instance.result();
    if (status > STEP_LIMIT) throw new MicrotinError(status);
    this.#used += used;
    this.#bytes += used;
    if (this.#used === this.#waiting[0].length && status !== STEP_LIMIT) {
      this.#waiting.shift();
      this.#used = 0;
    }
    const done = status === OK;
    if (!done && calls.verified_vertices(this.#mesh) === verified) return false;
    this.#show(this.terrain, done);
    return true;
  }
}

export function decode(bytes) {
  const decoder = new Decoder();
  decoder.push(bytes);
  return decoder.finish();
}

// The bytes of a Response, a ReadableStream, a Blob, or anything that yields Uint8Arrays.
async function* chunksOf(source) {
  if (source?.ok === false) throw new Error(`${source.url}: ${source.status} ${source.statusText}`);
  const stream = source?.body === null ? [] : source?.body ?? source?.stream?.() ?? source;
  if (stream?.[Symbol.asyncIterator] || stream?.[Symbol.iterator]) {
    yield* stream;
    return;
  }
  if (!stream?.getReader) throw new TypeError("a stream must be a Response, a Blob, a ReadableStream or an iterable");
  const reader = stream.getReader(); // not every browser iterates over streams
  try {
    for (let piece; !(piece = await reader.read()).done; ) yield piece.value;
  } finally {
    reader.cancel().catch(() => {});
  }
}

// Pieces that are bytes; what fails on the way is an error of reading.
async function* bytesOf(source) {
  try {
    let empty = 0;
    for await (const bytes of chunksOf(source)) {
      empty = checkBytes("a piece of a stream", bytes).length ? 0 : empty + 1;
      if (empty > MOST_EMPTY) throw new Error("only empty pieces");
      yield bytes;
    }
  } catch (cause) {
    throw cause instanceof TypeError ? cause : new MicrotinError(IO, { cause });
  }
}

export async function* decodeStream(source) {
  await ready;
  const decoder = new Decoder();
  for await (const bytes of bytesOf(source)) {
    yield* decoder.push(bytes);
    if (decoder.terrain?.done) return;
  }
  decoder.finish();
}
