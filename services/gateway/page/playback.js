// Play, pause, step, speed and seek where the source is a recording: `slammot play` reports where it is, and takes calls.
import { element } from "./panels.js";

const STEP_S = 0.1;
const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
const clock = (seconds) => `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`;

export class Playback {
  /** root: an empty panel; call(name, request): a promise, see Connection. */
  constructor(root, call) {
    this.root = root;
    this.call = call;
    this.known = null; // {position, duration, speed, isPaused, at}: what the player said last, and when
    this.isDragged = false;
    this.playButton = element("button", { title: "Play or pause (space)", onclick: () => this.toggle() });
    this.slider = element("input", { type: "range", min: 0, step: 0.1, "aria-label": "Time in the recording",
      oninput: () => ((this.isDragged = true), this.write(Number(this.slider.value))), onchange: () => this.seek(Number(this.slider.value)) });
    this.speed = element("select", { "aria-label": "Speed", onchange: () => this.setSpeed(Number(this.speed.value)) },
      ...SPEEDS.map((speed) => element("option", { value: speed }, `${speed}×`)));
    this.text = element("span", { class: "figure" });
    root.replaceChildren(this.playButton, element("button", { title: "Step (.)", onclick: () => this.step() }, "Step"), this.slider, this.text, this.speed);
  }

  /** health: message of /slammot/health; now: by the page's clock [ms]. */
  take(health, now) {
    const player = health?.services.find(({ service, state, counters }) => service === "player" && counters && state !== "silent" && state !== "stopping");
    if (!player) return (this.known = null);
    const { position_ms, duration_ms, is_paused, speed_percent } = player.counters;
    if (this.known && this.known.said === position_ms && this.known.isPaused === Boolean(is_paused) && now - this.known.at < 1500) return;
    this.known = { said: position_ms, position: position_ms / 1000, duration: duration_ms / 1000, speed: speed_percent / 100, isPaused: Boolean(is_paused), at: now };
  }

  position(now) {
    const { position, duration, speed, isPaused, at } = this.known;
    return Math.min(duration, position + (isPaused ? 0 : (speed * (now - at)) / 1000));
  }

  show(now) {
    this.root.hidden = this.known === null;
    if (this.root.hidden) return;
    this.playButton.textContent = this.known.isPaused ? "Play" : "Pause";
    this.slider.max = this.known.duration;
    if (document.activeElement !== this.speed && SPEEDS.includes(this.known.speed)) this.speed.value = this.known.speed;
    if (!this.isDragged) this.write((this.slider.value = this.position(now)));
  }

  write(seconds) {
    this.text.textContent = `${clock(Number(seconds))} / ${clock(this.known.duration)}`;
  }

  /** Shows at once what was asked for; the player's next report corrects it. */
  ask(name, request, change) {
    if (!this.known) return Promise.resolve();
    const now = performance.now();
    Object.assign(this.known, { position: this.position(now), at: now }, change);
    this.show(now);
    return this.call(name, request).catch((fault) => console.warn(`${name}: ${fault.message}`));
  }

  toggle() {
    return this.known?.isPaused ? this.ask("/player/go_on", {}, { isPaused: false }) : this.ask("/player/pause", {}, { isPaused: true });
  }
  step() {
    return this.ask("/player/step", { seconds: STEP_S }, { isPaused: true });
  }
  seek(seconds) {
    this.isDragged = false;
    return this.ask("/player/seek", { seconds }, { position: seconds });
  }
  setSpeed(speed) {
    return this.ask("/player/speed", { speed }, { speed });
  }
}
