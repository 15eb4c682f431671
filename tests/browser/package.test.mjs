// SPDX-License-Identifier: MIT
// The npm package as others see it: by publint, are-the-types-wrong and tsc, by loaders.gl, and by who reads its README.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import test, { after } from "node:test";
import { load, loadInBatches } from "@loaders.gl/core";
import { QuantizedMeshLoader } from "@loaders.gl/terrain";
import { MicrotinLoader } from "microtin/loader";
import { degrees, folder, golden, microtin, npm, remove, served } from "./files.mjs";

const here = import.meta.dirname;
const tool = (name, ...words) => execFileSync(process.execPath, [path.join(here, "node_modules", name), ...words],
  { cwd: here, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const bytesOf = (name) => fs.readFileSync(path.join(golden, name));

after(remove);

test("publint and are-the-types-wrong have no complaint", () => {
  assert.match(tool("publint/src/cli.js", "--strict", npm), /All good/);
  tool("@arethetypeswrong/cli/dist/index.js", "--pack", npm, "--profile", "esm-only");
});

// --- loaders.gl.

test("loaders.gl loads a stream, whole and by phases", async () => {
  const bytes = bytesOf("sections.mtin");
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const mesh = await load(buffer, MicrotinLoader);
  assert.equal(mesh.attributes.POSITION.value.length, 3 * mesh.header.vertexCount);
  await served((request, response) => response.writeHead(200).end(bytes), async (address) => {
    const chosen = await load(`${address}/sections.mtin`, [QuantizedMeshLoader, MicrotinLoader]); // by its name
    assert.deepEqual(chosen, mesh);
    const batches = [];
    for await (const batch of await loadInBatches(`${address}/sections.mtin`, MicrotinLoader)) batches.push(batch);
    assert.ok(batches.length > 1);
    assert.deepEqual(batches.at(-1).indices.value, mesh.indices.value);
  });
  await assert.rejects(load(buffer.slice(0, -1), MicrotinLoader), { status: "TRUNCATED" });
});

// A quantized mesh of one triangle: header, vertices (zigzag differences), indices, four sides.
function quantizedMesh() {
  const header = Buffer.alloc(88);
  header.writeFloatLE(100, 28);
  const zigzag = (values) => values.map((value, i) => value - (values[i - 1] ?? 0)).map((n) => (n << 1) ^ (n >> 31));
  const numbers = (values) => Buffer.from(Uint16Array.from(values).buffer);
  const count = (n) => Buffer.from(Uint32Array.of(n).buffer);
  const vertices = [[0, 32767, 0], [0, 0, 32767], [0, 16000, 32767]].flatMap(zigzag);
  return Buffer.concat([header, count(3), numbers(vertices), count(1), numbers([0, 0, 0]), ...[0, 0, 0, 0].map(count)]);
}

// The kinds of an object's values, by the paths to them.
function shapeOf(value, at = "") {
  if (ArrayBuffer.isView(value)) return { [at]: "numbers" };
  if (Array.isArray(value)) return { [at]: "list" };
  if (typeof value !== "object" || value === null) return { [at]: typeof value };
  return Object.assign({}, ...Object.entries(value).map(([key, inner]) => shapeOf(inner, `${at}.${key}`)));
}

test("the mesh has the shape of loaders.gl's quantized meshes", async () => {
  const bytes = quantizedMesh();
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const theirs = shapeOf(await load(buffer, QuantizedMeshLoader, { worker: false }));
  const ours = shapeOf(await load(new Uint8Array(bytesOf("hills.mtin")).buffer, MicrotinLoader));
  // They have no schema yet, and say nothing of texture coordinates that positions do not.
  const common = Object.keys(theirs).filter((key) => key !== ".schema" && !key.startsWith(".attributes.TEXCOORD_0"));
  assert.ok(common.length >= 8);
  for (const key of common) assert.equal(ours[key], theirs[key], key);
});

// --- The README, from its beginning.

const snippets = [...fs.readFileSync(path.join(npm, "README.md"), "utf8").matchAll(/^```js\n(.*?)^```/gms)].map(([, code]) => code);

// What the snippets take from their surroundings.
const GIVEN = `
import fs from "node:fs";
const file = (name: string): string => ${"`${process.env.MICROTIN_FILES}/${name}`"};
globalThis.fetch = async (url: any, options?: any) => {
  const bytes = fs.readFileSync(file(String(url).split("/").at(-1)!));
  const [from, to] = (options?.headers?.Range ?? "bytes=0-").match(/\\d+/g).map(Number);
  return new Response(bytes.subarray(from, (to ?? bytes.length) + 1), { status: to === undefined ? 200 : 206 });
};
const bytes: Uint8Array = fs.readFileSync(file("area.mtin"));
let drawn = 0;
function draw(positions: Float32Array, indices: Uint32Array) { drawn += positions.length && indices.length ? 1 : 0; }
const [x0, y0, x1, y1] = [7.01, 43.01, 7.02, 43.02];
`;

test("every snippet of the README has right types, and runs", () => {
  assert.ok(snippets.length >= 3);
  degrees("area", { size: 129, encode: ["--max-error", "4", "--tile-vertices", "500"] });
  microtin("encode", "area.asc", "--fast", "--epsg", "4326", "--units", "degree:metre", "--max-error", "4", "-o", "area.mtin");
  const programs = snippets.map((code, i) => {
    const name = path.join(here, `snippet${i}.ts`);
    fs.writeFileSync(name, `${GIVEN}${code}\nif (${/draw\(/.test(code)} && drawn < 3) throw new Error("nothing drawn");\n`);
    return name;
  });
  tool("typescript/bin/tsc", "--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom,dom.iterable,dom.asynciterable",
    "--skipLibCheck", "--types", "node", ...programs);
  for (const program of programs) {
    execFileSync(process.execPath, [program.replace(/ts$/, "js")], { env: { ...process.env, MICROTIN_FILES: folder } });
  }
});
