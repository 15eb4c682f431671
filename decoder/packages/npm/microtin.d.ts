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
  /** Triangles of which all vertices have this very height are water. */
  waterLevel?: number;
}

export interface TerrainHeader extends Header {
  vertices: number;
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

/** A terrain. While it is being decoded it grows: arrays are those of the moment. */
export interface Terrain extends Mesh {
  readonly header: TerrainHeader;
  readonly vertexCount: number;
  /** Bytes of the stream that have been decoded. */
  readonly bytes: number;
  /** Whether all is decoded and verified. */
  readonly done: boolean;
  /** A number that depends on the set of triangles alone; equal on every machine. */
  readonly digest: bigint;
  /** The height at a real place; NaN outside, or where the terrain is not known. */
  heightAt(x: number, y: number): number;
}

/** Decodes a whole stream; await {@link ready} first. @throws MicrotinError */
export function decode(bytes: Uint8Array): Terrain;

/** Decodes a stream from its bytes in any pieces; await {@link ready} first. */
export class Decoder {
  /** Undefined until the header is complete. */
  readonly terrain: Terrain | undefined;
  /** Takes the next bytes. Yields the terrain each time that a section of it, one phase or the first few together,
   * has passed its check: coarse at first, then finer. @throws MicrotinError */
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

/** Decodes a stream while it arrives: see {@link Decoder.push}. @throws MicrotinError */
export function decodeStream(source: Chunks): AsyncGenerator<Terrain, void>;

/** Where a pack lies: a URL, fetched by HTTP ranges; a file; all its bytes; or a function that reads up to `size`
 * bytes at `offset`, none only behind the end. */
export type PackSource =
  | string
  | URL
  | Blob
  | Uint8Array
  | ((offset: number, size: number) => Promise<Uint8Array>);

/** A terrain in tiles; only what is asked for is read. Its calls may overlap; they are served one by one. A call that
 * fails with status IO may be tried again. */
export class Pack {
  private constructor();
  /** @param options.slots tiles that are kept in memory; more where one question needs more */
  static open(source: PackSource, options?: { slots?: number }): Promise<Pack>;
  readonly header: Header;
  /** Tiles in a row and rows; tile 0 is the south-western one, and numbers grow along rows. */
  readonly columns: number;
  readonly rows: number;
  /** Width and height of a tile in steps of x and y; those of the last column and row may be smaller. */
  readonly tileSize: [number, number];
  readonly mostVertices: number;
  /** The lowest and highest vertex. */
  readonly lowest: number;
  readonly highest: number;
  /** Bytes read from the source so far. */
  readonly bytesRead: number;
  /** The real extent of a tile: x, y, largest x, largest y. */
  tileBox(tile: number): [number, number, number, number];
  /** The numbers of the tiles that touch an extent. */
  tilesIn(xMin: number, yMin: number, xMax: number, yMax: number): number[];
  /** A tile's mesh; empty if the terrain is not known there. Neighbours share their border, so there are no cracks. */
  tile(tile: number): Promise<Mesh & { done: true }>;
  /** The same, coarse at first, each as soon as its bytes are there. */
  tilePhases(tile: number): AsyncGenerator<Mesh & { done: boolean }, void>;
  /** The height at a real place; NaN outside, or where the terrain is not known. */
  heightAt(x: number, y: number): Promise<number>;
  /** The exact greatest height on the straight course; NaN if a part of it lies outside or where nothing is known. */
  highestOn(x: number, y: number, xEnd: number, yEnd: number): Promise<number>;
}
