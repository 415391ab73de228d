// Where the picture is taken from. Coordinates in map; the matrix is relative to the target, so that float32 is enough.
import { multiply, turn } from "./geometry.js";

const FIELD_OF_VIEW = 0.7; // vertical, rad
const NEAREST = 8;
const FARTHEST = 6000;
export const TILTED = 0.95; // rad from straight down

export class Camera {
  constructor() {
    this.x = 0;
    this.y = 0;
    this.distance = 110; // m, from the target
    this.heading = Math.PI / 2; // direction in map that is up in the picture
    this.tilt = 0;
    this.wantedTilt = 0;
    this.follows = true;
    this.width = 1;
    this.height = 1;
  }

  zoom(factor) {
    this.distance = Math.min(FARTHEST, Math.max(NEAREST, this.distance * factor));
  }

  /** Moves the target by pixels of the picture. */
  pan(dx, dy) {
    const scale = this.metresPerPixel();
    const c = Math.cos(this.heading), s = Math.sin(this.heading);
    const up = (dy * scale) / Math.max(0.3, Math.cos(this.tilt));
    const right = -dx * scale;
    this.x += c * up + s * right;
    this.y += s * up - c * right;
    this.follows = false;
  }

  metresPerPixel() {
    return (2 * this.distance * Math.tan(FIELD_OF_VIEW / 2)) / this.height;
  }

  /** Moves smoothly: seconds since the last picture, and the vehicle's pose if it is to be followed. */
  update(seconds, pose) {
    const part = 1 - Math.exp(-seconds * 6);
    this.tilt += (this.wantedTilt - this.tilt) * part;
    if (!this.follows || !pose) return;
    const far = Math.hypot(pose[0] - this.x, pose[1] - this.y) > 300;
    const step = far ? 1 : part;
    this.x += (pose[0] - this.x) * step;
    this.y += (pose[1] - this.y) * step;
    if (this.wantedTilt > 0) this.heading += turn(this.heading, pose[2]) * (1 - Math.exp(-seconds * 1.5));
  }

  /** Clip space from map coordinates relative to the target. */
  matrix() {
    const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
    const near = this.distance * 0.05, far = this.distance * 12 + 200;
    const projection = new Float64Array([
      (f * this.height) / this.width, 0, 0, 0, 0, f, 0, 0,
      0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0,
    ]);
    const turnAngle = Math.PI / 2 - this.heading;
    const c = Math.cos(turnAngle), s = Math.sin(turnAngle);
    const ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    // Turned about z, then tilted: the far side of the picture is up.
    const view = new Float64Array([
      c, ct * s, -st * s, 0, -s, ct * c, -st * c, 0,
      0, st, ct, 0, 0, 0, -this.distance, 1,
    ]);
    return multiply(projection, view);
  }

  /** Pixel [x, y] of a point in map, or null behind the camera. */
  project(x, y, z, matrix) {
    const dx = x - this.x, dy = y - this.y;
    const w = matrix[3] * dx + matrix[7] * dy + matrix[11] * z + matrix[15];
    if (w <= 0) return null;
    const px = (matrix[0] * dx + matrix[4] * dy + matrix[8] * z + matrix[12]) / w;
    const py = (matrix[1] * dx + matrix[5] * dy + matrix[9] * z + matrix[13]) / w;
    return [((px + 1) / 2) * this.width, ((1 - py) / 2) * this.height];
  }

  /** Rectangle [least x, least y, greatest x, greatest y] around the ground in the picture, in map, at most `far` metres from the target. */
  groundSeen(far) {
    const corners = [[0, 0], [this.width, 0], [0, this.height], [this.width, this.height]].map(([px, py]) => this.ground(px, py));
    const clamped = (value, centre) => Math.min(centre + far, Math.max(centre - far, value));
    const xs = corners.flatMap((corner) => (corner ? [clamped(corner[0], this.x)] : [this.x - far, this.x + far]));
    const ys = corners.flatMap((corner) => (corner ? [clamped(corner[1], this.y)] : [this.y - far, this.y + far]));
    return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  }

  /** Point on the ground, in map, under a pixel; null above the horizon. */
  ground(px, py) {
    const slope = Math.tan(FIELD_OF_VIEW / 2);
    const right = ((2 * px) / this.width - 1) * slope * (this.width / this.height);
    const up = (1 - (2 * py) / this.height) * slope;
    const ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    // Ray in the frame whose y is up in the picture and z is the map's: the camera sits behind the target.
    const down = ct - up * st;
    if (down <= 1e-3) return null;
    const length = (this.distance * ct) / down;
    const forward = length * (st + up * ct) - this.distance * st;
    const side = length * right;
    const c = Math.cos(this.heading), s = Math.sin(this.heading);
    return [this.x + c * forward + s * side, this.y + s * forward - c * side];
  }
}
