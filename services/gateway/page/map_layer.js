// Submaps as textures, each at its latest pose, so that a closed loop moves them. What the scanner saw since the last
// finished submap is drawn as points until its submap comes.
import { compose, inverse, multiply, placed } from "./geometry.js";
import { Program, Vertices } from "./gl.js";
import { withToken } from "./connection.js";

const VERTEX = `
uniform mat4 matrix; uniform vec4 box; out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = matrix * vec4(box.xy + at * box.zw, 0.0, 1.0);
}`;
// Red: evidence of stationary objects in 1/16 of log-odds, + 128; green: share of sightings in motion.
const GROUND_FRAGMENT = `
in vec2 at; uniform sampler2D cells; uniform vec3 free_color; uniform float alpha; out vec4 result;
void main() {
  float evidence = texture(cells, at).r * 255.0 - 128.0;
  float seen = clamp(abs(evidence) / 10.0, 0.0, 1.0);
  result = vec4(free_color, 1.0) * seen * alpha;
}`;
const WALL_FRAGMENT = `
in vec2 at; uniform sampler2D cells; uniform vec3 wall; uniform vec3 motion; uniform float so; uniform float mo; out vec4 result;
void main() {
  vec2 cell = texture(cells, at).rg;
  float log_odds = (cell.r * 255.0 - 128.0) / 16.0;
  float occupied = 1.0 / (1.0 + exp(-log_odds));
  float strength = smoothstep(0.5, 0.95, occupied) * so;
  float moved = smoothstep(0.02, 0.6, cell.g) * mo;
  vec4 below = vec4(motion, 1.0) * moved * 0.75;
  result = vec4(wall, 1.0) * strength + below * (1.0 - strength);
}`;

const LIVE_CELL_M = 0.15; // one point is kept of each
const MOST_LIVE_POINTS = 60000;

export class MapLayer {
  constructor(gl, onError) {
    this.gl = gl;
    this.onError = onError;
    this.ground = new Program(gl, VERTEX, GROUND_FRAGMENT);
    this.walls = new Program(gl, VERTEX, WALL_FRAGMENT);
    this.submaps = new Map(); // by id: {path, pose, shownPose, texture, box}
    this.live = new Map(); // by submap's id: {points, keys, count, vertices, isChanged}
    this.array = gl.createVertexArray();
    this.map = null;
  }

  clear() {
    for (const submap of this.submaps.values()) if (submap.texture) this.gl.deleteTexture(submap.texture);
    for (const live of this.live.values()) live.vertices.remove();
    this.submaps.clear();
    this.live.clear();
  }

  /** graph: message of /slammot/graph. */
  take(graph) {
    if (this.map !== graph.map) {
      this.clear();
      this.map = graph.map;
    }
    for (const submap of graph.submaps) {
      const known = this.submaps.get(submap.id);
      if (known && known.path === submap.path) known.pose = submap.pose;
      else this.load(submap, known);
    }
  }

  async load(submap, before) {
    const entry = { path: submap.path, pose: submap.pose, shownPose: before?.shownPose ?? submap.pose, texture: before?.texture, box: before?.box };
    this.submaps.set(submap.id, entry);
    if (submap.columns === 0) return;
    try {
      const answer = await fetch(withToken(submap.path));
      if (!answer.ok) throw new Error(`${submap.path}: ${answer.status}`);
      const cells = new Uint8Array(await answer.arrayBuffer());
      if (this.submaps.get(submap.id) !== entry) return;
      if (entry.texture) this.gl.deleteTexture(entry.texture);
      entry.texture = this.texture(cells, submap.columns, submap.rows);
      entry.box = [...submap.min, submap.columns * submap.cell_size_m, submap.rows * submap.cell_size_m];
      this.dropLive(submap.id);
    } catch (error) {
      this.submaps.delete(submap.id); // the next graph tries again
      this.onError(error);
    }
  }

  texture(cells, columns, rows) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG8, columns, rows, 0, gl.RG, gl.UNSIGNED_BYTE, cells);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  dropLive(id) {
    this.live.get(id)?.vertices.remove();
    this.live.delete(id);
  }

  /** points: of a labelled scan, in base; pose: the message of /slammot/pose of the same scan. */
  collect(points, pose) {
    if (this.submaps.get(pose.submap)?.texture) return;
    let live = this.live.get(pose.submap);
    if (!live) {
      const gl = this.gl;
      const vertices = new Vertices(gl, 12, [[0, 2, gl.FLOAT, false, 0, 0], [1, 1, gl.FLOAT, false, 8, 0]]);
      live = { points: new Float32Array(MOST_LIVE_POINTS * 3), keys: new Set(), count: 0, vertices, isChanged: false };
      this.live.set(pose.submap, live);
    }
    live.map_from_submap = compose(compose(pose.map_from_odom, pose.odom_from_base), inverse(pose.submap_from_base));
    const floats = new Float32Array(points.data.buffer);
    const [x, y, heading] = pose.submap_from_base;
    const c = Math.cos(heading), s = Math.sin(heading);
    for (let i = 0; i < points.count && live.count < MOST_LIVE_POINTS; ++i) {
      const label = points.data[i * 16 + 12];
      if (label !== 1 && label !== 2) continue;
      const px = floats[i * 4], py = floats[i * 4 + 1];
      const u = x + c * px - s * py, v = y + s * px + c * py;
      const key = (Math.round(u / LIVE_CELL_M) * 65536 + Math.round(v / LIVE_CELL_M)) * 4 + label;
      if (live.keys.has(key)) continue;
      live.keys.add(key);
      live.points.set([u, v, label], live.count++ * 3);
      live.isChanged = true;
    }
  }

  /** Moves shown poses towards the latest ones: a closed loop snaps within half a second, visibly. */
  update(seconds) {
    const part = 1 - Math.exp(-seconds * 8);
    for (const submap of this.submaps.values())
      submap.shownPose = submap.shownPose.map((value, i) => {
        const step = i === 2 ? Math.atan2(Math.sin(submap.pose[2] - value), Math.cos(submap.pose[2] - value)) : submap.pose[i] - value;
        return value + step * part;
      });
  }

  draw(matrix, camera, colors, opacity) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    const shown = [...this.submaps.values()].filter((submap) => submap.texture);
    const pass = (program, values) => {
      for (const submap of shown) {
        const [x, y, heading] = submap.shownPose;
        gl.bindTexture(gl.TEXTURE_2D, submap.texture);
        program.use({ matrix: multiply(matrix, placed([x - camera.x, y - camera.y, heading])), box: submap.box, ...values });
        gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      }
    };
    if (opacity.free > 0) pass(this.ground, { free_color: colors.free, alpha: opacity.free });
    if (opacity.so > 0 || opacity.mo > 0) pass(this.walls, { wall: colors.wall, motion: colors.motion, so: opacity.so, mo: opacity.mo });
  }

  drawLive(shapes, matrix, camera, colors, opacity, diameter) {
    for (const live of this.live.values()) {
      if (live.isChanged) live.vertices.fill(live.points.subarray(0, live.count * 3));
      live.isChanged = false;
      const [x, y, heading] = live.map_from_submap;
      const place = multiply(matrix, placed([x - camera.x, y - camera.y, heading]));
      const tints = { stationary: colors.wall, moving: colors.motion, unknown: colors.wall, unlabelled: colors.wall };
      if (opacity.so > 0) shapes.drawPoints(live.vertices, live.count, place, tints, diameter, 0, opacity.so);
    }
  }
}
