// SPDX-License-Identifier: MIT
// A terrain in tiles, of which those are read that are asked for.

import { axesAt, notesAt, toLattice } from "./header.js";
import { Instance, ready } from "./instance.js";
import { AHEAD, Source } from "./source.js";
import {
  ARGUMENT, BAD_TILES, CHECKSUM, DONE, IO, MicrotinError, NEED_INPUT, STEP_LIMIT, WORKSPACE_TOO_SMALL,
} from "./status.js";
import { meshArrays } from "./terrain.js";

const INFO_BYTES = 96, X_MAX = 0, Y_MAX = 4, WIDTH = 8, HEIGHT = 10, MOST = 12, LOWEST = 20, HIGHEST = 22,
  AXES = 24; // where they are in microtin_pack_info
const MOST_SLOTS = 255;
const FIRST_PIECE = 1024; // bytes of a tile that are read first; then twice as many
const PACK_STEPS = 256;
const IN_VOID = 2, IN_BAD_TILE = 6;

export class Pack {
  #source;
  #instance = new Instance();
  #pack;
  #course;
  #slots;
  #last = Promise.resolve();

  static async open(source, { slots = 16 } = {}) {
    await ready;
    const pack = new Pack();
    await pack.#open(source, slots);
    return pack;
  }

  async #open(source, slots) {
    this.#source = new Source(source);
    this.#course = this.#instance.reserve(32);
    this.#init(1, 3); // enough for the header
    await this.#readHeader();
    this.#slots = slots;
    this.#init(slots, Math.max(3, this.mostVertices));
  }

  #init(slots, capacity) {
    const { calls } = this.#instance;
    const size = calls.pack_bytes(slots, capacity);
    const { results } = this.#instance;
    const status = calls.microtin_pack_init_32(this.#instance.reserve(size), size, slots, capacity, results);
    if (status !== DONE) throw new MicrotinError(status);
    this.#pack = this.#instance.result();
  }

  async #readHeader() {
    const instance = this.#instance;
    const at = instance.reserve(INFO_BYTES);
    this.#putCourse([-256, -256, -256, -256]); // touches no tile
    await this.#serve();
    instance.calls.microtin_pack_header(this.#pack, at);
    const { view } = instance;
    const large = (place) => view.getUint32(at + place, true), small = (place) => view.getUint16(at + place, true);
    this.extent = [large(X_MAX), large(Y_MAX)];
    this.tileSize = [small(WIDTH), small(HEIGHT)];
    [this.columns, this.rows] = this.extent.map((extent, i) => Math.ceil(extent / this.tileSize[i]));
    this.mostVertices = large(MOST);
    const axes = axesAt(view, at + AXES);
    [this.lowest, this.highest] = [LOWEST, HIGHEST].map(
      (place) => axes.z.start + view.getInt16(at + place, true) * axes.z.step);
    this.header = { axes, ...await this.#readNotes() };
  }

  // The header has passed its check, so that nothing but its length is open.
  async #readNotes() {
    const instance = this.#instance;
    const { results, calls } = instance;
    for (let head = this.#source.known(0, AHEAD); ; head = await this.#source.read(0, instance.result(1))) {
      const notes = instance.borrow(head.length, (at) => {
        instance.put(at, head);
        const status = calls.microtin_find_note(at, head.length, 0, results, results + 4);
        return status === NEED_INPUT ? undefined : notesAt(instance, at, head.length);
      });
      if (notes) return notes;
    }
  }

  get bytesRead() {
    return this.#source.bytes;
  }

  // --- Tiles.

  // The corners of a tile on the pack's lattice: x, y, largest x, largest y.
  #box(tile) {
    if (!(Number.isInteger(tile) && tile >= 0 && tile < this.columns * this.rows)) {
      throw new RangeError(`no tile ${tile}`);
    }
    const first = [tile % this.columns, Math.floor(tile / this.columns)].map((n, i) => n * this.tileSize[i]);
    return [...first, ...first.map((n, i) => Math.min(n + this.tileSize[i], this.extent[i]))];
  }

  tileBox(tile) {
    const { x, y } = this.header.axes;
    return this.#box(tile).map((k, i) => (i % 2 ? y : x).start + k * (i % 2 ? y : x).step);
  }

  tilesIn(xMin, yMin, xMax, yMax) {
    const { axes } = this.header;
    const near = (axis, value, i) => Math.floor((value - axis.start) / axis.step / this.tileSize[i]);
    const [left, right] = [Math.max(0, near(axes.x, xMin, 0)), Math.min(this.columns - 1, near(axes.x, xMax, 0))];
    const [bottom, top] = [Math.max(0, near(axes.y, yMin, 1)), Math.min(this.rows - 1, near(axes.y, yMax, 1))];
    const tiles = [];
    for (let row = bottom; row <= top; ++row) {
      for (let column = left; column <= right; ++column) tiles.push(row * this.columns + column);
    }
    return tiles;
  }

  async tile(number) {
    let arrays;
    for await (arrays of this.#tileArrays(number, true));
    return arrays;
  }

  tilePhases(number) {
    return this.#tileArrays(number, false);
  }

  async *#tileArrays(tile, whole) {
    const [x, y, xEnd, yEnd] = this.#box(tile);
    const [midX, midY] = [(x + xEnd) * 128, (y + yEnd) * 128]; // in no other tile
    const { calls } = this.#instance;
    let verified = 0;
    for (let done = false, piece = FIRST_PIECE; !done; piece *= 2) {
      const arrays = await this.#alone(async () => {
        this.#putCourse([midX, midY, midX, midY]);
        const limits = whole ? {} : { piece, until: () => this.#verified(tile) !== verified };
        done = await this.#serve(limits) !== STEP_LIMIT;
        if (done && this.#why(tile)) throw new MicrotinError(this.#why(tile), { where: `tile ${tile}` });
        if (!done && this.#verified(tile) === verified) return undefined;
        verified = this.#verified(tile);
        return meshArrays(this.#instance, calls.tile_mesh(this.#pack, tile), this.header.axes, x, y);
      });
      if (arrays) yield { ...arrays, done };
    }
  }

  #verified(tile) {
    const mesh = this.#instance.calls.tile_mesh(this.#pack, tile);
    return mesh ? this.#instance.calls.verified_vertices(mesh) : 0;
  }

  // Why a tile is bad; 0 if it is not.
  #why(tile) {
    const instance = this.#instance;
    const { results } = instance;
    for (let i = 0; i < 8; ++i) {
      if (instance.calls.microtin_pack_bad_tile(this.#pack, i, results, results + 4) && instance.result() === tile) {
        return instance.result(1);
      }
    }
    return 0;
  }

  // --- Heights.

  async heightAt(x, y) {
    const { axes } = this.header;
    const place = [toLattice(axes.x, x), toLattice(axes.y, y)];
    return this.#ask([...place, ...place], ({ calls, results }) =>
      calls.microtin_pack_height_at(this.#pack, ...place.map(BigInt), results, results + 4));
  }

  async highestOn(x, y, xEnd, yEnd) {
    const { axes } = this.header;
    const course = [toLattice(axes.x, x), toLattice(axes.y, y), toLattice(axes.x, xEnd), toLattice(axes.y, yEnd)];
    return this.#ask(course, ({ calls, results }) =>
      calls.microtin_pack_highest(this.#pack, this.#course, results + 4));
  }

  // The height that a query on a course finds behind the second result.
  #ask(course, query) {
    return this.#alone(async () => {
      if (!course.every(Number.isFinite)) return NaN;
      this.#putCourse(course);
      await this.#serve();
      const answer = query(this.#instance);
      if (answer === IN_BAD_TILE) throw new MicrotinError(CHECKSUM, { where: "a tile of the pack" });
      if (answer !== DONE) return NaN; // void or outside
      const { z } = this.header.axes;
      return z.start + (this.#instance.view.getInt32(this.#instance.results + 4, true) / 65536) * z.step;
    });
  }

  // --- Reading.

  // One at a time: the work in hand is the pack's.
  #alone(work) {
    const result = this.#last.then(work);
    this.#last = result.catch(() => {});
    return result;
  }

  #putCourse(ends) {
    const { view } = this.#instance;
    ends.forEach((end, i) => view.setBigInt64(this.#course + 8 * i, BigInt(end), true));
  }

  // Brings the tiles of the course, or works until a condition holds; STEP_LIMIT: it does.
  async #serve({ piece = Infinity, until } = {}) {
    const { calls } = this.#instance;
    for (;;) {
      const status = calls.microtin_pack_prepare(this.#pack, this.#course, until ? PACK_STEPS : 0);
      if (until?.()) return STEP_LIMIT;
      if (status === NEED_INPUT) await this.#give(piece);
      else if (status === WORKSPACE_TOO_SMALL && this.#slots < MOST_SLOTS) this.#grow();
      else if (status !== STEP_LIMIT) return this.#settled(status);
    }
  }

  // DONE or BAD_TILES; everything else is an error.
  #settled(status) {
    if (status === DONE || status === BAD_TILES) return status;
    if (status === WORKSPACE_TOO_SMALL || status === ARGUMENT) throw new RangeError("the course is too long");
    throw new MicrotinError(status);
  }

  #grow() {
    this.#slots = Math.min(2 * this.#slots, MOST_SLOTS);
    this.#init(this.#slots, Math.max(3, this.mostVertices));
  }

  async #give(piece) {
    const instance = this.#instance;
    const { results, calls } = instance;
    calls.microtin_pack_wanted(this.#pack, results, results + 8, results + 12);
    const offset = Number(instance.view.getBigUint64(results, true));
    const [buffer, size] = [instance.result(2), instance.result(3)];
    if (size === 0) return;
    let bytes = this.#source.known(offset, size);
    try {
      bytes ??= await this.#source.read(offset, Math.min(calls.stream_end(this.#pack), offset + piece));
    } catch (cause) {
      throw new MicrotinError(IO, { cause });
    }
    instance.put(buffer, bytes.subarray(0, size));
    calls.microtin_pack_given(this.#pack, Math.min(bytes.length, size));
  }
}
