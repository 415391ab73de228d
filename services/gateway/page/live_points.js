// What was seen since the last finished submap, as pictures of cells of several widths, one of each width that is looked at. A point is drawn once into it, and not in each picture of the page: without a graphics processor
// each point costs a microsecond.
import { Floats, PART_VERTEX, Program, Vertices, emptyTexture } from "./gl.js";

const WIDEST_CELL_M = 0.2; // of the first level
const LEVELS = 7; // each with cells twice as wide
const SIDE_CELLS = 2048; // of each picture, 8 MB: at the first level up to 205 m to each side of the submap's origin
const MOVING = 2; // label of a point; others are stationary

const VERTEX = `
layout(location=0) in vec2 cell; layout(location=1) in float label; out vec2 evidence;
void main() {
  gl_Position = vec4((cell + 0.5) / ${SIDE_CELLS / 2}.0, 0.0, 1.0);
  gl_PointSize = 1.0;
  evidence = label == ${MOVING}.0 ? vec2(0.0, 1.0) : vec2(1.0, 0.0);
}`;
const FRAGMENT = `in vec2 evidence; out vec4 result; void main() { result = vec4(evidence, 0.0, 1.0); }`;

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
    this.shown = new Program(gl, PART_VERTEX, SHOWN_FRAGMENT);
    this.corners = gl.createVertexArray();
  }

  emptyTexture() {
    const gl = this.gl;
    const texture = emptyTexture(gl, gl.RG8, SIDE_CELLS);
    this.into(texture, () => {
      gl.clearColor(0, 0, 0, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
    });
    return texture;
  }

  /** points: column, row and label of each. */
  paint(points, texture) {
    const gl = this.gl;
    this.vertices.fill(points, gl.STREAM_DRAW);
    this.into(texture, () => {
      this.program.use({});
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

  into(texture, draw) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, SIDE_CELLS, SIDE_CELLS);
    gl.disable(gl.BLEND);
    draw();
    gl.enable(gl.BLEND);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
  }
}

/** Points of one submap. */
export class LivePoints {
  /** cell_m: of finished submaps, if there are any. */
  constructor(painter, cell_m = WIDEST_CELL_M) {
    this.painter = painter;
    this.levels = Array.from({ length: LEVELS }, (_, i) => ({
      cell_m: Math.min(cell_m, WIDEST_CELL_M) * 2 ** i, taken: new Set(), points: new Floats(3), bounds: [Infinity, Infinity, -Infinity, -Infinity], painted: 0, texture: null,
    }));
  }

  /** x, y in the submap. */
  add(x, y, label) {
    for (const { cell_m, taken, points, bounds } of this.levels) {
      const column = Math.floor(x / cell_m), row = Math.floor(y / cell_m);
      if (Math.max(Math.abs(column), Math.abs(row)) >= SIDE_CELLS / 2) continue;
      const key = (column * SIDE_CELLS + row) * 4 + label;
      if (taken.has(key)) return; // so it is in the wider ones
      taken.add(key);
      points.add(column, row, label);
      bounds[0] = Math.min(bounds[0], column);
      bounds[1] = Math.min(bounds[1], row);
      bounds[2] = Math.max(bounds[2], column + 1);
      bounds[3] = Math.max(bounds[3], row + 1);
    }
  }

  get isEmpty() {
    return this.levels.at(-1).points.count === 0;
  }

  /** [x, y, width, height] of what was seen, in the submap. */
  get box() {
    return this.boxOf(this.levels.at(-1));
  }

  boxOf({ bounds: [left, bottom, right, top], cell_m }) {
    return [left, bottom, right - left, top - bottom].map((cells) => cells * cell_m);
  }

  /** The picture whose cells are at least as wide as a pixel of so many metres. colors: {wall, motion}; opacity: of both. */
  show(matrix, pixel_m, colors, opacity) {
    const wanted = this.levels.find(({ cell_m }) => cell_m >= pixel_m) ?? this.levels.at(-1);
    for (const level of this.levels) if (level !== wanted) this.forget(level);
    if (wanted.points.count === 0) return;
    this.paint(wanted);
    const box = this.boxOf(wanted);
    const source = box.map((metres, i) => metres / (wanted.cell_m * SIDE_CELLS) + (i < 2 ? 0.5 : 0));
    this.painter.show(wanted.texture, { matrix, box, source, wall: colors.wall, motion: colors.motion, opacity });
  }

  paint(level) {
    level.texture ??= this.painter.emptyTexture();
    if (level.painted < level.points.count) this.painter.paint(level.points.view().subarray(3 * level.painted), level.texture);
    level.painted = level.points.count;
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
