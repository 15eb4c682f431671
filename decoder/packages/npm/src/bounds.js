// SPDX-License-Identifier: MIT
// Which tiles an area touches.

const NEAR = 1 / 256; // of a step: so that no rounding leaves a tile out

// From the first up to and without the last of `count` tiles in a row or a column.
function slices(low, high, size, count) {
  if (!(high + NEAR >= 0)) return [0, 0];
  return [Math.max(0, Math.floor((low - NEAR) / size)), Math.min(count, Math.floor((high + NEAR) / size) + 1)];
}

// Yields the first and the number of the tiles of each row that a box touches, or the line between its corners a and b:
// lattice coordinates.
export function* tilesNear({ columns, rows, tileSize: [width, height] }, a, b, isBox) {
  const [low, high] = [Math.min(a[1], b[1]), Math.max(a[1], b[1])];
  const [first, last] = slices(low, high, height, rows);
  const xAt = (y) => a[0] + (b[0] - a[0]) * Math.max(0, Math.min(1, (y - a[1]) / (b[1] - a[1])));
  for (let row = first; row < last; ++row) {
    const ends = isBox || low === high ? [a[0], b[0]] : [
      xAt(Math.max(low, row * height - NEAR)),
      xAt(Math.min(high, (row + 1) * height + NEAR)),
    ];
    const [left, right] = slices(Math.min(...ends), Math.max(...ends), width, columns);
    if (left < right) yield [row * columns + left, right - left];
  }
}
