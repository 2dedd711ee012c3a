// SPDX-License-Identifier: Apache-2.0
'use strict';
// The scene of the page, with its arrays decoded. All texts are shown as text, never as markup.

function bytesOf(text) {
  return Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
}
const floatsOf = text => new Float32Array(bytesOf(text));

const scene = JSON.parse(document.getElementById('scene').textContent);

// Fields of `numbers` per landmark and of a track per pose, as view_page.cpp writes them.
const LANDMARK = {x: 0, y: 1, z: 2, radius: 3, height: 4, confidence: 5, quality: 6, sd: 7, size: 10};
// Fields of `forms` per landmark of an oriented shape.
const FORM = {turn: 0, length: 1, width: 2, opening: 3, side: 4, size: 5};
const POSE = {t: 0, x: 1, y: 2, yaw: 3, varX: 4, varY: 5, covXY: 6, lost: 7, size: 8};

for (const layer of scene.layers) {
  layer.numbers = floatsOf(layer.numbers);
  layer.forms = floatsOf(layer.forms);
  layer.values = floatsOf(layer.values);
  layer.counts = new Int32Array(bytesOf(layer.counts));
  layer.evidence = floatsOf(layer.evidence);
  layer.count = layer.uids.length;
  layer.shown = true;
  layer.rgb = [1, 3, 5].map(i => parseInt(layer.colour.slice(i, i + 2), 16) / 255);
  let first = 0;
  layer.firstEvidence = layer.uids.map((_, i) => {
    const at = first;
    first += layer.counts[4 * i + 3];
    return at;
  });
}
for (const track of scene.tracks) {
  track.numbers = floatsOf(track.numbers);
  track.count = track.numbers.length / POSE.size;
  track.shown = true;
}
scene.scans = (() => {
  const heads = floatsOf(scene.scans.heads), rays = floatsOf(scene.scans.rays), scans = [];
  for (let i = 0, ray = 0; i < heads.length; i += 5) {
    const count = heads[i + 4];
    scans.push({t: heads[i], laser: heads[i + 1] === 1, mount: [heads[i + 2], heads[i + 3]],
                rays: rays.subarray(2 * ray, 2 * (ray + count))});
    ray += count;
  }
  return scans;
})();

// Terrain: heights in metres of the view frame, row 0 in the north; NaN where unknown.
const terrain = (() => {
  const given = scene.terrain;
  if (!given) {
    const side = 2.4 * scene.radius;
    return {columns: 2, rows: 2, west: -side / 2, south: -side / 2, step: side, known: false, picture: '',
            caption: '', heights: new Float32Array(4), lowest: 0, highest: 0};
  }
  const steps = new Uint16Array(bytesOf(given.heights));
  const heights = Float32Array.from(steps, s => s === 65535 ? NaN : given.lowest + s * given.height_step);
  return {...given, heights, known: true, highest: given.lowest + 65534 * given.height_step};
})();
terrain.width = (terrain.columns - 1) * terrain.step;
terrain.length = (terrain.rows - 1) * terrain.step;
// Heights without gaps, for everything that stands on the terrain.
terrain.filled = (() => {
  const middle = (terrain.lowest + terrain.highest) / 2;
  return terrain.heights.map(h => Number.isNaN(h) ? middle : h);
})();

function groundAt(x, y) {
  const column = Math.min(Math.max((x - terrain.west) / terrain.step, 0), terrain.columns - 1);
  const row = Math.min(Math.max((terrain.south + terrain.length - y) / terrain.step, 0), terrain.rows - 1);
  const c = Math.min(Math.floor(column), terrain.columns - 2), r = Math.min(Math.floor(row), terrain.rows - 2);
  const u = column - c, v = row - r, n = terrain.columns, h = terrain.filled;
  return (1 - v) * ((1 - u) * h[r * n + c] + u * h[r * n + c + 1]) +
         v * ((1 - u) * h[(r + 1) * n + c] + u * h[(r + 1) * n + c + 1]);
}
