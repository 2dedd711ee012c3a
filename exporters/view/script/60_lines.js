// SPDX-License-Identifier: Apache-2.0
// Lines of a width in pixels: one instance per segment.
const lineProgram = makeProgram(`
in vec2 end;              // 0 or 1 along, -1 or 1 across
in vec3 a;
in vec3 b;
in vec4 colour;
in float time;
uniform vec4 how;         // width in pixels, drape on terrain, lift in metres, opacity after \`now\`
uniform float now;
uniform vec2 canvasSize;
out vec4 paint;
vec4 placed(vec3 p) { return seen * vec4(p.xy, raised(how.y > 0.5 ? ground(p.xy) : p.z) + how.z, 1.0); }
void main() {
  vec4 p = placed(a), q = placed(b);
  float least = 1e-3;
  if (p.w < least && q.w < least) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (p.w < least) p = mix(p, q, (least - p.w) / (q.w - p.w));
  if (q.w < least) q = mix(q, p, (least - q.w) / (p.w - q.w));
  vec2 along = (q.xy / q.w - p.xy / p.w) * canvasSize;
  vec2 across = length(along) < 1e-6 ? vec2(0.0) : normalize(vec2(-along.y, along.x));
  vec4 at = end.x < 0.5 ? p : q;
  at.xy += end.y * across * how.x / canvasSize * at.w;
  at.z -= 2e-4 * at.w;
  gl_Position = at;
  paint = vec4(colour.rgb, colour.a * (time > now ? how.w : 1.0));
}`, `
in vec4 paint;
out vec4 drawn;
void main() { drawn = paint; }`);

const lineEnds = makeBuffer(new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]));
const SEGMENT = 11;  // floats: a, b, colour, time

// A set of segments that can be replaced.
class Lines {
  constructor() {
    this.data = [];
    this.buffer = gl.createBuffer();
    this.vertices = gl.createVertexArray();
    this.count = 0;
    gl.bindVertexArray(this.vertices);
    const at = lineProgram.attributes;
    useFloats(at.end, lineEnds, 2, 2, 0);
    useFloats(at.a, this.buffer, 3, SEGMENT, 0, 1);
    useFloats(at.b, this.buffer, 3, SEGMENT, 3, 1);
    useFloats(at.colour, this.buffer, 4, SEGMENT, 6, 1);
    useFloats(at.time, this.buffer, 1, SEGMENT, 10, 1);
    gl.bindVertexArray(null);
  }
  add(a, b, rgba, time = -Infinity) {
    this.data.push(...a, ...b, ...rgba, time === -Infinity ? -1e30 : time);
  }
  // Adds a chain of points; closed: back to the first one.
  chain(points, rgba, {closed = false, time} = {}) {
    for (let i = 0; i + 1 < points.length; ++i) this.add(points[i], points[i + 1], rgba, time);
    if (closed && points.length > 2) this.add(points[points.length - 1], points[0], rgba, time);
  }
  finish() {
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(this.data), gl.DYNAMIC_DRAW);
    this.count = this.data.length / SEGMENT;
    this.data = [];
    return this;
  }
  draw(view, {width = 2, drape = false, lift = 0, now = 1e30, later = 1} = {}) {
    if (this.count === 0) return;
    useProgram(lineProgram, view);
    const u = lineProgram.uniforms;
    gl.uniform4f(u.how, width * view.ratio, drape && terrain.known ? 1 : 0, lift, later);
    gl.uniform1f(u.now, now);
    gl.uniform2f(u.canvasSize, canvas.width, canvas.height);
    gl.enable(gl.BLEND);
    gl.bindVertexArray(this.vertices);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    gl.disable(gl.BLEND);
  }
}
gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
