// SPDX-License-Identifier: MIT
// Calls that overlap, break off or fail; numbers of every kind; what is handed out before all is verified.
import assert from "node:assert/strict";
import test from "node:test";
import { areaBytes, goldenBytes, microtin, skip } from "./support.mjs";

const { Decoder, MicrotinError, Pack, decode, decodeStream } = microtin;
const many = areaBytes("many.mtp"), packOfPhases = areaBytes("phases.mtp"), streamOfPhases = areaBytes("phases.mtin");

const copyOf = ({ positions, indices, voids }) => structuredClone({ positions, indices, voids });

// Where the stream of a tile lies in a pack: format-pack.md, section 2.
function placeOf(pack, tile) {
  const view = new DataView(pack.buffer, pack.byteOffset);
  const [across, up] = [10, 12].map((at, i) => Math.ceil(view.getUint32(20 + 4 * i, true) / view.getUint16(at, true)));
  const index = 48 + pack[6] + view.getUint16(8, true) + 4, entry = index + 20 * tile;
  return {
    start: index + 20 * across * up + view.getUint32(entry, true),
    size: view.getUint16(entry + 5, true) | (pack[entry + 7] << 16),
  };
}

function damaged(bytes, ...places) {
  const copy = bytes.slice();
  for (const place of places) copy[place] ^= 0x55;
  return copy;
}

async function allOf(generator, most = 1000) {
  const found = [];
  for await (const mesh of generator) {
    found.push(mesh);
    assert.ok(found.length <= most);
  }
  return found;
}

// --- Packs.

test("phases of tiles may overlap each other and questions; each tile is what it is alone", { skip }, async () => {
  const alone = await Pack.open(packOfPhases);
  const tiles = [0, 1, 2, 3, 0];
  const expected = [];
  for (const tile of tiles) expected.push(await allOf(alone.tilePhases(tile)));
  assert.ok(expected[0].length > 2);
  const [x, y, right, top] = alone.tileBox(0);
  const [height, highest] = [await alone.heightAt((x + right) / 2, (y + top) / 2), await alone.segmentMax(x, y, right, top)];
  for (const slots of [1, 16]) {
    const pack = await Pack.open(async (offset, size) => {
      await new Promise((done) => setTimeout(done, 1));
      return packOfPhases.subarray(offset, offset + size);
    }, { slots });
    const ask = async () => {
      for (let i = 0; i < 20; ++i) {
        assert.equal(await pack.heightAt((x + right) / 2, (y + top) / 2), height);
        assert.equal(await pack.segmentMax(x, y, right, top), highest);
      }
    };
    const [found] = await Promise.all([Promise.all(tiles.map((tile) => allOf(pack.tilePhases(tile)))), ask()]);
    for (const [i, phases] of found.entries()) {
      const counts = phases.map(({ positions }) => positions.length);
      assert.deepEqual(counts, [...counts].sort((a, b) => a - b));
      assert.deepEqual(phases.at(-1), expected[tiles[i]].at(-1));
      for (const phase of phases) {
        assert.ok(expected[tiles[i]].some(({ positions }) => positions.length === phase.positions.length));
      }
    }
    assert.ok(pack.bytesRead <= packOfPhases.length);
  }
});

test("phases that are abandoned, or asked for at once, disturb nobody", { skip }, async () => {
  const pack = await Pack.open(packOfPhases);
  const left = pack.tilePhases(1);
  await left.next();
  const [first, second] = await Promise.all([pack.tilePhases(0), left].map((phases) => phases.next()));
  assert.ok(first.value.positions.length > 0 && second.value.positions.length > 0);
  await left.return();
  assert.deepEqual(await pack.tile(2), await (await Pack.open(packOfPhases)).tile(2));
  const phases = pack.tilePhases(3);
  const results = await Promise.all(Array.from({ length: 30 }, () => phases.next()));
  assert.ok(results.at(-1).done);
});

