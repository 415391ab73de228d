// The bar of time below the picture: number of tracks, doubtful spans, the shown moment.
import { css } from "./theme.js";

export const clockText = (seconds) => `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`;

export class Timeline {
  constructor(canvas, recording, seek) {
    this.canvas = canvas;
    this.recording = recording;
    const { first_row } = recording.is;
    this.counts = Array.from({ length: recording.count }, (_, frame) => first_row[frame + 1] - first_row[frame]);
    this.most = Math.max(4, ...this.counts);
    const go = (event) => seek((event.offsetX / canvas.clientWidth) * recording.duration);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons && go(event));
  }

  draw(time, colors) {
    const { canvas, recording } = this;
    const ratio = devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const at = (seconds) => (width * seconds) / Math.max(recording.duration, 1e-6);
    context.fillStyle = css(colors.scan, 0.35);
    const bars = Math.max(1, Math.floor(width / 2));
    for (let bar = 0; bar < bars; ++bar) {
      const count = this.counts[recording.frameAt(((bar + 0.5) / bars) * recording.duration)];
      context.fillRect((bar * width) / bars, height, width / bars + 0.5, (-(height - 6) * count) / this.most);
    }
    context.fillStyle = css(colors.rejected, 0.75);
    for (const { begin, end } of recording.header.doubts) context.fillRect(at(begin), 0, Math.max(2, at(end) - at(begin)), 5);
    context.fillStyle = css(colors.vehicle);
    context.fillRect(Math.min(width - 2, at(time)), 0, 2, height);
  }
}
