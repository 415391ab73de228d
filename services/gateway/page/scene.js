// Draws the world: ground, maps, lanes, scan, way, graph, tracks and vehicle.
import { apply, boundsOfLine, compose, ellipse, meet, multiply, placed, sigmas, simplified } from "./geometry.js";
import { Vertices, areCompiled, isDrawnBySoftware } from "./gl.js";
import { Shapes } from "./shapes.js";
import { CLASSES, THEMES } from "./theme.js";

const VEHICLE = { length: 4.2, width: 1.8, height: 1.3 };
const ELLIPSE_SIGMAS = sigmas(0.95);
const PREDICTION_S = 1; // of the velocity's arrow
const LANES_REACH = 4; // times the camera's distance: farther lanes are not drawn
const MOST_LANE_WIDTH_M = 10;
const LINE_ERROR_PX = 0.5; // of long lines, at most
const LANE_ARROW_M = 1;
const LEAST_ARROW_PX = 4;
const LEAST_BAND_PX = 2; // narrower than this, the line in the middle of a lane covers it
const CONTOUR_GAP_M = 1.2; // between its points nothing was seen

export class Scene {
  /** makeMap(gl): the layer below everything; it has update(), draw() and drawLive(), see map_layer.js. */
  constructor(gl, world, makeMap) {
    this.gl = gl;
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.isSlow = isDrawnBySoftware(this.gl);
    this.world = world;
    this.map = makeMap(this.gl);
    this.shapes = new Shapes(this.gl);
    this.scanVertices = new Map(); // by scanner
    this.simpler = new WeakMap(); // by a long line's points: {most, points, bounds}, see simpleLine()
    world.onScan = (points, pose) => this.map.collect(points, pose);
    world.onGraph = (graph) => this.map.take(graph);
  }

  /** False at first, while the page may do other things. */
  get isReady() {
    return areCompiled(this.gl);
  }

  /** options: {theme, layers: {name: opacity}, selected}. */
  draw(camera, options, seconds) {
    const gl = this.gl;
    const colors = THEMES[options.theme];
    this.camera = camera;
    this.colors = colors;
    this.layers = options.layers;
    this.map.update(seconds);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...colors.back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.frontFace(gl.CCW);
    gl.disable(gl.CULL_FACE);
    const matrix = camera.matrix();
    const size = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    this.scale = gl.drawingBufferHeight / camera.height;
    const { layers } = options;
    this.map.draw(matrix, camera, colors, { free: layers.free, so: layers.so, mo: layers.mo });
    if (layers.grid > 0) this.drawGrid(matrix, size);
    if (layers.scan > 0) this.drawFans(matrix);
    this.map.drawLive(matrix, camera, colors, { so: layers.so, mo: layers.mo });
    this.shapes.begin(camera.metresPerPixel());
    if (layers.lanes > 0) this.addLanes(layers.lanes);
    if (layers.graph > 0) this.addGraph(layers.graph);
    if (layers.way > 0) this.addWay(layers.way);
    if (layers.tracks > 0) this.addTracks(options.selected, layers.tracks);
    this.addVehicle();
    if (options.measured) this.addMeasured(options.measured);
    if (layers.scan > 0) this.drawScans(matrix);
    gl.enable(gl.CULL_FACE);
    this.shapes.drawBoxes(matrix);
    gl.disable(gl.CULL_FACE);
    this.shapes.drawLines(matrix, size);
  }

  /** Diameter in pixels of something of this size in metres. */
  pointSize(metres) {
    return this.scale * Math.max(2.2, Math.min(9, metres / this.camera.metresPerPixel()));
  }

  relative([x, y, heading]) {
    return [x - this.camera.x, y - this.camera.y, heading];
  }

  /** {points, bounds} of a long line, as fine as it can be seen. The list of its points stays as it is once it was drawn. */
  simpleLine(points) {
    const most = 2 ** Math.floor(Math.log2(LINE_ERROR_PX * this.camera.metresPerPixel()));
    let kept = this.simpler.get(points);
    if (kept?.most !== most) this.simpler.set(points, (kept = { most, points: simplified(points, most), bounds: boundsOfLine(points) }));
    return kept;
  }

  /** The same, relative to the camera. */
  polyline(points) {
    const { x, y } = this.camera;
    return this.simpleLine(points).points.map((value, i) => value - (i % 2 ? y : x));
  }

  drawGrid(matrix, size) {
    this.shapes.begin(this.camera.metresPerPixel());
    this.shapes.grid(this.camera, this.colors.grid, this.scale);
    this.shapes.drawLines(matrix, size);
  }

