// Lines of constant width in pixels, boxes and points: what is drawn anew with each picture.
// All coordinates are relative to the camera's target.
import { FloatTexture, Floats, Program, Vertices } from "./gl.js";

// Not instanced: without a graphics processor each instance costs as much as a draw call.
const LINES_A_ROW = 256;
const LINE_VERTEX = `
uniform highp sampler2D lines; uniform mat4 matrix; uniform vec2 size; out vec4 tint; out float side; out float half_width;
const int corners[6] = int[6](0, 1, 2, 2, 1, 3);
void main() {
  int line = gl_VertexID / 6, corner = corners[gl_VertexID % 6];
  ivec2 texel = ivec2(line % ${LINES_A_ROW} * 3, line / ${LINES_A_ROW});
  vec4 from = texelFetch(lines, texel, 0), to = texelFetch(lines, texel + ivec2(1, 0), 0);
  vec4 color = texelFetch(lines, texel + ivec2(2, 0), 0);
  float width = from.w;
  vec4 a = matrix * vec4(from.xyz, 1.0), b = matrix * vec4(to.xyz, 1.0);
  const float near = 0.01;
  if (a.w < near && b.w < near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  float length_px = length(along);
  vec2 dir = length_px > 0.001 ? along / length_px : vec2(1.0, 0.0);
  float end = float(corner & 1); side = float(corner >> 1) * 2.0 - 1.0;
  half_width = width * 0.5 + 1.0;
  vec4 at = end < 0.5 ? a : b;
  vec2 offset = vec2(-dir.y, dir.x) * side * half_width * 2.0;
  gl_Position = at + vec4(offset / size * at.w, 0.0, 0.0);
  tint = color;
}`;
const LINE_FRAGMENT = `
in vec4 tint; in float side; in float half_width; out vec4 result;
void main() {
  float edge = clamp(half_width - abs(side) * half_width, 0.0, 1.0);
  result = vec4(tint.rgb, 1.0) * tint.a * edge;
}`;

const BOX_VERTEX = `
layout(location=0) in vec3 place; layout(location=1) in float heading; layout(location=2) in vec3 extent; layout(location=3) in vec4 color;
uniform mat4 matrix; out vec4 tint;
const vec3 corners[36] = vec3[36](
  vec3(0,0,1),vec3(1,0,1),vec3(1,1,1),vec3(0,0,1),vec3(1,1,1),vec3(0,1,1),
  vec3(0,0,0),vec3(1,0,0),vec3(1,0,1),vec3(0,0,0),vec3(1,0,1),vec3(0,0,1),
  vec3(1,0,0),vec3(1,1,0),vec3(1,1,1),vec3(1,0,0),vec3(1,1,1),vec3(1,0,1),
  vec3(1,1,0),vec3(0,1,0),vec3(0,1,1),vec3(1,1,0),vec3(0,1,1),vec3(1,1,1),
  vec3(0,1,0),vec3(0,0,0),vec3(0,0,1),vec3(0,1,0),vec3(0,0,1),vec3(0,1,1),
  vec3(0,0,0),vec3(0,1,0),vec3(1,1,0),vec3(0,0,0),vec3(1,1,0),vec3(1,0,0));
const float shades[6] = float[6](1.0, 0.62, 0.8, 0.62, 0.7, 0.5);
void main() {
  vec3 local = (corners[gl_VertexID] - vec3(0.5, 0.5, 0.0)) * extent;
  float c = cos(heading), s = sin(heading);
  vec3 at = place + vec3(c * local.x - s * local.y, s * local.x + c * local.y, local.z);
  gl_Position = matrix * vec4(at, 1.0);
  tint = vec4(color.rgb * shades[gl_VertexID / 6], color.a);
}`;
const FLAT_FRAGMENT = `in vec4 tint; out vec4 result; void main() { result = vec4(tint.rgb, 1.0) * tint.a; }`;

