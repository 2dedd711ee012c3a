// SPDX-License-Identifier: Apache-2.0
// Landmarks as instances of the solids of their types, and which one lies under the pointer.
const solidProgram = makeProgram(`
in vec3 corner;           // of the unit solid: radius 1, height 0 to 1
in vec3 side;             // its normal
in vec3 part;             // factors of the colour
in vec3 at;
in vec2 size;             // radius, height, metres
in vec2 trust;            // confidence, quality (< 0: not assessed)
in float number;          // of the landmark in its layer
uniform vec4 pixel;       // width of a pixel at distance 1, smallest radius in pixels, ground, bowl
uniform vec2 least;       // smallest confidence and quality drawn
uniform vec2 heading;     // cosine and sine of a turn
uniform int chosen;
flat out int instance;
flat out float sure;
out vec3 shade;
void main() {
  instance = int(number + 0.5);
  sure = trust.x;
  if (trust.x < least.x || (least.y > 0.0 && trust.y < least.y)) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  float z = pixel.z > 0.5 ? ground(at.xy) : at.z;
  float depth = (seen * vec4(at.xy, raised(z), 1.0)).w;
  float enlarged = max(1.0, pixel.y * max(depth, 0.0) * pixel.x / max(size.x, 1e-6));
  vec2 turned = vec2(heading.x * corner.x - heading.y * corner.y, heading.y * corner.x + heading.x * corner.y);
  vec2 p = at.xy + turned * size.x * enlarged;
  float top = corner.z * size.y * enlarged;
  float foot = pixel.w > 0.5 && pixel.z > 0.5 ? ground(p) : z;
  gl_Position = seen * vec4(p, raised(foot) + top, 1.0);
  vec3 n = normalize(vec3(heading.x * side.x - heading.y * side.y, heading.y * side.x + heading.x * side.y, side.z));
  float light = 0.62 + 0.38 * dot(n, normalize(vec3(-0.55, 0.55, 0.65)));
  shade = part * light * (instance == chosen ? 1.25 : 1.0);
}`, `
flat in int instance;
flat in float sure;
in vec3 shade;
uniform vec3 colour;
uniform int chosen;
uniform int layer;        // > 0: draw the number instead of the colour
out vec4 drawn;
void main() {
  if (layer > 0) {
    drawn = vec4(ivec4(instance & 255, (instance >> 8) & 255, (instance >> 16) & 255, layer)) / 255.0;
    return;
  }
  vec3 base = instance == chosen ? vec3(1.0, 0.82, 0.1) : mix(vec3(0.62), colour, 0.35 + 0.65 * sure);
  drawn = vec4(base * shade, 1.0);
}`);

// Corners, normals and colour factors of a solid of revolution given by its profile [radius, height, factor].
function revolve(profile, sides) {
  const data = [];
  for (let i = 0; i + 1 < profile.length; ++i) {
    const [r0, z0, tint] = profile[i], [r1, z1] = profile[i + 1];
    if (profile[i].end) continue;
    const slope = [z1 - z0, r0 - r1], length = Math.hypot(...slope) || 1;
    for (let s = 0; s < sides; ++s) {
      const angles = [s, s + 1].map(k => 2 * Math.PI * k / sides);
      const corner = (r, z, a) => [r * Math.cos(a), r * Math.sin(a), z,
                                   slope[0] / length * Math.cos(a), slope[0] / length * Math.sin(a), slope[1] / length,
                                   ...tint];
      const [a, b] = angles;
      if (r0 > 0) data.push(...corner(r0, z0, a), ...corner(r0, z0, b), ...corner(r1, z1, b));
      if (r1 > 0) data.push(...corner(r0, z0, a), ...corner(r1, z1, b), ...corner(r1, z1, a));
    }
  }
  return new Float32Array(data);
}