test("phases of a damaged tile are verified, and end in an error", { skip }, async () => {
  const { start, size } = placeOf(packOfPhases, 0);
  const good = (await allOf((await Pack.open(packOfPhases)).tilePhases(0))).map(copyOf);
  const ends = [];
  for (const terrain of new Decoder().push(packOfPhases.subarray(start, start + size))) ends.push(terrain.bytes);
  assert.ok(ends.length > 2);
  for (const [phase, end] of ends.slice(0, -1).entries()) {
    const pack = await Pack.open(damaged(packOfPhases, start + end + 8));
    const seen = [];
    await assert.rejects(async () => {
      for await (const mesh of pack.tilePhases(0)) {
        assert.ok(!mesh.done);
        seen.push(copyOf(mesh));
      }
    }, { status: "CHECKSUM" });
    assert.equal(seen.length, phase + 1);
    assert.deepEqual(seen, good.slice(0, phase + 1));
  }
});

test("a stream of another size is not handed out; one of another tile is refused at its end", { skip }, async () => {
  const { start, size } = placeOf(packOfPhases, 0), other = placeOf(packOfPhases, 1);
  const wrong = packOfPhases.slice();
  wrong.set(streamOfPhases.subarray(0, size), start);
  await assert.rejects((await Pack.open(wrong)).tilePhases(0).next(), MicrotinError);
  const exchanged = packOfPhases.slice();
  exchanged.set(packOfPhases.subarray(other.start, other.start + Math.min(size, other.size)), start);
  const pack = await Pack.open(exchanged);
  await assert.rejects(allOf(pack.tilePhases(0)), MicrotinError);
  await assert.rejects(pack.tile(0), MicrotinError);
});

test("phases after a failed read are verified, too", { skip }, async () => {
  const expected = (await allOf((await Pack.open(packOfPhases)).tilePhases(0))).map(copyOf);
  const { start, size } = placeOf(packOfPhases, 0);
  for (let end = start + 500; end < start + size; end += 1500) {
    let most = end;
    const pack = await Pack.open(async (offset, length) => {
      if (offset >= most) throw new Error("not yet");
      return packOfPhases.subarray(offset, Math.min(offset + length, most));
    });
    await assert.rejects(pack.tile(0), { status: "IO" });
    most = Infinity;
    for await (const mesh of pack.tilePhases(0)) {
      assert.ok(expected.some(({ positions }) => positions.length === mesh.positions.length));
    }
  }
});

test("questions that touch bad tiles are errors, however many these are", { skip }, async () => {
  for (const count of [1, 8, 9, 20]) {
    const pack = await Pack.open(damaged(many, ...Array.from({ length: count }, (_, tile) => placeOf(many, tile).start + 20)));
    const middle = (tile) => {
      const [x, y, right, top] = pack.tileBox(tile);
      return [(x + right) / 2, (y + top) / 2 + 0.1];
    };
    for (let attempt = 0; attempt < 3; ++attempt) {
      await assert.rejects(pack.segmentMax(...middle(0), ...middle(Math.min(count, pack.columns - 1))), { status: "CHECKSUM" });
      for (let tile = 0; tile < count; ++tile) {
        await assert.rejects(pack.heightAt(...middle(tile)), { status: "CHECKSUM" });
        await assert.rejects(pack.tile(tile), { status: "CHECKSUM", message: new RegExp(`^tile ${tile}: `) });
      }
    }
    assert.ok(Number.isFinite(await pack.heightAt(...middle(count))));
    assert.ok(Number.isNaN(await pack.heightAt(-1e6, 0)));
  }
});

// --- Numbers.

const OUTSIDE = [NaN, Infinity, -Infinity, -1e9, 2 ** 31, 2 ** 32, 2 ** 53, 2 ** 56, 2 ** 64, 1e300, -(2 ** 56), Number.MAX_VALUE];
const NO_NUMBERS = ["1", "", 1n, null, undefined, {}, [], true, new Date(0)];