  placeOf(pose) {
    return this.relative(compose(pose.map_from_odom, pose.odom_from_base));
  }

  drawScans(matrix) {
    const gl = this.gl;
    for (const [scanner, scan] of this.world.scans) {
      let vertices = this.scanVertices.get(scanner);
      if (!vertices) {
        vertices = new Vertices(gl, 16, [[0, 2, gl.FLOAT, false, 0, 0], [1, 1, gl.UNSIGNED_BYTE, false, 12, 0]]);
        this.scanVertices.set(scanner, vertices);
      }
      if (scan.isChanged) vertices.fill(scan.points.data);
      scan.isChanged = false;
      const place = multiply(matrix, placed(this.placeOf(scan.pose)));
      this.shapes.drawPoints(vertices, scan.points.count, place, this.colors, this.pointSize(0.22), 0.3, this.layers.scan);
    }
  }

  /** What the scanner sees now: the area between it and its echoes. */
  drawFans(matrix) {
    for (const { points, pose } of this.world.scans.values()) {
      if (points.count < 3) continue;
      const floats = new Float32Array(points.data.buffer);
      const rim = new Float32Array(2 + points.count * 2);
      rim.set(pose.base_from_laser.slice(0, 2));
      for (let i = 0; i < points.count; ++i) rim.set([floats[i * 4], floats[i * 4 + 1]], 2 + i * 2);
      this.shapes.drawFan(rim, multiply(matrix, placed(this.placeOf(pose))), this.colors.scan, 0.07 * this.layers.scan);
    }
  }

  addWay(alpha) {
    const { way, vehicle } = this.world;
    if (way.length < 2) return;
    const points = this.polyline(way);
    if (vehicle) points.push(vehicle[0] - this.camera.x, vehicle[1] - this.camera.y);
    this.shapes.strip(points, 0.05, this.colors.way, () => 0.85 * alpha, 2.2 * this.scale);
  }

  /** Lanes, cycle lanes and walkways as wide as they are used, fainter where few objects went; an arrow in the middle of each. */
  addLanes(alpha) {
    const seen = this.camera.groundSeen(LANES_REACH * this.camera.distance).map((value, i) => value + (i < 2 ? -MOST_LANE_WIDTH_M : MOST_LANE_WIDTH_M));
    for (const { color: name, directed, width, confidence, points } of this.world.lanes) {
      if (!meet(this.simpleLine(points).bounds, seen)) continue;
      const middle = 2 * Math.floor(points.length / 4);
      const color = this.colors[name];
      const own = this.polyline(points);
      const width_px = width / this.camera.metresPerPixel();
      if (width_px > LEAST_BAND_PX) this.shapes.strip(own, 0.02, color, () => 0.18 * confidence * alpha, width_px * this.scale);
      this.shapes.strip(own, 0.03, color, () => (0.2 + 0.6 * confidence) * alpha, 1.3 * this.scale);
      if (directed && LANE_ARROW_M > LEAST_ARROW_PX * this.camera.metresPerPixel()) this.addLaneArrow(points, middle, color, (0.2 + 0.6 * confidence) * alpha);
    }
  }

  addLaneArrow(points, middle, color, alpha) {
    const end = Math.max(2, middle);
    const [x, y] = this.relative([points[end], points[end + 1], 0]);
    const along = Math.atan2(points[end + 1] - points[end - 1], points[end] - points[end - 2]);
    for (const side of [2.6, -2.6])
      this.shapes.line([x + LANE_ARROW_M * Math.cos(along + side), y + LANE_ARROW_M * Math.sin(along + side)], [x, y], 0.03, color, alpha, 1.3 * this.scale);
  }

  addGraph(alpha) {
    const { submaps, constraints } = this.world.graph;
    const places = new Map(submaps.map((submap) => [submap.id, this.relative(submap.pose)]));
    for (const constraint of constraints) {
      const from = places.get(constraint.from), to = places.get(constraint.to);
      if (!from || !to) continue;
      const color = constraint.loop ? this.colors[constraint.state] : this.colors.graph;
      this.shapes.line(from, to, 0.1, color, alpha * (constraint.loop ? 0.9 : 0.5), (constraint.loop ? 2.2 : 1.2) * this.scale);
    }
    for (const [x, y] of places.values())
      this.shapes.ellipse(x, y, { major: 1.2, minor: 1.2, heading: 0 }, 0.1, this.colors.graph, alpha, 1.5 * this.scale);
  }

