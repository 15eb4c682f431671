// SPDX-License-Identifier: MIT
// The page: what the worker decodes is drawn, and what the user wants is done.
import { Camera } from "./camera.js";
import { Scene } from "./scene.js";

const element = (id) => document.getElementById(id);
const canvas = element("view");
const given = JSON.parse(element("scene").textContent);
const SYMBOLS = { metre: "m", degree: "°", "international foot": "ft", "US survey foot": "ft (US)" };

const camera = new Camera();
let scene, worker, header;
let phases = 1, following = true; // the last phase
let isStale = false, pointer;

function say(text) {
  element("facts").textContent = text;
}

function number(value) {
  return value.toLocaleString("en", { maximumFractionDigits: 1 });
}

// --- What the worker says.

function begin(message) {
  ({ header } = message);
  const { waterLevel, axes } = header;
  scene.frame({
    ...given, box: message.box,
    water: waterLevel === undefined ? undefined : { height: waterLevel, half: axes.z.step / 100 },
  });
  scene.scale = Math.min(10, Math.max(1, 0.15 / (scene.range || 1)));
  element("scale").value = scene.scale;
  element("tiles-label").hidden = message.tiles.length < 2;
}

function addMesh(message) {
  scene.add(message);
  phases = Math.max(phases, message.phase);
  element("phase").max = phases;
  if (following) element("phase").value = phases;
}

function factsOf({ kind, bytes, vertices }) {
  const { accuracy, units } = header;
  const unit = SYMBOLS[units?.vertical] ?? "";
  const error = accuracy ? `, at most ${number(accuracy.largest)} ${unit} off` : "";
  return `${number(vertices)} vertices, ${number(bytes)} bytes${kind === "end" ? "" : " so far"}${error}`;
}

const ANSWERS = {
  begin,
  mesh: addMesh,
  progress: (message) => say(factsOf(message)),
  end: (message) => {
    say(factsOf(message));
    document.body.dataset.state = "complete";
  },
  height: ({ x, y, height }) => {
    const unit = SYMBOLS[header.units?.vertical] ?? "", bound = header.accuracy?.bound;
    const digits = header.units?.horizontal === "degree" ? 5 : 1;
    const terrain = Number.isNaN(height) ? "not known" : `${number(height)} ${unit}${bound ? ` ± ${bound}` : ""}`;
    element("pointer").textContent = `${terrain}\n${x.toFixed(digits)}, ${y.toFixed(digits)}`;
  },
  error: ({ message }) => {
    say(`This terrain cannot be shown: ${message}`);
    document.body.dataset.state = "failed";
  },
};

// --- Drawing, when something has changed.

function refresh() {
  if (isStale) return;
  isStale = true;
  requestAnimationFrame(() => {
    isStale = false;
    if (scene.middle) draw();
  });
}

function draw() {
  const density = Math.min(2, devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth * density, canvas.clientHeight * density].map(Math.round);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const matrix = camera.matrix(width / height), phase = Number(element("phase").value);
  scene.draw(matrix, { phase, mesh: element("mesh").checked, tiles: element("tiles").checked });
  if (!pointer) return;
  const place = scene.placeAt(matrix, Math.round(pointer[0] * density), Math.round(height - 1 - pointer[1] * density), phase);
  if (place) worker.postMessage({ kind: "ask", x: place[0], y: place[1] });
  else element("pointer").textContent = "";
}

// --- What the user does.

const TURN = 0.006, KEY_TURN = 0.06, KEY_MOVE = 0.05;
const KEYS = {
  ArrowLeft: () => camera.turn(-KEY_TURN, 0, isFlying()),
  ArrowRight: () => camera.turn(KEY_TURN, 0, isFlying()),
  ArrowUp: () => camera.turn(0, KEY_TURN, isFlying()),
  ArrowDown: () => camera.turn(0, -KEY_TURN, isFlying()),
  w: () => camera.move(0, KEY_MOVE, 0),
  s: () => camera.move(0, -KEY_MOVE, 0),
  a: () => camera.move(-KEY_MOVE, 0, 0),
  d: () => camera.move(KEY_MOVE, 0, 0),
  r: () => camera.move(0, 0, KEY_MOVE),
  f: () => camera.move(0, 0, -KEY_MOVE),
  "+": () => camera.approach(0.9),
  "=": () => camera.approach(0.9),
  "-": () => camera.approach(1 / 0.9),
  m: () => element("mesh").click(),
  t: () => element("tiles").click(),
  0: () => camera.showMap(),
  Home: () => camera.showWhole(),
};
const isFlying = () => element("fly").checked;

const fingers = new Map(); // where each pointer is

// Two fingers: their middle and how far they are from each other.
function pinch() {
  const [a, b] = [...fingers.values()];
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, reach: Math.hypot(a.x - b.x, a.y - b.y) };
}

function drag(event) {
  const before = fingers.get(event.pointerId);
  const old = fingers.size === 2 ? pinch() : before;
  fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  const now = fingers.size === 2 ? pinch() : fingers.get(event.pointerId);
  const [x, y] = [now.x - old.x, now.y - old.y];
  if (fingers.size === 2 && old.reach > 0) camera.approach(old.reach / Math.max(now.reach, 1));
  if (fingers.size === 2 || event.shiftKey || event.buttons & 6 || camera.isMap) {
    camera.move(-x / canvas.clientHeight, y / canvas.clientHeight, 0);
  } else {
    camera.turn(x * TURN, -y * TURN, isFlying());
  }
}

function listen() {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (fingers.has(event.pointerId)) drag(event);
    pointer = [event.clientX, event.clientY];
    refresh();
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.approach(Math.exp(event.deltaY / 600));
    refresh();
  }, { passive: false });
  addEventListener("keydown", (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const isTyped = event.target instanceof HTMLInputElement || event.ctrlKey || event.metaKey || event.altKey;
    if (!KEYS[key] || isTyped) return;
    event.preventDefault();
    KEYS[key]();
    refresh();
  });
  element("whole").addEventListener("click", () => { camera.showWhole(); refresh(); });
  element("map").addEventListener("click", () => { camera.showMap(); refresh(); });
  element("controls").addEventListener("input", () => {
    following = Number(element("phase").value) === phases;
    scene.scale = Number(element("scale").value);
    refresh();
  });
  addEventListener("resize", refresh);
}

// --- Beginning.

// What is within the page, or a file that its address names: page.html?file=area.mtp.
function source() {
  const file = new URLSearchParams(location.search).get("file");
  return file ? { url: new URL(file, location.href).href } : { text: element("terrain").textContent };
}

function start() {
  worker = new Worker(URL.createObjectURL(new Blob([VIEWER_WORKER], { type: "text/javascript" })));
  worker.onmessage = ({ data }) => {
    ANSWERS[data.kind](data);
    refresh();
  };
  worker.onerror = ({ message }) => ANSWERS.error({ message });
  worker.postMessage({ kind: "show", scene: given, ...source() });
}

try {
  scene = new Scene(canvas, given.tints);
  listen();
  start();
} catch (error) {
  element("why").textContent = `The terrain is shown flat: ${error.message}.`;
  element("flat").hidden = false;
  for (const id of ["view", "controls"]) element(id).hidden = true;
  document.body.dataset.state = "flat";
}
