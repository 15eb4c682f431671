// SPDX-License-Identifier: MIT
// The profile between two places: whether masts there see each other, and a drawing of it.

const EARTH = (6371008.8 * 4) / 3; // metres: with the refraction of radio waves
const TOUCH = 1e-4; // metres: what is nearer touches
const WIDTH = 320, HEIGHT = 110, EDGE = 6; // of the drawing

const mix = (a, b, part) => a * (1 - part) + b * part;

// Places of a line, with distances and heights in metres. `scale` has the metres of a unit of x, of y and of heights.
export function inMetres(places, scale) {
  const [first] = places;
  return places.map(({ x, y, height, isKnownBefore }) => ({
    distance: Math.hypot((x - first.x) * scale[0], (y - first.y) * scale[1]), height: height * scale[2], isKnownBefore,
  }));
}

// Between the terrain of a part of the line and the ray, with the bulge of the Earth. It is convex.
function clearanceOf(a, b, ray, length) {
  return (distance) => {
    const part = b.distance > a.distance ? (distance - a.distance) / (b.distance - a.distance) : 0;
    const bulge = (distance * (length - distance)) / (2 * EARTH);
    return ray(distance) - mix(a.height, b.height, part) - bulge;
  };
}

// Where the part of a line is nearest to the ray, by halving.
function nearest(a, b, clearance) {
  let [low, high] = [a.distance, b.distance];
  for (let i = 0; i < 60; ++i) {
    const [left, right] = [mix(low, high, 0.49), mix(low, high, 0.51)];
    if (clearance(left) <= clearance(right)) high = right;
    else low = left;
  }
  return [a.distance, (low + high) / 2, b.distance].reduce((best, at) => (clearance(at) < clearance(best) ? at : best));
}

// Where the clearance first becomes negative, between a place where it is not and one where it is.
function firstBelow(low, high, clearance) {
  for (let i = 0; i < 60; ++i) {
    const middle = (low + high) / 2;
    if (clearance(middle) < -TOUCH) high = middle;
    else low = middle;
  }
  return high;
}

// Whether masts of a height above both ends see each other: "clear", "blocked" (at a distance) or "unknown".
export function sightOf(places, mast) {
  const [first, last] = [places[0], places.at(-1)];
  const [from, to, length] = [first.height + mast, last.height + mast, last.distance];
  const ray = (distance) => mix(from, to, length > 0 ? distance / length : 0);
  let isKnown = !Number.isNaN(from + to), least = Infinity;
  for (let i = 1; i < places.length; ++i) {
    const [a, b] = [places[i - 1], places[i]];
    if (!b.isKnownBefore) {
      isKnown = false;
      continue;
    }
    const clearance = clearanceOf(a, b, ray, length);
    const at = nearest(a, b, clearance);
    least = Math.min(least, clearance(at));
    if (clearance(at) < -TOUCH) return { result: "blocked", at: firstBelow(a.distance, at, clearance), from, to, length };
  }
  return { result: isKnown ? "clear" : "unknown", least, from, to, length };
}

// Paths of an SVG drawing: the terrain on the round Earth, and the ray.
export function pathsOf(places, { from, to, length }) {
  const bulge = (distance) => (distance * (length - distance)) / (2 * EARTH);
  const heights = places.flatMap(({ height, distance }) => (Number.isNaN(height) ? [] : [height + bulge(distance)]));
  const all = [...heights, from, to].filter((height) => !Number.isNaN(height));
  const [low, high] = [Math.min(...all), Math.max(...all)];
  const spot = (distance, height) => [
    EDGE + ((WIDTH - 2 * EDGE) * distance) / (length || 1),
    HEIGHT - EDGE - ((HEIGHT - 2 * EDGE) * (height - low)) / (high - low || 1),
  ].map((value) => value.toFixed(1)).join(" ");
  const ground = places.map(({ distance, height, isKnownBefore }, i) =>
    (Number.isNaN(height) ? "" : `${isKnownBefore && i ? "L" : "M"}${spot(distance, height + bulge(distance))}`)).join("");
  return { ground, ray: Number.isNaN(from + to) ? "" : `M${spot(0, from)}L${spot(length, to)}` };
}
