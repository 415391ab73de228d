// What the messages say, kept for drawing: the latest of each, and short histories.
import { apply, compose, rotate } from "./geometry.js";
import { readPoints, readPositions } from "./protobuf.js";

const TRAIL_S = 8;
const PLOT_S = 30;
const STALE_MS = 1500;
const COLOR_OF_WAY = { lane: "car", cycle_lane: "bicycle", walkway: "pedestrian" };
const seconds = (stamp) => Number(BigInt(stamp) / 1000n) * 1e-6;

export class World {
  constructor() {
    this.pose = null; // of /slammot/pose
    this.vehicle = null; // [x, y, heading] in map
    this.scans = new Map(); // by scanner: {points, pose, isChanged}
    this.poses = new Map(); // by stamp, of scans whose points have not come
    this.tracks = new Map(); // by id
    this.trails = new Map(); // by id: [[time, x, y]] in odom
    this.plots = new Map(); // by id: [[time, speed, existence]]
    this.way = [];
    this.lanes = []; // pieces of lanes, cycle lanes and walkways: {color, directed, width, confidence, points}
    this.graph = { submaps: [], constraints: [] };
    this.health = null;
    this.lastScanAt = 0; // by the page's clock
    this.arrivals = [];
    this.onScan = () => {};
  }

  handlers() {
    return {
      "/slammot/pose": (pose, time) => this.takePose(pose, time),
      "/scan/points": (bytes, time) => this.takePoints(readPoints(bytes), time),
      "/slammot/tracks": (message) => this.takeTracks(message),
      "/trajectory": (bytes) => (this.way = readPositions(bytes)),
      "/slammot/graph": (graph) => this.takeGraph(graph),
      "/slammot/ways": ({ ways }) => (this.lanes = ways.map((way) => ({ ...way, color: COLOR_OF_WAY[way.kind] ?? "other" }))),
      "/slammot/health": (health) => (this.health = health),
    };
  }

  takePose(pose, time) {
    if (this.pose && (this.pose.odom !== pose.odom || seconds(pose.stamp_ns) < seconds(this.pose.stamp_ns) - 1)) this.forgetTracks();
    this.pose = pose;
    this.vehicle = compose(pose.map_from_odom, pose.odom_from_base);
    this.poses.set(time, pose);
    if (this.poses.size > 50) this.poses.delete(this.poses.keys().next().value);
    const now = performance.now();
    this.lastScanAt = now;
    this.arrivals.push(now);
    while (this.arrivals.length && now - this.arrivals[0] > 2000) this.arrivals.shift();
  }

  takePoints(points, time) {
    const pose = this.poses.get(time);
    if (!pose) return;
    this.scans.set(pose.scanner, { points, pose, isChanged: true });
    this.onScan(points, pose);
  }

  takeTracks(message) {
    const time = seconds(message.stamp_ns);
    this.map_from_odom = message.map_from_odom;
    this.tracks = new Map(message.tracks.map((track) => [track.id, { ...track, speed: Math.hypot(...track.velocity), time }]));
    for (const track of this.tracks.values()) this.remember(track, time);
    for (const [id, trail] of this.trails) {
      while (trail.length && time - trail[0][0] > TRAIL_S) trail.shift();
      if (trail.length === 0) this.trails.delete(id), this.plots.delete(id);
    }
  }

  remember(track, time) {
    const append = (histories, entry, longest) => {
      const history = histories.get(track.id) ?? [];
      if (history.length === 0 || time - history.at(-1)[0] > 0.08) history.push(entry);
      while (time - history[0][0] > longest) history.shift();
      histories.set(track.id, history);
    };
    append(this.trails, [time, ...track.position], TRAIL_S);
    append(this.plots, [time, track.speed, track.existence, track.mode_probability], PLOT_S);
  }

  forgetTracks() {
    this.tracks.clear();
    this.trails.clear();
    this.plots.clear();
  }

  takeGraph(graph) {
    this.graph = graph;
    this.onGraph?.(graph);
  }

  /** Of a track, in map. */
  positionOf(track) {
    return apply(this.map_from_odom, track.position);
  }
  directionInMap(vector) {
    return rotate(this.map_from_odom[2], vector);
  }

  get rate() {
    const [first] = this.arrivals, last = this.arrivals.at(-1);
    return this.arrivals.length > 2 ? (1000 * (this.arrivals.length - 1)) / (last - first) : 0;
  }
  /** Seconds since the last scan; infinite if none came. */
  age(now) {
    return this.lastScanAt ? (now - this.lastScanAt) / 1000 : Infinity;
  }
  isStale(now) {
    return now - this.lastScanAt > STALE_MS;
  }
  get confirmedCount() {
    return [...this.tracks.values()].filter((track) => track.confirmed).length;
  }
  get drivenLength() {
    let length = 0;
    for (let i = 2; i < this.way.length; i += 2)
      length += Math.hypot(this.way[i] - this.way[i - 2], this.way[i + 1] - this.way[i - 1]);
    return length;
  }
}
