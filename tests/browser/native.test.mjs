// SPDX-License-Identifier: MIT
// What decoding takes of a processor and of memory, beside the same on the host.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import test, { after } from "node:test";
import { file, microtin, remove, tool } from "./files.mjs";

after(remove);

const RUNS = 5;

// The memory of each terrain, noted before the module knows its class.
const memories = [];
WebAssembly.Instance = class extends WebAssembly.Instance {
  constructor(...given) {
    super(...given);
    memories.push(this.exports.memory);
  }
};
const { decode, ready } = await import("microtin");

// The least of a few runs of the processor's time, in milliseconds.
const least = (run) => Math.min(...Array.from({ length: RUNS }, run));

function timeOfModule(bytes) {
  return least(() => {
    const before = process.cpuUsage();
    decode(bytes);
    const { user, system } = process.cpuUsage(before);
    return (user + system) / 1000;
  });
}

// The time of a program, as a shell prints it: of children, user and system, each as 0m0.110s.
function timeOfProgram(...words) {
  return least(() => {
    const times = execFileSync("bash", ["-c", '"$@" >/dev/null; times', "bash", ...words]).toString().trim().split("\n").at(-1);
    return times.match(/[\d.]+(?=s)/g).map(Number).reduce((a, b) => a + b) * 1000;
  });
}

test("the module decodes in at most three times the host's time", async (t) => {
  await ready;
  microtin("fractal", "--size", "513", "--seed", "5", "-o", "area.asc");
  microtin("encode", "area.asc", "--units", "metre", "--max-error", "0", "--fast", "-o", "area.mtin");
  const bytes = new Uint8Array(fs.readFileSync(file("area.mtin")));
  const { vertexCount } = decode(bytes);
  const module = timeOfModule(bytes);
  const host = timeOfProgram(tool, "height", file("area.mtin"), "960", "960"); // which decodes, for one height
  t.diagnostic(`${vertexCount} vertices: module ${module.toFixed(0)} ms, host ${host.toFixed(0)} ms of the processor's time`);
  assert.ok(vertexCount > 100_000);
  assert.ok(module <= 3 * host);

  const memory = memories.at(-1).buffer.byteLength / vertexCount;
  const onHost = JSON.parse(microtin("info", "--json", "area.mtin")).workspace_bytes_32 / vertexCount;
  t.diagnostic(`bytes of memory a vertex: module ${memory.toFixed(1)}, host ${onHost.toFixed(1)}`);
  assert.ok(memory <= 1.1 * onHost + 2 ** 20 / vertexCount);
});
