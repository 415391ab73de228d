// WebGL 2: programs, and instanced drawing from a buffer that grows.

function compile(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp int;\n${source}`);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

/** A program with its uniforms: use({name: number, or list of 2, 3, 4 or 16 numbers}). */
export class Program {
  constructor(gl, vertex, fragment) {
    this.gl = gl;
    this.program = gl.createProgram();
    gl.attachShader(this.program, compile(gl, gl.VERTEX_SHADER, vertex));
    gl.attachShader(this.program, compile(gl, gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    this.uniforms = new Map();
    const count = gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const { name } = gl.getActiveUniform(this.program, i);
      this.uniforms.set(name, gl.getUniformLocation(this.program, name));
    }
  }

  use(values) {
    const gl = this.gl;
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

  add(...numbers) {
    if ((this.count + 1) * this.perInstance > this.data.length) {
      const larger = new Float32Array(this.data.length * 2);
      larger.set(this.data);
      this.data = larger;
    }
    this.data.set(numbers, this.count++ * this.perInstance);
  }

  view() {
    return this.data.subarray(0, this.count * this.perInstance);
  }
}
