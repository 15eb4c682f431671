// SPDX-License-Identifier: MIT
// How few bytes of a pack make the first picture: its header, the entries of the tiles in view, their first sections.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { Decoder, Pack, ready } from "microtin";
import { degrees, remove } from "./files.mjs";

after(remove);
await ready;

const ENTRY = 20, AHEAD = 4096, PIECE = 1024; // format-pack.md, section 2; src/source.js; src/pack.js

// Where the index begins: behind the fixed header, placement, notes and check.
function indexOf(bytes) {
  return 48 + bytes[6] + (bytes[8] | (bytes[9] << 8)) + 4;
}

// The bytes of a tile's stream up to the end of its first section.
function firstSection(bytes, tiles, tile) {
  const entry = indexOf(bytes) + ENTRY * tile;
  const number = (at, size) => Array.from({ length: size }, (_, i) => bytes[at + i] * 256 ** i).reduce((a, b) => a + b);
  const start = indexOf(bytes) + ENTRY * tiles + number(entry, 5);
  const [terrain] = new Decoder().push(bytes.slice(start, start + number(entry + 5, 3)));
  return terrain.bytes;
}

test("the first picture of a pack takes header, entries and first sections", async (t) => {
  const bytes = degrees("area", { // of degree 6: with many phases
    size: 385, encode: ["--max-error", "1", "--max-degree", "6", "--tile-vertices", "20000", "--tile-size", "130"],
  });
  const pack = await Pack.open(bytes);
  const [x, y] = pack.tileBox(Math.floor((pack.columns * pack.rows) / 2));
  const { step } = pack.header.axes.x;
  for (const [name, tiles] of [["four tiles", pack.tilesIn(x - step, y - step, x + step, y + step)],
    ["all", Array.from({ length: pack.columns * pack.rows }, (_, tile) => tile)]]) {
    const fresh = await Pack.open(bytes);
    const sections = tiles.map((tile) => firstSection(bytes, pack.columns * pack.rows, tile)).reduce((a, b) => a + b);
    for (const tile of tiles) {
      for await (const mesh of fresh.tilePhases(tile)) {
        assert.ok(mesh.indices.length > 0);
        break;
      }
    }
    t.diagnostic(`${name}: ${fresh.bytesRead} of ${bytes.length} bytes; first sections have ${sections}`);
    // A piece is as large as all before it, and one more of the least size.
    const index = Math.ceil((indexOf(bytes) + ENTRY * pack.columns * pack.rows) / AHEAD) * AHEAD;
    assert.ok(fresh.bytesRead <= index + 2 * sections + PIECE * tiles.length);
    assert.ok(fresh.bytesRead < bytes.length / 2);
  }
});
