// SPDX-License-Identifier: MIT
// The package as a whole: its size, its entry points, the loader.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import test from "node:test";
import zlib from "node:zlib";
import { goldenBytes, microtin } from "./support.mjs";

const folder = process.env.MICROTIN_NPM;
const size = (bytes) => zlib.gzipSync(bytes, { level: 9 }).length;

test("the module takes at most 29 KB gzipped, its WebAssembly 39 KB and 20, without packs 24 and 13", (t) => {
  const module = size(fs.readFileSync(path.join(folder, "microtin.js")));
  t.diagnostic(`module ${module} bytes gzipped`);
  assert.ok(module <= 29 * 1024);
  for (const [name, most, mostGzipped] of [["microtin", 39, 20], ["streams", 24, 13]]) {
    const wasm = fs.readFileSync(path.join(folder, `../decoder/packages/npm/${name}.opt.wasm`));
    t.diagnostic(`${name}: WebAssembly ${wasm.length}, ${size(wasm)} gzipped`);
    assert.ok(wasm.length <= most * 1024 && size(wasm) <= mostGzipped * 1024);
  }
});

test("every file that the package names is there, and its version is the library's", () => {
  const description = JSON.parse(fs.readFileSync(path.join(folder, "package.json"), "utf8"));
  const named = Object.values(description.exports).flatMap((entry) => (entry.types ? [entry.types, entry.default] : [entry]));
  for (const file of [...named, "README.md", "LICENSE"]) assert.ok(fs.existsSync(path.join(folder, file)), file);
  assert.match(description.version, /^\d+\.\d+\.\d+$/);
  assert.equal(microtin.version, description.version);
});

test("the types name what the module exports", () => {
  const types = fs.readFileSync(path.join(folder, "microtin.d.ts"), "utf8");
  for (const name of Object.keys(microtin)) {
    assert.match(types, new RegExp(`export (const|function|class|interface) ${name}\\b`), name);
  }
});

test("the loader makes a mesh, and one for each phase", async () => {
  const { MicrotinLoader } = await import(path.join(folder, "loader.js"));
  const bytes = goldenBytes("sections.mtin");
  const mesh = await MicrotinLoader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  assert.equal(mesh.attributes.POSITION.value.length, 3 * mesh.header.vertexCount);
  assert.equal(mesh.mode, 4);
  const batches = [];
  for await (const batch of MicrotinLoader.parseInBatches([bytes])) batches.push(batch);
  assert.ok(batches.length > 1);
  assert.deepEqual(batches.at(-1).indices.value, mesh.indices.value);
});
