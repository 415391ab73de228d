// Joins connection, world, picture and panels.
import { Camera } from "./camera.js";
import { Connection } from "./connection.js";
import { gl } from "./context.js";
import { Input, tiltOf } from "./input.js";
import { Labels } from "./labels.js";
import { MapLayer } from "./map_layer.js";
import { readOptions, writeOptions } from "./options.js";
import { buildLayers, showDetails, showHealth, showLegend, showScale, showStatus } from "./panels.js";
import { Playback } from "./playback.js";
import { Scene } from "./scene.js";
import { World } from "./world.js";

const PANEL_PERIOD_MS = 200;
const ADDRESS_PERIOD_MS = 500;
const SELECT_PX = 26;
const SLOW_FRAME_MS = 31; // above it, fewer pixels are drawn
const FAST_FRAME_MS = 18;
const SETTLED_FRAME_MS = 25; // taken for the truth after a change
const COARSEST = 0.5; // share of the screen's pixels along each side

let link = "connecting";
const $ = (id) => document.getElementById(id);
const world = new World();
const camera = new Camera();
const options = readOptions(camera);
const connection = new Connection(world.handlers(), (state) => (link = state)); // the first, so that it goes on meanwhile
const scene = new Scene(gl, world, (gl) => new MapLayer(gl, (error) => console.warn(error.message)));
const labels = new Labels($("labels"), world);
let frames = 0;
let measuredText = "";

const playback = new Playback($("playback"), (name, request) => connection.call(name, request));

function state(now) {
  if (link === "closed") return "lost";
  if (link === "connecting") return "connecting";
  if (!world.pose) return "waiting";
  return world.isStale(now) ? "stale" : "live";
}

function applyTheme() {
  document.documentElement.dataset.theme = options.theme;
  showLegend(options.theme);
}

const togglePanel = (name) => {
  const panel = $(name);
  const isHidden = panel.hidden;
  for (const other of ["layers", "health"]) $(other).hidden = true;
  panel.hidden = !isHidden;
  showHealth(world.health);
};

const toggles = {
  follow: () => (camera.follows = !camera.follows),
  tilt: () => {
    camera.wantedTilt = tiltOf(camera.wantedTilt === 0);
    if (camera.wantedTilt === 0) camera.heading = Math.PI / 2;
  },
  measure: () => {
    input.isMeasuring = !input.isMeasuring;
    if (!input.isMeasuring) options.measured = null;
    $("scene").classList.toggle("measuring", input.isMeasuring);
  },
  layers: () => togglePanel("layers"),
  health: () => togglePanel("health"),
  theme: () => {
    options.theme = options.theme === "dark" ? "light" : "dark";
    applyTheme();
  },
};

function showButtons() {
  const pressed = {
    follow: camera.follows, tilt: camera.wantedTilt > 0, measure: input.isMeasuring,
    "layers-button": !$("layers").hidden, "health-button": !$("health").hidden,
  };
  for (const [id, is] of Object.entries(pressed)) $(id).setAttribute("aria-pressed", is);
}

function select(px, py) {
  const distance = (track) => {
    const [x, y] = world.positionOf(track);
    const at = camera.project(x, y, track.height / 2, camera.lastMatrix);
    const reach = track.length / 2 / camera.metresPerPixel();
    return at ? Math.max(0, Math.hypot(at[0] - px, at[1] - py) - reach) : Infinity;
  };
  const shown = [...world.tracks.values()].filter((track) => track.confirmed || options.layers.tentative > 0);
  const nearest = shown.map((track) => [distance(track), track.id]).sort((a, b) => a[0] - b[0])[0];
  options.selected = nearest && nearest[0] < SELECT_PX ? nearest[1] : null;
  refresh();
}

const input = new Input($("scene"), camera, {
  select,
  toggle: (name) => toggles[name](),
  deselect: () => (options.selected = options.measured = null),
  measure: (point, isFirst) => {
    if (!point) return;
    options.measured = isFirst ? [point, point] : [options.measured[0], point];
    const [from, to] = options.measured;
    measuredText = `${Math.hypot(to[0] - from[0], to[1] - from[1]).toFixed(2)} m   `;
  },
  hover: (point) => {
    if (!options.measured) measuredText = "";
    $("cursor").textContent = point ? `${measuredText}${point[0].toFixed(1)}, ${point[1].toFixed(1)} m` : "";
  },
  changed: () => refresh(),
});

for (const name of ["follow", "tilt", "measure", "theme"]) $(name).onclick = () => (toggles[name](), refresh());
for (const name of ["layers", "health"]) $(`${name}-button`).onclick = () => (toggles[name](), refresh());

function refresh() {
  showStatus(state(performance.now()), world, performance.now());
  showHealth(world.health);
  showDetails(world, options, () => {
    options.selected = null;
    refresh();
  });
  showScale(camera);
  showButtons();
  playback.take(world.health, performance.now());
  playback.show(performance.now());
}

function resize() {
  const ratio = (devicePixelRatio || 1) * fineness;
  camera.width = innerWidth;
  camera.height = innerHeight;
  $("scene").width = Math.round(innerWidth * ratio);
  $("scene").height = Math.round(innerHeight * ratio);
}

let fineness = scene.isSlow && !options.isFine ? COARSEST : 1;
let frameMs = SETTLED_FRAME_MS; // smoothed
/** A machine without a graphics processor draws fewer pixels rather than fewer pictures. */
function adaptFineness(ms) {
  if (options.isFine) return;
  frameMs += (Math.min(ms, 500) - frameMs) * 0.05;
  const wanted = frameMs > SLOW_FRAME_MS ? fineness - 0.125 : frameMs < FAST_FRAME_MS ? fineness + 0.125 : fineness;
  const next = Math.min(1, Math.max(COARSEST, wanted));
  if (next === fineness) return;
  fineness = next;
  frameMs = SETTLED_FRAME_MS;
  resize();
}

let last = performance.now();
function frame(now) {
  const seconds = Math.min(0.2, (now - last) / 1000);
  adaptFineness(now - last);
  last = now;
  camera.update(seconds, world.vehicle);
  camera.lastMatrix = camera.matrix();
  if (scene.isReady) scene.draw(camera, options, seconds);
  labels.draw(camera, options);
  ++frames;
  requestAnimationFrame(frame);
}

addEventListener("keydown", (event) => {
  if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
  if (event.key === " ") playback.toggle();
  if (event.key === ".") playback.step();
});
addEventListener("resize", resize);
resize();
applyTheme();
buildLayers(options, refresh);
refresh();
setInterval(refresh, PANEL_PERIOD_MS);
setInterval(() => writeOptions(camera, options), ADDRESS_PERIOD_MS);
requestAnimationFrame(frame);

// For the tests of the page, and for the curious.
window.slammot = { world, camera, options, connection, playback, scene, map: scene.map, state: () => state(performance.now()), frames: () => frames };
