// SPDX-License-Identifier: MIT
// A terrain provider for CesiumJS, of packs in degrees. Its finest level has the pack's own tiles; each coarser one
// joins two by two of them, from so many of their phases that its tiles have half as many vertices or more.

const MOST_LEVELS = 4; // joins 64 tiles of 256 vertices, of which the first phase has that many
const MOST_WAITING = 16; // tiles asked for at once; Cesium asks for others again, if they are still in view
const FULL = 32767; // the largest number in a quantized mesh
const DEGREE = Math.PI / 180;

function check({ header: { epsg, units } }) {
  const code = epsg?.horizontal;
  if (code !== 4326) {
    throw new RangeError(`CesiumJS wants a pack in EPSG:4326, not in ${code ? `EPSG:${code}` : "an unknown system"}`);
  }
  for (const [unit, wanted] of [[units?.horizontal, "degree"], [units?.vertical, "metre"]]) {
    if (unit && unit !== wanted) throw new RangeError(`CesiumJS wants the unit ${wanted}, not ${unit}`);
  }
}

// How many levels: more would make tiles of level 0 that hardly hold anything, or reach beyond the poles.
function levelsOf({ columns, rows, header: { axes }, tileSize: [width, height] }) {
  const fits = (side) => axes.x.start + Math.ceil(columns / side) * side * width * axes.x.step <= 180 &&
    axes.y.start + Math.ceil(rows / side) * side * height * axes.y.step <= 90;
  let levels = 1;
  while (levels < MOST_LEVELS && 2 ** levels < 2 * Math.max(columns, rows) && fits(2 ** levels)) ++levels;
  return levels;
}

// --- Meshes.

// A tile's mesh, or its coarse beginning of at least so many vertices.
async function meshOf(pack, tile, vertices) {
  let mesh;
  for await (mesh of pack.tilePhases(tile)) {
    if (mesh.positions.length >= 3 * vertices) break;
  }
  return mesh;
}

// Triangles of several tiles, whose common vertices are one. Places are lattice steps from the first corner of all.
class Joined {
  places = []; // x, y, height in steps
  triangles = [];
  #known = new Map();

  // The first corner of the mesh lies at (left, bottom).
  add({ positions, indices }, { x, y, z }, left, bottom) {
    const numbers = Array.from({ length: positions.length / 3 }, (_, i) => this.#vertex(
      left + Math.round(positions[3 * i] / x.step), bottom + Math.round(positions[3 * i + 1] / y.step),
      Math.round((positions[3 * i + 2] - z.start) / z.step)));
    for (let t = 0; t < indices.length; t += 3) {
      this.triangles.push([0, 1, 2].map((i) => numbers[indices[t + i]]));
    }
  }

  #vertex(x, y, z) {
    const key = x * 2 ** 24 + y; // below 2^48: at most 8 tiles of 65535 steps
    if (!this.#known.has(key)) this.#known.set(key, this.places.push([x, y, z]) - 1);
    return this.#known.get(key);
  }

  // Coarse neighbours have not the same vertices yet along their border: where one has more, the other's triangles
  // are split, so that there are no cracks.
  stitch(size) {
    const lines = [0, 1].map((axis) => this.#borders(axis, size[axis]));
    for (let side = 0; side < 3; ++side) {
      this.triangles = this.triangles.flatMap(([a, b, c]) => {
        const chain = [a, ...this.#between(lines, a, b), b];
        return chain.slice(1).map((end, i) => [end, c, chain[i]]);
      });
    }
  }

  // By place on an axis, the vertices on that border, in order.
  #borders(axis, size) {
    const lines = new Map();
    this.places.forEach((place, v) => {
      if (place[axis] % size !== 0) return;
      if (!lines.has(place[axis])) lines.set(place[axis], []);
      lines.get(place[axis]).push(v);
    });
    for (const line of lines.values()) line.sort((a, b) => this.places[a][1 - axis] - this.places[b][1 - axis]);
    return lines;
  }

  // The vertices on an edge, from its beginning to its end.
  #between(lines, a, b) {
    const axis = [0, 1].find((i) => this.places[a][i] === this.places[b][i] && lines[i].has(this.places[a][i]));
    if (axis === undefined) return [];
    const line = lines[axis].get(this.places[a][axis]);
    const [from, to] = [line.indexOf(a), line.indexOf(b)];
    return from < to ? line.slice(from + 1, to) : line.slice(to + 1, from).reverse();
  }
}

