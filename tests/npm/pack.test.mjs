// SPDX-License-Identifier: MIT
// Packs: out of memory and by HTTP, from servers that know ranges, know none, and break off.
import assert from "node:assert/strict";
import test from "node:test";
import { areaBytes, areaFile, bytesOf, goldenBytes, grown, microtin, postsOf, served, skip, withChecks } from "./support.mjs";

const { MicrotinError, Pack, decode } = microtin;
const bytes = areaBytes("area.mtp");

function withRanges(response, [from, to]) {
  if (from >= bytes.length) {
    response.writeHead(416).end();
    return;
  }
  const part = bytes.subarray(from, to + 1);
  response.writeHead(206, { "Content-Range": `bytes ${from}-${from + part.length - 1}/${bytes.length}` }).end(part);
}

test("heights at every post keep the bound", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const { bound } = pack.header.accuracy;
  assert.equal(pack.header.surface.side, "both");
  assert.ok(Math.max(pack.header.everywhere.below, pack.header.everywhere.above) >= pack.header.accuracy.largest);
  for (const { x, y, z } of postsOf(areaFile("asc")).filter((_, i) => i % 37 === 0)) {
    assert.ok(Math.abs((await pack.heightAt(x, y)) - z) <= bound * 1.0001);
  }
});

test("a gradient in a tile is that of its triangle, and none is outside", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const [left, bottom, right, top] = pack.tileBox(0);
  const { axes } = pack.header;
  let found = 0;
  for (let i = 1; i < 40; ++i) {
    const [x, y] = [left + ((right - left) * i) / 40.3, bottom + ((top - bottom) * ((7 * i) % 40)) / 40.7];
    const { east, north } = await pack.gradientAt(x, y);
    const [dx, dy] = [axes.x.step / 16, axes.y.step / 16];
    const heights = [];
    for (const [a, b] of [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]]) heights.push(await pack.heightAt(x + a * dx, y + b * dy));
    const straight = (a, b) => Math.abs(heights[a] + heights[b] - 2 * heights[0]) < 1e-4 * axes.z.step;
    if (!straight(1, 3) || !straight(2, 4)) continue; // more than one triangle
    ++found;
    const unit = (d, rise) => Math.abs(d - rise) < 0.02 * (1 + Math.abs(rise));
    assert.ok(unit(east, (heights[1] - heights[3]) / (2 * dx)) && unit(north, (heights[2] - heights[4]) / (2 * dy)));
  }
  assert.ok(found > 5);
  assert.deepEqual(await pack.gradientAt(left - 1e6, bottom), { east: NaN, north: NaN });
});

test("bounds of an area are those of the tiles that it touches, by the index alone", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const boxes = Array.from({ length: pack.columns * pack.rows }, (_, tile) => pack.tileBox(tile));
  const spans = [];
  for (const tile of boxes.keys()) {
    const heights = (await pack.tile(tile)).positions.filter((_, i) => i % 3 === 2);
    spans.push([Math.min(...heights), Math.max(...heights)]);
  }
  const fresh = await Pack.open(bytes);
  const [west, south, east, north] = [...boxes[0].slice(0, 2), ...boxes.at(-1).slice(2)];
  const reach = (axis) => pack.header.axes[axis].step / 100;
  const spanOf = (meets) => spans.filter((_, tile) => meets(boxes[tile])).reduce(
    ([low, high], span) => [Math.min(low, span[0]), Math.max(high, span[1])], [Infinity, -Infinity]);
  const near = (a, b) => Math.abs(a - b) < 1e-3;
  for (let i = 0; i < 60; ++i) {
    const at = (k, from, to) => from + ((to - from) * ((k * 37) % 101)) / 100.7;
    const [x, y, xEnd, yEnd] = [at(i, west, east), at(3 * i + 1, south, north), at(5 * i + 2, west, east), at(7 * i, south, north)];
    const box = [Math.min(x, xEnd), Math.min(y, yEnd), Math.max(x, xEnd), Math.max(y, yEnd)];
    const [lowest, highest] = spanOf(([left, bottom, right, top]) => left <= box[2] + reach("x") && right >= box[0] - reach("x") &&
      bottom <= box[3] + reach("y") && top >= box[1] - reach("y"));
    const found = await fresh.boundsInBox(...box);
    assert.ok(found.isComplete && near(found.lowest, lowest) && near(found.highest, highest), `${box}`);
    assert.ok(near(found.sourceHighest, found.highest + pack.header.everywhere.below));
    assert.ok(near(found.sourceLowest, found.lowest - pack.header.everywhere.above));
    const line = await fresh.boundsOnLine(x, y, xEnd, yEnd);
    const [low, high] = spanOf(([left, bottom, right, top]) => Array.from({ length: 2001 }, (_, k) => k / 2000).some((part) => {
      const [px, py] = [x + (xEnd - x) * part, y + (yEnd - y) * part];
      return px >= left && px <= right && py >= bottom && py <= top;
    }));
    assert.ok(line.isComplete && line.lowest <= low + 1e-3 && line.highest >= high - 1e-3);
    assert.ok(line.lowest >= found.lowest && line.highest <= found.highest);
    const heights = (await pack.profile(x, y, xEnd, yEnd)).map(({ height }) => height);
    assert.ok(Math.max(...heights) <= line.highest + 1e-3 && Math.min(...heights) >= line.lowest - 1e-3);
  }
  assert.equal((await fresh.boundsInBox(west - 1e6, south, east, north)).isComplete, false);
  assert.ok(Number.isNaN((await fresh.boundsOnLine(west - 9e6, south, west - 8e6, north)).highest));
  assert.equal((await fresh.boundsInBox(NaN, south, east, north)).isComplete, false);
  await assert.rejects(fresh.boundsInBox(west, south, east), TypeError);
  const damaged = bytes.slice();
  const index = 48 + bytes[6] + new DataView(bytes.buffer, bytes.byteOffset).getUint16(8, true) + 4;
  damaged[index + 13] ^= 1; // the first tile's lowest height
  await assert.rejects((await Pack.open(damaged)).boundsInBox(west, south, west, south), MicrotinError);
});