test("numbers that lie outside, and what is no number, are no place", { skip }, async () => {
  const terrain = decode(goldenBytes("hills.mtin"));
  const [x, y] = terrain.origin;
  const pack = await Pack.open(many, { slots: 4 });
  const [left, bottom, right, top] = pack.tileBox(0);
  const inside = [(left + right) / 2, (bottom + top) / 2];
  const before = await pack.heightAt(...inside);
  for (const value of OUTSIDE) {
    for (const place of [[value, inside[1]], [inside[0], value], [value, value]]) {
      assert.ok(Number.isNaN(await pack.heightAt(...place)), `${place}`);
      assert.ok(Number.isNaN(await pack.segmentMax(...inside, ...place)), `${place}`);
      assert.ok(Number.isNaN(await pack.segmentMax(...place, ...inside)), `${place}`);
    }
    assert.ok(Number.isNaN(terrain.heightAt(value, y)) && Number.isNaN(terrain.heightAt(x, value)));
    assert.deepEqual(pack.tilesIn(value, value, value, value), []);
  }
  for (const value of NO_NUMBERS) {
    await assert.rejects(pack.heightAt(value, inside[1]), TypeError);
    await assert.rejects(pack.heightAt(inside[0], value), TypeError);
    await assert.rejects(pack.segmentMax(...inside, value, inside[1]), TypeError);
    assert.throws(() => terrain.heightAt(value, y), TypeError);
    assert.throws(() => pack.tilesIn(0, 0, value, 0), TypeError);
    assert.throws(() => pack.tileBox(value), TypeError);
    await assert.rejects(pack.tile(value), TypeError);
    await assert.rejects(pack.tilePhases(value).next(), TypeError);
    if (value !== undefined) await assert.rejects(Pack.open(many, { slots: value }), TypeError);
    if (value !== undefined) await assert.rejects(Pack.open(many, { cacheBytes: value }), TypeError);
  }
  for (const value of [...OUTSIDE, -1, 0.5, 400]) {
    assert.throws(() => pack.tileBox(value), RangeError);
    await assert.rejects(pack.tile(value), RangeError);
    await assert.rejects(pack.tilePhases(value).next(), RangeError);
    await assert.rejects(Pack.open(many, { slots: value }), RangeError);
  }
  await assert.rejects(Pack.open(many, { slots: 0 }), RangeError);
  for (const value of [-1, NaN, 0.5]) await assert.rejects(Pack.open(many, { cacheBytes: value }), RangeError);
  assert.equal(await pack.heightAt(...inside), before);
  assert.equal(pack.tilesIn(-Infinity, -Infinity, Infinity, Infinity).length, pack.columns * pack.rows);
});

test("a pack's corners are inside, and a step beyond them is not", { skip }, async () => {
  const pack = await Pack.open(many);
  const { x, y } = pack.header.axes;
  const [left, bottom] = pack.tileBox(0);
  const [, , right, top] = pack.tileBox(pack.columns * pack.rows - 1);
  for (const [cx, sx] of [[left, -1], [right, 1]]) {
    for (const [cy, sy] of [[bottom, -1], [top, 1]]) {
      assert.ok(Number.isFinite(await pack.heightAt(cx, cy)));
      assert.ok(Number.isNaN(await pack.heightAt(cx + sx * x.step, cy)));
      assert.ok(Number.isNaN(await pack.heightAt(cx, cy + sy * y.step)));
    }
  }
});

// --- Streams.

const stateOf = (terrain) => ({
  ...copyOf(terrain), count: terrain.vertexCount, digest: terrain.digest, bytes: terrain.bytes, done: terrain.done,
});

// Heights on a grid over a terrain.
function gridOf(terrain, { origin: [x, y], header: { axes }, positions }) {
  const side = (axis) => positions.reduce((most, value, i) => (i % 3 === axis ? Math.max(most, value) : most), 0);
  const [width, height] = [side(0), side(1)];
  return Array.from({ length: 400 }, (_, i) =>
    terrain.heightAt(x + (width * (i % 20 + 0.5)) / 20, y + (height * (Math.floor(i / 20) + 0.5)) / 20));
}

