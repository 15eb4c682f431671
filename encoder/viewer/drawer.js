// SPDX-License-Identifier: MIT
// Draws in the background: graphics processors make one wait.
import { Scene } from "./scene.js";

let scene;
let wanted; // how to draw, as the page said last
let isStale = false;

// Only the last wish counts.
function refresh() {
  if (isStale || !wanted || !scene?.middle) return;
  isStale = true;
  requestAnimationFrame(() => {
    isStale = false;
    draw();
  });
}

function draw() {
  const { number, matrix, phase, pointer } = wanted;
  scene.draw(wanted);
  const place = pointer && scene.placeAt(matrix, ...pointer, phase);
  self.postMessage({ kind: "drawn", number, pointer, place });
}

const WISHES = {
  begin: ({ canvas, tints }) => { scene = new Scene(canvas, tints); },
  frame: (message) => scene.frame(message),
  draw: (message) => { wanted = message; },
};

// What the decoder has to be drawn, and that it is all.
function take({ data }) {
  if (!scene) return; // the page shows the flat picture
  if (data.kind === "mesh") scene.add(data);
  else self.postMessage(data);
  refresh();
}

self.onmessage = ({ data }) => {
  try {
    if (data.port) data.port.onmessage = take;
    WISHES[data.kind](data);
    refresh();
  } catch (error) {
    self.postMessage({ kind: "flat", message: error.message });
  }
};
