// SPDX-License-Identifier: MIT
// The package under test, and files to test it on.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";

export const microtin = await import(path.join(process.env.MICROTIN_NPM, "microtin.js"));
await microtin.ready;

const golden = path.join(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), "../golden/1.0");

export const bytesOf = (file) => new Uint8Array(fs.readFileSync(file));
export const goldenNames = fs.readdirSync(golden).filter((name) => name.endsWith(".mtin"));
export const goldenBytes = (name) => bytesOf(path.join(golden, name));
export const refusedNames = fs.readdirSync(path.join(golden, "refused")).filter((name) => name.endsWith(".mtin"));
export const refusedBytes = (name) => bytesOf(path.join(golden, "refused", name));

// What a host printed of a golden stream: a word, then a value.
export function reportOf(name) {
  const text = fs.readFileSync(path.join(golden, name.replace(/mtin$/, "report")), "utf8");
  return Object.fromEntries(text.trim().split("\n").map((line) => [line.split(" ")[0], line.split(" ").slice(1).join(" ")]));
}

// Files that a host made, by tests/npm/area; undefined without.
export const area = process.env.MICROTIN_AREA || undefined;
export const skip = area ? false : "skipped: no files of a host; tests/devices.sh makes them";
export const areaFile = (ending) => path.join(area, `area.${ending}`);
export const areaBytes = (name) => area && bytesOf(path.join(area, name));

// The bytes of memory that instances ask for while something is done; what that returns, and these.
export async function grown(work) {
  const { grow } = WebAssembly.Memory.prototype;
  let pages = 0;
  WebAssembly.Memory.prototype.grow = function (more) {
    pages += more;
    return grow.call(this, more);
  };
  try {
    return { result: await work(), bytes: 65536 * pages };
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
}

function crc32(bytes, crc) {
  let rest = ~crc;
  for (const byte of bytes) {
    rest ^= byte;
    for (let bit = 0; bit < 8; ++bit) rest = (rest >>> 1) ^ (rest & 1 ? 0xedb88320 : 0);
  }
  return ~rest >>> 0;
}

// A pack with the checks of its header and of the index that belong to what they hold now.
export function withChecks(pack, tiles) {
  const bytes = pack.slice();
  const view = new DataView(bytes.buffer);
  const index = 48 + bytes[6] + view.getUint16(8, true) + 4;
  const identity = view.getUint32(36, true);
  view.setUint32(index - 4, crc32(bytes.subarray(0, index - 4), 0), true);
  for (let tile = 0; tile < tiles; ++tile) {
    const entry = index + 20 * tile;
    const place = new Uint8Array(Uint32Array.of(tile).buffer);
    view.setUint32(entry + 16, crc32(bytes.subarray(entry, entry + 16), crc32(place, identity)), true);
  }
  return bytes;
}

// Runs with a server's address; `answer` handles a request for bytes from .. to.
export async function served(answer, use) {
  const server = http.createServer((request, response) => {
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range);
    answer(response, range && range.slice(1).map(Number));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  try {
    return await use(`http://127.0.0.1:${server.address().port}/area.mtp`);
  } finally {
    server.closeAllConnections();
    server.close();
  }
}

// The heights of an .asc file of square cells: its posts, row by row from the south.
export function postsOf(file) {
  const words = fs.readFileSync(file, "utf8").split(/\s+/).filter(Boolean);
  const header = {};
  while (/^[a-z]/i.test(words[0])) header[words.shift().toLowerCase()] = Number(words.shift());
  const { ncols, nrows, cellsize } = header;
  const [west, south] = [header.xllcenter ?? header.xllcorner + cellsize / 2, header.yllcenter ?? header.yllcorner + cellsize / 2];
  return Array.from({ length: ncols * nrows }, (_, i) => ({
    x: west + (i % ncols) * cellsize,
    y: south + Math.floor(i / ncols) * cellsize,
    z: Number(words[(nrows - 1 - Math.floor(i / ncols)) * ncols + (i % ncols)]),
  }));
}