const PLAIN = [1, 1, 1], BARK = [1.25, 0.75, 0.55], RIM = [0.85, 0.85, 0.85];
const ended = point => Object.assign(point, {end: true});
const arc = count => Array.from({length: count + 1}, (_, i) => {
  const a = Math.PI * (i / count - 0.5);
  return [Math.cos(a), 0.5 + 0.5 * Math.sin(a), PLAIN];
});
const SOLIDS = {
  point: {data: revolve(arc(6), 10), pixels: 4},
  sphere: {data: revolve(arc(8), 14), pixels: 2.5},
  cylinder: {data: revolve([[1, 0, PLAIN], [1, 1, PLAIN], [0, 1, PLAIN]], 8), pixels: 2.5},
  cone: {data: revolve([[1, 0, PLAIN], [0, 1, PLAIN]], 14), pixels: 6},
  canopy: {data: revolve([[0.1, 0, BARK], ended([0.1, 0.35, BARK]), [0.55, 0.22, PLAIN], [1, 0.36, PLAIN],
                        [0.82, 0.58, PLAIN], [0.45, 0.84, PLAIN], [0, 1, PLAIN]], 7), pixels: 2.5},
  // A rim that stands a little above the terrain it is draped on.
  bowl: {data: revolve([[0.94, 0.2, RIM], [1, 1, PLAIN], [1.06, 0.2, RIM]], 40), pixels: 3},
  // A pointer that shows where a robot heads.
  robot: {data: (() => {
    const top = [[-1, -0.7], [1.6, 0], [-1, 0.7], [-0.5, 0]], data = [];
    const add = (points, n) => points.forEach(p => data.push(...p, ...n, 1, 1, 1));
    for (const [a, b, c] of [[0, 1, 3], [1, 2, 3]])
      add([a, b, c].map(i => [...top[i], 1]), [0, 0, 1]);
    for (let i = 0; i < 4; ++i) {
      const a = top[i], b = top[(i + 1) % 4], n = unit([b[1] - a[1], a[0] - b[0], 0]);
      add([[...a, 0], [...b, 0], [...b, 1]], n);
      add([[...a, 0], [...b, 1], [...a, 1]], n);
    }
    return new Float32Array(data);
  })(), pixels: 9},
};

// Returns vertices of a solid with instances of 8 floats: position, radius, height, confidence, quality, number.
function makeInstances(solid, instances) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  const a = solidProgram.attributes, shape = makeBuffer(SOLIDS[solid].data);
  useFloats(a.corner, shape, 3, 9, 0);
  useFloats(a.side, shape, 3, 9, 3);
  useFloats(a.part, shape, 3, 9, 6);
  const buffer = makeBuffer(instances, gl.ARRAY_BUFFER, gl.DYNAMIC_DRAW);
  useFloats(a.at, buffer, 3, 8, 0, 1);
  useFloats(a.size, buffer, 2, 8, 3, 1);
  useFloats(a.trust, buffer, 2, 8, 5, 1);
  useFloats(a.number, buffer, 1, 8, 7, 1);
  gl.bindVertexArray(null);
  return {vertices, buffer, count: instances.length / 8, corners: SOLIDS[solid].data.length / 9, instanced: true,
          pixels: SOLIDS[solid].pixels, draped: solid === 'bowl'};
}

// Returns radius and height at which a landmark is drawn; 0: by the smallest size in pixels.
function drawnSize(layer, i) {
  const n = layer.numbers, at = i * LANDMARK.size;
  const radius = n[at + LANDMARK.radius], height = n[at + LANDMARK.height];
  if (layer.shape in FORMS) return [reachOf(formOf(layer, i)), layer.shape === 'strip' ? 0.06 : height || NOMINAL[layer.shape]];
  switch (layer.shape) {
    case 'bowl': return [radius, 0.05 * radius];
    case 'sphere': return [radius, 2 * radius];
    case 'canopy': return [radius || 0.15 * height, height || 4 * radius];
    case 'cone': return [radius || 1e-3, height || 2 * radius || 2.2e-3];
    case 'point': return [radius || 1e-3, 2 * (radius || 1e-3)];
    default: return [radius || 0.1 * height, height || radius];
  }
}

// Returns the 7 floats of a landmark that all its corners share: foot, radius, height, confidence, quality.
function sharedNumbers(layer, i, radius, height) {
  const n = layer.numbers.subarray(i * LANDMARK.size, (i + 1) * LANDMARK.size), quality = n[LANDMARK.quality];
  // The foot is computed once here: a texture access per corner costs more than all else.
  return [n[0], n[1], terrain.known ? groundAt(n[0], n[1]) : n[2], radius, height, n[LANDMARK.confidence],
          Number.isNaN(quality) ? -1 : quality];
}

