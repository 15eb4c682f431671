// SPDX-License-Identifier: MIT
// Where packs are read from: functions and servers that keep their promises, and those that do not.
import assert from "node:assert/strict";
import test from "node:test";
import zlib from "node:zlib";
import { areaBytes, microtin, served, skip } from "./support.mjs";

const { MicrotinError, Pack } = microtin;
const many = areaBytes("many.mtp"), phases = areaBytes("phases.mtp");

const tilesOf = (pack) => Array.from({ length: pack.columns * pack.rows }, (_, tile) => tile);
const isFailure = (error) => error instanceof MicrotinError && error.status === "IO";

// What every source must give: all heights of a row of tiles.
async function heightsIn(pack) {
  const heights = [];
  for (let tile = 0; tile < pack.columns; ++tile) {
    const [x, y, right, top] = pack.tileBox(tile);
    heights.push(await pack.heightAt((x + right) / 2, (y + top) / 2));
  }
  return heights;
}
const whole = many && await Pack.open(many);
const expected = many && await heightsIn(whole);

// A server of many.mtp: what it answers to bytes from .. to.
function part(response, [from, to], { headers = {}, body = many.subarray(from, to + 1), status = 206 } = {}) {
  const range = `bytes ${from}-${Math.min(to, many.length - 1)}/${many.length}`;
  response.writeHead(status, { "Content-Range": range, ...headers }).end(body);
}

test("a whole view costs the file once, however few tiles are kept", { skip }, async () => {
  for (const bytes of [many, phases]) {
    let sent = 0;
    const count = (piece) => {
      sent += piece.length;
      return piece;
    };
    const view = async (source) => {
      sent = 0;
      const pack = await Pack.open(source, { slots: 1 });
      for (const tile of tilesOf(pack)) for await (const _ of pack.tilePhases(tile)) break;
      const first = pack.bytesRead;
      for (const tile of tilesOf(pack)) await pack.tile(tile);
      for (const tile of tilesOf(pack)) for await (const _ of pack.tilePhases(tile));
      assert.equal(pack.bytesRead, bytes.length);
      assert.ok(first <= bytes.length);
      return pack;
    };
    await view(async (offset, size) => count(bytes.subarray(offset, offset + size)));
    assert.equal(sent, bytes.length);
    for (const source of [bytes, new Blob([bytes])]) assert.equal((await view(source)).size, bytes.length);
    await served((response, [from, to]) => {
      const piece = count(bytes.subarray(from, to + 1));
      response.writeHead(206, { "Content-Range": `bytes ${from}-${from + piece.length - 1}/${bytes.length}` }).end(piece);
    }, async (url) => assert.equal((await view(url)).size, bytes.length));
    assert.equal(sent, bytes.length);
  }
});

test("a cache of any size changes no height", { skip }, async () => {
  for (const cacheBytes of [0, 500, 20_000]) {
    const source = async (offset, size) => many.subarray(offset, offset + size);
    assert.deepEqual(await heightsIn(await Pack.open(source, { slots: 1, cacheBytes })), expected);
  }
});

test("reads of a few bytes go on, and each is asked for once", { skip }, async () => {
  for (const most of [1, 7, 1000]) {
    const asked = new Set();
    const pack = await Pack.open(async (offset, size) => {
      assert.ok(size > 0 && !asked.has(offset), `${offset}`);
      asked.add(offset);
      return many.subarray(offset, offset + Math.min(size, most));
    });
    assert.deepEqual(await heightsIn(pack), expected);
    assert.deepEqual(pack.header, whole.header);
    assert.ok(pack.bytesRead <= many.length);
  }
  for (const most of [10, 1024]) {
    await served((response, [from, to]) => part(response, [from, Math.min(to, from + most - 1)]), async (url) => {
      assert.deepEqual(await heightsIn(await Pack.open(url)), expected);
    });
  }
});

test("a buffer that is used again changes nothing", { skip }, async () => {
  const buffer = new Uint8Array(8192);
  const pack = await Pack.open(async (offset, size) => {
    const piece = many.subarray(offset, offset + size);
    buffer.fill(0xee).set(piece);
    return buffer.subarray(0, piece.length);
  });
  assert.deepEqual(await heightsIn(pack), expected);
});

// What may come instead of at most `size` bytes at `offset`.
const BROKEN = {
  "more bytes": (offset, size) => many.subarray(offset, offset + size + 1),
  nothing: () => undefined,
  null: () => null,
  text: () => "abc",
  "an array": () => [1, 2, 3],
  "an ArrayBuffer": () => new ArrayBuffer(8),
  "other numbers": () => new Uint16Array(4),
  "a number": () => 5,
  "an error": () => { throw new Error("no"); },
  "no error at all": () => Promise.reject(undefined),
};

test("a read function that does not keep its promise is an IO error, and may be asked again", { skip }, async () => {
  for (const [name, broken] of Object.entries(BROKEN)) {
    await assert.rejects(Pack.open(async (...range) => broken(...range)), isFailure, name);
    let isBroken = false;
    const pack = await Pack.open(async (offset, size) =>
      isBroken ? broken(offset, size) : many.subarray(offset, offset + size));
    const last = pack.columns * pack.rows - 1;
    isBroken = true;
    for (let attempt = 0; attempt < 2; ++attempt) await assert.rejects(pack.tile(last), isFailure, name);
    isBroken = false;
    assert.ok((await pack.tile(last)).done);
  }
});

