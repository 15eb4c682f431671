// SPDX-License-Identifier: MIT
// Decodes in the background, with the decoder of the devices, and answers for heights.
import { Pack, decodeStream, ready } from "microtin";
import { edgesOf, normalsOf } from "./surface.js";

let drawer; // takes meshes
let heightAt = async () => NaN;
let scene; // the page's: how long units are beside each other, and how light finds slopes

function send(message, transfer = []) {
  self.postMessage(message, transfer);
}

function sendMesh(mesh, tile, phase) {
  const { origin, positions, indices } = mesh;
  const normals = normalsOf(mesh, scene.ground, scene.slope);
  const arrays = { positions, normals, indices, ...edgesOf(indices) };
  drawer.postMessage({ kind: "mesh", tile, phase, origin, ...arrays }, Object.values(arrays).map(({ buffer }) => buffer));
}

function copyOf({ origin, positions, indices }) {
  return { origin, positions: positions.slice(), indices: indices.slice() };
}

async function showStream(source) {
  let phase = 0, terrain;
  for await (terrain of decodeStream(source)) {
    if (phase === 0) {
      heightAt = async (x, y) => terrain.heightAt(x, y);
      const [x, y] = terrain.origin;
      const { positions } = terrain;
      const box = [x, y, x, y];
      for (let i = 0; i < positions.length; i += 3) {
        box[2] = Math.max(box[2], x + positions[i]);
        box[3] = Math.max(box[3], y + positions[i + 1]);
      }
      send({ kind: "begin", header: terrain.header, box, tiles: [] });
    }
    sendMesh(copyOf(terrain), 0, ++phase);
    send({ kind: "progress", phase, bytes: terrain.bytes, vertices: terrain.vertexCount });
  }
  drawer.postMessage({ kind: "end", bytes: terrain.bytes, vertices: terrain.vertexCount });
}

async function showPack(source) {
  const pack = await Pack.open(source, { slots: 64 });
  const count = pack.columns * pack.rows;
  const boxes = Array.from({ length: count }, (_, tile) => pack.tileBox(tile));
  const box = [boxes[0][0], boxes[0][1], boxes[count - 1][2], boxes[count - 1][3]];
  heightAt = (x, y) => pack.heightAt(x, y);
  send({ kind: "begin", header: pack.header, box, tiles: boxes });
  let vertices = 0;
  for (let tile = 0; tile < count; ++tile) {
    let phase = 0;
    for await (const mesh of pack.tilePhases(tile)) {
      if (mesh.done) vertices += mesh.positions.length / 3;
      sendMesh(mesh, tile, ++phase);
    }
    send({ kind: "progress", phase, bytes: pack.bytesRead, vertices });
  }
  drawer.postMessage({ kind: "end", bytes: pack.bytesRead, vertices });
}

const isPack = (bytes) => String.fromCharCode(...bytes.subarray(0, 4)) === "mtpk";

async function show({ text, url, port, ...given }) {
  ({ scene } = given);
  drawer = port;
  await ready;
  if (!url) {
    const bytes = Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
    return isPack(bytes) ? showPack(bytes) : showStream([bytes]);
  }
  if (url.endsWith(".mtp")) return showPack(url);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return showStream(response);
}

self.onmessage = async ({ data }) => {
  try {
    if (data.kind === "show") await show(data);
    if (data.kind === "ask") send({ kind: "height", x: data.x, y: data.y, height: await heightAt(data.x, data.y) });
  } catch (error) {
    send({ kind: "error", message: error.message });
  }
};
