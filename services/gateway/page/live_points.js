// What was seen since the last finished submap, as pictures of cells of several widths, one of each width that is looked at. A point is drawn once into it, and not in each picture of the page: without a graphics processor
// each point costs a microsecond.
import { Floats, Program, Vertices } from "./gl.js";

const CELL_M = 0.2;
const LEVELS = 6; // each with cells twice as wide: up to 6.4 m
const SIDE_CELLS = 2048; // of the narrowest: 205 m to each side of the submap's origin
const MOVING = 2; // label of a point; others are stationary

const VERTEX = `
layout(location=0) in vec2 cell; layout(location=1) in float label; uniform float side; out vec2 evidence;
void main() {
  gl_Position = vec4((cell + 0.5) / (0.5 * side), 0.0, 1.0);
  gl_PointSize = 1.0;
  evidence = label == ${MOVING}.0 ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
}`;
const FRAGMENT = `in vec2 evidence; out vec4 result; void main() { result = vec4(evidence, 0.0, 1.0); }`;

const SHOWN_VERTEX = `
uniform mat4 matrix; uniform vec4 box; uniform vec4 source; out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at = source.xy + corner * source.zw;
  gl_Position = matrix * vec4(box.xy + corner * box.zw, 0.0, 1.0);
}`;
// Red: share of stationary objects, green: of motion.
const SHOWN_FRAGMENT = `
in vec2 at; uniform sampler2D cells; uniform vec3 wall; uniform vec3 motion; uniform vec2 opacity; out vec4 result;
void main() {
  vec2 strength = texture(cells, at).rg * opacity;
  result = vec4(wall, 1.0) * strength.r + vec4(motion, 1.0) * strength.g * (1.0 - strength.r);
}`;

/** Draws points into the pictures of all submaps, and shows them. */
export class PointPainter {
  constructor(gl) {
    this.gl = gl;
    this.program = new Program(gl, VERTEX, FRAGMENT);
    this.vertices = new Vertices(gl, 12, [[0, 2, gl.FLOAT, false, 0, 0], [1, 1, gl.FLOAT, false, 8, 0]]);
    this.target = gl.createFramebuffer();
    this.shown = new Program(gl, SHOWN_VERTEX, SHOWN_FRAGMENT);
    this.corners = gl.createVertexArray();
  }

  emptyTexture(side) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RG8, side, side);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    this.into(texture, side, () => {
      gl.clearColor(0, 0, 0, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
    });
    return texture;
  }

  /** points: column, row and label of each. */
  paint(points, texture, side) {
    const gl = this.gl;
    this.vertices.fill(points, gl.STREAM_DRAW);
    this.into(texture, side, () => {
      this.program.use({ side });
      this.vertices.bind();
      gl.drawArrays(gl.POINTS, 0, points.length / 3);
    });
  }

  /** values: {matrix, box in the submap, source: the same in the picture, wall, motion, opacity}. */
  show(texture, values) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    this.shown.use(values);
    gl.bindVertexArray(this.corners);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  into(texture, side, draw) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, side, side);
    gl.disable(gl.BLEND);
    draw();
    gl.enable(gl.BLEND);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
  }
}

/** Points of one submap. */
export class LivePoints {
  constructor(painter) {
    this.painter = painter;
    this.levels = Array.from({ length: LEVELS }, () => ({ taken: new Set(), points: new Floats(3), painted: 0, texture: null }));
    this.bounds = [Infinity, Infinity, -Infinity, -Infinity]; // of the points, in cells of the first level
  }

  /** x, y in the submap. */
  add(x, y, label) {
    const column = Math.floor(x / CELL_M), row = Math.floor(y / CELL_M);
    if (Math.max(Math.abs(column), Math.abs(row)) >= SIDE_CELLS / 2) return;
    const [left, bottom, right, top] = this.bounds;
    if (column < left || row < bottom || column >= right || row >= top)
      this.bounds = [Math.min(left, column), Math.min(bottom, row), Math.max(right, column + 1), Math.max(top, row + 1)];
    for (let i = 0; i < LEVELS; ++i) {
      const { taken, points } = this.levels[i];
      const cell = [column >> i, row >> i];
      const key = (cell[0] * SIDE_CELLS + cell[1]) * 4 + label;
      if (taken.has(key)) return; // so it is in the wider ones
      taken.add(key);
      points.add(cell[0], cell[1], label);
    }
  }

  get isEmpty() {
    return this.levels[0].points.count === 0;
  }

  /** [x, y, width, height] of what was seen, in the submap. */
  get box() {
    const [left, bottom, right, top] = this.bounds;
    return [left, bottom, right - left, top - bottom].map((cells) => cells * CELL_M);
  }

  /** colors: {wall, motion}; opacity: of both. */
  show(matrix, pixel_m, colors, opacity) {
    const { box } = this;
    const source = box.map((metres, i) => metres / (CELL_M * SIDE_CELLS) + (i < 2 ? 0.5 : 0));
    this.painter.show(this.texture(pixel_m), { matrix, box, source, wall: colors.wall, motion: colors.motion, opacity });
  }

  /** The picture whose cells are at least as wide as a pixel of so many metres. */
  texture(pixel_m) {
    const wanted = Math.min(LEVELS - 1, Math.max(0, Math.ceil(Math.log2(pixel_m / CELL_M))));
    for (const level of this.levels) if (level !== this.levels[wanted]) this.forget(level);
    const level = this.levels[wanted], side = SIDE_CELLS >> wanted;
    level.texture ??= this.painter.emptyTexture(side);
    if (level.painted < level.points.count) this.painter.paint(level.points.view().subarray(3 * level.painted), level.texture, side);
    level.painted = level.points.count;
    return level.texture;
  }

  forget(level) {
    if (level.texture) this.painter.gl.deleteTexture(level.texture);
    level.texture = null;
    level.painted = 0;
  }

  remove() {
    for (const level of this.levels) this.forget(level);
  }
}
