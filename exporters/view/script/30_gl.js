// SPDX-License-Identifier: Apache-2.0
// WebGL 2: the canvas, programs, and what all vertex shaders share.
const canvas = document.createElement('canvas');
canvas.id = 'picture';
canvas.tabIndex = 0;
canvas.setAttribute('aria-label', 'Map in three dimensions');
document.body.append(canvas);
const gl = canvas.getContext('webgl2', {antialias: true, powerPreference: 'high-performance'});
if (!gl) {
  document.body.replaceChildren(Object.assign(document.createElement('p'), {
    id: 'failure', textContent: 'This page needs WebGL 2, which this browser does not offer.'}));
  throw new Error('no WebGL 2');
}

// Positions are those of the view frame. Heights are stretched about the terrain's lowest one.
const SHARED = `#version 300 es
precision highp float;
precision highp int;
uniform mat4 seen;
uniform vec2 relief;     // level, stretch
uniform vec4 area;       // west, north, step, 0
uniform highp sampler2D heights;
float ground(vec2 p) {
  vec2 g = vec2(p.x - area.x, area.y - p.y) / area.z;
  ivec2 last = textureSize(heights, 0) - 1;
  vec2 q = clamp(floor(g), vec2(0), vec2(last - 1)), f = clamp(g - q, 0.0, 1.0);
  ivec2 i = ivec2(q);
  float a = texelFetch(heights, i, 0).r, b = texelFetch(heights, i + ivec2(1, 0), 0).r;
  float c = texelFetch(heights, i + ivec2(0, 1), 0).r, d = texelFetch(heights, i + ivec2(1, 1), 0).r;
  return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}
float raised(float z) { return (z - relief.x) * relief.y; }
`;

function compiled(kind, source) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

// Returns a program with its uniforms and attributes by name.
function makeProgram(vertex, fragment) {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl.VERTEX_SHADER, SHARED + vertex));
  gl.attachShader(program, compiled(gl.FRAGMENT_SHADER, '#version 300 es\nprecision highp float;\nprecision highp int;\n' + fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniforms = {}, attributes = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
    const name = gl.getActiveUniform(program, i).name;
    uniforms[name.replace('[0]', '')] = gl.getUniformLocation(program, name);
  }
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); ++i) {
    const name = gl.getActiveAttrib(program, i).name;
    attributes[name] = gl.getAttribLocation(program, name);
  }
  return {program, uniforms, attributes};
}

function makeBuffer(data, target = gl.ARRAY_BUFFER, usage = gl.STATIC_DRAW) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(target, buffer);
  gl.bufferData(target, data, usage);
  return buffer;
}

// Points an attribute at floats of a buffer; `divisor` 1: one value per instance.
function useFloats(location, buffer, size, stride, offset, divisor = 0) {
  if (location === undefined) return;
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * stride, 4 * offset);
  gl.vertexAttribDivisor(location, divisor);
}

// Loads a data URI as a texture; `done` is called when it can be drawn.
function loadTexture(uri, done) {
  const holder = {texture: null};
  if (!uri) return holder;
  const image = new Image();
  image.onload = () => {
    holder.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, holder.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    const sharper = gl.getExtension('EXT_texture_filter_anisotropic');
    if (sharper) gl.texParameterf(gl.TEXTURE_2D, sharper.TEXTURE_MAX_ANISOTROPY_EXT, 8);
    --loading;
    done();
  };
  image.onerror = () => { --loading; };
  ++loading;
  image.src = uri;
  return holder;
}
let loading = 0;

const heightTexture = gl.createTexture();
gl.bindTexture(gl.TEXTURE_2D, heightTexture);
gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, terrain.columns, terrain.rows, 0, gl.RED, gl.FLOAT, terrain.filled);
for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
  gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);

// Sets the program and the uniforms of SHARED.
function useProgram(p, view) {
  gl.useProgram(p.program);
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, heightTexture);
  gl.uniform1i(p.uniforms.heights, 0);
  gl.uniformMatrix4fv(p.uniforms.seen, false, view.seen);
  gl.uniform2f(p.uniforms.relief, terrain.lowest, view.stretch);
  gl.uniform4f(p.uniforms.area, terrain.west, terrain.south + terrain.length, terrain.step, 0);
}
