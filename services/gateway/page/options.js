// What is shown and from where, kept in the page's address (after '#') so that a view can be passed on. With 'q' all pixels
// are drawn, also where that is slow.

export const LAYERS = {
  so: ["Stationary map", 1], free: ["Free space", 1], mo: ["Moving-object map", 0.8], lanes: ["Lanes and walkways", 0.7], scan: ["Scan", 1],
  tracks: ["Tracks", 1], tentative: ["Tentative tracks", 0], labels: ["Labels", 1], trails: ["Trails", 1],
  predictions: ["Predicted paths", 1], uncertainty: ["Uncertainty, 95 %", 1], way: ["Way driven", 1],
  graph: ["Pose graph and closures", 0], grid: ["Grid", 1],
};

const short = (number, digits) => String(Number(number.toFixed(digits)));

export function readOptions(camera) {
  const given = new URLSearchParams(location.hash.slice(1));
  const number = (name, otherwise) => (given.has(name) && Number.isFinite(Number(given.get(name))) ? Number(given.get(name)) : otherwise);
  camera.x = number("x", 0);
  camera.y = number("y", 0);
  camera.distance = number("d", camera.distance);
  camera.heading = number("r", camera.heading);
  camera.tilt = camera.wantedTilt = Math.min(1.3, Math.max(0, number("t", 0)));
  camera.follows = number("f", given.has("x") ? 0 : 1) === 1;
  const layers = Object.fromEntries(Object.entries(LAYERS).map(([name, [, opacity]]) => [name, opacity]));
  for (const part of (given.get("l") ?? "").split(",")) {
    const [name, opacity] = part.split(":");
    if (name in layers && Number.isFinite(Number(opacity))) layers[name] = Math.min(1, Math.max(0, Number(opacity)));
  }
  const prefersLight = matchMedia("(prefers-color-scheme: light)").matches;
  return { theme: given.get("c") ?? (prefersLight ? "light" : "dark"), layers, selected: given.has("s") ? number("s", null) : null, measured: null, isFine: given.has("q") };
}

/** Writes the view into the address, without a new entry in the history. */
export function writeOptions(camera, options) {
  const view = new URLSearchParams({
    d: short(camera.distance, 1), r: short(camera.heading, 3), t: short(camera.wantedTilt, 2), f: camera.follows ? 1 : 0, c: options.theme,
  });
  if (!camera.follows) {
    view.set("x", short(camera.x, 1));
    view.set("y", short(camera.y, 1));
  }
  const changed = Object.entries(options.layers).filter(([name, opacity]) => opacity !== LAYERS[name][1]);
  if (changed.length) view.set("l", changed.map(([name, opacity]) => `${name}:${short(opacity, 2)}`).join(","));
  if (options.isFine) view.set("q", 1);
  if (options.selected !== null) view.set("s", options.selected);
  const address = `#${view}`;
  if (address !== location.hash) history.replaceState(null, "", location.pathname + location.search + address);
}