const POINT_VERTEX = `
layout(location=0) in vec2 at; layout(location=1) in float label;
uniform mat4 matrix; uniform float diameter; uniform float height; uniform float alpha;
uniform vec3 stationary; uniform vec3 moving; uniform vec3 unknown; uniform vec3 unlabelled; out vec4 tint;
void main() {
  gl_Position = matrix * vec4(at, height, 1.0);
  bool is_moving = label == 2.0;
  gl_PointSize = diameter * (is_moving ? 1.35 : 1.0);
  vec3 color = label == 1.0 ? stationary : is_moving ? moving : label == 3.0 ? unknown : unlabelled;
  tint = vec4(color, alpha);
}`;
const POINT_FRAGMENT = `
in vec4 tint; out vec4 result;
void main() {
  float edge = 1.0 - smoothstep(0.35, 0.5, length(gl_PointCoord - 0.5));
  result = vec4(tint.rgb, 1.0) * tint.a * edge;
}`;

const FAN_VERTEX = `
layout(location=0) in vec2 at; uniform mat4 matrix; void main() { gl_Position = matrix * vec4(at, 0.0, 1.0); }`;
const FAN_FRAGMENT = `uniform vec4 color; out vec4 result; void main() { result = vec4(color.rgb, 1.0) * color.a; }`;

const GRID_LEAST_PX = 40; // between two lines
const GRID_PIECES = 6; // of a line, on each side, each of one strength
const GRID_FULL = 0.3; // share of its reach within which it does not fade

/** 1 near the camera's target, 0 at the end of the grid's reach. */
function fading(away) {
  const share = Math.max(0, (away - GRID_FULL) / (1 - GRID_FULL));
  return 1 - share * share * (3 - 2 * share);
}

export class Shapes {
  constructor(gl) {
    this.gl = gl;
    const F = gl.FLOAT;
    this.lines = new Floats(12); // from and width, to and nothing, color
    this.boxes = new Floats(11);
    this.lineProgram = new Program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.lineTexture = new FloatTexture(gl, 3 * LINES_A_ROW);
    this.boxProgram = new Program(gl, BOX_VERTEX, FLAT_FRAGMENT);
    this.boxVertices = new Vertices(gl, 44, [[0, 3, F, false, 0, 1], [1, 1, F, false, 12, 1], [2, 3, F, false, 16, 1], [3, 4, F, false, 28, 1]]);
    this.pointProgram = new Program(gl, POINT_VERTEX, POINT_FRAGMENT);
    this.fanProgram = new Program(gl, FAN_VERTEX, FAN_FRAGMENT);
    this.fanVertices = new Vertices(gl, 8, [[0, 2, F, false, 0, 0]]);
    this.noVertices = gl.createVertexArray();
  }

  /** For a picture of this resolution, on which the number of an ellipse's sides depends. */
  begin(metresPerPixel) {
    this.metresPerPixel = metresPerPixel;
    this.lines.clear();
    this.boxes.clear();
  }

  line(a, b, z, [r, g, blue], alpha, width) {
    this.lines.add(a[0], a[1], z, width, b[0], b[1], z, 0, r, g, blue, alpha);
  }

  /** points: flat list of x, y. alphaOf: of the segment that ends at the point's index. */
  strip(points, z, color, alphaOf, width) {
    for (let i = 2; i < points.length; i += 2)
      this.lines.add(points[i - 2], points[i - 1], z, width, points[i], points[i + 1], z, 0, color[0], color[1], color[2], alphaOf(i / 2));
  }

  ellipse(x, y, { major, minor, heading }, z, color, alpha, width) {
    const count = Math.min(40, Math.max(10, Math.round(6 * Math.sqrt(major / this.metresPerPixel))));
    const c = Math.cos(heading), s = Math.sin(heading);
    const points = [];
    for (let i = 0; i <= count; ++i) {
      const u = major * Math.cos((2 * Math.PI * i) / count), v = minor * Math.sin((2 * Math.PI * i) / count);
      points.push(x + c * u - s * v, y + s * u + c * v);
    }
    this.strip(points, z, color, () => alpha, width);
  }

