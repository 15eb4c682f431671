// SPDX-License-Identifier: MIT
// Streams: every golden one, in pieces, damaged; phases; heights.
import assert from "node:assert/strict";
import test from "node:test";
import {
  areaBytes, goldenBytes, goldenNames, grown, microtin, refusedBytes, refusedNames, reportOf, skip,
} from "./support.mjs";

const { Decoder, MicrotinError, decode, decodeStream } = microtin;

function piecesOf(bytes, size) {
  return Array.from({ length: Math.ceil(bytes.length / size) }, (_, i) => bytes.subarray(i * size, (i + 1) * size));
}

// Twice the area, on the plane.
function turn(positions, indices, t) {
  const [a, b, c] = [0, 1, 2].map((i) => 3 * indices[t + i]);
  return (positions[b] - positions[a]) * (positions[c + 1] - positions[a + 1]) -
    (positions[b + 1] - positions[a + 1]) * (positions[c] - positions[a]);
}

test("golden streams have the digests that the host printed", () => {
  assert.ok(goldenNames.length > 5);
  for (const name of goldenNames) {
    const terrain = decode(goldenBytes(name));
    assert.equal(terrain.digest.toString(16).padStart(16, "0"), reportOf(name).digest, name);
    assert.equal(terrain.vertexCount, Number(reportOf(name).vertices), name);
    assert.equal(terrain.positions.length, 3 * terrain.vertexCount);
  }
});

test("pieces of any size change nothing", async () => {
  const bytes = goldenBytes("sections.mtin");
  for (const size of [1, 7, 1000]) {
    let last;
    for await (last of decodeStream(piecesOf(bytes, size)));
    assert.ok(last.done);
    assert.equal(last.digest, decode(bytes).digest);
    assert.equal(last.bytes, bytes.length);
  }
});

test("a response, a blob and a stream can be decoded as they arrive", async () => {
  const bytes = goldenBytes("hills.mtin");
  for (const source of [new Response(bytes), new Blob([bytes]), new Blob([bytes]).stream()]) {
    let last;
    for await (last of decodeStream(source));
    assert.equal(last.digest, decode(bytes).digest);
  }
});

test("vertices that a header alone announces take no memory", { skip }, async () => {
  const bytes = areaBytes("all.mtin");
  const { vertices } = decode(bytes).header;
  assert.equal(vertices, 257 * 257);
  const length = bytes[5] & 128 ? ((bytes[5] & 127) << 7) | bytes[6] : bytes[5];
  const header = 5 + (bytes[5] & 128 ? 2 : 1) + length + 4; // the identity, the length, so many bytes, their check
  const enough = header + Math.ceil((vertices - 3) / 1421);
  const decoder = new Decoder();
  const before = await grown(() => {
    for (let n = 0; n + 1 < enough; ++n) for (const _ of decoder.push(bytes.subarray(n, n + 1)));
  });
  assert.equal(decoder.terrain, undefined);
  assert.equal(before.bytes, 0);
  const { bytes: taken } = await grown(() => {
    for (const _ of decoder.push(bytes.subarray(enough - 1, enough)));
  });
  assert.equal(decoder.terrain.header.vertices, vertices);
  assert.ok(taken > 60 * vertices);
  for (const _ of decoder.push(bytes.subarray(enough)));
  assert.equal(decoder.finish().digest, decode(bytes).digest);
  const cut = new Decoder();
  cut.push(bytes.subarray(0, enough - 1));
  assert.throws(() => cut.finish(), { status: "TRUNCATED" });
});

test("phases grow, each a complete triangulation", () => {
  const decoder = new Decoder();
  const counts = [];
  for (const terrain of decoder.push(goldenBytes("sections.mtin"))) {
    counts.push(terrain.vertexCount);
    const { positions, indices } = terrain;
    assert.ok(indices.length > 0);
    for (let t = 0; t < indices.length; t += 3) assert.ok(turn(positions, indices, t) > 0);
  }
  assert.ok(counts.length > 1);
  assert.deepEqual(counts, [...counts].sort((a, b) => a - b));
  assert.equal(decoder.finish().vertexCount, counts.at(-1));
});

