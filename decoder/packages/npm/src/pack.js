// SPDX-License-Identifier: MIT
// A terrain in tiles, of which those are read that are asked for.

import { tilesNear } from "./bounds.js";
import { checkInteger, checkNumber } from "./check.js";
import { noGradient, realGradient } from "./gradient.js";
import { axesAt, canHold, everywhereAt, notesAt, toLattice } from "./header.js";
import { Instance, ready } from "./instance.js";
import { placesAlong } from "./profile.js";
import { Source } from "./source.js";
import {
  ARGUMENT, BAD_TILES, CHECKSUM, OK, MicrotinError, NEED_INPUT, NOT_FOUND, STEP_LIMIT, TOO_BIG, TRUNCATED,
  WORKSPACE_TOO_SMALL,
} from "./status.js";
import { meshArrays } from "./terrain.js";

const INFO_BYTES = 104, X_MAX = 0, Y_MAX = 4, WIDTH = 8, HEIGHT = 10, MOST = 12, LOWEST = 20, HIGHEST = 22,
  MARGINS = 24, AXES = 32; // where they are in microtin_pack_info
const MOST_SLOTS = 255, MOST_BAD = 8; // MICROTIN_PACK_MAX_BAD_TILES
const CACHE_BYTES = 2 ** 26;
const FIXED = 48; // bytes of a header, at least
const ENTRY = 20, HEIGHTS = 12, START = 64; // bytes of an entry, up to its heights, and of a stream that announce vertices
const USUAL = 2 ** 14; // vertices that a slot has room for, until a stream has more
const ROOM = 2 ** 20; // vertices that slots have room for together, if one has as many as that
const FIRST_PIECE = 1024; // bytes of a tile that are read first; then twice as many
const WHOLE = 0xffffffff; // more vertices than a tile has
const FOUND = 0, OUTSIDE = 1, VOID = 2; // microtin_query_result

export class Pack {
  #source;
  #instance = new Instance();
  #pack;
  #segment;
  #slots;
  #capacity;
  #last = Promise.resolve();

  static async open(source, { slots = 16, cacheBytes = CACHE_BYTES } = {}) {
    await ready;
    const pack = new Pack();
    pack.#source = new Source(source, cacheBytes);
    await pack.#open(checkInteger("slots", slots, 1, MOST_SLOTS));
    return pack;
  }