for (const layer of scene.layers) {
  if (layer.shape in FORMS) {
    layer.instances = makeForms(layer);
    continue;
  }
  const instances = new Float32Array(8 * layer.count);
  for (let i = 0; i < layer.count; ++i)
    instances.set([...sharedNumbers(layer, i, ...drawnSize(layer, i)), i], 8 * i);
  layer.instances = makeInstances(layer.shape in SOLIDS ? layer.shape : 'point', instances);
}

// Draws instances; `number` > 0 draws their numbers for picking.
function drawInstances(view, instances, rgb, {number = 0, chosen = -1, heading = 0, onGround = terrain.known} = {}) {
  const u = solidProgram.uniforms;
  // Crowds are drawn smaller, so that they do not hide the terrain.
  const room = 0.11 * Math.sqrt(canvas.clientWidth * canvas.clientHeight / Math.max(instances.count, 1));
  const pixels = Math.min(instances.pixels, Math.max(room, 0.7));
  gl.uniform4f(u.pixel, view.pixel, pixels, onGround ? 1 : 0, instances.draped ? 1 : 0);
  gl.uniform2f(u.heading, Math.cos(heading), Math.sin(heading));
  gl.uniform3f(u.colour, ...rgb);
  gl.uniform1i(u.chosen, chosen);
  gl.uniform1i(u.layer, number);
  gl.bindVertexArray(instances.vertices);
  if (instances.instanced) gl.drawArraysInstanced(gl.TRIANGLES, 0, instances.corners, instances.count);
  else gl.drawArrays(gl.TRIANGLES, 0, instances.corners);
}

function drawLandmarks(view, picking = false) {
  useProgram(solidProgram, view);
  gl.uniform2f(solidProgram.uniforms.least, options.confidence, options.quality);
  scene.layers.forEach((layer, k) => {
    if (!layer.shown || layer.count === 0) return;
    const chosen = selected && selected.layer === layer ? selected.index : -1;
    drawInstances(view, layer.instances, layer.rgb,
                  {number: picking ? k + 1 : 0, chosen, onGround: terrain.known && layer.instances.draped});
  });
}

const picker = {frame: gl.createFramebuffer(), colour: gl.createTexture(), depth: gl.createRenderbuffer(), size: ''};

// Returns the landmark nearest to a pixel of the canvas, within 4 pixels, or null.
function landmarkAt(view, x, y) {
  const width = canvas.width, height = canvas.height;
  gl.bindFramebuffer(gl.FRAMEBUFFER, picker.frame);
  if (picker.size !== width + 'x' + height) {
    picker.size = width + 'x' + height;
    gl.bindTexture(gl.TEXTURE_2D, picker.colour);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.bindRenderbuffer(gl.RENDERBUFFER, picker.depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, picker.colour, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, picker.depth);
  }
  const reach = 4, left = Math.round(x) - reach, low = Math.round(height - y) - reach, side = 2 * reach + 1;
  gl.enable(gl.SCISSOR_TEST);
  gl.scissor(left, low, side, side);
  gl.viewport(0, 0, width, height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.colorMask(false, false, false, false);
  drawTerrain(view);
  gl.colorMask(true, true, true, true);
  drawLandmarks(view, true);
  const pixels = new Uint8Array(4 * side * side);
  gl.readPixels(left, low, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  gl.disable(gl.SCISSOR_TEST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  let best = null, nearest = Infinity;
  for (let i = 0; i < side * side; ++i) {
    const distance = Math.hypot(i % side - reach, Math.floor(i / side) - reach);
    if (pixels[4 * i + 3] === 0 || distance >= nearest) continue;
    nearest = distance;
    best = {layer: scene.layers[pixels[4 * i + 3] - 1],
            index: pixels[4 * i] + 256 * pixels[4 * i + 1] + 65536 * pixels[4 * i + 2]};
  }
  return best;
}
