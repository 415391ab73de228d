// The map in squares of the map frame. Each is drawn from the submaps that it shows and kept as a texture until one of them
// changes, so that a picture costs one layer of pixels however many submaps overlap.
import { apply, meet } from "./geometry.js";
import { PART_VERTEX, Program, emptyTexture } from "./gl.js";

const SIDE_PX = 256;
const MOST_KEPT = 256; // 64 MB
const MOST_SHOWN = 80; // with more, coarser ones are shown
const DRAWN_A_PICTURE = 2;
const COARSER_LEVELS = 4; // among which one stands in for a square that is not drawn yet
const FARTHEST = 3; // in camera distances, of a tilted view

const FRAGMENT = `in vec2 at; uniform sampler2D picture; out vec4 result; void main() { result = texture(picture, at); }`;

/** [least x, least y, greatest x, greatest y] in map of a part as Ground.draw() takes it. */
export function boundsOf({ box: [x, y, width, height], shownPose }) {
  const corners = [[x, y], [x + width, y], [x, y + height], [x + width, y + height]].map((corner) => apply(shownPose, corner));
  const xs = corners.map((corner) => corner[0]), ys = corners.map((corner) => corner[1]);
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

export class Tiles {
  constructor(gl, ground) {
    this.gl = gl;
    this.ground = ground;
    this.program = new Program(gl, PART_VERTEX, FRAGMENT);
    this.array = gl.createVertexArray();
    this.target = gl.createFramebuffer();
    this.kept = new Map(); // by "level:column:row": {texture, stamp}, the least recently shown first
  }

  clear() {
    for (const tile of this.kept.values()) this.gl.deleteTexture(tile.texture);
    this.kept.clear();
  }

  /** parts: as for Ground.draw(), with bounds in map and a version that grows with each change. */
  draw(parts, matrix, camera, colors, opacity) {
    const style = JSON.stringify([colors.free, colors.wall, colors.motion, opacity]);
    const shown = this.squares(parts, camera.groundSeen(FARTHEST * camera.distance), Math.round(Math.log2((camera.metresPerPixel() * camera.height) / this.gl.drawingBufferHeight)));
    let drawn = 0;
    for (const square of shown) {
      const stamp = `${style} ${square.parts.length} ${Math.max(...square.parts.map((part) => part.version))}`;
      if (this.kept.get(square.key)?.stamp === stamp || drawn === DRAWN_A_PICTURE) continue;
      this.render(square, stamp, colors, opacity);
      ++drawn;
    }
    this.gl.viewport(0, 0, this.gl.drawingBufferWidth, this.gl.drawingBufferHeight);
    for (const square of shown) this.show(square, matrix, camera);
    this.forgetOldest(shown.length);
  }

  /** Those within the bounds that show something, the nearest to their middle first. */
  squares(parts, bounds, level) {
    for (;; ++level) {
      const side = SIDE_PX * 2 ** level;
      const [left, bottom, right, top] = bounds.map((value) => Math.floor(value / side));
      if ((right - left + 1) * (top - bottom + 1) > 4 * MOST_SHOWN) continue;
      const found = [];
      for (let column = left; column <= right; ++column)
        for (let row = bottom; row <= top; ++row) {
          const box = [column * side, row * side, (column + 1) * side, (row + 1) * side];
          const within = parts.filter((part) => meet(part.bounds, box));
          if (within.length > 0) found.push({ level, column, row, side, box, parts: within, key: `${level}:${column}:${row}` });
        }
      if (found.length > MOST_SHOWN) continue;
      const x = (bounds[0] + bounds[2]) / 2, y = (bounds[1] + bounds[3]) / 2;
      const away = ({ box, side }) => Math.hypot(box[0] + side / 2 - x, box[1] + side / 2 - y);
      return found.sort((a, b) => away(a) - away(b));
    }
  }

  render({ key, box, side, parts }, stamp, colors, opacity) {
    const gl = this.gl;
    const texture = this.kept.get(key)?.texture ?? emptyTexture(gl, gl.RGBA8, SIDE_PX);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, SIDE_PX, SIDE_PX);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const scale = 2 / side;
    const fromAbove = new Float64Array([scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    this.ground.draw(parts, fromAbove, { x: box[0] + side / 2, y: box[1] + side / 2 }, colors, opacity);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.kept.set(key, { texture, stamp });
  }

  /** The square, or a coarser one's part in its place. */
  show({ level, column, row, side, box, key }, matrix, camera) {
    for (let up = 0; up <= COARSER_LEVELS; ++up) {
      const share = 2 ** up;
      const kept = up === 0 ? key : `${level + up}:${Math.floor(column / share)}:${Math.floor(row / share)}`;
      const tile = this.kept.get(kept);
      if (!tile) continue;
      this.kept.delete(kept);
      this.kept.set(kept, tile);
      const part = (index) => index / share - Math.floor(index / share);
      const gl = this.gl;
      gl.bindTexture(gl.TEXTURE_2D, tile.texture);
      this.program.use({ matrix, box: [box[0] - camera.x, box[1] - camera.y, side, side], source: [part(column), part(row), 1 / share, 1 / share] });
      gl.bindVertexArray(this.array);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      return;
    }
  }

  forgetOldest(shown) {
    for (const [key, tile] of this.kept) {
      if (this.kept.size <= Math.max(MOST_KEPT, 2 * shown)) return;
      this.gl.deleteTexture(tile.texture);
      this.kept.delete(key);
    }
  }
}
