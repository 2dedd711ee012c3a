// SPDX-License-Identifier: Apache-2.0
// The terrain with its picture, and images draped on it by projection.
const terrainProgram = makeProgram(`
in vec2 node;
out vec2 place;
out vec3 point;
void main() {
  vec2 p = vec2(area.x + node.x * area.z, area.y - node.y * area.z);
  float z = texelFetch(heights, ivec2(node), 0).r;
  place = node / vec2(textureSize(heights, 0) - 1);
  point = vec3(p, z);
  gl_Position = seen * vec4(p, raised(z), 1.0);
}`, `
in vec2 place;
in vec3 point;
uniform sampler2D picture;
uniform vec4 plain;      // colour without a picture; alpha 1: use it
uniform float grid;      // spacing of lines, 0: none
out vec4 colour;
void main() {
  colour = vec4(mix(texture(picture, place).rgb, plain.rgb, plain.a), 1.0);
  if (grid > 0.0) {
    vec2 f = abs(fract(point.xy / grid - 0.5) - 0.5) * grid / fwidth(point.xy);
    colour.rgb = mix(colour.rgb, vec3(0.5), 0.35 * (1.0 - min(min(f.x, f.y), 1.0)));
  }
}`);

const drapeProgram = makeProgram(`
in vec2 node;
out vec3 point;
void main() {
  vec2 p = vec2(area.x + node.x * area.z, area.y - node.y * area.z);
  float z = texelFetch(heights, ivec2(node), 0).r;
  point = vec3(p, z);
  gl_Position = seen * vec4(p, raised(z), 1.0);
}`, `
in vec3 point;
uniform sampler2D picture;
uniform mat3 turn;        // camera from frame
uniform vec3 centre;
uniform vec4 lens;        // fx, fy, cx, cy
uniform vec4 more;        // skew, columns, rows, squared largest radius
uniform float k[8];
uniform bool fisheye;
uniform float opacity;
out vec4 colour;
void main() {
  vec3 c = turn * (point - centre);
  if (c.z <= 0.0) discard;
  vec2 x = c.xy / c.z;
  float r2 = dot(x, x);
  if (r2 > more.w) discard;
  if (fisheye) {
    float r = sqrt(r2), a = atan(r), a2 = a * a;
    float d = a * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
    if (r > 1e-9) x *= d / r;
  } else {
    float radial = (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    x = x * radial + vec2(2.0 * k[2] * x.x * x.y + k[3] * (r2 + 2.0 * x.x * x.x),
                          k[2] * (r2 + 2.0 * x.y * x.y) + 2.0 * k[3] * x.x * x.y);
  }
  vec2 uv = (vec2(lens.x * x.x + more.x * x.y + lens.z, lens.y * x.y + lens.w) + 0.5) / more.yz;
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) discard;
  colour = vec4(texture(picture, uv).rgb, opacity);
}`);

// Mesh of all squares whose corners are known, by rows from the north, so that drapes draw only some rows.
const mesh = (() => {
  const {columns, rows, heights} = terrain;
  const nodes = new Float32Array(2 * columns * rows), triangles = [], firstOfRow = [];
  for (let r = 0; r < rows; ++r)
    for (let c = 0; c < columns; ++c) nodes.set([c, r], 2 * (r * columns + c));
  for (let r = 0; r + 1 < rows; ++r) {
    firstOfRow.push(triangles.length);
    for (let c = 0; c + 1 < columns; ++c) {
      const a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (Number.isNaN(heights[a] + heights[b] + heights[d] + heights[e])) continue;
      triangles.push(a, d, b, b, d, e);
    }
  }
  firstOfRow.push(triangles.length);
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  const buffer = makeBuffer(nodes);
  for (const p of [terrainProgram, drapeProgram]) useFloats(p.attributes.node, buffer, 2, 2, 0);
  makeBuffer(new Uint32Array(triangles), gl.ELEMENT_ARRAY_BUFFER);
  gl.bindVertexArray(null);
  return {vertices, firstOfRow, count: triangles.length};
})();

const groundPicture = loadTexture(terrain.picture, () => redraw());

function drawTerrain(view) {
  useProgram(terrainProgram, view);
  const u = terrainProgram.uniforms;
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, groundPicture.texture);
  gl.uniform1i(u.picture, 1);
  gl.uniform4f(u.plain, ...view.ground, groundPicture.texture && options.picture ? 0 : 1);
  gl.uniform1f(u.grid, terrain.known ? 0 : roundLength(scene.radius / 4));
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1, 2);
  gl.bindVertexArray(mesh.vertices);
  gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
  gl.disable(gl.POLYGON_OFFSET_FILL);
}

// Returns where a ray meets the terrain, or a point `longest` along it.
function meetGround(from, direction, longest) {
  let t = direction[2] < -0.02 ? (from[2] - groundAt(from[0], from[1])) / -direction[2] : longest;
  for (let i = 0; i < 12 && direction[2] < -0.02; ++i) {
    t = Math.min(t, longest);
    const h = groundAt(from[0] + t * direction[0], from[1] + t * direction[1]);
    t = Math.max(0, (from[2] - h) / -direction[2]);
  }
  t = Math.min(t, longest);
  return [0, 1, 2].map(i => from[i] + t * direction[i]);
}

for (const image of scene.images) {
  image.texture = loadTexture(image.picture, () => redraw());
  image.edge = [];
  for (let i = 0; i + 2 < image.border.length; i += 3)
    image.edge.push(meetGround(image.centre, image.border.slice(i, i + 3), 2.5 * scene.radius));
  const rows = image.edge.map(p => (terrain.south + terrain.length - p[1]) / terrain.step);
  const clamped = row => Math.min(Math.max(Math.floor(row), 0), terrain.rows - 1);
  image.meshRows = image.edge.length ? [clamped(Math.min(...rows) - 1), clamped(Math.max(...rows) + 2)] : [0, 0];
}

// Drapes images in the given order, later ones on top.
function drapeImages(view, images) {
  useProgram(drapeProgram, view);
  const u = drapeProgram.uniforms;
  gl.bindVertexArray(mesh.vertices);
  gl.enable(gl.BLEND);
  gl.depthFunc(gl.LEQUAL);
  gl.depthMask(false);
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(0, 0);
  for (const image of images) {
    if (!image.texture.texture) continue;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, image.texture.texture);
    gl.uniform1i(u.picture, 1);
    gl.uniformMatrix3fv(u.turn, false, image.rotation);  // rows of frame-from-camera: columns of its inverse
    gl.uniform3f(u.centre, ...image.centre);
    gl.uniform4f(u.lens, ...image.lens.slice(0, 4));
    gl.uniform4f(u.more, image.lens[4], image.columns, image.rows, image.max_radius * image.max_radius * 1.02);
    gl.uniform1fv(u.k, image.distortion);
    gl.uniform1i(u.fisheye, image.fisheye ? 1 : 0);
    gl.uniform1f(u.opacity, 1);
    const first = mesh.firstOfRow[image.meshRows[0]], last = mesh.firstOfRow[Math.min(image.meshRows[1], terrain.rows - 1)];
    if (last > first) gl.drawElements(gl.TRIANGLES, last - first, gl.UNSIGNED_INT, 4 * first);
  }
  gl.disable(gl.POLYGON_OFFSET_FILL);
  gl.depthMask(true);
  gl.depthFunc(gl.LESS);
  gl.disable(gl.BLEND);
}
