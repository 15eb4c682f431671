// SPDX-License-Identifier: MIT
// The page: what the worker decodes is drawn, and what the user wants is done.
import { Camera } from "./camera.js";
import { inMetres, pathsOf, sightOf } from "./profile.js";

const element = (id) => document.getElementById(id);
const canvas = element("view");
const given = JSON.parse(element("scene").textContent);
const SYMBOLS = { metre: "m", degree: "°", "international foot": "ft", "US survey foot": "ft (US)" };

const camera = new Camera();
let decoder, drawer, header;
let phases = 1, following = true; // the last phase
let number = 0; // of pictures asked for
let pointer;

function say(text) {
  element("facts").textContent = text;
}

// With one decimal at most, and thousands apart; the first toLocaleString keeps the page waiting for 10 ms.
function text(value) {
  return value.toFixed(1).replace(/\.0$/, "").replace(/\B(?=(\d{3})+(?!\d))/g, ",");
}

// --- What the decoder and the drawer say.

const FLATTEST = 0.15, TALLEST = 2; // the range of heights in the world where the slider begins
let range; // of heights in the world, without the slider
let unit; // the world's length of one on the ground

function begin(message) {
  ({ header } = message);
  const { box, tiles } = message;
  const scale = element("scale");
  const { waterLevel, axes } = header;
  const size = [box[2] - box[0], box[3] - box[1]];
  unit = 2 / Math.max(size[0] * given.ground[0], size[1] * given.ground[1], 1e-9);
  const units = given.ground.map((length) => length * unit);
  range = (given.heights[1] - given.heights[0]) * units[2];
  scale.min = Math.min(0.5, TALLEST / (range || TALLEST));
  scale.value = Math.min(Math.max(1, FLATTEST / (range || FLATTEST)), TALLEST / (range || TALLEST));
  camera.box = [size[0] * units[0], size[1] * units[1], 0];
  show("Whole");
  showLegend();
  element("tiles-label").hidden = tiles.length < 2;
  drawer.postMessage({
    kind: "frame", units, heights: given.heights, middle: [box[0] + size[0] / 2, box[1] + size[1] / 2],
    water: waterLevel === undefined ? undefined : { height: waterLevel, half: axes.z.step / 100 },
  });
}

// "Whole" or "Map", with heights as the slider has them.
function show(what) {
  camera.box[2] = range * element("scale").value;
  camera.aspect = aspect();
  camera[`show${what}`]();
}

// Colours of heights, and where the terrain comes from.
function showLegend() {
  const { source, date, attribution, license, units } = header;
  const { tints, heights } = given;
  const colours = tints.flatMap((_, i) => (i % 3 ? [] : `rgb(${tints.slice(i, i + 3)})`));
  element("tints").style.background = `linear-gradient(to top, ${colours})`;
  [element("lowest").textContent, element("highest").textContent] =
    heights.map((height) => `${text(height)} ${SYMBOLS[units?.vertical] ?? ""}`);
  element("source").textContent = [source, date, attribution, license].filter(Boolean).join(", ");
  element("legend").hidden = false;
}

// A bar of a round length at the middle of the view, and where north is.
function showScale() {
  if (!header) return;
  const perPixel = camera.span / unit / canvas.clientHeight;
  const most = 100 * perPixel, power = 10 ** Math.floor(Math.log10(most));
  const length = power * ([5, 2].find((digit) => digit * power <= most) ?? 1);
  const horizontal = header.units?.horizontal;
  const symbol = horizontal === "degree" ? "m" : SYMBOLS[horizontal] ?? "";
  const isLong = symbol === "m" && length >= 1000;
  element("bar").style.width = `${length / perPixel}px`;
  element("length").textContent = `${+(isLong ? length / 1000 : length).toPrecision(1)} ${isLong ? "km" : symbol}`;
  element("north").style.rotate = `${-camera.azimuth}rad`;
  element("factor").textContent = +Number(element("scale").value).toPrecision(2);
}

function progress(message) {
  say(factsOf(message));
  phases = Math.max(phases, message.phase);
  element("phase").max = phases;
  if (following) element("phase").value = phases;
}

function showFlat({ message }) {
  element("why").textContent = `The terrain is shown flat: ${message}.`;
  element("flat").hidden = false;
  for (const id of ["view", "controls", "legend"]) element(id).hidden = true;
  document.body.dataset.state = "flat";
}

function factsOf({ kind, size, bytes, vertices, first }) {
  const isAll = kind === "end";
  const largest = isAll ? header.accuracy?.largest : header.phases?.find((one) => one.vertices === vertices)?.largest;
  const error = largest === undefined ? "" : `, at most ${text(largest)} ${SYMBOLS[header.units?.vertical] ?? ""} off`;
  const seen = first ? `, first seen after ${text(first)} bytes` : "";
  const read = size ? `${text(bytes)} of ${text(size)}` : text(bytes);
  return `${text(vertices)} vertices, ${read} bytes${isAll ? "" : " so far"}${error}${seen}`;
}