test("a vertex has its height, a middle of a triangle the mean of three", () => {
  const terrain = decode(goldenBytes("hills.mtin"));
  const { origin, positions, indices } = terrain;
  const { step } = terrain.header.axes.z;
  const at = (v, i) => (i < 2 ? origin[i] : 0) + positions[3 * v + i];
  for (let v = 0; v < terrain.vertexCount; ++v) {
    assert.ok(Math.abs(terrain.heightAt(at(v, 0), at(v, 1)) - at(v, 2)) < step / 100);
  }
  for (let t = 0; t < indices.length; t += 300) {
    const corners = [...indices.subarray(t, t + 3)];
    const [x, y, z] = [0, 1, 2].map((i) => corners.reduce((sum, v) => sum + at(v, i), 0) / 3);
    const spread = Math.max(...corners.map((v) => at(v, 2))) - Math.min(...corners.map((v) => at(v, 2)));
    assert.ok(Math.abs(terrain.heightAt(x, y) - z) < spread / 100 + step / 100);
  }
  assert.ok(Number.isNaN(terrain.heightAt(-1e9, 0)));
  assert.ok(Number.isNaN(terrain.heightAt(NaN, 0)));
});

test("voids are no terrain", () => {
  const terrain = decode(goldenBytes("voids.mtin"));
  assert.ok(terrain.voids.length > 0);
  const [a, b, c] = [0, 1, 2].map((i) => terrain.voids[i]);
  const middle = (i) => [a, b, c].reduce((sum, v) => sum + terrain.positions[3 * v + i], 0) / 3;
  assert.ok(Number.isNaN(terrain.heightAt(terrain.origin[0] + middle(0), terrain.origin[1] + middle(1))));
});

test("the header tells units, systems, accuracy", () => {
  const { header } = decode(goldenBytes("hills.mtin"));
  assert.deepEqual(header.units, { horizontal: "degree", vertical: "metre" });
  assert.deepEqual(header.epsg, { horizontal: 4326, vertical: 5773 });
  assert.deepEqual(header.accuracy, { bound: 10, largest: 9.9, rms: 3.45, mean: -0.12 });
});

test("the header has what its maker states of the source", () => {
  const { header } = decode(goldenBytes("notes.mtin"));
  assert.equal(header.attribution, "\u00a9 the <survey>\u001b");
  assert.equal(header.license, "CC-BY-4.0");
  assert.equal(header.valid, "2024-01/..");
  assert.equal(header.epoch, 2020.5);
  assert.deepEqual(header.sourceAccuracy, { kind: "LE90", value: 4 });
  assert.equal(header.digest, decode(goldenBytes("notes.mtin")).digest);
  assert.deepEqual(header.phases, [{ vertices: 60, bytes: goldenBytes("notes.mtin").length, largest: 9.9 }]);
  const bare = decode(goldenBytes("hills.mtin")).header;
  for (const name of ["attribution", "license", "valid", "epoch", "sourceAccuracy", "digest", "phases"]) assert.equal(bare[name], undefined);
});

test("the header tells how far the surface is from its source everywhere, if it states that", () => {
  assert.deepEqual(decode(goldenBytes("later.mtin")).header.everywhere, { below: 0, above: 65536 });
  assert.equal(decode(goldenBytes("hills.mtin")).header.everywhere, undefined);
});

test("what must be refused is, with its status", () => {
  assert.ok(refusedNames.length > 0);
  for (const name of refusedNames) assert.throws(() => decode(refusedBytes(name)), MicrotinError, name);
  const status = (bytes) => {
    try {
      decode(bytes);
    } catch (error) {
      return error.status;
    }
  };
  const bytes = goldenBytes("hills.mtin");
  assert.equal(status(bytes.subarray(0, -1)), "TRUNCATED");
  assert.equal(status(bytes.subarray(0, 3)), "TRUNCATED");
  assert.equal(status(new Uint8Array(100)), "BAD_MAGIC");
  const damaged = bytes.slice();
  damaged[damaged.length >> 1] ^= 4;
  assert.equal(status(damaged), "CHECKSUM");
});

test("every damaged byte is told, and the module goes on", () => {
  const bytes = goldenBytes("example.mtin");
  for (let i = 0; i < bytes.length; ++i) {
    const damaged = bytes.slice();
    damaged[i] ^= 1;
    assert.throws(() => decode(damaged), MicrotinError);
  }
  assert.equal(decode(bytes).vertexCount, 6);
});

