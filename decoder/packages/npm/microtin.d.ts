// SPDX-License-Identifier: MIT

/** The version of this package, which is that of the library. */
export const version: string;

/** Resolves once the decoder is compiled; {@link decode} and {@link Decoder} need it. */
export const ready: Promise<void>;

export type Status =
  | "BAD_MAGIC"
  | "UNSUPPORTED_VERSION"
  | "TOO_BIG"
  | "CHECKSUM"
  | "MALFORMED"
  | "TRUNCATED"
  | "IO"
  | "INTERNAL";

/** Damaged, unknown or unreadable data. */
export class MicrotinError extends Error {
  readonly status: Status;
}

/** The real coordinate of lattice value k is `start + step * k`. */
export interface Axis {
  start: number;
  step: number;
}

export type Unit = "metre" | "degree" | "international foot" | "US survey foot";

/** What a header says; what it does not say is undefined. */
export interface Header {
  axes: { x: Axis; y: Axis; z: Axis };
  units?: { horizontal?: Unit; vertical?: Unit };
  /** EPSG codes. */
  epsg?: { horizontal?: number; vertical?: number };
  /** Well-known text of a horizontal system without an EPSG code. */
  wkt?: string;
  /** In units of height: the bound asked for, and the errors measured at every sample of the source. */
  accuracy?: { bound?: number; largest: number; rms: number; mean: number };
  /** What the heights are, which side of the source the bound allows, and, in units of height, the largest distances of
   * the surface below and above a sample of the source. */
  surface?: {
    kind?: "ground" | "top" | "bed" | "geoid" | "obstacles";
    side?: "both" | "never_below" | "never_above";
    below?: number;
    above?: number;
  };
  /** The largest distances of the surface below and above the bilinear surface of a raster's posts, also between posts. */
  everywhere?: { below: number; above: number };
  /** Where the terrain comes from, as its maker states it, and the date of the source in ISO 8601. */
  source?: string;
  date?: string;
  /** A text that must be shown to users. */
  attribution?: string;
  /** An SPDX expression or a URL. */
  license?: string;
  /** When the terrain is valid, in ISO 8601: 2024-01/2025-06, 2024-01/.. or ../2025. */
  valid?: string;
  /** The epoch of the coordinates, a decimal year. */
  epoch?: number;
  /** How accurate the source itself is, in units of height. */
  sourceAccuracy?: { kind?: "LE90" | "RMSE" | "LE95"; value: number };
  /** Triangles of which all vertices have this very height are water. */
  waterLevel?: number;
}

export interface TerrainHeader extends Header {
  vertices: number;
  /** After each phase, or after the first few: the vertices, the bytes of the file up to there, and the largest error at
   * the samples of the source that the surface covers then, in units of height. */
  phases?: { vertices: number; bytes: number; largest?: number }[];
  /** What Terrain.digest must be when all is decoded. */
  digest?: bigint;
}

export interface Mesh {
  /** The real x and y to which positions are relative. */
  origin: [number, number];
  /** x, y (relative to the origin, y grows north) and height of each vertex; x and y are exact to
   * 1/256 of a step. */
  positions: Float32Array;
  /** Three vertices for each triangle with terrain, counter-clockwise from above. */
  indices: Uint32Array;
  /** ... for each triangle without; known once all is decoded. */
  voids: Uint32Array;
}

/** How many metres the terrain rises for each metre east, and for each metre north; NaN where it has no slope. A degree
 * has its length at the place; a unit that is not known counts as the metre. The slope is Math.atan(Math.hypot(east,
 * north)), the direction of steepest descent Math.atan2(-east, -north), clockwise from north. */
export interface Gradient {
  east: number;
  north: number;
}

/** Between which heights an area lies, by those of the tiles that it touches. */
export interface HeightBounds {
  /** Of vertices; NaN if no tile of the area has terrain. */
  lowest: number;
  highest: number;
  /** How low and how high the source is at most; NaN if the header states no margins. */
  sourceLowest: number;
  sourceHighest: number;
  /** Whether the area lies inside, and each of its tiles has terrain. Then all above `highest` is surely above the
   * terrain there. Voids within tiles have no height and do not count. */
  isComplete: boolean;
}

/** A place of a profile: an end of the line, a vertex on it, or where it crosses an edge. */
export interface ProfilePlace {
  /** The part of the line before the place, 0 to 1. */
  along: number;
  x: number;
  y: number;
  /** NaN if there is none; linear between two places where isKnownBefore is true. */
  height: number;
  /** Whether there is terrain from the place before up to this one. */
  isKnownBefore: boolean;
}

/** A terrain. While it is being decoded it holds what the sections that have passed their checks contain, and nothing of
 * a later section: no vertices before the first one has passed, and the last verified terrain after an error. It changes
 * only when {@link Decoder.push} or {@link decodeStream} yields it. Its arrays are copies, which it returns again until
 * then. */
export interface Terrain extends Mesh {
  readonly header: TerrainHeader;
  readonly vertexCount: number;
  /** Bytes of the stream up to the end of the last verified section. */
  readonly bytes: number;
  /** Whether all is decoded and verified. */
  readonly done: boolean;
  /** A number that depends on the set of triangles alone; equal on every machine. */
  readonly digest: bigint;
  /** The height at a real place; NaN outside, for NaN and infinities, or where the terrain is not known. Voids are known
   * once all is decoded. @throws TypeError if an argument is not a number */
  heightAt(x: number, y: number): number;
  /** The gradient of the triangle at a real place; NaN where there is no height. On an edge or a vertex it is that of the
   * triangle whose centre lies farthest east, and of those with the same x farthest north. @throws TypeError if an
   * argument is not a number */
  gradientAt(x: number, y: number): Gradient;
  /** The places along the straight line between two real places, each rounded to 1/256 of a step; empty if an end lies
   * outside the lattice, for NaN and infinities, or until all is decoded. @throws TypeError if an argument is not a number */
  profile(x: number, y: number, xEnd: number, yEnd: number): ProfilePlace[];
}

