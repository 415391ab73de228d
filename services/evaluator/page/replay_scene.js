// The scene of the live view with the map as one picture, the whole way, and where the pose was doubtful.
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
  constructor(gl, replay, onLoad) {
    super(gl, replay, () => new PictureLayer(gl, replay.recording.header.map, onLoad));
  }

  addWay(alpha) {
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