  addVehicle() {
    const { pose, vehicle } = this.world;
    if (!vehicle) return;
    const place = this.relative(vehicle);
    const { length, width, height } = VEHICLE;
    this.shapes.box(place, length, width, height, this.colors.vehicle, 0.28);
    this.shapes.frame(place, length, width, height, this.colors.vehicle, 0.95, 1.6 * this.scale);
    const nose = apply(place, [length * 0.32, 0]);
    for (const side of [-0.36, 0.36])
      this.shapes.line(apply(place, [-length * 0.08, side * width]), nose, height, this.colors.vehicle, 1, 2.2 * this.scale);
    if (this.layers.uncertainty > 0) {
      const [a, b, , , d] = pose.covariance;
      const shape = ellipse(a, b, d, ELLIPSE_SIGMAS);
      shape.heading += pose.map_from_odom[2];
      this.shapes.ellipse(place[0], place[1], shape, 0.1, this.colors.way, this.layers.uncertainty, 1.8 * this.scale);
    }
  }

  addTracks(selected, alpha) {
    const { world } = this;
    if (!world.map_from_odom) return;
    const map = this.relative(world.map_from_odom);
    for (const track of world.tracks.values()) {
      if (!track.confirmed && this.layers.tentative <= 0) continue;
      const color = this.colors[CLASSES[track.class] ?? "other"];
      this.addTrack(track, map, color, track.confirmed && !track.occluded ? alpha : 0.35 * alpha, track.id === selected);
    }
  }

  addTrack(track, map, color, alpha, isSelected) {
    const { shapes, layers, scale } = this;
    const place = compose(map, [...track.position, track.heading]);
    shapes.box(place, track.length, track.width, track.height, color, (isSelected ? 0.55 : 0.3) * alpha);
    shapes.frame(place, track.length, track.width, track.height, color, alpha, (isSelected ? 3 : 1.5) * scale);
    this.addContour(track, map, color, alpha);
    const trail = this.world.trails.get(track.id) ?? [];
    if (layers.trails > 0) {
      const points = trail.flatMap(([, x, y]) => apply(map, [x, y]));
      shapes.strip(points, 0.08, color, (i) => (0.75 * alpha * layers.trails * i) / trail.length, 2 * scale);
    }
    if (track.speed > 0.3) {
      const tip = apply(map, track.position.map((value, i) => value + track.velocity[i] * PREDICTION_S));
      shapes.arrow(place, tip, track.height, this.colors.vehicle, alpha, 1.8 * scale);
    }
    if (layers.predictions > 0 && track.confirmed) this.addPrediction(track, map, color, alpha * layers.predictions);
    if (layers.uncertainty > 0 && track.confirmed) {
      const [a, b, , , , d] = track.covariance;
      this.addEllipse(place, a, b, d, map[2], color, 0.9 * alpha * layers.uncertainty);
    }
  }

  /** What was seen of its sides. */
  addContour({ contour = [] }, map, color, alpha) {
    const points = [];
    for (let i = 0; i < contour.length; i += 2) points.push(apply(map, [contour[i], contour[i + 1]]));
    points.forEach((a, i) => {
      const b = points[(i + 1) % points.length];
      if (Math.hypot(b[0] - a[0], b[1] - a[1]) < CONTOUR_GAP_M) this.shapes.line(a, b, 0.5, color, alpha, 3 * this.scale);
    });
  }

  addEllipse([x, y], a, b, d, turned, color, alpha) {
    const shape = ellipse(a, b, d, ELLIPSE_SIGMAS);
    shape.heading += turned;
    this.shapes.ellipse(x, y, shape, 0.06, color, alpha, 1.2 * this.scale);
  }

  addPrediction(track, map, color, alpha) {
    if (track.speed < 0.5) return;
    const path = [track.position, ...track.path.map((entry) => entry.position)];
    const points = path.flatMap((at) => apply(map, at));
    this.shapes.strip(points, 0.06, color, (i) => 0.7 * alpha * (1 - (0.6 * i) / path.length), 1.4 * this.scale);
    const last = track.path.at(-1);
    if (!last) return;
    const [a, b, , d] = last.covariance;
    this.addEllipse(apply(map, last.position), a, b, d, map[2], color, 0.16 * alpha);
  }

  addMeasured([from, to]) {
    if (!from || !to) return;
    const a = this.relative([...from, 0]), b = this.relative([...to, 0]);
    this.shapes.line(a, b, 0.2, this.colors.unknown, 1, 2.5 * this.scale);
    for (const end of [a, b]) {
      const radius = 6 * this.camera.metresPerPixel();
      this.shapes.ellipse(end[0], end[1], { major: radius, minor: radius, heading: 0 }, 0.2, this.colors.unknown, 1, 2 * this.scale);
    }
  }
}
