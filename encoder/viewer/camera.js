// SPDX-License-Identifier: MIT
// Where one looks from: around a target, in a world where the terrain's longer side is 2 long.

const NEAREST = 0.01, FIELD = 0.7; // of view, radians
const WIDE = Math.tan(FIELD / 2), MARGIN = 1.1;

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

export class Camera {
  box = [2, 2, 0]; // the terrain's sides in the world, with its heights; they begin at 0
  aspect = 1; // of the view: width over height

  constructor() {
    this.showWhole();
  }

  showWhole() {
    this.#look({ azimuth: -0.5, elevation: 0.7, isMap: false });
  }

  // From straight above, without perspective, north up.
  showMap() {
    this.#look({ azimuth: 0, elevation: Math.PI / 2, isMap: true });
  }

  // At the middle of the box, from so far away that all its corners are in view.
  #look(direction) {
    Object.assign(this, { ...direction, target: [0, 0, this.box[2] / 2] });
    const { up, right, forward } = this;
    const needed = Array.from({ length: 8 }, (_, corner) => {
      const place = this.box.map((side, i) => (corner >> i & 1 ? side : -side) / 2);
      const reach = Math.max(Math.abs(dot(right, place)) / this.aspect, Math.abs(dot(up, place))) / WIDE;
      return reach - (this.isMap ? 0 : dot(forward, place));
    });
    this.distance = Math.max(NEAREST, MARGIN * Math.max(...needed));
  }

  // The box's longest line.
  get size() {
    return Math.hypot(...this.box);
  }
  // The world's length that fills the view from below to above, at the target.
  get span() {
    return 2 * WIDE * this.distance;
  }

  // Towards the target.
  get forward() {
    const flat = Math.cos(this.elevation);
    return [flat * Math.sin(this.azimuth), flat * Math.cos(this.azimuth), -Math.sin(this.elevation)];
  }
  get right() {
    return [Math.cos(this.azimuth), -Math.sin(this.azimuth), 0];
  }
  get up() {
    return cross(this.right, this.forward);
  }
  get eye() {
    return this.target.map((value, i) => value - this.forward[i] * this.distance);
  }

  // Around the target, or, when one flies, around the eye.
  turn(across, up, aroundEye) {
    this.isMap = false;
    const { eye } = this;
    const sign = aroundEye ? 1 : -1;
    this.azimuth += sign * across;
    this.elevation = clamp(this.elevation - sign * up, aroundEye ? -1.5 : 0.02, Math.PI / 2);
    if (aroundEye) this.target = eye.map((value, i) => value + this.forward[i] * this.distance);
  }

  // Over the ground: to the right, ahead and up, in parts of the distance.
  move(right, ahead, up) {
    const [sine, cosine] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    const step = [right * cosine + ahead * sine, ahead * cosine - right * sine, up];
    this.target = this.target.map((value, i) => clamp(value + step[i] * this.distance, -2 * this.size, 2 * this.size));
  }

  approach(factor) {
    this.distance = clamp(this.distance * factor, NEAREST, 4 * this.size);
  }

  // Column by column.
  matrix() {
    const back = this.forward.map((value) => -value), { right, up, eye } = this;
    const view = [right, up, back].map((axis) => [...axis, -dot(axis, eye)]);
    const far = this.distance + 4 * this.size;
    const near = this.isMap ? this.distance - 4 * this.size : this.distance / 50; // also of what is above the eye
    const x = 1 / (WIDE * this.aspect), y = 1 / WIDE;
    const rows = this.isMap
      ? [view[0].map((value) => (value * x) / this.distance), view[1].map((value) => (value * y) / this.distance),
        view[2].map((value, i) => (-2 * value) / (far - near) - (i === 3 ? (far + near) / (far - near) : 0)), [0, 0, 0, 1]]
      : [view[0].map((value) => value * x), view[1].map((value) => value * y),
        view[2].map((value, i) => (value * (far + near)) / (near - far) + (i === 3 ? (2 * far * near) / (near - far) : 0)),
        view[2].map((value) => -value)];
    return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][i >> 2]);
  }
}
