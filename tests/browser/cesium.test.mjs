// SPDX-License-Identifier: MIT
// microtin/cesium with the real CesiumJS, without its pictures; viewer.test.mjs has them drawn.
import assert from "node:assert/strict";
import path from "node:path";
import test, { after } from "node:test";
import * as cesium from "@cesium/engine";
import { degrees, npm, remove } from "./files.mjs";

const { Pack } = await import(path.join(npm, "microtin.js"));
const { cesiumTerrain } = await import(path.join(npm, "cesium.js"));

after(remove);
const file = degrees("area", { // of degree 6: with many phases
  size: 513, encode: ["--max-error", "2", "--max-degree", "6", "--tile-vertices", "6000", "--tile-size", "120"],
});
const pack = await Pack.open(file);
const provider = cesiumTerrain(cesium, pack);
const { tilingScheme, levels } = provider;
const RADIAN = 180 / Math.PI;

const countsAt = (level) => [tilingScheme.getNumberOfXTilesAtLevel(level), tilingScheme.getNumberOfYTilesAtLevel(level)];
const boxOf = (x, y, level) => {
  const { west, south, east, north } = tilingScheme.tileXYToRectangle(x, y, level);
  return [west, south, east, north].map((angle) => angle * RADIAN);
};

// The tiles of a level that lie within the pack.
function* tilesOf(level) {
  const [columns, rows] = countsAt(level);
  const side = 2 ** (levels - 1 - level);
  for (let y = 0; y < rows; ++y) {
    for (let x = 0; x < columns; ++x) {
      if (x * side < pack.columns && (rows - 1 - y) * side < pack.rows) yield [x, y];
    }
  }
}

// Heights of a tile's mesh at degrees, as Cesium finds them.
function heightsOf(data, x, y, level) {
  const rectangle = tilingScheme.tileXYToRectangle(x, y, level);
  return (longitude, latitude) => data.interpolateHeight(rectangle, longitude / RADIAN, latitude / RADIAN);
}

test("the finest level has the pack's tiles, and its heights", async () => {
  assert.ok(levels > 1 && pack.columns > 2 && pack.rows > 2);
  const { step } = pack.header.axes.x;
  for (const [x, y] of tilesOf(levels - 1)) {
    const box = boxOf(x, y, levels - 1);
    const row = countsAt(levels - 1)[1] - 1 - y;
    const own = pack.tileBox(row * pack.columns + x);
    [0, 1].forEach((i) => assert.ok(Math.abs(box[i] - own[i]) < step / 1000));
    if (x + 1 < pack.columns) assert.ok(Math.abs(box[2] - own[2]) < step / 1000);
    const height = heightsOf(await provider.requestTileGeometry(x, y, levels - 1), x, y, levels - 1);
    for (let i = 1; i < 8; ++i) {
      const place = [own[0] + ((own[2] - own[0]) * i) / 8, own[1] + ((own[3] - own[1]) * ((3 * i) % 8)) / 8];
      // A place is moved by half of 1/32767 of the tile.
      assert.ok(Math.abs(height(...place) - await pack.heightAt(...place)) < 0.1);
    }
  }
});

// Whether a tile is as large as the others.
function hasWhole(x, y) {
  const [west, south, east, north] = pack.tileBox((countsAt(levels - 1)[1] - 1 - y) * pack.columns + x);
  const { axes } = pack.header;
  return [(east - west) / axes.x.step, (north - south) / axes.y.step].every((size, i) => Math.abs(size - pack.tileSize[i]) < 0.5);
}

// Vertices on a side of a tile: their place along it and height, as numbers of the quantized mesh.
function sideOf(data, side) {
  const [us, vs, heights] = [data._uValues, data._vValues, data._heightValues];
  const along = side === "_eastIndices" || side === "_westIndices" ? vs : us;
  return [...data[side]].map((v) => [along[v], heights[v]]).sort((a, b) => a[0] - b[0]);
}

test("borders are exactly on the edges, and the same on both sides", async () => {
  const level = levels - 1;
  const data = new Map();
  for (const [x, y] of tilesOf(level)) data.set(`${x} ${y}`, await provider.requestTileGeometry(x, y, level));
  let borders = 0;
  for (const [x, y] of tilesOf(level)) {
    const tile = data.get(`${x} ${y}`);
    for (const [other, side, facing] of [[`${x + 1} ${y}`, "_eastIndices", "_westIndices"],
      [`${x} ${y + 1}`, "_southIndices", "_northIndices"]]) {
      if (!data.has(other)) continue;
      const border = sideOf(tile, side);
      assert.ok(border.length > 1);
      const [first, last] = [border[0][0], border.at(-1)[0]];
      // The last tiles of a row and a column are cut off at the end of the pack.
      assert.ok(first === 0 && (last === 32767 || !hasWhole(x, y)));
      assert.deepEqual(sideOf(data.get(other), facing), border);
      assert.equal(tile._minimumHeight, data.get(other)._minimumHeight);
      assert.equal(tile._maximumHeight, data.get(other)._maximumHeight);
      ++borders;
    }
  }
  assert.ok(borders > 10);
});

// Not at the rim of the pack either, where rounding may move a place to the other side.
function isWithin([x, y]) {
  const [east, north] = pack.tileBox(pack.columns * pack.rows - 1).slice(2);
  const { step } = pack.header.axes.x;
  return x < east - step && y < north - step;
}

