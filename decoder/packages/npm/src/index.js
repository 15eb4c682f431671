// SPDX-License-Identifier: MIT
export { ready, version } from "./instance.js";
export { Pack } from "./pack.js";
export { MicrotinError } from "./status.js";
export { Decoder, Terrain, decode, decodeStream } from "./terrain.js";
