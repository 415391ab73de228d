// Mouse, touch and keyboard.
import { TILTED } from "./camera.js";

const CLICK_PX = 5;

export class Input {
  /**
   * actions: {select(x, y), toggle(name), deselect(), measure(point, isFirst), hover(point)}
   * keyboard: where keys are heard.
   */
  constructor(canvas, camera, actions, keyboard = window) {
    this.camera = camera;
    this.actions = actions;
    this.canvas = canvas;
    this.pointers = new Map();
    this.isMeasuring = false;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.up(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    keyboard.addEventListener("keydown", (event) => this.key(event));
  }

  down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({ preventScroll: true });
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.moved = 0;
    this.turns = event.button === 2 || event.shiftKey;
    this.isMeasured = this.isMeasuring && event.button === 0;
    if (this.isMeasured) this.actions.measure(this.camera.ground(event.offsetX, event.offsetY), true);
    else this.canvas.classList.add("dragging");
  }

  move(event) {
    this.actions.hover(this.camera.ground(event.offsetX, event.offsetY));
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.offsetX, event.offsetY];
    const dx = now[0] - before[0], dy = now[1] - before[1];
    this.moved += Math.hypot(dx, dy);
    if (this.pointers.size === 2) this.pinch(event.pointerId, before, now);
    else if (this.isMeasured) this.actions.measure(this.camera.ground(...now), false);
    else if (this.moved > CLICK_PX) this.drag(dx, dy);
    this.pointers.set(event.pointerId, now);
  }

  drag(dx, dy) {
    const { camera } = this;
    if (!this.turns) {
      camera.pan(dx, dy);
      this.actions.changed();
      return;
    }
    camera.heading += dx * 0.006;
    camera.tilt = camera.wantedTilt = Math.min(1.3, Math.max(0, camera.tilt - dy * 0.006));
  }

  pinch(id, before, now) {
    const [, other] = [...this.pointers].find(([key]) => key !== id);
    const span = (point) => [point[0] - other[0], point[1] - other[1]];
    const a = span(before), b = span(now);
    this.camera.zoom(Math.hypot(...a) / Math.max(1, Math.hypot(...b)));
    this.camera.heading += Math.atan2(b[1], b[0]) - Math.atan2(a[1], a[0]);
  }

  up(event) {
    const isClick = this.pointers.size === 1 && this.moved <= CLICK_PX && !this.isMeasured && event.type === "pointerup";
    this.pointers.delete(event.pointerId);
    this.canvas.classList.remove("dragging");
    if (isClick) this.actions.select(event.offsetX, event.offsetY);
  }

  wheel(event) {
    event.preventDefault();
    const { camera } = this;
    const before = camera.ground(event.offsetX, event.offsetY);
    camera.zoom(Math.exp(event.deltaY * 0.0012));
    const after = camera.ground(event.offsetX, event.offsetY);
    if (camera.follows || !before || !after) return;
    camera.x += before[0] - after[0];
    camera.y += before[1] - after[1];
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "INPUT") return;
    const { camera, actions } = this;
    const step = camera.height / 10;
    const keys = {
      f: () => actions.toggle("follow"), t: () => actions.toggle("tilt"), m: () => actions.toggle("measure"), l: () => actions.toggle("layers"),
      h: () => actions.toggle("health"), d: () => actions.toggle("theme"), Escape: () => actions.deselect(),
      "+": () => camera.zoom(0.8), "=": () => camera.zoom(0.8), "-": () => camera.zoom(1.25),
      ArrowLeft: () => camera.pan(step, 0), ArrowRight: () => camera.pan(-step, 0), ArrowUp: () => camera.pan(0, step), ArrowDown: () => camera.pan(0, -step),
      q: () => (camera.heading += 0.15), e: () => (camera.heading -= 0.15),
    };
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
    actions.changed();
  }
}

export const tiltOf = (isTilted) => (isTilted ? TILTED : 0);