test("between sections a terrain is what the last one left", { skip }, async () => {
  const whole = decode(streamOfPhases);
  const decoder = new Decoder();
  let last;
  for (let i = 0; i < streamOfPhases.length; i += 900) {
    for (const terrain of decoder.push(streamOfPhases.subarray(i, i + 900))) {
      assert.equal(terrain.positions.length, 3 * terrain.vertexCount);
      last = { state: stateOf(terrain), heights: gridOf(terrain, whole) };
    }
    if (!decoder.terrain) continue;
    if (last) assert.deepEqual({ state: stateOf(decoder.terrain), heights: gridOf(decoder.terrain, whole) }, last);
    else assert.deepEqual([decoder.terrain.vertexCount, decoder.terrain.positions.length, decoder.terrain.indices.length], [0, 0, 0]);
  }
  assert.equal(decoder.finish().digest, whole.digest);
  assert.deepEqual(gridOf(decoder.terrain, whole), gridOf(whole, whole));
});

test("after an error a terrain is what the last good section left, and the decoder goes no further", { skip }, async () => {
  const whole = decode(streamOfPhases);
  for (const place of [streamOfPhases.length - 40, streamOfPhases.length >> 1, streamOfPhases.length - 3]) {
    const bad = damaged(streamOfPhases, place);
    const decoder = new Decoder();
    let last;
    assert.throws(() => {
      for (const terrain of decoder.push(bad)) last = { state: stateOf(terrain), heights: gridOf(terrain, whole) };
    }, { status: "CHECKSUM" });
    assert.ok(last.state.count > 0);
    for (let attempt = 0; attempt < 2; ++attempt) {
      assert.deepEqual({ state: stateOf(decoder.terrain), heights: gridOf(decoder.terrain, whole) }, last);
      assert.equal(decoder.terrain.done, false);
      assert.throws(() => decoder.finish(), { status: "CHECKSUM" });
      assert.throws(() => [...decoder.push(streamOfPhases)], { status: "CHECKSUM" });
    }
  }
});

test("pieces are taken when they are pushed: overlapping, abandoned and unread iterations change nothing", () => {
  const bytes = goldenBytes("sections.mtin");
  const { digest } = decode(bytes);
  const third = Math.ceil(bytes.length / 3);
  const pieces = [0, 1, 2].map((i) => bytes.slice(i * third, (i + 1) * third));
  const unread = new Decoder();
  for (const piece of pieces) unread.push(piece);
  assert.equal(unread.finish().digest, digest);
  const overlapping = new Decoder();
  const iterations = pieces.map((piece) => overlapping.push(piece));
  pieces[1].fill(0); // taken already
  for (let going = true; going;) going = iterations.map((iteration) => !iteration.next().done).some(Boolean);
  assert.equal(overlapping.finish().digest, digest);
  const abandoned = new Decoder();
  for (const _ of abandoned.push(bytes)) break;
  assert.ok(!abandoned.terrain.done);
  assert.equal(abandoned.finish().digest, digest);
  assert.throws(() => new Decoder().finish(), { status: "TRUNCATED" });
});

test("what is no piece of a stream is told", async () => {
  for (const value of [...NO_NUMBERS, new ArrayBuffer(4), new Uint16Array(4), [1, 2]]) {
    assert.throws(() => decode(value), TypeError);
    assert.throws(() => new Decoder().push(value), TypeError);
    await assert.rejects(decodeStream([value]).next(), TypeError);
  }
  for (const value of [undefined, null, 5, {}]) await assert.rejects(decodeStream(value).next(), TypeError);
  assert.throws(() => decode(new Uint8Array(0)), { status: "TRUNCATED" });
});

test("streams that fail, end early or never bring a byte are errors", async () => {
  const bytes = goldenBytes("hills.mtin");
  const drain = (source) => allOf(decodeStream(source));
  await assert.rejects(drain(new Response("no such file", { status: 404 })), { status: "IO" });
  await assert.rejects(drain(new Response(null)), { status: "TRUNCATED" });
  await assert.rejects(drain([]), { status: "TRUNCATED" });
  await assert.rejects(drain([bytes.subarray(0, -1)]), { status: "TRUNCATED" });
  await assert.rejects(drain((async function* () {
    yield bytes.subarray(0, 100);
    throw new Error("the line is dead");
  })()), { status: "IO", message: /the line is dead/ });
  await assert.rejects(drain((function* () {
    for (;;) yield new Uint8Array(0);
  })()), { status: "IO" });
});
