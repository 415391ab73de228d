// Poses in the plane are [x, y, heading]; matrices are column-major, 4 x 4.

export const compose = ([ax, ay, ah], [bx, by, bh]) => {
  const c = Math.cos(ah), s = Math.sin(ah);
  return [ax + c * bx - s * by, ay + s * bx + c * by, ah + bh];
};

export const inverse = ([x, y, h]) => {
  const c = Math.cos(h), s = Math.sin(h);
  return [-c * x - s * y, s * x - c * y, -h];
};

export const apply = ([x, y, h], [px, py]) => {
  const c = Math.cos(h), s = Math.sin(h);
  return [x + c * px - s * py, y + s * px + c * py];
};

export const rotate = (h, [x, y]) => [Math.cos(h) * x - Math.sin(h) * y, Math.sin(h) * x + Math.cos(h) * y];

export function multiply(a, b) {
  const out = new Float64Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let i = 0; i < 4; ++i) sum += a[i * 4 + row] * b[column * 4 + i];
      out[column * 4 + row] = sum;
    }
  return out;
}

/** Matrix of a pose in the plane. */
export function placed([x, y, h]) {
  const c = Math.cos(h), s = Math.sin(h);
  return new Float64Array([c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x, y, 0, 1]);
}

/** Semi-axes and direction of the ellipse x' C^-1 x = scale^2, of C = [[a, b], [b, d]]. */
export function ellipse(a, b, d, scale) {
  const mean = (a + d) / 2;
  const spread = Math.hypot((a - d) / 2, b);
  return {
    major: scale * Math.sqrt(Math.max(0, mean + spread)),
    minor: scale * Math.sqrt(Math.max(0, mean - spread)),
    heading: 0.5 * Math.atan2(2 * b, a - d),
  };
}

/** Standard deviations of the ellipse that holds the share of a Gaussian in the plane. */
export const sigmas = (share) => Math.sqrt(-2 * Math.log(1 - share));

/** Of two rectangles [least x, least y, greatest x, greatest y]: whether they have points in common. */
export const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

/** Rectangle around a polyline [x0, y0, x1, y1, ...]. */
export function boundsOfLine(points) {
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  points.forEach((value, i) => {
    bounds[i % 2] = Math.min(bounds[i % 2], value);
    bounds[2 + (i % 2)] = Math.max(bounds[2 + (i % 2)], value);
  });
  return bounds;
}

/** Difference of two angles, in (-pi, pi]. */
export const turn = (from, to) => Math.atan2(Math.sin(to - from), Math.cos(to - from));

/** Those points of a polyline [x0, y0, x1, y1, ...] from which none of the others is farther than `most`, with its ends (Douglas and Peucker 1973). */
export function simplified(points, most) {
  const last = points.length / 2 - 1;
  if (last < 2) return points;
  const isKept = new Uint8Array(last + 1);
  isKept[0] = isKept[last] = 1;
  const pending = [[0, last]];
  while (pending.length) {
    const [from, to] = pending.pop();
    const [farthest, away] = farthestBetween(points, from, to);
    if (away <= most) continue;
    isKept[farthest] = 1;
    pending.push([from, farthest], [farthest, to]);
  }
  return points.filter((_, i) => isKept[i >> 1]);
}

/** Of the points between two: [index, distance] of the one that is farthest from the line segment between them. */
function farthestBetween(points, from, to) {
  const x = points[2 * from], y = points[2 * from + 1];
  const dx = points[2 * to] - x, dy = points[2 * to + 1] - y;
  const length2 = dx * dx + dy * dy;
  let farthest = from, most = 0;
  for (let i = from + 1; i < to; ++i) {
    const px = points[2 * i] - x, py = points[2 * i + 1] - y;
    const share = length2 > 0 ? Math.min(1, Math.max(0, (px * dx + py * dy) / length2)) : 0;
    const away = Math.hypot(px - share * dx, py - share * dy);
    if (away > most) [farthest, most] = [i, away];
  }
  return [farthest, most];
}
