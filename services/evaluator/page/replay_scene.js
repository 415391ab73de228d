// The scene of the live view with the map as one picture, lanes, the whole way, and where the pose was doubtful.
import { Ground } from "./ground.js";
import { Scene } from "./scene.js";

/** The map of the run. Its picture's red and green are what ground.js expects of a submap. */
class PictureLayer {
  constructor(gl, picture, onLoad) {
    this.ground = new Ground(gl);
    this.parts = [];
    if (!picture) return;
    const image = new Image();
    image.onload = () => {
      const texture = this.ground.texture(() => {
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, image);
      });
      const { min, size } = picture;
      this.parts = [{ texture, box: [min[0], min[1] + size[1], size[0], -size[1]], shownPose: [0, 0, 0] }]; // its first row is the top one
      onLoad();
    };
    image.setAttribute("src", `data:image/png;base64,${document.getElementById("drive-map").textContent.trim()}`);
  }

  update() {}
  draw(matrix, camera, colors, opacity) {
    this.ground.draw(this.parts, matrix, camera, colors, opacity);
  }
  drawLive() {}
}

export class ReplayScene extends Scene {
  constructor(canvas, replay, onLoad) {
    super(canvas, replay, (gl) => new PictureLayer(gl, replay.recording.header.map, onLoad));
  }

  /** Lanes, cycle lanes and walkways as wide as they are used, fainter where few objects went; an arrow in the middle of each. */
  addLanes(alpha) {
    for (const { color: name, directed, width, confidence, points } of this.world.recording.header.lanes) {
      const color = this.colors[name];
      const own = points.map((value, i) => value - (i % 2 ? this.camera.y : this.camera.x));
      this.shapes.strip(own, 0.02, color, () => 0.18 * confidence * alpha, width / this.camera.metresPerPixel());
      this.shapes.strip(own, 0.03, color, () => (0.2 + 0.6 * confidence) * alpha, 1.3 * this.scale);
      if (directed) this.addArrow(own, color, (0.2 + 0.6 * confidence) * alpha);
    }
  }

  addArrow(points, color, alpha) {
    const end = 2 * Math.floor(points.length / 4);
    const [x, y] = points.slice(end, end + 2);
    const along = Math.atan2(y - points[end - 1], x - points[end - 2]);
    for (const side of [2.6, -2.6])
      this.shapes.line([x + Math.cos(along + side), y + Math.sin(along + side)], [x, y], 0.03, color, alpha, 1.3 * this.scale);
  }

  addWay(alpha) {
    if (this.layers.lanes > 0) this.addLanes(this.layers.lanes);
    const { is, header } = this.world.recording;
    const strip = (begin, end, color, strength, width) => {
      const points = [];
      for (let i = begin; i <= end; ++i) points.push(is.x[i] - this.camera.x, is.y[i] - this.camera.y);
      this.shapes.strip(points, 0.04, color, () => strength * alpha, width * this.scale);
    };
    strip(0, is.x.length - 1, this.colors.way, 0.3, 1.6);
    super.addWay(alpha);
    for (const span of header.doubts) strip(span.frames[0], span.frames[1], this.colors.rejected, 0.9, 4);
  }
}
