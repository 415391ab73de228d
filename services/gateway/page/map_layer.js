// Submaps as textures, each at its latest pose, so that a closed loop moves them. What the scanner saw since the last
// finished submap is drawn as points until its submap comes.
import { compose, inverse, multiply, placed, turn } from "./geometry.js";
import { Vertices } from "./gl.js";
import { Ground } from "./ground.js";
import { Tiles, boundsOf } from "./tiles.js";
import { withToken } from "./connection.js";

const LIVE_CELL_M = 0.15; // one point is kept of each
const MOST_LIVE_POINTS = 60000;
const MOST_LEFT_OUT = 16; // from afar one of at most so many is drawn
const LEAST_STEP = [0.02, 0.0002]; // m and rad: smaller corrections of a pose are not shown
const LEAST_GLIDE = [0.5, 0.01]; // m and rad: larger corrections are shown as a motion

export class MapLayer {
  constructor(gl, onError) {
    this.gl = gl;
    this.onError = onError;
    this.ground = new Ground(gl);
    this.tiles = new Tiles(gl, this.ground);
    this.submaps = new Map(); // by id: {path, pose, shownPose, glides, texture, box, bounds, version}
    this.version = 0;
    this.live = new Map(); // by submap's id: {points, keys, count, vertices, isChanged}
    this.map = null;
  }

  clear() {
    for (const submap of this.submaps.values()) if (submap.texture) this.gl.deleteTexture(submap.texture);
    for (const live of this.live.values()) live.vertices.remove();
    this.tiles.clear();
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
    const entry = { ...before, path: submap.path, pose: submap.pose, shownPose: before?.shownPose ?? submap.pose };
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
      this.changed(entry);
      this.dropLive(submap.id);
    } catch (error) {
      this.submaps.delete(submap.id); // the next graph tries again
      this.onError(error);
    }
  }

  changed(submap) {
    submap.bounds = boundsOf(submap);
    submap.version = ++this.version;
  }

  texture(cells, columns, rows) {
    return this.ground.texture((gl) => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG8, columns, rows, 0, gl.RG, gl.UNSIGNED_BYTE, cells));
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
    for (const submap of this.submaps.values()) {
      const [x, y, heading] = submap.shownPose;
      const steps = [submap.pose[0] - x, submap.pose[1] - y, turn(heading, submap.pose[2])];
      const exceeds = ([metres, radians]) => Math.hypot(steps[0], steps[1]) > metres || Math.abs(steps[2]) > radians;
      if (!exceeds(LEAST_STEP)) {
        submap.glides = false;
        continue;
      }
      submap.glides ||= exceeds(LEAST_GLIDE);
      const share = submap.glides ? part : 1;
      submap.shownPose = submap.shownPose.map((value, i) => value + steps[i] * share);
      if (submap.texture) this.changed(submap);
    }
  }

  /** While submaps glide each picture is drawn anew, otherwise from tiles. */
  draw(matrix, camera, colors, opacity) {
    const shown = [...this.submaps.values()].filter((submap) => submap.texture);
    const drawer = shown.some((submap) => submap.glides) ? this.ground : this.tiles;
    drawer.draw(shown, matrix, camera, colors, opacity);
  }

  drawLive(shapes, matrix, camera, colors, opacity, diameter) {
    for (const live of this.live.values()) {
      if (live.isChanged) live.vertices.fill(live.points.subarray(0, live.count * 3));
      live.isChanged = false;
      const [x, y, heading] = live.map_from_submap;
      const place = multiply(matrix, placed([x - camera.x, y - camera.y, heading]));
      const tints = { stationary: colors.wall, moving: colors.motion, unknown: colors.wall, unlabelled: colors.wall };
      const oneOf = Math.min(MOST_LEFT_OUT, Math.max(1, Math.floor(camera.metresPerPixel() / LIVE_CELL_M))); // from afar they overlap
      if (opacity.so > 0) shapes.drawPoints(live.vertices.every(oneOf), Math.ceil(live.count / oneOf), place, tints, diameter, 0, opacity.so);
    }
  }
}
