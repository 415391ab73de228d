// Evidence of a map, drawn in the colours of the theme: free ground below, walls and motion above.
import { multiply, placed } from "./geometry.js";
import { Program } from "./gl.js";

const VERTEX = `
uniform mat4 matrix; uniform vec4 box; out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = matrix * vec4(box.xy + at * box.zw, 0.0, 1.0);
}`;
// Red: evidence of stationary objects in 1/16 of log-odds, + 128; green: share of sightings in motion.
const GROUND_FRAGMENT = `
in vec2 at; uniform sampler2D cells; uniform vec3 free_color; uniform float alpha; out vec4 result;
void main() {
  float evidence = texture(cells, at).r * 255.0 - 128.0;
  float seen = clamp(abs(evidence) / 10.0, 0.0, 1.0);
  result = vec4(free_color, 1.0) * seen * alpha;
}`;
const WALL_FRAGMENT = `
in vec2 at; uniform sampler2D cells; uniform vec3 wall; uniform vec3 motion; uniform float so; uniform float mo; out vec4 result;
void main() {
  vec2 cell = texture(cells, at).rg;
  float log_odds = (cell.r * 255.0 - 128.0) / 16.0;
  float occupied = 1.0 / (1.0 + exp(-log_odds));
  float strength = smoothstep(0.5, 0.95, occupied) * so;
  float moved = smoothstep(0.02, 0.6, cell.g) * mo;
  vec4 below = vec4(motion, 1.0) * moved * 0.75;
  result = vec4(wall, 1.0) * strength + below * (1.0 - strength);
}`;

export class Ground {
  constructor(gl) {
    this.gl = gl;
    this.ground = new Program(gl, VERTEX, GROUND_FRAGMENT);
    this.walls = new Program(gl, VERTEX, WALL_FRAGMENT);
    this.array = gl.createVertexArray();
  }

  /** fill(gl): uploads the picture, two channels or more, in the meaning of the shaders above. */
  texture(fill) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    fill(gl);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  /** parts: [{texture, box: [x, y, width, height] in its frame, shownPose: its frame in map}]. */
  draw(parts, matrix, camera, colors, opacity) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    const pass = (program, values) => {
      for (const part of parts) {
        const [x, y, heading] = part.shownPose;
        gl.bindTexture(gl.TEXTURE_2D, part.texture);
        program.use({ matrix: multiply(matrix, placed([x - camera.x, y - camera.y, heading])), box: part.box, ...values });
        gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      }
    };
    if (opacity.free > 0) pass(this.ground, { free_color: colors.free, alpha: opacity.free });
    if (opacity.so > 0 || opacity.mo > 0) pass(this.walls, { wall: colors.wall, motion: colors.motion, so: opacity.so, mo: opacity.mo });
  }
}
