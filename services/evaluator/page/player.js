// Plays the drive of a report. Several pages side by side show the same moment from the same place.
import { Camera } from "./camera.js";
import { gl } from "./context.js";
import { Input, tiltOf } from "./input.js";
import { Labels } from "./labels.js";
import { LAYERS, readOptions } from "./options.js";
import { bars, buildLayers, degrees, drawPlot, element, number, showLegend, showScale } from "./panels.js";
import { Recording, Replay } from "./recording.js";
import { ReplayScene } from "./replay_scene.js";
import { CLASSES, THEMES, css } from "./theme.js";
import { Timeline, clockText } from "./timeline.js";

const $ = (id) => document.getElementById(id);
const SELECT_PX = 26;
const SPEEDS = [0.25, 0.5, 1, 2, 5, 10, 20, 50];
const STEP_S = 0.2;
const START_M = 75; // distance of the camera

class Player {
  constructor() {
    const stage = $("player");
    const recording = new Recording(JSON.parse($("drive").textContent), $("drive-data").textContent.trim());
    this.recording = recording;
    this.replay = new Replay(recording);
    this.camera = new Camera();
    if (!recording.header.lanes.length) delete LAYERS.lanes;
    this.options = readOptions(this.camera);
    if (!location.hash.includes("l=")) this.options.layers.graph = 0.8;
    this.isDirty = true;
    this.scene = new ReplayScene(gl, this.replay, () => (this.isDirty = true));
    this.labels = new Labels($("labels"), this.replay);
    this.timeline = new Timeline($("timeline"), recording, (time) => this.seek(time));
    this.isPlaying = false;
    this.leads = window === parent;
    this.input = new Input($("scene"), this.camera, this.actions(), stage);
    this.bindControls(stage);
    if (!location.hash.includes("d=")) this.camera.distance = START_M;
    const [, at] = location.hash.match(/\bat=([\d.]+)/) ?? [];
    this.seek(Number(at ?? 0));
    this.applyTheme();
    this.resize();
    this.last = performance.now();
    requestAnimationFrame((now) => this.draw(now));
  }

  actions() {
    const toggles = {
      follow: () => (this.camera.follows = !this.camera.follows),
      tilt: () => {
        this.camera.wantedTilt = tiltOf(this.camera.wantedTilt === 0);
        if (this.camera.wantedTilt === 0) this.camera.heading = Math.PI / 2;
      },
      measure: () => {
        this.input.isMeasuring = !this.input.isMeasuring;
        if (!this.input.isMeasuring) this.options.measured = null;
        $("scene").classList.toggle("measuring", this.input.isMeasuring);
      },
      layers: () => ($("layers").hidden = !$("layers").hidden),
      health: () => {},
      theme: () => {
        this.options.theme = this.options.theme === "dark" ? "light" : "dark";
        this.applyTheme();
      },
      play: () => this.play(!this.isPlaying),
      whole: () => this.showAll(),
      sigma: () => {
        this.replay.exaggeration = this.replay.exaggeration === 1 ? 10 : 1;
        this.seek(this.replay.time);
      },
    };
    this.toggles = toggles;
    return {
      select: (px, py) => this.select(px, py),
      toggle: (name) => toggles[name](),
      deselect: () => (this.options.selected = this.options.measured = null),
      measure: (point, isFirst) => point && (this.options.measured = isFirst ? [point, point] : [this.options.measured[0], point]),
      hover: (point) => this.hover(point),
      changed: () => this.refresh(),
    };
  }

  bindControls(stage) {
    for (const name of ["follow", "tilt", "measure", "theme", "whole", "sigma", "play"])
      $(name).onclick = () => (this.toggles[name](), this.refresh());
    $("layers-button").onclick = () => (this.toggles.layers(), this.refresh());
    for (const [id, step] of [["back", -STEP_S], ["forward", STEP_S]]) $(id).onclick = () => this.step(step);
    $("speed").append(...SPEEDS.map((speed) => element("option", { value: speed }, `${speed}×`)));
    $("speed").value = 1;
    const keys = { " ": () => this.toggles.play(), ",": () => this.step(-STEP_S), ".": () => this.step(STEP_S) };
    stage.addEventListener("keydown", (event) => {
      const action = event.target.tagName === "BUTTON" && event.key === " " ? null : keys[event.key];
      if (!action) return;
      event.preventDefault();
      action();
      this.refresh();
    });
    // A page scrolls; the picture zooms only once it has been clicked.
    $("scene").addEventListener("wheel", (event) => document.activeElement !== $("scene") && event.stopImmediatePropagation(), true);
    for (const kind of ["pointerdown", "keydown", "wheel"]) stage.addEventListener(kind, () => (this.leads = true), true);
    for (const kind of ["pointermove", "wheel"]) stage.addEventListener(kind, () => (this.isDirty = true));
    document.addEventListener("click", (event) => this.followLink(event.target.closest?.("[data-at]")));
    addEventListener("resize", () => this.resize());
    addEventListener("message", (event) => event.source === parent && this.adopt(event.data));
    buildLayers(this.options, () => this.refresh());
  }

