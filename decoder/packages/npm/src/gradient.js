// SPDX-License-Identifier: MIT
// Slopes in metres for a metre.

const METRES = { "international foot": 0.3048, "US survey foot": 1200 / 3937 };

// Metres of a degree along the parallel and the meridian of WGS 84, by series that are right to 0.2 m; beyond 89 degrees
// as there.
function degreeAt(latitude) {
  const angle = (Math.max(-89, Math.min(89, latitude)) * Math.PI) / 180;
  return [
    111412.84 * Math.cos(angle) - 93.5 * Math.cos(3 * angle),
    111132.92 - 559.82 * Math.cos(2 * angle) + 1.175 * Math.cos(4 * angle),
  ];
}

export const noGradient = () => ({ east: NaN, north: NaN });

// The gradient that the decoder wrote at `at`, of a place with this y.
export function realGradient(instance, at, { axes, units }, y) {
  const [dx, dy, whole] = [0, 8, 16].map((place) => Number(instance.view.getBigInt64(at + place, true)));
  const metres = (unit) => METRES[unit] ?? 1;
  const rise = (axes.z.step * metres(units?.vertical)) / whole;
  const across = metres(units?.horizontal);
  const [x, up] = units?.horizontal === "degree" ? degreeAt(y) : [across, across];
  return { east: (dx * rise) / (axes.x.step * x), north: (dy * rise) / (axes.y.step * up) };
}
