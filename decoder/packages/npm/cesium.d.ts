// SPDX-License-Identifier: MIT
import type { Pack } from "./microtin.js";

/** A terrain provider of CesiumJS, whose types are its own and `any` here.
 *
 * The tiles of the finest level are the pack's own, vertex by vertex, so that their borders meet; each coarser level,
 * of which there are at most three, joins two by two of them from their first phases: packs that are encoded with
 * `--max-degree 6` have several, others often none. Where levels meet, skirts hide the difference. Places are rounded to 1/32767 of
 * a tile, the unit of quantized meshes; heights are exact if the pack has at most 32768 different ones.
 * Tiles without terrain are empty; below the finest level CesiumJS divides tiles itself. */
export interface MicrotinTerrainProvider {
  readonly tilingScheme: any;
  readonly errorEvent: any;
  readonly credit: any;
  readonly availability: any;
  readonly hasWaterMask: boolean;
  readonly hasVertexNormals: boolean;
  /** Levels of detail; the finest is `levels - 1`. */
  readonly levels: number;
  /** In metres: at the finest level the pack's greatest error; at coarser ones an estimate, CesiumJS's own for grids, a
   * quarter of the distance between vertices. */
  getLevelMaximumGeometricError(level: number): number;
  getTileDataAvailable(x: number, y: number, level: number): boolean;
  loadTileDataAvailability(x: number, y: number, level: number): undefined;
  /** Undefined while too many tiles are being made. */
  requestTileGeometry(x: number, y: number, level: number): Promise<any> | undefined;
}

/** Makes a terrain provider of a pack in degrees, EPSG:4326.
 *
 * Heights are passed as they are: CesiumJS takes them to be above the ellipsoid, while most elevation data is above the
 * geoid, up to 107 m away from it.
 * @param cesium the module of CesiumJS: `import * as cesium from "cesium"`
 * @throws RangeError if the pack is in another or in no known system, or not in degrees and metres */
export function cesiumTerrain(cesium: object, pack: Pack, options?: { credit?: string }): MicrotinTerrainProvider;