  /** A button of the page's text that names a moment, and perhaps a track. */
  followLink(link) {
    if (!link) return;
    this.seek(Number(link.dataset.at));
    this.camera.follows = true;
    this.camera.distance = Math.min(this.camera.distance, 110);
    if (link.dataset.track) this.options.selected = Number(link.dataset.track);
    $("player").scrollIntoView({ behavior: "smooth" });
    this.refresh();
  }

  seek(time) {
    this.replay.go(time);
    this.refresh();
  }
  step(seconds) {
    this.play(false);
    this.seek(this.replay.time + seconds);
  }
  play(isPlaying) {
    if (isPlaying && this.replay.time >= this.recording.duration) this.replay.go(0);
    this.isPlaying = isPlaying;
  }

  /** Shows the whole drive from above. */
  showAll() {
    const { x, y } = this.recording.is;
    const range = (values) => [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
    const [x0, x1] = range(x), [y0, y1] = range(y);
    const aspect = $("player").clientWidth / $("player").clientHeight;
    Object.assign(this.camera, { x: (x0 + x1) / 2, y: (y0 + y1) / 2, follows: false, wantedTilt: 0, heading: Math.PI / 2 });
    this.camera.distance = Math.max(30, 1.9 * Math.max(y1 - y0, (x1 - x0) / aspect));
  }

  select(px, py) {
    const { camera, replay } = this;
    const distance = (track) => {
      const at = camera.project(...track.position, track.height / 2, camera.lastMatrix);
      return at ? Math.max(0, Math.hypot(at[0] - px, at[1] - py) - track.length / 2 / camera.metresPerPixel()) : Infinity;
    };
    const nearest = [...replay.tracks.values()].map((track) => [distance(track), track.id]).sort((a, b) => a[0] - b[0])[0];
    this.options.selected = nearest && nearest[0] < SELECT_PX ? nearest[1] : null;
    this.refresh();
  }

  hover(point) {
    const { measured } = this.options;
    const length = measured ? `${Math.hypot(measured[1][0] - measured[0][0], measured[1][1] - measured[0][1]).toFixed(2)} m   ` : "";
    $("cursor").textContent = point ? `${length}${point[0].toFixed(1)}, ${point[1].toFixed(1)} m` : "";
  }

  applyTheme() {
    $("player").dataset.theme = this.options.theme;
    showLegend(this.options.theme);
    for (const point of $("legend").querySelectorAll(".point")) point.parentElement.remove(); // no scan is recorded
    const colors = THEMES[this.options.theme];
    const line = (name, color) => element("span", { "--color": css(colors[color]) }, element("i", { class: "line" }), name);
    $("legend").append(line("accepted closure", "accepted"), line("rejected, or doubtful pose", "rejected"), line("withdrawn", "withdrawn"));
  }

  resize() {
    const { clientWidth, clientHeight } = $("player");
    const ratio = devicePixelRatio || 1;
    [this.camera.width, this.camera.height] = [clientWidth, clientHeight];
    [$("scene").width, $("scene").height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    this.refresh();
  }

  refresh() {
    this.isDirty = true;
    const { replay, recording, camera } = this;
    $("clock").textContent = `${clockText(replay.time)} / ${clockText(recording.duration)}`;
    $("play").textContent = this.isPlaying ? "❚❚" : "▶";
    $("play").setAttribute("aria-label", this.isPlaying ? "Pause" : "Play");
    $("kmh").textContent = Math.round(replay.pose.speed_mps * 3.6);
    $("count").textContent = replay.confirmedCount;
    $("sigma-now").textContent = (Math.sqrt(Math.max(0, ...[0, 2].map((i) => recording.covarianceAt(replay.frame)[i]))) * 100).toFixed(1);
    const pressed = { follow: camera.follows, tilt: camera.wantedTilt > 0, measure: this.input.isMeasuring, "layers-button": !$("layers").hidden, sigma: replay.exaggeration > 1 };
    for (const [id, is] of Object.entries(pressed)) $(id).setAttribute("aria-pressed", is);
    showScale(camera);
    this.showTrack();
  }

  showTrack() {
    const { options, recording, replay } = this;
    const panel = $("details");
    panel.hidden = options.selected === null || !$("layers").hidden || !recording.rowsOf.has(options.selected);
    if (panel.hidden) return;
    const life = recording.lifeOf(options.selected);
    const { rows } = recording.rowsOf.get(options.selected);
    const shown = life.findLastIndex(([time]) => time <= replay.time);
    const track = replay.tracks.get(options.selected) ?? recording.trackOf(rows[Math.max(0, shown)], undefined, 0);
    const isThere = replay.tracks.has(options.selected);
    const color = THEMES[options.theme][CLASSES[track.class] ?? "other"];
    const values = [
      ["state", !isThere ? "not tracked now" : `${track.occluded ? "occluded, " : ""}${track.stopped ? "stopped" : "moving"}`],
      ["speed", number(track.speed * 3.6, 1, "km/h")], ["heading", degrees(track.heading)],
      ["size", `${track.length.toFixed(1)} × ${track.width.toFixed(1)} m`],
      ["position", `± ${Math.sqrt(track.covariance[0]).toFixed(2)}, ± ${Math.sqrt(track.covariance[5]).toFixed(2)} m`],
      ["tracked", `${clockText(life[0][0])} to ${clockText(life.at(-1)[0])}`],
    ];
    const highest = Math.max(5, ...life.map((entry) => entry[1]));
    const plots = [["speed", 1, highest, `0 to ${(highest * 3.6).toFixed(0)} km/h`], ["existence", 2, 1, track.existence.toFixed(3)]];
    const canvases = plots.map(() => element("canvas"));
    const [velocity, acceleration, turning] = track.mode_probability;
    panel.replaceChildren(
      element("h2", {}, element("i", { class: "dot" }), `${track.class} ${track.id}`,
        element("button", { "aria-label": "Deselect", onclick: () => ((options.selected = null), this.refresh()) }, "×")),
      element("table", {}, ...values.map(([name, value]) => element("tr", {}, element("td", {}, name), element("td", {}, value)))),
      ...plots.map(([name, , , now], i) => element("div", { class: "plot" }, name, element("b", {}, now), canvases[i])),
      bars([["constant velocity", velocity], ["acceleration", acceleration], ["turn", turning]]));
    panel.querySelector(".dot").style.background = css(color);
    plots.forEach(([, index, top], i) => drawPlot(canvases[i], life.map((entry) => [entry[0], entry[index]]), top, color, replay.time));
  }

  /** What another page beside this one shows. */
  adopt({ stamp, camera, speed, exaggeration }) {
    this.leads = false;
    this.isPlaying = false;
    Object.assign(this.camera, camera);
    $("speed").value = speed;
    this.replay.exaggeration = exaggeration;
    this.seek(stamp - this.recording.header.start_s);
  }

  tellOthers() {
    if (window === parent || !this.leads) return;
    const { x, y, distance, heading, tilt, wantedTilt, follows } = this.camera;
    const camera = { x, y, distance, heading, tilt, wantedTilt, follows };
    const state = { stamp: this.recording.header.start_s + this.replay.time, camera, isPlaying: this.isPlaying, speed: $("speed").value, exaggeration: this.replay.exaggeration };
    parent.postMessage(state, "*");
  }

  draw(now) {
    const seconds = Math.min(0.2, (now - this.last) / 1000);
    this.last = now;
    if (this.isPlaying) {
      this.replay.go(this.replay.time + seconds * Number($("speed").value));
      if (this.replay.time >= this.recording.duration) this.isPlaying = false;
      this.refresh();
    }
    const { camera } = this;
    const before = [camera.x, camera.y, camera.tilt, camera.heading, camera.distance].join();
    camera.update(seconds, this.replay.vehicle);
    const after = [camera.x, camera.y, camera.tilt, camera.heading, camera.distance].join();
    if (this.isDirty || before !== after) {
      this.isDirty = false;
      camera.lastMatrix = camera.matrix();
      this.scene.draw(camera, this.options, seconds);
      this.labels.draw(camera, this.options);
      this.timeline.draw(this.replay.time, THEMES[this.options.theme]);
      this.tellOthers();
    }
    requestAnimationFrame((next) => this.draw(next));
  }
}

try {
  window.slammotReport = new Player(); // named for the tests of the page
} catch (error) {
  document.getElementById("failure").textContent = `The drive cannot be drawn: ${error.message}.`;
  document.getElementById("failure").hidden = false;
}
