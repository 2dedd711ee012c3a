// SPDX-License-Identifier: Apache-2.0
// Landmarks that have a direction and are drawn as boxes: walls, corners, plates, doors, buildings, marks.

// Heights in metres where a landmark has none, and sizes that no type states.
const NOMINAL = {panel: 2.5, corner: 2.5, end: 2.5, plate: 2.2, portal: 2.1, block: 3, strip: 0};
const THICK = 0.12, WING = 0.6, POST = 0.04, FACE = 0.3, JAMB = 0.08, PAINT = 0.03, DRAPE = 4;
const GREY = [0.75, 0.75, 0.75];

// Each returns boxes [u0, u1, v0, v1, z0, z1, turn, tint] in metres about the landmark: u along `turn`, v to its
// left, z above the ground.
const FORMS = {
  // The position lies on the face whose normal is `turn`.
  panel: (f, top) => [[-THICK, 0, -f.length / 2, f.length / 2, -0.3, top, f.turn]],
  // Two pieces of the walls that meet, `opening` apart about the bisector.
  corner: (f, top) => [-1, 1].map(s => [0, WING, s > 0 ? 0 : -THICK, s > 0 ? THICK : 0, -0.3, top, f.turn + s * f.opening / 2]),
  // The wall lies left of its end for who looks at the face: on the right of the normal.
  end: (f, top) => [[-THICK, 0, f.side > 0 ? -WING : -WING * (f.side < 0 ? 0 : 0.5), f.side < 0 ? WING : WING * (f.side > 0 ? 0 : 0.5), -0.3, top, f.turn]],
  plate: (f, top) => [[-POST, POST, -POST, POST, -0.2, top + FACE, f.turn, GREY], [POST, POST + 0.04, -FACE, FACE, top - FACE, top + FACE, f.turn]],
  portal: (f, top) => [...[-1, 1].map(s => [Math.min(s, 0) * JAMB + s * f.width / 2, Math.max(s, 0) * JAMB + s * f.width / 2, -THICK, THICK, -0.1, top, f.turn]),
                       [-f.width / 2, f.width / 2, -THICK, THICK, top - JAMB, top, f.turn]],
  // A square of the outline's area.
  block: (f, top) => { const s = f.radius * Math.sqrt(Math.PI) / 2; return [[-s, s, -s, s, -0.5, top, f.turn]]; },
  // Pieces that follow the terrain.
  strip: f => {
    const count = Math.max(1, Math.ceil(f.length / DRAPE)), step = f.length / count;
    return Array.from({length: count}, (_, k) =>
      [k * step - f.length / 2, (k + 1) * step - f.length / 2, -f.width / 2, f.width / 2, 0, PAINT, f.turn]);
  },
};

// Returns the boxes of a landmark. Without its direction or size it is a post.
function formOf(layer, i) {
  const n = layer.numbers, form = layer.forms, at = i * FORM.size;
  const f = {turn: form[at], length: form[at + FORM.length], width: form[at + FORM.width], opening: form[at + FORM.opening],
             side: form[at + FORM.side], radius: n[i * LANDMARK.size + LANDMARK.radius]};
  const top = n[i * LANDMARK.size + LANDMARK.height] || NOMINAL[layer.shape];
  const needed = {panel: f.length, corner: f.opening, portal: f.width, block: f.radius, strip: f.length * f.width}[layer.shape];
  const known = Number.isFinite(f.turn) && (needed === undefined || needed > 0);
  return known ? FORMS[layer.shape](f, top) : [[-0.15, 0.15, -0.15, 0.15, 0, Math.max(top, 0.3), 0]];
}

// Returns the radius of the upright cylinder about a landmark that holds its boxes.
function reachOf(boxes) {
  return Math.max(...boxes.map(([u0, u1, v0, v1]) => Math.hypot(Math.max(-u0, u1), Math.max(-v0, v1))));
}

// Calls corner(position, normal, tint) for the triangles of a box without its underside.
function visitBox([u0, u1, v0, v1, z0, z1, turn, tint = [1, 1, 1]], corner) {
  const c = Math.cos(turn), s = Math.sin(turn);
  const face = (points, n) => [0, 1, 2, 0, 2, 3].forEach(k => {
    const [u, v, z] = points[k];
    corner([c * u - s * v, s * u + c * v, z], [c * n[0] - s * n[1], s * n[0] + c * n[1], n[2]], tint);
  });
  face([[u0, v0, z1], [u1, v0, z1], [u1, v1, z1], [u0, v1, z1]], [0, 0, 1]);
  face([[u1, v0, z0], [u1, v1, z0], [u1, v1, z1], [u1, v0, z1]], [1, 0, 0]);
  face([[u0, v1, z0], [u0, v0, z0], [u0, v0, z1], [u0, v1, z1]], [-1, 0, 0]);
  face([[u1, v1, z0], [u0, v1, z0], [u0, v1, z1], [u1, v1, z1]], [0, 1, 0]);
  face([[u0, v0, z0], [u1, v0, z0], [u1, v0, z1], [u0, v0, z1]], [0, -1, 0]);
}

// Returns the vertices of all landmarks of a layer, 17 floats each: as of a solid and of an instance.
function makeForms(layer) {
  const data = [];
  for (let i = 0; i < layer.count; ++i) {
    const boxes = formOf(layer, i), reach = reachOf(boxes), shared = sharedNumbers(layer, i, reach, reach);
    for (const box of boxes)
      visitBox(box, (at, normal, tint) => data.push(at[0] / reach, at[1] / reach, at[2] / reach, ...normal, ...tint, ...shared, i));
  }
  const vertices = gl.createVertexArray(), buffer = makeBuffer(new Float32Array(data)), a = solidProgram.attributes;
  gl.bindVertexArray(vertices);
  let first = 0;
  for (const [name, size] of [['corner', 3], ['side', 3], ['part', 3], ['at', 3], ['size', 2], ['trust', 2], ['number', 1]]) {
    useFloats(a[name], buffer, size, 17, first);
    first += size;
  }
  gl.bindVertexArray(null);
  return {vertices, buffer, count: layer.count, corners: data.length / 17, instanced: false, pixels: 3, draped: layer.shape === 'strip'};
}