// Metres of a unit of x and y at a place, and of a unit of heights.
function metresOf({ units }, y) {
  const feet = { "international foot": 0.3048, "US survey foot": 1200 / 3937 };
  const other = feet[units?.horizontal] ?? 1;
  const radian = Math.PI / 180, sine = Math.sin(y * radian), square = 0.0066943799901413;
  const root = Math.sqrt(1 - square * sine * sine), equator = 6378137 * radian;
  const [x, north] = units?.horizontal === "degree"
    ? [(equator * Math.cos(y * radian)) / root, (equator * (1 - square)) / root ** 3]
    : [other, other];
  return { x, y: north, z: feet[units?.vertical] ?? 1 };
}

test("a gradient is that of the triangle, in metres for a metre", () => {
  let found = 0;
  for (const name of goldenNames) {
    const terrain = decode(goldenBytes(name));
    for (let i = 0; i < terrain.indices.length; i += 3 * Math.ceil(terrain.indices.length / 300)) {
      const [a, b, c] = [0, 1, 2].map((k) =>
        [0, 1, 2].map((axis) => terrain.positions[3 * terrain.indices[i + k] + axis]));
      const [bx, by, bz, cx, cy, cz] = [...b.map((v, k) => v - a[k]), ...c.map((v, k) => v - a[k])];
      const area = bx * cy - cx * by, { axes } = terrain.header;
      const [sx, sy] = [axes.x.step, axes.y.step];
      const longest = Math.max(...[[bx, by], [cx, cy], [bx - cx, by - cy]].map(([x, y]) => Math.hypot(x / sx, y / sy)));
      if (area / sx / sy < longest) continue; // thin, and the middle is rounded to 1/256 of a step
      const y = terrain.origin[1] + (a[1] + b[1] + c[1]) / 3;
      const { east, north } = terrain.gradientAt(terrain.origin[0] + (a[0] + b[0] + c[0]) / 3, y);
      const metres = metresOf(terrain.header, y);
      const expected = [(bz * cy - cz * by) / area / metres.x, (bx * cz - cx * bz) / area / metres.y];
      for (const [is, should] of [[east, expected[0]], [north, expected[1]]]) {
        assert.ok(Math.abs(is - should * metres.z) <= 1e-3 * (Math.abs(should * metres.z) + 1e-3), `${name} ${is} ${should}`);
      }
      ++found;
    }
    assert.deepEqual(terrain.gradientAt(NaN, 0), { east: NaN, north: NaN });
    assert.deepEqual(terrain.gradientAt(-1e12, 0), { east: NaN, north: NaN });
    assert.throws(() => terrain.gradientAt(0), TypeError);
  }
  assert.ok(found > 100);
});

test("a profile has the heights of the terrain, in order, and its ends", () => {
  for (const name of goldenNames) {
    const terrain = decode(goldenBytes(name));
    const { axes } = terrain.header, { origin, positions } = terrain;
    const far = positions.length - 3;
    const ends = [0, far].flatMap((i) => [origin[0] + positions[i], origin[1] + positions[i + 1]]);
    const places = terrain.profile(...ends);
    assert.ok(places.length >= 2, name);
    assert.equal(places[0].along, 0);
    assert.equal(places.at(-1).along, 1);
    assert.equal(places[0].isKnownBefore, false);
    places.forEach(({ along, x, y, height, isKnownBefore }, i) => {
      if (i === 0) return;
      assert.ok(along >= places[i - 1].along);
      const [mx, my] = [(x + places[i - 1].x) / 2, (y + places[i - 1].y) / 2];
      const middle = terrain.heightAt(mx, my); // at the nearest 1/256 of a step
      const steep = 2 + Math.abs(height - places[i - 1].height) / axes.z.step;
      if (isKnownBefore && along - places[i - 1].along > 1e-3) {
        assert.ok(Math.abs(middle - (height + places[i - 1].height) / 2) < steep * axes.z.step, `${name} ${mx} ${my}`);
      }
    });
    assert.deepEqual(terrain.profile(NaN, 0, 1, 1), []);
    assert.deepEqual(terrain.profile(-1e12, 0, 1, 1), []);
    assert.throws(() => terrain.profile(0, 0, 1), TypeError);
  }
});
