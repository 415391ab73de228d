// Submaps as textures, each at its latest pose, so that a closed loop moves them. What the scanner saw since the last
// finished submap is shown until its submap comes, see live_points.js.
import { compose, inverse, meet, multiply, placed, turn } from "./geometry.js";
import { Ground } from "./ground.js";
import { LivePoints, PointPainter } from "./live_points.js";
import { Tiles, boundsOf } from "./tiles.js";
import { withToken } from "./connection.js";

const LIVE_REACH = 4; // camera distances: what is farther is not shown
const SHOWN_A_PICTURE = 3; // submaps whose cells become a texture, some milliseconds each
const LEAST_STEP = [0.02, 0.0002]; // m and rad: smaller corrections of a pose are not shown
const LEAST_GLIDE = [0.5, 0.01]; // m and rad: larger corrections are shown as a motion

export class MapLayer {
  constructor(gl, onError) {
    this.gl = gl;
    this.onError = onError;
    this.ground = new Ground(gl);
    this.tiles = new Tiles(gl, this.ground);
    this.painter = new PointPainter(gl);
    this.submaps = new Map(); // by id: {path, pose, shownPose, glides, texture, box, bounds, version}
    this.arrived = []; // cells of submaps that are not shown yet
    this.version = 0;
    this.live = new Map(); // by submap's id: {points, map_from_submap}
    this.map = null;
  }

  clear() {
    for (const submap of this.submaps.values()) if (submap.texture) this.gl.deleteTexture(submap.texture);
    for (const live of this.live.values()) live.points.remove();
    this.tiles.clear();
    this.submaps.clear();
    this.arrived = [];
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
      this.arrived.push({ submap, entry, cells });
    } catch (error) {
      this.submaps.delete(submap.id); // the next graph tries again
      this.onError(error);
    }
  }

  show({ submap, entry, cells }) {
    if (this.submaps.get(submap.id) !== entry) return; // a newer one is on its way
    if (entry.texture) this.gl.deleteTexture(entry.texture);
    entry.texture = this.texture(cells, submap.columns, submap.rows);
    this.cell_m = submap.cell_size_m;
    entry.box = [...submap.min, submap.columns * submap.cell_size_m, submap.rows * submap.cell_size_m];
    this.changed(entry);
    this.dropLive(submap.id);
  }

  changed(submap) {
    submap.bounds = boundsOf(submap);
    submap.version = ++this.version;
  }

  texture(cells, columns, rows) {
    return this.ground.texture((gl) => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG8, columns, rows, 0, gl.RG, gl.UNSIGNED_BYTE, cells));
  }

  dropLive(id) {
    this.live.get(id)?.points.remove();
    this.live.delete(id);
  }

  /** points: of a labelled scan, in base; pose: the message of /slammot/pose of the same scan. */
  collect(points, pose) {
    if (this.submaps.get(pose.submap)?.texture) return;
    let live = this.live.get(pose.submap);
    if (!live) this.live.set(pose.submap, (live = { points: new LivePoints(this.painter, this.cell_m) }));
    live.map_from_submap = compose(compose(pose.map_from_odom, pose.odom_from_base), inverse(pose.submap_from_base));
    const floats = new Float32Array(points.data.buffer);
    const [x, y, heading] = pose.submap_from_base;
    const c = Math.cos(heading), s = Math.sin(heading);
    for (let i = 0; i < points.count; ++i) {
      const label = points.data[i * 16 + 12];
      if (label !== 1 && label !== 2) continue;
      const px = floats[i * 4], py = floats[i * 4 + 1];
      live.points.add(x + c * px - s * py, y + s * px + c * py, label);
    }
  }

  /** Moves shown poses towards the latest ones: a closed loop snaps within half a second, visibly. */
  update(seconds) {
    for (const arrived of this.arrived.splice(0, SHOWN_A_PICTURE)) this.show(arrived);
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

  drawLive(matrix, camera, colors, opacity) {
    const seen = camera.groundSeen(LIVE_REACH * camera.distance);
    const pixel_m = (camera.metresPerPixel() * camera.height) / this.gl.drawingBufferHeight;
    for (const { points, map_from_submap } of this.live.values()) {
      if (points.isEmpty || !meet(boundsOf({ box: points.box, shownPose: map_from_submap }), seen)) continue;
      const [x, y, heading] = map_from_submap;
      points.show(multiply(matrix, placed([x - camera.x, y - camera.y, heading])), pixel_m, colors, [opacity.so, opacity.mo]);
    }
  }
}
