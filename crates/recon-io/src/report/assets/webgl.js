// Draws into one hidden WebGL 2 canvas, from which each view copies its picture: browsers limit the number of contexts.
const MESH_VERTEX = `#version 300 es
in vec3 position; in vec3 normal;
uniform mat4 camera, model;
out vec3 at, facing;
void main() { vec4 p = model * vec4(position, 1.0); at = p.xyz; facing = mat3(model) * normal; gl_Position = camera * p; }`;

const MESH_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, facing;
uniform vec3 eye, colour, light; uniform float alpha, glass;
out vec4 result;
void main() {
  vec3 n = normalize(facing), v = normalize(eye - at);
  if (dot(n, v) < 0.0) n = -n;
  float key = 0.5 + 0.5 * dot(n, light);
  vec3 shaded = colour * (0.5 + 0.56 * key * key) + vec3(0.08) * pow(max(dot(reflect(-light, n), v), 0.0), 24.0);
  float edge = pow(1.0 - abs(dot(n, v)), 2.0);
  float a = alpha * mix(1.0, 0.45 + 1.6 * edge, glass);
  result = vec4(mix(shaded, colour, 0.6 * glass) * a, a);
}`;

const LINE_VERTEX = `#version 300 es
in vec3 a, b; in vec2 corner;
uniform mat4 camera, model; uniform vec2 view; uniform float width, lift, cap;
out float across;
void main() {
  vec4 p = camera * model * vec4(a, 1.0), q = camera * model * vec4(b, 1.0);
  vec2 along = (q.xy / q.w - p.xy / p.w) * view;
  float l = length(along);
  vec2 dir = l > 1e-6 ? along / l : vec2(1.0, 0.0);
  float half_width = 0.5 * width + 0.75;
  vec2 shift = (vec2(-dir.y, dir.x) * corner.y + dir * (corner.x * 2.0 - 1.0) * cap) * half_width * 2.0 / view;
  vec4 c = corner.x < 0.5 ? p : q;
  across = corner.y * half_width;
  gl_Position = vec4(c.xy + shift * c.w, c.z - lift * c.w, c.w);
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
in float across;
uniform vec3 colour; uniform float alpha, width;
out vec4 result;
void main() {
  float a = alpha * clamp(0.5 * width + 0.5 - abs(across), 0.0, 1.0);
  if (a < 0.004) discard;
  result = vec4(colour * a, a);
}`;

const DOT_VERTEX = `#version 300 es
in vec2 corner;
uniform mat4 camera, model; uniform vec3 centre; uniform vec2 view; uniform float radius, lift;
out vec2 at;
void main() {
  vec4 c = camera * model * vec4(centre, 1.0);
  at = vec2(corner.x * 2.0 - 1.0, corner.y) * (radius + 1.0);
  gl_Position = vec4(c.xy + at * 2.0 / view * c.w, c.z - lift * c.w, c.w);
}`;

const DOT_FRAGMENT = `#version 300 es
precision highp float;
in vec2 at;
uniform vec3 colour, ring; uniform float radius;
out vec4 result;
void main() {
  float d = length(at), a = clamp(radius + 0.5 - d, 0.0, 1.0);
  if (a < 0.004) discard;
  result = vec4(mix(colour, ring, clamp(d - radius * 0.68 + 0.5, 0.0, 1.0)) * a, a);
}`;

class WebGl {
  // Null where the browser has no WebGL 2.
  static make() {
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { alpha: true, antialias: true, premultipliedAlpha: true });
    if (!gl) return null;
    try { return new WebGl(canvas, gl); } catch (error) { console.warn("recon: " + error.message); return null; }
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.buffers = new WeakMap();
    this.programs = {
      mesh: this.program(MESH_VERTEX, MESH_FRAGMENT),
      line: this.program(LINE_VERTEX, LINE_FRAGMENT),
      dot: this.program(DOT_VERTEX, DOT_FRAGMENT),
    };
    this.strip = new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(program, i);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms };
  }

  begin(width, height, ratio, look) {
    const gl = this.gl;
    // The canvas only grows, so that views of different sizes do not reallocate it in turn.
    if (this.canvas.width < width) this.canvas.width = width;
    if (this.canvas.height < height) this.canvas.height = height;
    Object.assign(this, { width, height, ratio, look });
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  use(name, model, numbers, vectors) {
    const gl = this.gl, { program, uniforms } = this.programs[name];
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.camera, false, this.look.matrix);
    gl.uniformMatrix4fv(uniforms.model, false, model);
    if (uniforms.view) gl.uniform2f(uniforms.view, this.width, this.height);
    for (const key in numbers) gl.uniform1f(uniforms[key], numbers[key]);
    for (const key in vectors) gl.uniform3fv(uniforms[key], vectors[key]);
    return program;
  }

  attribute(program, name, array, size, stride, offset, divisor) {
    const gl = this.gl;
    let buffer = this.buffers.get(array);
    if (!buffer) {
      buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
      this.buffers.set(array, buffer);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    const place = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(place, divisor);
  }

  // `face`: "front", "back" or "both"; a translucent convex body is right when its back is drawn before its front.
  mesh(body, model, { colour, alpha = 1, glass = 0, face = "both" }) {
    const gl = this.gl;
    if (face === "both") gl.disable(gl.CULL_FACE); else gl.enable(gl.CULL_FACE);
    gl.cullFace(face === "back" ? gl.FRONT : gl.BACK);
    gl.depthMask(alpha === 1);
    // Pushed back a little, so that lines on the surface are in front of it.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 2);
    const light = unit(add(add(scale(this.look.back, 0.75), scale(this.look.up, 0.75)), scale(this.look.right, -0.55)));
    const program = this.use("mesh", model, { alpha, glass }, { colour, light, eye: this.look.eye });
    this.attribute(program, "position", body.position, 3, 0, 0, 0);
    this.attribute(program, "normal", body.normal, 3, 0, 0, 0);
    gl.drawArrays(gl.TRIANGLES, 0, body.position.length / 3);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  lines(set, model, { colour, alpha = 1, width = 1.5, lift = 6e-4, count = set.count }) {
    if (count < 1) return;
    const gl = this.gl;
    gl.disable(gl.CULL_FACE);
    gl.depthMask(false);
    const program = this.use("line", model, { alpha, width: width * this.ratio, lift, cap: alpha < 1 ? 0 : 0.5 }, { colour });
    this.attribute(program, "a", set.segments, 3, 24, 0, 1);
    this.attribute(program, "b", set.segments, 3, 24, 12, 1);
    this.attribute(program, "corner", this.strip, 2, 0, 0, 0);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    for (const name of ["a", "b"]) gl.vertexAttribDivisor(gl.getAttribLocation(program, name), 0);
  }

  dot(centre, model, { colour, ring, radius = 5, lift = 3e-3 }) {
    const gl = this.gl;
    gl.disable(gl.CULL_FACE);
    gl.depthMask(false);
    const program = this.use("dot", model, { radius: radius * this.ratio, lift }, { colour, ring, centre });
    this.attribute(program, "corner", this.strip, 2, 0, 0, 0);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  end(context) {
    const from = this.canvas.height - this.height;
    context.drawImage(this.canvas, 0, from, this.width, this.height, 0, 0, this.width, this.height);
  }
}
