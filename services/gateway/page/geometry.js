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

/** Difference of two angles, in (-pi, pi]. */
export const turn = (from, to) => Math.atan2(Math.sin(to - from), Math.cos(to - from));

/** A polyline [x0, y0, x1, y1, ...] relative to [x, y], with its ends, without points that are closer than `least` to the one kept before. */
export function thinned(points, [x, y], least) {
  const kept = [];
  for (let i = 0; i < points.length; i += 2) {
    const px = points[i] - x, py = points[i + 1] - y;
    const isLast = i + 2 >= points.length;
    if (!isLast && kept.length && Math.hypot(px - kept.at(-2), py - kept.at(-1)) < least) continue;
    kept.push(px, py);
  }
  return kept;
}