  async #open(slots) {
    this.#segment = this.#instance.reserve(32);
    this.#init(1, 3); // enough for the header
    await this.#readHeader();
    this.#init(slots, Math.min(Math.max(3, this.maxTileVertices), USUAL));
  }

  #init(slots, capacity) {
    const { calls } = this.#instance;
    const size = calls.pack_bytes(slots, capacity);
    const { results } = this.#instance;
    const status = calls.microtin_pack_init_32(this.#instance.reserve(size), size, slots, capacity, results);
    if (status !== OK) throw new MicrotinError(status);
    this.#pack = this.#instance.result();
    [this.#slots, this.#capacity] = [slots, capacity];
  }

  async #readHeader() {
    const instance = this.#instance;
    const at = instance.reserve(INFO_BYTES);
    this.#putSegment([-256, -256, -256, -256]); // touches no tile
    await this.#serve();
    instance.calls.microtin_pack_get_info(this.#pack, at);
    const { view } = instance;
    const large = (place) => view.getUint32(at + place, true), small = (place) => view.getUint16(at + place, true);
    this.extent = [large(X_MAX), large(Y_MAX)];
    this.tileSize = [small(WIDTH), small(HEIGHT)];
    [this.columns, this.rows] = this.extent.map((extent, i) => Math.ceil(extent / this.tileSize[i]));
    this.maxTileVertices = large(MOST);
    const axes = axesAt(view, at + AXES);
    [this.lowest, this.highest] = [LOWEST, HIGHEST].map(
      (place) => axes.z.start + view.getInt16(at + place, true) * axes.z.step);
    const everywhere = everywhereAt(view, at + MARGINS, axes);
    this.header = { axes, ...(everywhere && { everywhere }), ...await this.#readNotes() };
  }

  // The header has passed its check, so that nothing but its length is open.
  async #readNotes() {
    const instance = this.#instance;
    const { results, calls } = instance;
    for (let size = FIXED; ; size = instance.result(1) > size ? instance.result(1) : 2 * size) {
      const head = await this.#source.first(size);
      const notes = instance.borrow(head.length, (at) => {
        instance.put(at, head);
        const status = calls.microtin_find_note(at, head.length, 0, results, results + 4);
        if (status === NEED_INPUT) return false;
        if (status !== OK && status !== NOT_FOUND) throw new MicrotinError(status);
        return notesAt(instance, at, head.length);
      });
      if (notes) return notes;
      if (head.length < size) throw new MicrotinError(TRUNCATED);
    }
  }

  get bytesRead() {
    return this.#source.bytes;
  }
  get size() {
    return this.#source.size;
  }

  // --- Tiles.

  // The corners of a tile on the pack's lattice: x, y, largest x, largest y.
  #box(tile) {
    checkInteger("a tile", tile, 0, this.columns * this.rows - 1);
    const first = [tile % this.columns, Math.floor(tile / this.columns)].map((n, i) => n * this.tileSize[i]);
    return [...first, ...first.map((n, i) => Math.min(n + this.tileSize[i], this.extent[i]))];
  }

  tileBox(tile) {
    const { x, y } = this.header.axes;
    return this.#box(tile).map((k, i) => (i % 2 ? y : x).start + k * (i % 2 ? y : x).step);
  }

  tilesIn(xMin, yMin, xMax, yMax) {
    const { axes } = this.header;
    const near = (axis, value, i) =>
      Math.floor((checkNumber("a coordinate", value) - axis.start) / axis.step / this.tileSize[i]);
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

  // Each piece of work begins where the last one ended, or anew from the bytes that are kept, if other calls came in
  // between. It ends when more vertices have passed their checks than before, so that it never goes round.
  async *#tileArrays(tile, whole) {
    const [x, y, xEnd, yEnd] = this.#box(tile);
    const [midX, midY] = [(x + xEnd) * 128, (y + yEnd) * 128]; // in no other tile
    const segment = [midX, midY, midX, midY];
    let done = false, verified = whole ? WHOLE : 0;
    for (let piece = whole ? Infinity : FIRST_PIECE; !done; piece *= 2) {
      yield await this.#alone(async () => {
        this.#putSegment(segment);
        const status = await this.#serve({ piece, verified });
        if (status === BAD_TILES) throw this.#badTile(segment);
        done = status === OK;
        const { calls } = this.#instance;
        const mesh = calls.tile_mesh(this.#pack, tile);
        verified = mesh && calls.verified_vertices(mesh);
        return { ...meshArrays(this.#instance, mesh, this.header.axes, x, y), done };
      });
    }
  }

  // The error of a segment that touches bad tiles. The decoder remembers some of them.
  #badTile([x, y, xEnd, yEnd]) {
    for (const { tile, why } of this.#badTiles()) {
      const [left, bottom, right, top] = this.#box(tile).map((k) => 256 * k);
      if (left <= Math.max(x, xEnd) && right >= Math.min(x, xEnd) && bottom <= Math.max(y, yEnd) &&
          top >= Math.min(y, yEnd)) return new MicrotinError(why, { where: `tile ${tile}` });
    }
    return new MicrotinError(CHECKSUM, { where: "a tile" });
  }

  #badTiles() {
    const instance = this.#instance;
    const { results, calls } = instance;
    const tiles = [];
    for (let i = 0; i < MOST_BAD; ++i) {
      if (calls.microtin_pack_bad_tile(this.#pack, i, results, results + 4) !== OK) continue;
      tiles.push({ tile: instance.result(), why: instance.result(1) });
    }
    return tiles;
  }

  // --- Heights.

  #place(x, y) {
    const { axes } = this.header;
    return [toLattice(axes.x, this.extent[0], x), toLattice(axes.y, this.extent[1], y)];
  }

  async heightAt(x, y) {
    const place = this.#place(x, y);
    return this.#ask([...place, ...place], ({ calls, results }) =>
      calls.microtin_pack_height_at(this.#pack, ...place.map(BigInt), results, results + 4));
  }

  async gradientAt(x, y) {
    const place = this.#place(x, y);
    return this.#ask([...place, ...place], ({ calls, results }) =>
      calls.microtin_pack_gradient_at(this.#pack, ...place.map(BigInt), results, results + 8),
    (instance) => realGradient(instance, instance.results + 8, this.header, y), noGradient());
  }

  async segmentMax(x, y, xEnd, yEnd) {
    return this.#ask([...this.#place(x, y), ...this.#place(xEnd, yEnd)], ({ calls, results }) =>
      calls.microtin_pack_segment_extremes(this.#pack, this.#segment, results + 4));
  }

  async profile(x, y, xEnd, yEnd) {
    const ends = [...this.#place(x, y), ...this.#place(xEnd, yEnd)];
    return this.#alone(async () => {
      if (ends.some(Number.isNaN)) return [];
      this.#putSegment(ends);
      await this.#serve();
      const instance = this.#instance;
      return placesAlong(instance, this.header.axes, ends,
        (...at) => instance.calls.microtin_pack_profile_next(this.#pack, ...at));
    });
  }

  #height(instance) {
    const { z } = this.header.axes;
    return z.start + (instance.view.getInt32(instance.results + 4, true) / 65536) * z.step;
  }

  // What a query on a segment finds: the height behind the second result, or what read() makes of the results. Both ends
  // are within the pack, and so is all between them, or there is none.
  #ask(segment, query, read = (instance) => this.#height(instance), none = NaN) {
    return this.#alone(async () => {
      if (segment.some(Number.isNaN)) return none;
      this.#putSegment(segment);
      const status = await this.#serve();
      const answer = query(this.#instance);
      if (answer === FOUND) return read(this.#instance);
      if (answer === OUTSIDE || answer === VOID) return none;
      throw status === BAD_TILES ? this.#badTile(segment) : new MicrotinError(-1, { where: `answer ${answer}` });
    });
  }

  // --- Between which heights an area lies, by the index alone.

  async boundsInBox(xMin, yMin, xMax, yMax) {
    return this.#bounds([xMin, yMin], [xMax, yMax], true);
  }

  async boundsOnLine(x, y, xEnd, yEnd) {
    return this.#bounds([x, y], [xEnd, yEnd], false);
  }

  #bounds(...area) {
    const { x, y, z } = this.header.axes, { everywhere } = this.header;
    const isBox = area.pop();
    const [a, b] = area.map((place) =>
      [x, y].map((axis, i) => (checkNumber("a coordinate", place[i]) - axis.start) / axis.step));
    return this.#alone(async () => {
      this.#putSegment([-256, -256, -256, -256]);
      await this.#serve(); // the header
      let [lowest, highest] = [Infinity, -Infinity];
      let isComplete = [a, b].every((place) => place.every((k, i) => k >= 0 && k <= this.extent[i]));
      for (const run of tilesNear(this, a, b, isBox)) {
        for (const heights of await this.#heightsOf(...run)) {
          if (!heights) isComplete = false;
          else [lowest, highest] = [Math.min(lowest, heights[0]), Math.max(highest, heights[1])];
        }
      }
      const isKnown = lowest <= highest;
      const real = (k, more = 0) => (isKnown ? z.start + k * z.step + more : NaN);
      return {
        lowest: real(lowest),
        highest: real(highest),
        sourceLowest: real(lowest, -(everywhere?.above ?? NaN)),
        sourceHighest: real(highest, everywhere?.below ?? NaN),
        isComplete: isComplete && isKnown,
      };
    });
  }

  // The lowest and the highest height of each of `count` tiles; undefined without terrain.
  async #heightsOf(first, count) {
    const instance = this.#instance;
    const { results, calls } = instance;
    const bytes = await this.#source.bytesAt(calls.entry_start(this.#pack, first), ENTRY * count);
    return Array.from({ length: count }, (_, i) => instance.borrow(ENTRY, (at) => {
      const entry = bytes.subarray(ENTRY * i, ENTRY * (i + 1));
      const where = `tile ${first + i}`;
      if (entry.length < ENTRY) throw new MicrotinError(TRUNCATED, { where });
      instance.put(at, entry);
      const size = calls.read_entry(this.#pack, first + i, at, results);
      if (size < 0) throw new MicrotinError(CHECKSUM, { where });
      return size ? [...instance.array(Int16Array, at + HEIGHTS, 2)] : undefined;
    }));
  }

  // --- Reading.

  // One at a time: the work in hand is the pack's.
  #alone(work) {
    const result = this.#last.then(work);
    this.#last = result.catch(() => {});
    return result;
  }

  #putSegment(ends) {
    const { view } = this.#instance;
    ends.forEach((end, i) => view.setBigInt64(this.#segment + 8 * i, BigInt(end), true));
  }

  // Brings the tiles of the segment. STEP_LIMIT: more vertices than `verified` of the tile in hand have passed their
  // checks. Each read brings a byte or more that was missing, or ends the work.
  async #serve({ piece = Infinity, verified = WHOLE } = {}) {
    const { calls } = this.#instance;
    for (;;) {
      const status = calls.prepare_section(this.#pack, this.#segment, verified);
      if (status === NEED_INPUT) await this.#give(piece);
      else if (status === WORKSPACE_TOO_SMALL && this.#slots < MOST_SLOTS) this.#grow();
      else if (status !== BAD_TILES || !await this.#widen()) return this.#settled(status);
    }
  }

  // OK, BAD_TILES or STEP_LIMIT; everything else is an error.
  #settled(status) {
    if (status === OK || status === BAD_TILES || status === STEP_LIMIT) return status;
    if (status === WORKSPACE_TOO_SMALL || status === ARGUMENT) throw new RangeError("the segment is too long");
    throw new MicrotinError(status);
  }

  #grow() {
    this.#init(Math.min(2 * this.#slots, MOST_SLOTS), this.#capacity);
  }

  // Makes room for the largest of the tiles that were refused for want of it; false if there is none.
  async #widen() {
    let most = 0;
    for (const { tile, why } of this.#badTiles()) {
      if (why === TOO_BIG) most = Math.max(most, await this.#verticesOf(tile));
    }
    if (most <= this.#capacity) return false;
    this.#init(Math.min(this.#slots, Math.max(1, Math.floor(ROOM / most))), most);
    return true;
  }

  // As its stream announces; 0 if it cannot be so many.
  async #verticesOf(tile) {
    const instance = this.#instance;
    const { results, calls } = instance;
    const holding = (bytes, use) => instance.borrow(bytes.length, (at) => {
      instance.put(at, bytes);
      return use(at, bytes.length);
    });
    const entry = await this.#source.bytesAt(calls.entry_start(this.#pack, tile), ENTRY);
    const size = holding(entry, (at, length) => (length < ENTRY ? 0 : calls.read_entry(this.#pack, tile, at, results)));
    if (size <= 0) return 0;
    const start = await this.#source.bytesAt(instance.view.getFloat64(results, true), Math.min(size, START));
    const vertices = holding(start, (at, length) => calls.announced_vertices(this.#pack, tile, at, length));
    return canHold(size, vertices) ? vertices : 0;
  }

  async #give(piece) {
    const instance = this.#instance;
    const { results, calls } = instance;
    calls.microtin_pack_next_read(this.#pack, results, results + 8, results + 12);
    const offset = Number(instance.view.getBigUint64(results, true));
    const [buffer, size] = [instance.result(2), instance.result(3)];
    const bytes = this.#source.known(offset, size) ??
      await this.#source.read(offset, Math.min(calls.stream_end(this.#pack), offset + piece));
    instance.put(buffer, bytes.subarray(0, size));
    calls.microtin_pack_complete_read(this.#pack, Math.min(bytes.length, size));
  }
}