const ANSWERS = {
  begin,
  progress,
  end: (message) => {
    say(factsOf(message));
    document.body.dataset.state = "complete";
  },
  drawn: ({ number: drawn, pointer: at, place }) => {
    document.body.dataset.drawn = drawn;
    if (picking && drawn >= picking) pick(place);
    if (place) decoder.postMessage({ kind: "ask", x: place[0], y: place[1] });
    else if (at) element("pointer").textContent = "";
  },
  flat: showFlat,
  profile: ({ places }) => {
    profile = places;
    showProfile();
  },
  height: ({ x, y, height }) => {
    const unit = SYMBOLS[header.units?.vertical] ?? "", bound = header.accuracy?.bound;
    const digits = header.units?.horizontal === "degree" ? 5 : 1;
    const terrain = Number.isNaN(height) ? "not known" : `${text(height)} ${unit}${bound ? ` ± ${bound}` : ""}`;
    element("pointer").textContent = `${terrain}\n${x.toFixed(digits)}, ${y.toFixed(digits)}`;
  },
  error: ({ message }) => {
    say(`This terrain cannot be shown: ${message}`);
    document.body.dataset.state = "failed";
  },
};

// --- The profile between two places that are clicked.

const METRES = { "international foot": 0.3048, "US survey foot": 1200 / 3937 };
let ends = []; // x and y of both
let profile; // places of the line
let picking = 0; // from this picture on, its place is an end

function startProfile() {
  [ends, profile, picking] = [[], undefined, 0];
  element("profile").hidden = !element("line").checked;
  showProfile();
}

function pick(place) {
  picking = 0;
  if (!place) return;
  if (ends.length === 4) [ends, profile] = [[], undefined];
  ends.push(...place);
  if (ends.length === 4) decoder.postMessage({ kind: "line", ends });
  showProfile();
}

function showProfile() {
  const panel = element("profile"), drawing = panel.querySelector("svg");
  drawing.toggleAttribute("hidden", !profile?.length);
  panel.dataset.result = "";
  if (!profile) {
    element("sight").textContent = ends.length < 4 ? `Click the ${ends.length ? "other" : "first"} end of a line.` : "";
    return;
  }
  if (!profile.length) {
    element("sight").textContent = "The terrain is not known there yet.";
    return;
  }
  const metre = METRES[header.units?.horizontal] ?? 1;
  const places = inMetres(profile, given.ground.map((length) => length * metre));
  const sight = sightOf(places, Number(element("mast").value));
  const { ground, ray } = pathsOf(places, sight);
  element("ground").setAttribute("d", ground);
  element("ray").setAttribute("d", ray);
  panel.dataset.result = sight.result;
  const meanings = {
    clear: "The masts see each other.",
    blocked: `The masts do not see each other: the terrain is in the way after ${text(sight.at ?? 0)} m.`,
    unknown: "A part of the line is not known; nothing that is known is in the way.",
  };
  element("sight").textContent = `${text(sight.length)} m. ${meanings[sight.result]}`;
}

// --- Drawing.

const aspect = () => Math.max(1, canvas.clientWidth) / Math.max(1, canvas.clientHeight);

function refresh() {
  camera.aspect = aspect();
  showScale();
  const density = Math.min(2, devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth * density, canvas.clientHeight * density].map(Math.round);
  document.body.dataset.asked = ++number;
  drawer.postMessage({
    kind: "draw", number, width, height, matrix: camera.matrix(),
    phase: Number(element("phase").value), scale: Number(element("scale").value),
    mesh: element("mesh").checked, tiles: element("tiles").checked,
    pointer: pointer && [Math.round(pointer[0] * density), Math.round(height - 1 - pointer[1] * density)],
  });
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
  0: () => show("Map"),
  Home: () => show("Whole"),
};
const isFlying = () => element("fly").checked;

const STILL = 4; // pixels that a click may move
let pressed; // where the pointer was put down

// A click chooses an end of the profile.
function release({ pointerId, clientX, clientY }) {
  const isClick = pressed && fingers.size === 1 && Math.hypot(clientX - pressed[0], clientY - pressed[1]) < STILL;
  fingers.delete(pointerId);
  if (!isClick || !element("line").checked) return;
  pointer = [clientX, clientY];
  picking = number + 1;
  refresh();
}

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
    pressed = [event.clientX, event.clientY];
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (fingers.has(event.pointerId)) drag(event);
    pointer = [event.clientX, event.clientY];
    refresh();
  });
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", (event) => fingers.delete(event.pointerId));
  element("line").addEventListener("input", startProfile);
  element("mast").addEventListener("input", showProfile);
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
  element("whole").addEventListener("click", () => { show("Whole"); refresh(); });
  element("map").addEventListener("click", () => { show("Map"); refresh(); });
  element("controls").addEventListener("input", () => {
    following = Number(element("phase").value) === phases;
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

function workerOf(code) {
  const worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
  worker.onmessage = ({ data }) => {
    ANSWERS[data.kind](data);
    if (!["drawn", "height", "profile"].includes(data.kind)) refresh();
  };
  worker.onerror = ({ message }) => ANSWERS.error({ message });
  return worker;
}

function start() {
  const { port1, port2 } = new MessageChannel();
  const shown = canvas.transferControlToOffscreen();
  drawer = workerOf(VIEWER_DRAWER);
  decoder = workerOf(VIEWER_DECODER);
  drawer.postMessage({ kind: "begin", canvas: shown, tints: given.tints, port: port1 }, [shown, port1]);
  decoder.postMessage({ kind: "show", scene: given, port: port2, ...source() }, [port2]);
}

try {
  start();
  listen();
} catch (error) {
  showFlat(error);
}
