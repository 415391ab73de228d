// Text beside tracks, above the scene, without overlaps: the nearest to the vehicle first. Each is an element that is moved, which
// costs the pixels of the text; a canvas above the scene would cost those of the whole picture.
import { element } from "./panels.js";
import { CLASSES, THEMES, css } from "./theme.js";

const MOST_LABELS = 60;
const FARTHEST_MPP = 0.45; // metres per pixel beyond which only the selected track has a label
const HEIGHT_PX = 18;

export class Labels {
  constructor(box, world) {
    this.box = box;
    this.world = world;
    this.labels = new Map(); // by track: {node, name, speed, color, width}
  }

  draw(camera, options) {
    const { opacity } = this.box.style;
    if (opacity !== String(options.layers.labels)) this.box.style.opacity = options.layers.labels;
    const isShown = this.world.map_from_odom && options.layers.labels > 0;
    const tracks = isShown ? this.candidates(camera, options) : [];
    const ids = new Set(tracks.map((track) => track.id));
    for (const [id, { node }] of this.labels)
      if (!ids.has(id)) node.remove(), this.labels.delete(id);
    const taken = [];
    for (const track of tracks) {
      const label = this.label(track, css(THEMES[options.theme][CLASSES[track.class] ?? "other"]));
      label.node.style.visibility = this.place(label, track, camera, options.selected, taken) ? "" : "hidden";
    }
  }

  candidates(camera, { selected }) {
    const isFar = camera.metresPerPixel() > FARTHEST_MPP;
    const distance = (track) => {
      const [x, y] = this.world.positionOf(track);
      return track.id === selected ? -1 : Math.hypot(x - camera.x, y - camera.y);
    };
    return [...this.world.tracks.values()]
      .filter((track) => track.confirmed && (!isFar || track.id === selected))
      .sort((a, b) => distance(a) - distance(b))
      .slice(0, MOST_LABELS);
  }

  /** Moves it to its track; whether there is room for it. */
  place({ node, width }, track, camera, selected, taken) {
    const [x, y] = this.world.positionOf(track);
    const at = camera.project(x, y, track.height + 0.4, camera.lastMatrix);
    if (!at) return false;
    const left = Math.round(at[0]) + 8, top = Math.round(at[1]) - 24;
    const box = [left, top, left + width, top + HEIGHT_PX];
    const overlaps = taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1]);
    if (overlaps && track.id !== selected) return false;
    taken.push(box);
    node.style.transform = `translate(${left}px, ${top}px)`;
    return true;
  }

  /** With the text of now; its width is measured where the text is another one. */
  label(track, color) {
    const speed = track.stopped ? "stopped" : `${Math.round(track.speed * 3.6)} km/h`;
    const name = `${track.class} ${track.id}${track.occluded ? " (occluded)" : ""}`;
    let label = this.labels.get(track.id);
    if (!label) {
      label = { node: element("p", {}, element("b"), element("span")) };
      this.box.append(label.node);
      this.labels.set(track.id, label);
    }
    if (label.color !== color) label.node.style.setProperty("--color", (label.color = color));
    if (label.name === name && label.speed === speed) return label;
    label.node.firstChild.textContent = label.name = name;
    label.node.lastChild.textContent = label.speed = speed;
    label.width = label.node.offsetWidth;
    return label;
  }
}
