// SPDX-License-Identifier: MIT
// The terrain on the graphics processor: tinted and lit as in the pictures.

const VERTEX = `#version 300 es
in vec3 position;
in vec3 normal;
uniform mat4 view;
uniform vec3 offset; // of the mesh's origin from the middle; of the lowest height
uniform vec3 stretch;
out vec3 upward;
out vec3 place; // from the middle; the height is absolute
void main() {
  place = vec3(position.xy + offset.xy, position.z);
  upward = normal;
  gl_Position = view * vec4((position + offset) * stretch, 1.0);
}`;

// As in encoder/picture/maps.cpp.
const GROUND = `#version 300 es
precision highp float;
in vec3 upward;
in vec3 place;
uniform sampler2D tints;
uniform vec2 heights; // the lowest, and one over the range
uniform vec4 water; // height, and half of what counts as it
out vec4 colour;
const vec3 light = vec3(-0.53, 0.53, 0.66), shadow = vec3(0.25, 0.29, 0.42);
void main() {
  if (abs(place.z - water.x) < water.y) {
    colour = vec4(0.56, 0.73, 0.84, 1.0);
    return;
  }
  float relative = (place.z - heights.x) * heights.y;
  vec3 base = texture(tints, vec2((relative * 63.0 + 0.5) / 64.0, 0.5)).rgb;
  float lit = dot(normalize(upward), light) / light.z;
  vec3 shaded = lit >= 1.0 ? mix(base, vec3(1.0), min(1.0, (lit - 1.0) * 0.9))
                           : mix(base, shadow, min(0.85, (1.0 - lit) * 0.75));
  colour = vec4(shaded, 1.0);
}`;

const LINE = `#version 300 es
precision highp float;
in vec3 upward;
in vec3 place;
uniform vec4 line;
out vec4 colour;
void main() {
  colour = line;
}`;

const PLACE = `#version 300 es
precision highp float;
in vec3 upward;
in vec3 place;
out uvec4 found;
void main() {
  found = uvec4(floatBitsToUint(place), 1u);
}`;

const MESH_LINE = [0.13, 0.17, 0.24, 0.45], TILE_LINE = [0.75, 0.15, 0.1, 1];

function compile(gl, fragment) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.bindAttribLocation(program, 0, "position");
  gl.bindAttribLocation(program, 1, "normal");
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

export class Scene {
  // Throws if there is no WebGL2.
  constructor(canvas, tints) {
    const gl = canvas.getContext("webgl2", { antialias: true });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.programs = { ground: compile(gl, GROUND), line: compile(gl, LINE), place: compile(gl, PLACE) };
    this.meshes = new Map(); // by tile: one for each phase
    this.#putTints(tints);
    this.#makePlaceTarget();
    gl.enable(gl.DEPTH_TEST);
    gl.polygonOffset(2, 8);
    // What covers the page covers it still beneath a line.
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  #putTints(tints) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, tints.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, Uint8Array.from(tints));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  }

  // One pixel, which holds a place.
  #makePlaceTarget() {
    const { gl } = this;
    this.target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    for (const [where, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA32UI], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, where, gl.RENDERBUFFER, buffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  // The real middle, how long units of x, y and heights are in the world, and the lowest and highest height.
  frame({ middle, units, heights: [lowest, highest], water }) {
    this.middle = middle;
    this.units = units;
    this.heights = [lowest, 1 / Math.max(highest - lowest, 1e-9)];
    this.lowest = lowest;
    this.water = water;
  }

  add({ tile, phase, origin, positions, normals, indices, edges, rims }) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const [place, values] of [[0, positions], [1, normals]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    }
    const buffers = [indices, edges, rims].map((values) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, values, gl.STATIC_DRAW);
      return { buffer, count: values.length };
    });
    const phases = this.meshes.get(tile) ?? [];
    phases[phase - 1] = { array, buffers, origin };
    this.meshes.set(tile, phases);
  }

  #drawAll(program, mode, which, phase) {
    const { gl } = this;
    for (const phases of this.meshes.values()) {
      const mesh = phases[Math.min(phase, phases.length) - 1];
      gl.uniform3f(gl.getUniformLocation(program, "offset"), mesh.origin[0] - this.middle[0],
        mesh.origin[1] - this.middle[1], -this.lowest);
      gl.bindVertexArray(mesh.array);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.buffers[which].buffer);
      gl.drawElements(mode, mesh.buffers[which].count, gl.UNSIGNED_INT, 0);
    }
  }

  #use(name, matrix) {
    const { gl } = this;
    const program = this.programs[name];
    gl.useProgram(program);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, "view"), false, matrix);
    gl.uniform3f(gl.getUniformLocation(program, "stretch"), this.units[0], this.units[1], this.scale * this.units[2]);
    return program;
  }

  draw({ matrix, width, height, scale, phase, mesh, tiles }) {
    const { gl } = this;
    if (gl.canvas.width !== width || gl.canvas.height !== height) Object.assign(gl.canvas, { width, height });
    this.scale = scale;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    // Not while lines are drawn, which it should not move: a software renderer moves them at random.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    const ground = this.#use("ground", matrix);
    gl.uniform2f(gl.getUniformLocation(ground, "heights"), ...this.heights);
    gl.uniform4f(gl.getUniformLocation(ground, "water"), this.water?.height ?? 0, this.water?.half ?? -1, 0, 0);
    this.#drawAll(ground, gl.TRIANGLES, 0, phase);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.enable(gl.BLEND);
    const line = this.#use("line", matrix);
    if (tiles) this.#drawLines(line, TILE_LINE, 2, phase); // first: the mesh has the same lines, no nearer
    if (mesh) this.#drawLines(line, MESH_LINE, 1, phase);
    gl.disable(gl.BLEND);
  }

  #drawLines(program, colour, which, phase) {
    this.gl.uniform4f(this.gl.getUniformLocation(program, "line"), ...colour);
    this.#drawAll(program, this.gl.LINES, which, phase);
  }

  // The real place that is seen at a pixel, from the lower left; undefined beside the terrain.
  placeAt(matrix, x, y, phase) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(-x, -y, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.#drawAll(this.#use("place", matrix), gl.TRIANGLES, 0, phase);
    const found = new Uint32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const place = new Float32Array(found.buffer);
    return found[3] ? [place[0] + this.middle[0], place[1] + this.middle[1]] : undefined;
  }
}
