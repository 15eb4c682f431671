// SPDX-License-Identifier: MIT
// A loader object for loaders.gl, in the manner of its quantized-mesh loader.
import { decode, decodeStream, ready, version } from "./microtin.js";

function meshOf(terrain) {
  const { positions, indices } = terrain;
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  positions.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  return {
    loader: "microtin",
    loaderData: { header: terrain.header, origin: terrain.origin },
    header: { vertexCount: terrain.vertexCount, boundingBox: [low, high] },
    schema: { fields: [], metadata: {} },
    topology: "triangle-list",
    mode: 4,
    indices: { value: indices, size: 1 },
    attributes: { POSITION: { value: positions, size: 3 } },
  };
}

async function parse(buffer) {
  await ready;
  return meshOf(decode(new Uint8Array(buffer)));
}

async function* parseInBatches(chunks) {
  for await (const terrain of decodeStream(bytesOf(chunks))) yield meshOf(terrain);
}

async function* bytesOf(chunks) {
  for await (const chunk of chunks) yield new Uint8Array(chunk);
}

export const MicrotinLoader = {
  id: "microtin",
  name: "microtin terrain",
  dataType: null,
  batchType: null,
  module: "microtin",
  version,
  worker: false,
  extensions: ["mtin"],
  mimeTypes: ["application/octet-stream"],
  category: "mesh",
  binary: true,
  tests: ["mtin"],
  options: { microtin: {} },
  parse,
  parseInBatches,
};