test("a profile through tiles has their heights, in order, and says what is not known", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const [left, bottom, right, top] = [...pack.tileBox(0).slice(0, 2), ...pack.tileBox(pack.columns * pack.rows - 1).slice(2)];
  const places = await pack.profile(left, bottom, right, top);
  assert.ok(places.length > 30);
  for (const [i, { along, x, y, height, isKnownBefore }] of places.entries()) {
    assert.ok(i === 0 || along > places[i - 1].along);
    assert.equal(isKnownBefore, i > 0);
    assert.ok(Math.abs(height - (await pack.heightAt(x, y))) < 2 * pack.header.axes.z.step, `${x} ${y}`);
  }
  const highest = Math.max(...places.map(({ height }) => height));
  assert.ok(Math.abs(highest - (await pack.segmentMax(left, bottom, right, top))) < 1e-3);
  assert.deepEqual(await pack.profile(left - 1, bottom, right, top), []);
  const damaged = bytes.slice();
  damaged[damaged.length - 20] ^= 255; // of the last tile
  const known = await (await Pack.open(damaged)).profile(left, bottom, right, top);
  assert.ok(Number.isNaN(known.at(-1).height));
  assert.ok(known[1].isKnownBefore && !known.at(-1).isKnownBefore);
});

test("tiles have no cracks: their borders are the same", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const rightBorder = async (tile, side) => {
    const { origin, positions } = await pack.tile(tile);
    const x = pack.tileBox(tile)[side];
    const { step } = pack.header.axes.x;
    const vertices = [];
    for (let i = 0; i < positions.length; i += 3) {
      if (Math.abs(origin[0] + positions[i] - x) < step / 2) {
        vertices.push([Math.round((origin[1] + positions[i + 1]) / step), positions[i + 2]]);
      }
    }
    return vertices.sort((a, b) => a[0] - b[0]);
  };
  assert.ok(pack.columns > 1 && pack.rows > 1);
  for (let row = 0; row < pack.rows; ++row) {
    for (let column = 0; column + 1 < pack.columns; ++column) {
      const tile = row * pack.columns + column;
      const border = await rightBorder(tile, 2);
      assert.ok(border.length > 1);
      assert.deepEqual(await rightBorder(tile + 1, 0), border);
    }
  }
});

test("the highest of a segment is not below any height on it, and is that of a place", { skip }, async () => {
  const pack = await Pack.open(bytes, { slots: 1 }); // grows
  const { x, y } = pack.header.axes;
  const [left, bottom] = pack.tileBox(0);
  const [, , right, top] = pack.tileBox(pack.columns * pack.rows - 1);
  const highest = await pack.segmentMax(left, bottom, right, top);
  let most = -Infinity;
  for (let i = 0; i <= 1000; ++i) {
    const height = await pack.heightAt(left + ((right - left) * i) / 1000, bottom + ((top - bottom) * i) / 1000);
    most = Math.max(most, height);
  }
  assert.ok(highest >= most - 0.01);
  assert.ok(highest <= most + (pack.highest - pack.lowest) / 20);
  assert.ok(Number.isNaN(await pack.segmentMax(left, bottom, right + 10 * (right - left), top)));
  assert.ok(Number.isNaN(await pack.heightAt(left - 100 * x.step, bottom - 100 * y.step)));
});

test("only what is asked for is fetched", { skip }, async () => {
  await served(withRanges, async (url) => {
    const pack = await Pack.open(url);
    const afterHeader = pack.bytesRead;
    const { indices } = await pack.tile(pack.columns * pack.rows - 1);
    assert.ok(indices.length > 0);
    assert.ok(afterHeader <= 8192);
    assert.ok(pack.bytesRead < bytes.length || bytes.length < 16384);
  });
});

test("phases of a tile end with the tile", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const seen = [];
  for await (const mesh of pack.tilePhases(0)) seen.push(mesh);
  assert.ok(seen.length > 0 && seen.at(-1).done);
  assert.deepEqual(seen.at(-1), await pack.tile(0));
});

