// Text beside tracks, drawn on a canvas above the scene, without overlaps: the nearest to the vehicle first.
import { CLASSES, THEMES, css } from "./theme.js";

const MOST_LABELS = 60;
const FARTHEST_MPP = 0.45; // metres per pixel beyond which only the selected track has a label

export class Labels {
  constructor(canvas, world) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.world = world;
  }

  draw(camera, options, ratio) {
    const { canvas, context } = this;
    const width = Math.round(camera.width * ratio), height = Math.round(camera.height * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, camera.width, camera.height);
    if (!this.world.map_from_odom || options.layers.labels <= 0) return;
    context.font = "600 12px system-ui, 'DejaVu Sans', sans-serif";
    context.textBaseline = "middle";
    const taken = [];
    for (const track of this.candidates(camera, options)) this.label(track, camera, options, taken);
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

  label(track, camera, { theme, selected, layers }, taken) {
    const [x, y] = this.world.positionOf(track);
    const at = camera.project(x, y, track.height + 0.4, camera.lastMatrix);
    if (!at) return;
    const colors = THEMES[theme];
    const color = colors[CLASSES[track.class] ?? "other"];
    const speed = track.stopped ? "stopped" : `${Math.round(track.speed * 3.6)} km/h`;
    const name = `${track.class} ${track.id}${track.occluded ? " (occluded)" : ""}`;
    const { context } = this;
    const width = context.measureText(`${name}  ${speed}`).width + 14;
    const left = at[0] + 8, top = at[1] - 24;
    const box = [left, top, left + width, top + 18];
    const overlaps = taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1]);
    if (overlaps && track.id !== selected) return;
    taken.push(box);
    context.globalAlpha = layers.labels;
    context.fillStyle = css(colors.back, 0.72);
    context.beginPath();
    context.roundRect(left, top, width, 18, 5);
    context.fill();
    context.fillStyle = css(color);
    context.fillRect(left, top + 3, 2.5, 12);
    context.fillText(name, left + 7, top + 9.5);
    context.fillStyle = css(colors.vehicle, 0.75);
    context.fillText(speed, left + 7 + context.measureText(`${name}  `).width, top + 9.5);
    context.globalAlpha = 1;
  }
}
