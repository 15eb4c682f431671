// SPDX-License-Identifier: MIT
// Decodes in the background, with the decoder of the devices, and answers for heights and profiles.
import { Pack, decodeStream, ready } from "microtin";
import { edgesOf, normalsOf } from "./surface.js";

let drawer; // takes meshes
let heightAt = async () => NaN;
let profileOf = async () => []; // of x, y of both ends
let size; // of the file, if known
let first; // bytes, after which all that is in view was there, if coarse
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

async function showStream(source, fileSize) {
  size = fileSize;
  let phase = 0, terrain;
  for await (terrain of decodeStream(source)) {
    if (phase === 0) {
      heightAt = async (x, y) => terrain.heightAt(x, y);
      profileOf = async (...ends) => terrain.profile(...ends);
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
    first ??= terrain.bytes;
    send({ kind: "progress", first, phase, size, bytes: terrain.bytes, vertices: terrain.vertexCount });
  }
  drawer.postMessage({ kind: "end", first, size, bytes: terrain.bytes, vertices: terrain.vertexCount });
}

async function showPack(source) {
  const pack = await Pack.open(source, { slots: 64, cacheBytes: 2 ** 40 }); // all of the file, which is shown twice
  const count = pack.columns * pack.rows;
  const boxes = Array.from({ length: count }, (_, tile) => pack.tileBox(tile));
  const box = [boxes[0][0], boxes[0][1], boxes[count - 1][2], boxes[count - 1][3]];
  heightAt = (x, y) => pack.heightAt(x, y);
  profileOf = (...ends) => pack.profile(...ends);
  send({ kind: "begin", header: pack.header, box, tiles: boxes });
  let vertices = 0;
  const show = (mesh, tile, phase) => {
    if (mesh.done) vertices += mesh.positions.length / 3;
    sendMesh(mesh, tile, phase); // which gives the arrays away
    send({ kind: "progress", first, phase, size: pack.size, bytes: pack.bytesRead, vertices });
  };
  const coarse = await showFirstPhases(pack, count, show);
  first = pack.bytesRead;
  for (const [tile, size] of coarse) await showRest(pack, tile, size, show);
  drawer.postMessage({ kind: "end", first, size: pack.size, bytes: pack.bytesRead, vertices });
}

// Shows the first phases of all tiles, which are in view. Returns how much there is of those that have more phases.
async function showFirstPhases(pack, count, show) {
  const coarse = new Map();
  for (let tile = 0; tile < count; ++tile) {
    for await (const mesh of pack.tilePhases(tile)) {
      if (!mesh.done) coarse.set(tile, mesh.positions.length);
      show(mesh, tile, 1);
      break;
    }
  }
  return coarse;
}

// The phases of a tile that have more than is known of it.
async function showRest(pack, tile, size, show) {
  let phase = 1;
  for await (const mesh of pack.tilePhases(tile)) {
    if (mesh.done || mesh.positions.length > size) show(mesh, tile, ++phase);
  }
}

const isPack = (bytes) => String.fromCharCode(...bytes.subarray(0, 4)) === "mtpk";

async function show({ text, url, port, ...given }) {
  ({ scene } = given);
  drawer = port;
  await ready;
  if (!url) {
    const bytes = Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
    return isPack(bytes) ? showPack(bytes) : showStream([bytes], bytes.length);
  }
  if (url.endsWith(".mtp")) return showPack(url);
  const response = await fetch(url);
  const isCoded = response.headers.get("Content-Encoding"); // its length is then not the file's
  return showStream(response, isCoded ? undefined : Number(response.headers.get("Content-Length")) || undefined);
}

self.onmessage = async ({ data }) => {
  try {
    if (data.kind === "show") await show(data);
    if (data.kind === "line") send({ kind: "profile", places: await profileOf(...data.ends) });
    if (data.kind === "ask") send({ kind: "height", x: data.x, y: data.y, height: await heightAt(data.x, data.y) });
  } catch (error) {
    send({ kind: "error", message: error.message });
  }
};
