// SPDX-License-Identifier: MIT
// What a header says beside the terrain: format-stream.md, section 4.

import { checkNumber } from "./check.js";
import { OK } from "./status.js";

const UNITS = [undefined, "metre", "degree", "international foot", "US survey foot"];
const SURFACES = [undefined, "ground", "top", "bed", "geoid", "obstacles"];
const SIDES = [undefined, "both", "never_below", "never_above"];
const ACCURACIES = [undefined, "LE90", "RMSE", "LE95"];
const AXIS_BYTES = 24, NOT_STATED = 0xffffffff;

// An axis as the decoder writes it: the real coordinate of lattice value k is start + step * k.
function axisAt(view, at) {
  const denominator = Number(view.getBigUint64(at + 16, true));
  return {
    start: Number(view.getBigInt64(at, true)) / denominator,
    step: Number(view.getBigUint64(at + 8, true)) / denominator,
  };
}

export function axesAt(view, at) {
  return { x: axisAt(view, at), y: axisAt(view, at + AXIS_BYTES), z: axisAt(view, at + 2 * AXIS_BYTES) };
}

// The margins that lie at `at` as the decoder writes them, in units of height; undefined if they are not stated.
export function everywhereAt(view, at, axes) {
  const [below, above] = [at, at + 4].map((place) => view.getUint32(place, true));
  if (below === NOT_STATED || above === NOT_STATED) return undefined;
  return { below: (below / 16) * axes.z.step, above: (above / 16) * axes.z.step };
}

// The place of a coordinate on an axis, with the 8 fractional bits of queries; NaN outside 0 .. `most` steps.
export function toLattice(axis, most, value) {
  const place = Math.round(((checkNumber("a coordinate", value) - axis.start) / axis.step) * 256);
  return place >= 0 && place <= 256 * most ? place : NaN;
}

// Whether a stream can hold so many vertices behind its header: each takes two symbols at least, of which a byte holds
// fewer than 2842 (shared/docs/guarantees.md). No memory is taken for those that a header alone states.
export function canHold(bytes, vertices) {
  return vertices <= 3 + 1421 * bytes;
}

// Reads a note from its beginning; what it lacks is 0.
class NoteReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.next = 0;
  }

  byte() {
    return this.bytes[this.next++] ?? 0;
  }

  varint() {
    let value = 0n;
    for (let byte = 128; byte & 128; ) {
      byte = this.byte();
      value = (value << 7n) | BigInt(byte & 127);
    }
    return value;
  }

  // The number of entries that follow, at most the number of bytes.
  count() {
    return Math.min(Number(this.varint()), this.bytes.length);
  }

  text() {
    return new TextDecoder().decode(this.bytes);
  }

  decimal() {
    const value = this.varint();
    const mantissa = value & 1n ? -(value >> 1n) - 1n : value >> 1n;
    return Number(`${mantissa}e-${this.byte()}`);
  }
}

const NOTES = {
  1: (note) => ({ units: { horizontal: UNITS[note.byte()], vertical: UNITS[note.byte()] } }),
  2: (note) => ({
    epsg: {
      horizontal: Number(note.varint()) || undefined,
      vertical: Number(note.varint()) || undefined,
    },
  }),
  3: (note) => ({ source: note.text() }),
  4: (note) => {
    const isBound = note.byte() === 1;
    const [bound, largest, rms, mean] = Array.from({ length: 4 }, () => note.decimal());
    return { accuracy: { bound: isBound ? bound : undefined, largest, rms, mean } };
  },
  5: (note) => ({ date: note.text() }),
  7: (note) => ({ waterLevel: note.decimal() }),
  9: (note) => ({ wkt: note.text() }),
  13: (note) => {
    const surface = { kind: SURFACES[note.byte()], side: SIDES[note.byte()] };
    const hasErrors = note.next < note.bytes.length;
    return { surface: hasErrors ? { ...surface, below: note.decimal(), above: note.decimal() } : surface };
  },
  14: (note) => ({
    phases: Array.from({ length: note.count() }, () => {
      const [vertices, bytes] = [Number(note.varint()), Number(note.varint())];
      return { vertices, bytes, ...(note.byte() === 1 && { largest: note.decimal() }) };
    }),
  }),
  15: (note) => ({ digest: note.bytes.subarray(0, 8).reduceRight((sum, byte) => (sum << 8n) | BigInt(byte), 0n) }),
  64: (note) => ({ attribution: note.text() }),
  65: (note) => ({ license: note.text() }),
  66: (note) => ({ epoch: note.decimal() }),
  67: (note) => ({ valid: note.text() }),
  68: (note) => ({ sourceAccuracy: { kind: ACCURACIES[note.byte()], value: note.decimal() } }),
};

// The notes of the header with which `size` bytes at `start` of an instance's memory begin.
export function notesAt(instance, start, size) {
  const notes = {};
  for (const [type, read] of Object.entries(NOTES)) {
    const { results } = instance;
    if (instance.calls.microtin_find_note(start, size, type, results, results + 4) !== OK) continue;
    const content = instance.result();
    Object.assign(notes, read(new NoteReader(instance.array(Uint8Array, content, instance.result(1)).slice())));
  }
  return notes;
}