test("a file that ends too early is told for every tile that it lacks", { skip }, async () => {
  const end = many.length - 100;
  const short = many.subarray(0, end);
  for (const source of [short, new Blob([short]), async (offset, size) => short.subarray(offset, offset + size)]) {
    const pack = await Pack.open(source);
    await assert.rejects(pack.tile(pack.columns * pack.rows - 1), { status: "TRUNCATED" });
    assert.deepEqual(await heightsIn(pack), expected);
  }
  for (const length of [0, 1, 39, 50]) {
    const few = many.subarray(0, length);
    await assert.rejects(Pack.open(few), { status: "TRUNCATED" });
    await assert.rejects(Pack.open(async (offset, size) => few.subarray(offset, offset + size)), { status: "TRUNCATED" });
  }
});

const GOOD_ANSWERS = {
  "no Content-Range, as other origins show none": (response, range) => {
    response.writeHead(206).end(many.subarray(range[0], range[1] + 1));
  },
  "more than was asked for": (response, [from, to]) => part(response, [from, to + 100]),
  "a size that is not told": (response, [from, to]) => {
    const body = many.subarray(from, to + 1);
    response.writeHead(206, { "Content-Range": `bytes ${from}-${from + body.length - 1}/*` }).end(body);
  },
  "all of it": (response) => response.writeHead(200).end(many),
  "all of it, zipped": (response) => response.writeHead(200, { "Content-Encoding": "gzip" }).end(zlib.gzipSync(many)),
};

test("answers that differ from what was asked for, and are right", { skip }, async () => {
  for (const [name, answer] of Object.entries(GOOD_ANSWERS)) {
    await served(answer, async (url) => {
      assert.deepEqual(await heightsIn(await Pack.open(url)), expected, name);
    });
  }
});

const BAD_ANSWERS = {
  "another place": (response, [from, to]) => part(response, [from + 1, to + 1]),
  "a range longer than its bytes": (response, [from, to]) => part(response, [from, to], { body: many.subarray(from, to) }),
  "a range shorter than its bytes": (response, [from, to]) => part(response, [from, to], { body: many.subarray(from, to + 5) }),
  "a range beyond the file": (response, [from, to]) =>
    part(response, [from, to], { headers: { "Content-Range": `bytes ${from}-${to}/10` } }),
  "a range that is none": (response, range) => part(response, range, { headers: { "Content-Range": "bytes=0-" } }),
  "more, and no Content-Range": (response, [from, to]) => response.writeHead(206).end(many.subarray(from, to + 2)),
  "no bytes": (response, range) => part(response, range, { body: "" }),
  "several parts": (response, [from, to]) => response.writeHead(206, {
    "Content-Type": "multipart/byteranges; boundary=x" }).end(many.subarray(from, to)),
  "a zipped part of the zipped file": (response, [from, to]) =>
    part(response, [from, to], { headers: { "Content-Encoding": "gzip" } }),
  "not found": (response) => response.writeHead(404).end("no"),
  "a failure": (response) => response.writeHead(500).end("no"),
  "no content": (response) => response.writeHead(204).end(),
  "accepted": (response) => response.writeHead(202).end("later"),
  "a range that it refuses, of a file that has it": (response) =>
    response.writeHead(416, { "Content-Range": `bytes */${many.length}` }).end(),
  "a body that breaks off": (response) => {
    response.writeHead(200, { "Content-Length": many.length }).write(many.subarray(0, 100));
    setTimeout(() => response.destroy(), 20);
  },
};

test("wrong answers are IO errors, at first and later, and may be asked again", { skip }, async () => {
  for (const [name, wrong] of Object.entries(BAD_ANSWERS)) {
    let answer = wrong;
    await served((...request) => answer(...request), async (url) => {
      await assert.rejects(Pack.open(url), isFailure, name);
      answer = part;
      const pack = await Pack.open(url);
      const last = pack.columns * pack.rows - 1;
      answer = wrong;
      await assert.rejects(pack.tile(last), isFailure, name);
      answer = part;
      assert.ok((await pack.tile(last)).done);
    });
  }
});

test("a server that has nothing at the beginning has an empty file", { skip }, async () => {
  await served((response) => response.writeHead(416).end(), (url) =>
    assert.rejects(Pack.open(url), { status: "TRUNCATED" }));
});

test("a file that changes while it is read is an IO error", { skip }, async () => {
  let size = many.length;
  await served((response, [from, to]) =>
    part(response, [from, to], { headers: { "Content-Range": `bytes ${from}-${to}/${size}` } }), async (url) => {
    const pack = await Pack.open(url);
    size += 1;
    await assert.rejects(pack.tile(200), isFailure);
  });
});

test("what is no source is told", async () => {
  for (const source of [undefined, null, 5, {}, [1], new ArrayBuffer(8), new Uint16Array(3)]) {
    await assert.rejects(Pack.open(source), TypeError);
  }
});