test("a server without ranges sends all, once", { skip }, async () => {
  let requests = 0;
  await served((response) => {
    ++requests;
    response.writeHead(200).end(bytes);
  }, async (url) => {
    const pack = await Pack.open(url);
    for (let tile = 0; tile < pack.columns * pack.rows; ++tile) await pack.tile(tile);
    assert.equal(requests, 1);
  });
});

test("a server that breaks off is told, and may be asked again", { skip }, async () => {
  let broken = false;
  await served((response, range) => {
    if (!broken) return withRanges(response, range);
    response.writeHead(206, { "Content-Length": 1000 }).write("a few bytes");
    setTimeout(() => response.destroy(), 20);
  }, async (url) => {
    const pack = await Pack.open(url);
    const last = pack.columns * pack.rows - 1;
    broken = true;
    await assert.rejects(pack.tile(last), (error) => error instanceof MicrotinError && error.status === "IO");
    broken = false;
    assert.ok((await pack.tile(last)).done);
  });
});

test("damaged bytes and what is no pack are told", { skip }, async () => {
  await assert.rejects(Pack.open(new Uint8Array(100)), { status: "BAD_MAGIC" });
  await assert.rejects(Pack.open(bytes.subarray(0, 20)), { status: "TRUNCATED" });
  const damaged = bytes.slice();
  damaged[damaged.length - 3] ^= 1;
  const pack = await Pack.open(damaged);
  const results = await Promise.allSettled(
    Array.from({ length: pack.columns * pack.rows }, (_, tile) => pack.tile(tile)));
  assert.equal(results.filter(({ status }) => status === "rejected").length, 1);
  assert.equal(results.find(({ status }) => status === "rejected").reason.status, "CHECKSUM");
  await assert.rejects(pack.tile(-1), RangeError);
});

test("the header of a pack has what its maker states of the source", async () => {
  const { header } = await Pack.open(goldenBytes("noted.mtp"));
  assert.equal(header.attribution, "\u00a9 the <survey>\u001b");
  assert.equal(header.license, "CC-BY-4.0");
  assert.equal(header.valid, "2024-01/..");
  assert.equal(header.epoch, 2020.5);
  assert.deepEqual(header.sourceAccuracy, { kind: "LE90", value: 4 });
});

test("what a later version may add is read, or refused as unsupported", async () => {
  const golden = goldenBytes("unknown.mtp");
  const pack = await Pack.open(golden);
  assert.equal(pack.header.source, "x"); // between unknown notes
  const reasons = [undefined, "UNSUPPORTED_VERSION", "UNSUPPORTED_VERSION", undefined, undefined, undefined, undefined,
    "CHECKSUM"];
  for (const [tile, status] of reasons.entries()) {
    if (status) await assert.rejects(pack.tile(tile), { status });
    else assert.ok((await pack.tile(tile)).done);
  }
  for (const [name, status] of [["flag_low", "UNSUPPORTED_VERSION"], ["flag_low_damaged", "CHECKSUM"],
    ["flag_high", "UNSUPPORTED_VERSION"]]) {
    await assert.rejects(Pack.open(goldenBytes(`${name}.mtp`)), { status });
  }
});

test("what a header alone says of the largest tile takes no memory", { skip }, async () => {
  const good = await Pack.open(bytes);
  const forged = bytes.slice();
  new DataView(forged.buffer).setUint32(28, 2 ** 24, true);
  const { result, bytes: taken } = await grown(async () => {
    const pack = await Pack.open(withChecks(forged, good.columns * good.rows));
    assert.equal(pack.maxTileVertices, 2 ** 24);
    const [x, y] = pack.tileBox(0);
    return pack.heightAt(x, y);
  });
  const [x, y] = good.tileBox(0);
  assert.equal(result, await good.heightAt(x, y));
  assert.ok(taken < 2 ** 25, `${taken}`);
});

test("a tile that is larger than usual ones has room, as its stream says", { skip }, async () => {
  const large = areaBytes("large.mtp");
  const posts = postsOf(areaFile("asc")).filter((_, i) => i % 4099 === 0);
  for (const slots of [1, 16]) {
    const pack = await Pack.open(large, { slots });
    assert.equal(pack.maxTileVertices, 16641);
    for (const { x, y, z } of posts) assert.ok(Math.abs((await pack.heightAt(x, y)) - z) < 1e-6 * Math.abs(z) + 1e-9);
    const [left, bottom] = pack.tileBox(0), [, , right, top] = pack.tileBox(3);
    assert.ok((await pack.segmentMax(left, bottom, right, top)) <= pack.highest); // three tiles
    let last;
    for await (last of pack.tilePhases(3));
    assert.equal(last.positions.length, 3 * 16641);
  }
});

test("a stream of the same terrain agrees within both bounds", { skip }, async () => {
  const pack = await Pack.open(bytes);
  const terrain = decode(bytesOf(areaFile("mtin")));
  const most = pack.header.accuracy.bound + terrain.header.accuracy.bound;
  for (const { x, y } of postsOf(areaFile("asc")).filter((_, i) => i % 101 === 0)) {
    assert.ok(Math.abs((await pack.heightAt(x, y)) - terrain.heightAt(x, y)) <= most * 1.0001);
  }
});
