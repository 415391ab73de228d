// The drive that is written into this page: a header in JSON, and columns of numbers (drive_data.hpp).

const TYPES = { f32: Float32Array, u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array };
const CLASSES = ["unknown", "pedestrian", "bicycle", "car", "truck or bus"];
const HEIGHTS = { pedestrian: 1.75, bicycle: 1.7, car: 1.5, "truck or bus": 3, unknown: 1 }; // m, as drawn
const LONGEST_GAP_S = 1; // in a track, over which it is interpolated

const between = (a, b, part) => a + (b - a) * part;
const turned = (a, b, part) => a + Math.atan2(Math.sin(b - a), Math.cos(b - a)) * part;

export class Recording {
  constructor(header, text) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    this.header = header;
    this.is = Object.fromEntries(header.columns.map(([name, type, offset, count]) => [name, new TYPES[type](bytes.buffer, offset, count)]));
    this.rowsOf = new Map(); // by track: its rows, and the frame of each
    const { first_row, track } = this.is;
    for (let frame = 0; frame < this.count; ++frame)
      for (let row = first_row[frame]; row < first_row[frame + 1]; ++row) {
        if (!this.rowsOf.has(track[row])) this.rowsOf.set(track[row], { rows: [], frames: [] });
        const own = this.rowsOf.get(track[row]);
        own.rows.push(row);
        own.frames.push(frame);
      }
  }

  get count() {
    return this.is.time.length;
  }
  get duration() {
    return this.is.time[this.count - 1];
  }

  /** The last frame at or before a time. */
  frameAt(time) {
    let low = 0, high = this.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.is.time[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** [frame, next frame, part of the way between them]. */
  place(time) {
    const frame = this.frameAt(time), next = Math.min(frame + 1, this.count - 1);
    const span = this.is.time[next] - this.is.time[frame];
    return [frame, next, span > 0 ? Math.min(1, Math.max(0, (time - this.is.time[frame]) / span)) : 0];
  }

  poseAt([frame, next, part]) {
    const { x, y, heading } = this.is;
    return [between(x[frame], x[next], part), between(y[frame], y[next], part), turned(heading[frame], heading[next], part)];
  }

  /** Variances of x and y and their covariance, in map [m^2]: [xx, xy, yy]. */
  covarianceAt(frame) {
    return [this.is.var_x[frame], this.is.cov_xy[frame], this.is.var_y[frame]];
  }

  speedAt([frame, next]) {
    const { x, y, time } = this.is;
    const from = next > frame ? frame : Math.max(0, frame - 1); // at the end of the drive
    const span = time[next] - time[from];
    return span > 0 ? Math.hypot(x[next] - x[from], y[next] - y[from]) / span : 0;
  }

  /** Everything known about a track at a row; `next`: its row in the next frame, if any. */
  trackOf(row, next, part) {
    const { is } = this;
    const kind = CLASSES[is.flags[row] & 7];
    const sigma_x = is.sigma_x[row] * 1e-3, sigma_y = is.sigma_y[row] * 1e-3;
    const covariance = new Array(16).fill(0);
    [covariance[0], covariance[5]] = [sigma_x ** 2, sigma_y ** 2];
    covariance[1] = covariance[4] = (is.correlation[row] / 127) * sigma_x * sigma_y;
    const velocity = [is.vx[row] * 0.01, is.vy[row] * 0.01];
    const to = next ?? row;
    return {
      id: is.track[row], confirmed: true, occluded: (is.flags[row] & 16) !== 0, stopped: (is.flags[row] & 8) === 0,
      existence: is.existence[row] / 65535, class: kind, height: HEIGHTS[kind], length: is.length[row] * 0.1, width: is.width[row] * 0.1,
      position: [between(is.track_x[row], is.track_x[to], part), between(is.track_y[row], is.track_y[to], part)],
      heading: turned(is.track_heading[row] * 1e-4, is.track_heading[to] * 1e-4, part),
      velocity, speed: Math.hypot(...velocity), covariance, path: [],
      mode_probability: [is.mode_0[row] / 255, is.mode_1[row] / 255, is.mode_2[row] / 255],
    };
  }

  tracksAt([frame, next, part]) {
    const { first_row, track, time } = this.is;
    const following = new Map();
    if (time[next] - time[frame] <= LONGEST_GAP_S)
      for (let row = first_row[next]; row < first_row[next + 1]; ++row) following.set(track[row], row);
    const tracks = new Map();
    for (let row = first_row[frame]; row < first_row[frame + 1]; ++row)
      tracks.set(track[row], this.trackOf(row, following.get(track[row]), part));
    return tracks;
  }

  /** Places of a track in the seconds before a time: [[time, x, y]]. */
  trailOf(id, frame, seconds) {
    const { rows, frames } = this.rowsOf.get(id);
    const { time, track_x, track_y } = this.is;
    const trail = [];
    for (let i = frames.length - 1; i >= 0; --i) {
      if (frames[i] > frame) continue;
      if (time[frame] - time[frames[i]] > seconds) break;
      trail.unshift([time[frames[i]], track_x[rows[i]], track_y[rows[i]]]);
    }
    return trail;
  }

  /** The whole life of a track: [[time, speed, existence]]. */
  lifeOf(id) {
    const { rows, frames } = this.rowsOf.get(id);
    return rows.map((row, i) => [this.is.time[frames[i]], Math.hypot(this.is.vx[row], this.is.vy[row]) * 0.01, this.is.existence[row] / 65535]);
  }
}

/** What Scene and Labels draw (world.js of the live view), at one time of a recording. */
export class Replay {
  constructor(recording) {
    this.recording = recording;
    this.map_from_odom = [0, 0, 0]; // all that is recorded is in map
    this.scans = new Map();
    this.trails = new Map();
    this.exaggeration = 1; // of standard deviations
    this.graph = recording.header.graph;
    this.lanes = recording.header.lanes;
    this.go(0);
  }

  go(time) {
    const { recording } = this;
    this.time = Math.min(recording.duration, Math.max(0, time));
    const place = recording.place(this.time);
    [this.frame] = place;
    this.vehicle = recording.poseAt(place);
    const scale = this.exaggeration ** 2;
    const [a, b, d] = recording.covarianceAt(this.frame).map((value) => value * scale);
    this.pose = { map_from_odom: this.map_from_odom, odom_from_base: this.vehicle, covariance: [a, b, 0, b, d], speed_mps: recording.speedAt(place) };
    this.tracks = recording.tracksAt(place);
    for (const track of this.tracks.values()) track.covariance = track.covariance.map((value) => value * scale);
    this.trails = new Map([...this.tracks].map(([id, track]) => [id, [...recording.trailOf(id, this.frame, 8), [this.time, ...track.position]]]));
    this.way = [];
    for (let i = 0; i <= this.frame; ++i) this.way.push(recording.is.x[i], recording.is.y[i]);
  }

  positionOf(track) {
    return track.position;
  }
  directionInMap(vector) {
    return vector;
  }
  get confirmedCount() {
    return this.tracks.size;
  }
}
