// WebGL 2: programs, and instanced drawing from a buffer that grows.

function compile(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp int;\n${source}`);
  gl.compileShader(shader);
  return shader;
}

/** Whether pictures are drawn without a graphics processor. */
export function isDrawnBySoftware(gl) {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

const compiling = new Set(); // programs

/** Whether all programs can be used without waiting for them. */
export function areCompiled(gl) {
  const parallel = gl.getExtension("KHR_parallel_shader_compile");
  for (const { program } of parallel ? compiling : [])
    if (!gl.getProgramParameter(program, parallel.COMPLETION_STATUS_KHR)) return false;
  compiling.clear();
  return true;
}

/** A program with its uniforms: use({name: number, or list of 2, 3, 4 or 16 numbers}). It is waited for when it is used first. */
export class Program {
  constructor(gl, vertex, fragment) {
    compiling.add(this);
    this.gl = gl;
    this.program = gl.createProgram();
    this.shaders = [compile(gl, gl.VERTEX_SHADER, vertex), compile(gl, gl.FRAGMENT_SHADER, fragment)];
    for (const shader of this.shaders) gl.attachShader(this.program, shader);
    gl.linkProgram(this.program);
  }

  readUniforms() {
    const { gl } = this;
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS))
      throw new Error([...this.shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(this.program)].join("\n"));
    this.uniforms = new Map();
    const count = gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const { name } = gl.getActiveUniform(this.program, i);
      this.uniforms.set(name, gl.getUniformLocation(this.program, name));
    }
  }

  use(values) {
    const gl = this.gl;
    if (!this.uniforms) this.readUniforms();
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(values)) {
      const at = this.uniforms.get(name);
      if (at === undefined) continue;
      if (typeof value === "number") gl.uniform1f(at, value);
      else if (value.length === 2) gl.uniform2fv(at, value);
      else if (value.length === 3) gl.uniform3fv(at, value);
      else if (value.length === 4) gl.uniform4fv(at, value);
      else gl.uniformMatrix4fv(at, false, new Float32Array(value));
    }
  }
}

/** Of a rectangle on the ground that shows a part of a texture: uniforms matrix, box and source, each [x, y, width, height]. */
export const PART_VERTEX = `
uniform mat4 matrix; uniform vec4 box; uniform vec4 source; out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at = source.xy + corner * source.zw;
  gl_Position = matrix * vec4(box.xy + corner * box.zw, 0.0, 1.0);
}`;

/** A square texture to draw into, interpolated where it is shown. */
export function emptyTexture(gl, format, side) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, side, side);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
  for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  return texture;
}

/** Vertices: a buffer and the layout of its attributes, [[location, size, type, normalized, offset, divisor]]. */
export class Vertices {
  constructor(gl, stride, attributes) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const [location, size, type, normalized, offset, divisor] of attributes) {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, type, normalized, stride, offset);
      gl.vertexAttribDivisor(location, divisor ?? 0);
    }
    gl.bindVertexArray(null);
  }

  fill(data, usage = this.gl.DYNAMIC_DRAW) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, data, usage);
  }

  bind() {
    this.gl.bindVertexArray(this.array);
  }

  remove() {
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteVertexArray(this.array);
  }
}

/** Numbers for texelFetch() of a shader, four a texel, from left to right and row by row. */
export class FloatTexture {
  constructor(gl, width) {
    this.gl = gl;
    this.width = width;
    this.rows = 0;
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
  }

  /** Binds it, too. The storage of the numbers is at least as long as the rows that they fill. */
  fill(floats) {
    const gl = this.gl;
    const perRow = 4 * this.width;
    const rows = Math.ceil((floats.count * floats.perInstance) / perRow);
    floats.reserve(rows * perRow);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (rows > this.rows) {
      this.rows = 2 ** Math.ceil(Math.log2(rows));
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, this.width, this.rows, 0, gl.RGBA, gl.FLOAT, null);
    }
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, this.width, rows, gl.RGBA, gl.FLOAT, floats.data.subarray(0, rows * perRow));
  }
}

/** Numbers that are added one instance after another. */
export class Floats {
  constructor(perInstance) {
    this.perInstance = perInstance;
    this.data = new Float32Array(1024 * perInstance);
    this.count = 0;
  }

  clear() {
    this.count = 0;
  }

  reserve(length) {
    if (length <= this.data.length) return;
    const larger = new Float32Array(Math.max(length, this.data.length * 2));
    larger.set(this.data);
    this.data = larger;
  }

  /** As many numbers as an instance has. Thousands a picture: no list is made of them. */
  add() {
    this.reserve((this.count + 1) * this.perInstance);
    const { data } = this;
    const begin = this.count++ * this.perInstance;
    for (let i = 0; i < arguments.length; ++i) data[begin + i] = arguments[i];
  }

  view() {
    return this.data.subarray(0, this.count * this.perInstance);
  }
}