// --- The provider.

class Provider {
  #pack;
  #cesium;
  #levels;
  #last = Promise.resolve();
  #waiting = 0;
  #empty = new Set(); // tiles without terrain

  hasWaterMask = false;
  hasVertexNormals = false;
  availability = undefined;

  constructor(cesium, pack, { credit }) {
    check(pack);
    this.#pack = pack;
    this.#cesium = cesium;
    this.#levels = levelsOf(pack);
    const { x, y } = pack.header.axes;
    const side = 2 ** (this.#levels - 1);
    const [across, up] = [Math.ceil(pack.columns / side), Math.ceil(pack.rows / side)];
    this.tilingScheme = new cesium.GeographicTilingScheme({
      rectangle: cesium.Rectangle.fromDegrees(x.start, y.start, x.start + across * side * pack.tileSize[0] * x.step,
        y.start + up * side * pack.tileSize[1] * y.step),
      numberOfLevelZeroTilesX: across,
      numberOfLevelZeroTilesY: up,
    });
    this.errorEvent = new cesium.Event();
    this.credit = credit === undefined ? undefined : new cesium.Credit(credit);
  }

  get levels() {
    return this.#levels;
  }

  // The finest level has the pack's own error. That of a coarser one is not known before it is read: Cesium's rule for
  // grids, a quarter of the distance between vertices.
  getLevelMaximumGeometricError(level) {
    const { header: { accuracy, axes }, maxTileVertices, tileSize } = this.#pack;
    const own = Math.max(accuracy?.largest ?? 0, axes.z.step);
    const side = 2 ** (this.#levels - 1 - level);
    const height = tileSize[1] * axes.y.step * DEGREE * this.tilingScheme.ellipsoid.maximumRadius;
    return side <= 1 ? own * side : side * Math.max(own, height / Math.sqrt(maxTileVertices) / 4);
  }

  // Below the finest level Cesium cuts the tiles itself, unless there is nothing to cut.
  getTileDataAvailable(x, y, level) {
    const below = level - (this.#levels - 1);
    return below <= 0 || this.#empty.has(`${x >> below} ${y >> below}`);
  }

  loadTileDataAvailability() {
    return undefined;
  }

  // One after another: the pack decodes one tile at a time. Undefined: ask again later.
  requestTileGeometry(x, y, level) {
    if (this.#waiting >= MOST_WAITING) return undefined;
    ++this.#waiting;
    const result = this.#last.then(() => this.#tile(x, y, level)).finally(() => { --this.#waiting; });
    this.#last = result.catch(() => {});
    return result;
  }

  async #tile(x, y, level) {
    const joined = new Joined();
    const depth = this.#levels - 1 - level;
    if (depth >= 0) await this.#join(joined, x, y, level);
    if (depth === 0 && joined.triangles.length === 0) this.#empty.add(`${x} ${y}`);
    return this.#data(joined, 2 ** depth, this.tilingScheme.tileXYToRectangle(x, y, level));
  }

  // Rows count from the south in packs, from the north in Cesium.
  async #join(joined, x, y, level) {
    const pack = this.#pack, { axes } = pack.header, [width, height] = pack.tileSize;
    const side = 2 ** (this.#levels - 1 - level);
    const bottom = (this.tilingScheme.getNumberOfYTilesAtLevel(level) - 1 - y) * side;
    for (let row = bottom; row < Math.min(bottom + side, pack.rows); ++row) {
      for (let column = x * side; column < Math.min((x + 1) * side, pack.columns); ++column) {
        const mesh = await meshOf(pack, row * pack.columns + column, side > 1 ? pack.maxTileVertices / (2 * side ** 2) : Infinity);
        joined.add(mesh, axes, (column - x * side) * width, (row - bottom) * height);
      }
    }
    if (side > 1) joined.stitch(pack.tileSize);
  }

  // Heights of all tiles are numbers on one scale, so that they are equal where they meet: steps, a whole number of
  // times, unless the pack has more of them than fit.
  #scale() {
    const { lowest, highest, header: { axes: { z } } } = this.#pack;
    const steps = Math.max(1, Math.round((highest - lowest) / z.step));
    const fine = FULL >= steps ? Math.floor(FULL / steps) : FULL / steps;
    return { base: Math.round((lowest - z.start) / z.step), fine, top: lowest + (FULL / fine) * z.step };
  }

  #data({ places, triangles }, side, rectangle) {
    const { lowest, tileSize } = this.#pack;
    const { base, fine, top } = this.#scale();
    if (triangles.length === 0) [places, triangles] = [[[0, 0, base]], [[0, 0, 0]]]; // Cesium has no empty meshes
    const sizes = tileSize.map((size) => size * side);
    const numbers = [0, 1].map((i) => places.map((place) => Math.round((place[i] / sizes[i]) * FULL)));
    numbers.push(places.map((place) => Math.round((place[2] - base) * fine)));
    const Indices = places.length > 65536 ? Uint32Array : Uint16Array;
    return new this.#cesium.QuantizedMeshTerrainData({
      quantizedVertices: Uint16Array.from(numbers.flat()),
      indices: Indices.from(triangles.flat()),
      minimumHeight: lowest,
      maximumHeight: top,
      ...this.#edges(numbers, triangles),
      ...this.#bounds(numbers, rectangle, (number) => lowest + (number / FULL) * (top - lowest)),
    });
  }

  // Skirts hide cracks between levels; tiles of the finest have none between them.
  #edges([xs, ys], triangles) {
    const used = [...new Set(triangles.flat())];
    const edge = (values, value) => {
      const found = used.filter((v) => values[v] === value);
      return found.length > 0 ? found : [used[0]]; // Cesium wants one
    };
    const skirt = this.#levels > 1 ? 2 * this.getLevelMaximumGeometricError(0) : 0;
    return {
      westIndices: edge(xs, 0), eastIndices: edge(xs, FULL), southIndices: edge(ys, 0), northIndices: edge(ys, FULL),
      westSkirtHeight: skirt, eastSkirtHeight: skirt, southSkirtHeight: skirt, northSkirtHeight: skirt,
    };
  }

  // What Cesium wants to know in order to leave out what is not seen.
  #bounds([xs, ys, zs], rectangle, heightOf) {
    const { BoundingSphere, Cartesian3, EllipsoidalOccluder, OrientedBoundingBox } = this.#cesium;
    const { ellipsoid } = this.tilingScheme;
    const [low, high] = [Math.min, Math.max].map((pick) => heightOf(zs.reduce((a, b) => pick(a, b))));
    const points = xs.map((x, v) => Cartesian3.fromRadians(rectangle.west + (x / FULL) * rectangle.width,
      rectangle.south + (ys[v] / FULL) * rectangle.height, heightOf(zs[v]), ellipsoid));
    const boundingSphere = BoundingSphere.fromPoints(points);
    return {
      boundingSphere,
      orientedBoundingBox: OrientedBoundingBox.fromRectangle(rectangle, low, high, ellipsoid),
      horizonOcclusionPoint: new EllipsoidalOccluder(ellipsoid).computeHorizonCullingPointPossiblyUnderEllipsoid(
        boundingSphere.center, points, low),
    };
  }
}

export function cesiumTerrain(cesium, pack, options = {}) {
  return new Provider(cesium, pack, options);
}