// Twice the area of a tile's triangles, all of which must turn the same way, and their edges by how often they occur.
function areaOf({ _indices: indices, _uValues: us, _vValues: vs }) {
  let area = 0;
  const open = new Set();
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = indices.subarray(t, t + 3);
    const turn = (us[b] - us[a]) * (vs[c] - vs[a]) - (vs[b] - vs[a]) * (us[c] - us[a]);
    assert.ok(turn > 0);
    area += turn;
    for (const [from, to] of [[a, b], [b, c], [c, a]]) {
      if (!open.delete(`${to} ${from}`)) open.add(`${from} ${to}`);
    }
  }
  return { area, open };
}

test("coarser levels have fewer vertices and no cracks, and are near", async (t) => {
  let before = Infinity, finest;
  for (let level = levels - 1; level >= 0; --level) {
    const fresh = cesiumTerrain(cesium, await Pack.open(file)); // which remembers no finer tiles
    let vertices = 0, worst = 0, squares = 0, places = 0;
    for (const [x, y] of tilesOf(level)) {
      const data = await fresh.requestTileGeometry(x, y, level);
      vertices += data._uValues.length;
      const { open } = areaOf(data);
      for (const edge of open) { // at the rim alone
        const [a, b] = edge.split(" ").map(Number);
        assert.ok([data._uValues, data._vValues].some((values) => values[a] === values[b]), "a crack");
      }
      const height = heightsOf(data, x, y, level), [west, south, east, north] = boxOf(x, y, level);
      for (let i = 1; i < 40; ++i) {
        const place = [west + ((east - west) * i) / 40, south + ((north - south) * ((7 * i) % 40)) / 40];
        if (!isWithin(place)) continue;
        const error = Math.abs(height(...place) - await pack.heightAt(...place));
        worst = Math.max(worst, error);
        squares += error ** 2;
        ++places;
      }
    }
    const error = provider.getLevelMaximumGeometricError(level);
    const rms = Math.sqrt(squares / places);
    t.diagnostic(`level ${level}: ${vertices} vertices, ${rms.toFixed(2)} m off the finest (root mean square), ` +
      `at most ${worst.toFixed(1)}; said: ${error.toFixed(1)}`);
    assert.ok(vertices <= before && rms <= error);
    before = vertices;
    finest ??= vertices;
  }
  assert.ok(before < 0.4 * finest);
});

test("coarse levels of one tile take fewer bytes", async (t) => {
  const fresh = await Pack.open(file);
  await cesiumTerrain(cesium, fresh).requestTileGeometry(0, 0, 0);
  t.diagnostic(`${fresh.bytesRead} of ${file.length} bytes for level 0`);
  assert.ok(fresh.bytesRead < 0.75 * file.length);
});

test("beyond the pack tiles are empty, and Cesium is told not to divide them", async () => {
  const level = levels - 1;
  const [columns, rows] = countsAt(level);
  const [x, y] = [columns - 1, 0];
  assert.ok(columns > pack.columns && rows > pack.rows, "the grid is larger than the pack");
  const data = await provider.requestTileGeometry(x, y, level);
  assert.deepEqual([...data._indices], [0, 0, 0]);
  assert.ok(provider.getTileDataAvailable(2 * x, 2 * y, level + 1));
  assert.deepEqual([...(await provider.requestTileGeometry(2 * x, 2 * y, level + 1))._indices], [0, 0, 0]);
  assert.equal(provider.getTileDataAvailable(0, 2 * rows - 1, level + 1), false);
});

test("Cesium asks again when too much is asked for", async () => {
  const asked = Array.from({ length: 40 }, () => provider.requestTileGeometry(0, 0, levels - 1));
  assert.ok(asked.some((answer) => answer === undefined));
  await Promise.all(asked);
  assert.ok(await provider.requestTileGeometry(0, 0, 0));
});

test("a damaged tile is an error of its own", async () => {
  const damaged = file.slice();
  damaged[damaged.length - 3] ^= 1;
  const broken = cesiumTerrain(cesium, await Pack.open(damaged));
  const [, rows] = countsAt(levels - 1);
  await assert.rejects(broken.requestTileGeometry(pack.columns - 1, rows - pack.rows, levels - 1), { status: "CHECKSUM" });
  assert.ok(await broken.requestTileGeometry(0, rows - 1, levels - 1));
});

test("another system or unit is an exception that says so", async () => {
  const metres = await Pack.open(degrees("metres", { size: 65, cell: 30, encode: ["--max-error", "4", "--tile-vertices", "500", "--epsg", "32632"] }));
  assert.throws(() => cesiumTerrain(cesium, metres), { name: "RangeError", message: /EPSG:4326, not in EPSG:32632/ });
  const unknown = await Pack.open(degrees("unknown", { size: 65, cell: 30, encode: ["--max-error", "4", "--tile-vertices", "500", "--units", "metre"] }));
  assert.throws(() => cesiumTerrain(cesium, unknown), { name: "RangeError", message: /an unknown system/ });
  const feet = await Pack.open(degrees("feet", { size: 65, encode: ["--max-error", "4", "--tile-vertices", "500", "--epsg", "4326", "--units", "degree:foot"] }));
  assert.throws(() => cesiumTerrain(cesium, feet), { name: "RangeError", message: /metre, not/ });
});

test("a credit is shown", () => {
  assert.equal(cesiumTerrain(cesium, pack, { credit: "a survey" }).credit.html, "a survey");
});
