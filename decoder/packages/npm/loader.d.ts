// SPDX-License-Identifier: MIT
import type { TerrainHeader } from "./microtin.js";

/** A mesh as loaders.gl knows it; positions are relative to `loaderData.origin`. Voids are left out. */
export interface MicrotinMesh {
  loader: "microtin";
  loaderData: { header: TerrainHeader; origin: [number, number] };
  header: { vertexCount: number; boundingBox: [number[], number[]] };
  schema: { fields: []; metadata: {} };
  topology: "triangle-list";
  mode: 4;
  indices: { value: Uint32Array; size: 1 };
  attributes: { POSITION: { value: Float32Array; size: 3 } };
}

/** For `load(url, MicrotinLoader)` and `loadInBatches` of @loaders.gl/core, which then has a batch for each phase. */
export const MicrotinLoader: {
  id: "microtin";
  name: string;
  dataType: null;
  batchType: null;
  module: "microtin";
  version: string;
  worker: false;
  extensions: string[];
  mimeTypes: string[];
  category: "mesh";
  binary: true;
  tests: string[];
  options: { microtin: object };
  parse(buffer: ArrayBuffer): Promise<MicrotinMesh>;
  parseInBatches(chunks: AsyncIterable<ArrayBufferLike | Uint8Array>): AsyncGenerator<MicrotinMesh, void>;
};