/** Decodes a whole stream; await {@link ready} first. @throws MicrotinError, or TypeError if it is not a Uint8Array */
export function decode(bytes: Uint8Array): Terrain;

/** Decodes a stream from its bytes in any pieces; await {@link ready} first. */
export class Decoder {
  /** Undefined until the header is complete, and a byte behind it for each 1421 vertices. */
  readonly terrain: Terrain | undefined;
  /** Takes a copy of the next bytes at once. The generator decodes them, and yields the terrain each time that a section
   * of it, one phase or the first few together, has passed its check: coarse at first, then finer. Bytes that an
   * iteration leaves are decoded by the next one, or by {@link finish}. An error is final: later calls throw it again.
   * @throws MicrotinError, or TypeError if it is not a Uint8Array */
  push(bytes: Uint8Array): Generator<Terrain, void>;
  /** No byte will follow. @throws MicrotinError if the terrain is not complete */
  finish(): Terrain;
}

export type Chunks =
  | Response
  | Blob
  | ReadableStream<Uint8Array>
  | AsyncIterable<Uint8Array>
  | Iterable<Uint8Array>;

/** Decodes a stream while it arrives: see {@link Decoder.push}. The same terrain is yielded each time.
 * @throws MicrotinError, with status IO if the source fails or is an HTTP error; TypeError if it does not yield
 * Uint8Arrays */
export function decodeStream(source: Chunks): AsyncGenerator<Terrain, void>;

/** Where a pack lies: a URL, fetched by HTTP ranges, or as a whole if the server has none; a file; all its bytes; or a
 * function that reads up to `size` bytes at `offset`, at least one, and none only behind the end. What it returns is
 * copied. */
export type PackSource =
  | string
  | URL
  | Blob
  | Uint8Array
  | ((offset: number, size: number) => Promise<Uint8Array>);

/** A terrain in tiles; only what is asked for is read, and nothing twice while it is kept. Its calls may overlap; they
 * are served one by one. A call that fails with status IO may be tried again; one that touches a damaged tile fails each
 * time. Calls throw a TypeError if an argument is not a number, and a RangeError if there is no such tile. */
export class Pack {
  private constructor();
  /** @param options.slots decoded tiles that are kept in memory, 1 to 255; more where one question needs more
   * @param options.cacheBytes bytes of the file that are kept in memory, those used last; 64 MiB if not given */
  static open(source: PackSource, options?: { slots?: number; cacheBytes?: number }): Promise<Pack>;
  readonly header: Header;
  /** Tiles in a row and rows; tile 0 is the south-western one, and numbers grow along rows. */
  readonly columns: number;
  readonly rows: number;
  /** Width and height of a tile in steps of x and y; those of the last column and row may be smaller. */
  readonly tileSize: [number, number];
  readonly maxTileVertices: number;
  /** The lowest and highest vertex. */
  readonly lowest: number;
  readonly highest: number;
  /** Bytes read from the source so far. */
  readonly bytesRead: number;
  /** Bytes of the file; undefined if the source does not state it, as read functions do not. */
  readonly size: number | undefined;
  /** The real extent of a tile: x, y, largest x, largest y. */
  tileBox(tile: number): [number, number, number, number];
  /** The numbers of the tiles that touch an extent; none for NaN. */
  tilesIn(xMin: number, yMin: number, xMax: number, yMax: number): number[];
  /** A tile's mesh; empty if the terrain is not known there. Neighbours share their border, so there are no cracks. */
  tile(tile: number): Promise<Mesh & { done: true }>;
  /** Yields a tile's mesh, coarse at first, each as soon as its bytes are there. A mesh that is not `done` holds the
   * sections that have passed their checks, of a stream of the tile's size. Only the end shows whether the stream is
   * undamaged and the one that the index names: if not, the generator throws. Iterations may overlap. */
  tilePhases(tile: number): AsyncGenerator<Mesh & { done: boolean }, void>;
  /** The height at a real place; NaN outside, for NaN and infinities, or where the terrain is not known.
   * @throws MicrotinError if the tile is damaged */
  heightAt(x: number, y: number): Promise<number>;
  /** Between which heights a box lies, by 20 bytes of the index for each tile: no tile is read.
   * @throws MicrotinError if an entry is damaged */
  boundsInBox(xMin: number, yMin: number, xMax: number, yMax: number): Promise<HeightBounds>;
  /** Between which heights the straight line between two real places lies, as {@link boundsInBox}. */
  boundsOnLine(x: number, y: number, xEnd: number, yEnd: number): Promise<HeightBounds>;
  /** The gradient at a real place, as that of a {@link Terrain}. @throws MicrotinError if the tile is damaged */
  gradientAt(x: number, y: number): Promise<Gradient>;
  /** The exact greatest height on the straight segment; NaN if a part of it lies outside or where nothing is
   * known. @throws MicrotinError if a tile is damaged, RangeError if the segment touches more than 255 tiles */
  segmentMax(x: number, y: number, xEnd: number, yEnd: number): Promise<number>;
  /** The places along the straight line between two real places, each rounded to 1/256 of a step; empty if an end lies
   * outside. What damaged tiles hold is not known. @throws RangeError if the line touches more than 255 tiles */
  profile(x: number, y: number, xEnd: number, yEnd: number): Promise<ProfilePlace[]>;
}
