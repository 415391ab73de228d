// Points of a submap that is not finished, kept at several densities: from afar a picture needs a few of them only, and without
// a graphics processor each point costs a microsecond.
import { Floats, Vertices } from "./gl.js";

const CELL_M = 0.15; // one point of a label is kept of each
const LEVELS = 5; // each with cells twice as wide: up to 2.4 m
const MOST_POINTS = 60000;

export class LivePoints {
  constructor(gl) {
    const layout = [[0, 2, gl.FLOAT, false, 0, 0], [1, 1, gl.FLOAT, false, 8, 0]];
    /** The points of levels[i] are alone in a cell of CELL_M * 2 ** i, but not in a wider one. */
    this.levels = Array.from({ length: LEVELS }, () => ({ taken: new Set(), points: new Floats(3), vertices: new Vertices(gl, 12, layout), isChanged: false }));
    this.count = 0;
  }

  /** x, y in the submap. */
  add(x, y, label) {
    if (this.count === MOST_POINTS) return;
    const column = Math.floor(x / CELL_M), row = Math.floor(y / CELL_M);
    const key = (level) => ((column >> level) * 65536 + (row >> level)) * 4 + label;
    if (this.levels[0].taken.has(key(0))) return;
    let widest = LEVELS - 1;
    while (this.levels[widest].taken.has(key(widest))) --widest;
    for (let level = 0; level <= widest; ++level) this.levels[level].taken.add(key(level));
    this.levels[widest].points.add(x, y, label);
    this.levels[widest].isChanged = true;
    ++this.count;
  }

  /** draw(vertices, count) of points of which one is enough within so many metres. */
  draw(metres, draw) {
    const densest = Math.min(LEVELS - 1, Math.max(0, Math.floor(Math.log2(metres / CELL_M))));
    for (const level of this.levels.slice(densest)) {
      if (level.isChanged) level.vertices.fill(level.points.view());
      level.isChanged = false;
      if (level.points.count > 0) draw(level.vertices, level.points.count);
    }
  }

  remove() {
    for (const level of this.levels) level.vertices.remove();
  }
}
