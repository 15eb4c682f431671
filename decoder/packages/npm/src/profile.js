// SPDX-License-Identifier: MIT
// Profiles along segments.

const END = 2 ** 30; // where a segment ends
const SEGMENT = 32, STATE = 56, CROSSING = 16; // bytes of microtin_segment and others

// The places along a segment between two lattice positions, none if one is NaN. next(segment, state, crossing) finds one
// after another; it is 0, or there are none.
export function placesAlong(instance, { x, y, z }, ends, next) {
  if (ends.some(Number.isNaN)) return [];
  return instance.borrow(SEGMENT + STATE + CROSSING, (segment) => {
    const [state, crossing] = [segment + SEGMENT, segment + SEGMENT + STATE];
    ends.forEach((end, i) => instance.view.setBigInt64(segment + 8 * i, BigInt(end), true));
    instance.put(state, new Uint8Array(STATE));
    const places = [];
    for (let along = 0; along < 1 && next(segment, state, crossing) === 0;) {
      const [part, height, result, before] = instance.array(Int32Array, crossing, 4);
      along = part / END;
      const at = (axis, from, to) => axis.start + ((from + (to - from) * along) / 256) * axis.step;
      places.push({
        along,
        x: at(x, ends[0], ends[2]),
        y: at(y, ends[1], ends[3]),
        height: result ? NaN : z.start + (height / 65536) * z.step,
        isKnownBefore: places.length > 0 && before === 0,
      });
    }
    return places;
  });
}
