// SPDX-License-Identifier: MIT
// Where one looks from: around a target, in a world where the terrain's longer side is 2 long.

const NEAREST = 0.01, FARTHEST = 12, FIELD = 0.7; // of view, radians

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

export class Camera {
  constructor() {
    this.showWhole();
  }

  showWhole() {
    Object.assign(this, { target: [0, 0, 0], distance: 3.2, azimuth: -0.5, elevation: 0.7, isMap: false });
  }

  // From straight above, without perspective, north up.
  showMap() {
    this.showWhole();
    Object.assign(this, { azimuth: 0, elevation: Math.PI / 2, isMap: true });
  }

  // Towards the target.
  get forward() {
    const flat = Math.cos(this.elevation);
    return [flat * Math.sin(this.azimuth), flat * Math.cos(this.azimuth), -Math.sin(this.elevation)];
  }
  get right() {
    return [Math.cos(this.azimuth), -Math.sin(this.azimuth), 0];
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
    this.target = this.target.map((value, i) => clamp(value + step[i] * this.distance, -4, 4));
  }

  approach(factor) {
    this.distance = clamp(this.distance * factor, NEAREST, FARTHEST);
  }

  // Column by column, for a view so many times as wide as high.
  matrix(aspect) {
    const back = this.forward.map((value) => -value), { right, eye } = this;
    const up = cross(back, right);
    const view = [right, up, back].map((axis) => [...axis, -dot(axis, eye)]);
    const wide = Math.tan(FIELD / 2), near = this.distance / 50, far = this.distance + 12;
    const x = 1 / (wide * Math.max(aspect, 1e-6)), y = 1 / wide;
    const rows = this.isMap
      ? [view[0].map((value) => (value * x) / this.distance), view[1].map((value) => (value * y) / this.distance),
        view[2].map((value, i) => (-2 * value) / (far - near) - (i === 3 ? (far + near) / (far - near) : 0)), [0, 0, 0, 1]]
      : [view[0].map((value) => value * x), view[1].map((value) => value * y),
        view[2].map((value, i) => (value * (far + near)) / (near - far) + (i === 3 ? (2 * far * near) / (near - far) : 0)),
        view[2].map((value) => -value)];
    return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][i >> 2]);
  }
}