  box([x, y, heading], length, width, height, color, alpha) {
    this.boxes.add(x, y, 0.02, heading, length, width, height, ...color, alpha);
  }

  /** Edges of a box: its bottom, top and corners. */
  frame([x, y, heading], length, width, height, color, alpha, thickness) {
    const c = Math.cos(heading), s = Math.sin(heading);
    const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([i, j]) => {
      const u = (i * length) / 2, v = (j * width) / 2;
      return [x + c * u - s * v, y + s * u + c * v];
    });
    corners.forEach((corner, i) => {
      const next = corners[(i + 1) % 4];
      this.line(corner, next, 0.05, color, alpha, thickness);
      this.line(corner, next, height, color, alpha, thickness);
      this.lines.add(...corner, 0.05, thickness, ...corner, height, 0, ...color, alpha * 0.7);
    });
  }

  /** An arrow on the ground. */
  arrow(from, to, z, color, alpha, width) {
    this.line(from, to, z, color, alpha, width);
    const dx = to[0] - from[0], dy = to[1] - from[1];
    const head = Math.min(1.2, 0.3 * Math.hypot(dx, dy)) / (Math.hypot(dx, dy) || 1);
    for (const side of [-0.6, 0.6])
      this.line(to, [to[0] - head * (dx + side * dy), to[1] - head * (dy - side * dx)], z, color, alpha, width);
  }

  /** Lines on the ground, every tenth bolder, fainter from afar. Width in pixels. */
  grid(camera, color, width) {
    const spacing = 10 ** Math.ceil(Math.log10(camera.metresPerPixel() * GRID_LEAST_PX));
    const reach = camera.distance * 4 + 50;
    const piece = reach / GRID_PIECES;
    const [left, bottom, right, top] = camera.groundSeen(reach).map((value, i) => value - (i % 2 ? camera.y : camera.x));
    const addLines = (first, [from, to], [begin, end], placed) => {
      for (let index = Math.ceil((first + from) / spacing); index * spacing < first + to; ++index) {
        const aside = index * spacing - first;
        const alpha = index % 10 === 0 ? 0.32 : 0.18;
        for (let along = begin; along < end; along += piece) {
          const away = Math.hypot(aside, along + piece / 2) / reach;
          if (away < 1) this.line(placed(aside, along), placed(aside, Math.min(end, along + piece)), 0, color, alpha * fading(away), width);
        }
      }
    };
    addLines(camera.x, [left, right], [bottom, top], (aside, along) => [aside, along]);
    addLines(camera.y, [bottom, top], [left, right], (aside, along) => [along, aside]);
  }

  drawLines(matrix, size) {
    const gl = this.gl;
    if (this.lines.count === 0) return;
    this.lineTexture.fill(this.lines);
    this.lineProgram.use({ matrix, size });
    gl.bindVertexArray(this.noVertices);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.lines.count);
  }

  drawBoxes(matrix) {
    const gl = this.gl;
    if (this.boxes.count === 0) return;
    this.boxVertices.fill(this.boxes.view(), gl.STREAM_DRAW);
    this.boxProgram.use({ matrix });
    this.boxVertices.bind();
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 36, this.boxes.count);
  }

  /** vertices: x, y as floats and the label as a byte. */
  drawPoints(vertices, count, matrix, colors, diameter, height, alpha) {
    this.pointProgram.use({ matrix, diameter, height, alpha, ...colors });
    vertices.bind();
    this.gl.drawArrays(this.gl.POINTS, 0, count);
  }

  /** points: x, y of the centre, then of the rim. */
  drawFan(points, matrix, color, alpha) {
    this.fanVertices.fill(points, this.gl.STREAM_DRAW);
    this.fanProgram.use({ matrix, color: [...color, alpha] });
    this.fanVertices.bind();
    this.gl.drawArrays(this.gl.TRIANGLE_FAN, 0, points.length / 2);
  }
}
