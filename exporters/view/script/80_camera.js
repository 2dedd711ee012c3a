// SPDX-License-Identifier: Apache-2.0
// The eye: it turns about a target on the terrain.
const FIELD_OF_VIEW = 40 * Math.PI / 180;
const eye = {x: 0, y: 0, lift: 0, distance: 2.1 * scene.radius, azimuth: 20 * Math.PI / 180, elevation: 38 * Math.PI / 180};
const options = {picture: true, images: true, frusta: true, ellipses: true, rays: true, labels: true, follow: false,
                 enlarge: 1, stretch: 1, confidence: 0, quality: 0};
// Low relief is raised, so that mountains of a wide map can be seen.
const STRETCHES = [1, 1.5, 2, 3, 5];
if (terrain.known) {
  const slope = (terrain.highest - terrain.lowest) / scene.radius;
  options.stretch = slope > 0.12 || slope === 0 ? 1 : slope > 0.05 ? 2 : 3;
}
let selected = null;
const view = {ink: [0.1, 0.12, 0.14], ground: [0.75, 0.76, 0.74], stretch: 1, ratio: 1};

function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find(f => f * power <= most * (1 + 1e-12)) * power;
}

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const parsed = name => [1, 3, 5].map(i => parseInt(style.getPropertyValue(name).trim().slice(i, i + 2), 16) / 255);
  view.ink = parsed('--ink');
  view.sky = parsed('--sky');
  view.ground = parsed('--ground');
}

function resize() {
  view.ratio = Math.min(window.devicePixelRatio || 1, 2);
  const width = Math.max(1, Math.round(canvas.clientWidth * view.ratio));
  const height = Math.max(1, Math.round(canvas.clientHeight * view.ratio));
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
}

// Puts the target on the terrain and computes the matrix from the view frame to the screen.
function aim() {
  resize();
  eye.elevation = Math.min(Math.max(eye.elevation, 0.03), Math.PI / 2 - 1e-3);
  eye.distance = Math.min(Math.max(eye.distance, 2), 12 * scene.radius + 4 * eye.lift);
  view.stretch = options.stretch;
  const level = z => (z - terrain.lowest) * view.stretch;
  const lift = eye.lift * Math.min(1, eye.distance / focus.distance) ** 2;  // towards the cameras, in a wide view
  const target = [eye.x, eye.y, level(groundAt(eye.x, eye.y)) + lift];
  const flat = Math.cos(eye.elevation) * eye.distance;
  view.eye = [target[0] - flat * Math.sin(eye.azimuth), target[1] - flat * Math.cos(eye.azimuth),
              target[2] + Math.sin(eye.elevation) * eye.distance];
  const floor = level(groundAt(view.eye[0], view.eye[1])) + 0.01 * eye.distance + 0.5;  // never below the terrain
  view.eye[2] = Math.max(view.eye[2], floor);
  const far = eye.distance + 6 * scene.radius + 6 * eye.lift;
  view.seen = multiply(perspective(FIELD_OF_VIEW, canvas.width / canvas.height, eye.distance * 0.02, far),
                       lookAt(view.eye, target));
  view.pixel = 2 * Math.tan(FIELD_OF_VIEW / 2) / canvas.height * view.ratio;
  view.target = target;
}

// Returns CSS pixels of a position, or null behind the eye. `above`: metres above the terrain or its own height.
function screenOf(x, y, z = null, above = 0) {
  const height = (((z === null ? groundAt(x, y) : z) - terrain.lowest) * view.stretch) + above;
  const p = transform(view.seen, x, y, height);
  if (p[3] <= 0) return null;
  return {x: (p[0] / p[3] + 1) / 2 * canvas.clientWidth, y: (1 - p[1] / p[3]) / 2 * canvas.clientHeight, w: p[3]};
}

function pan(dx, dy) {
  const metres = view.pixel * eye.distance / view.ratio * view.ratio;
  const c = Math.cos(eye.azimuth), s = Math.sin(eye.azimuth);
  const ahead = dy * metres / Math.max(Math.sin(eye.elevation), 0.25), right = -dx * metres;
  eye.x = Math.min(Math.max(eye.x + c * right + s * ahead, terrain.west), terrain.west + terrain.width);
  eye.y = Math.min(Math.max(eye.y - s * right + c * ahead, terrain.south), terrain.south + terrain.length);
  setFollow(false);
}

const pointers = new Map();
let travelled = 0;
canvas.addEventListener('pointerdown', event => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
  travelled = 0;
});
canvas.addEventListener('pointermove', event => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const dx = event.clientX - before.x, dy = event.clientY - before.y;
  travelled += Math.hypot(dx, dy);
  if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const was = Math.hypot(before.x - other.x, before.y - other.y);
    const is = Math.hypot(event.clientX - other.x, event.clientY - other.y);
    if (is > 1) eye.distance *= was / is;
    pan(dx / 2, dy / 2);
  } else if (event.buttons & 6 || event.shiftKey) {
    pan(dx, dy);
  } else {
    eye.azimuth += dx * 0.006;
    eye.elevation += dy * 0.006;
  }
  Object.assign(before, {x: event.clientX, y: event.clientY});
  redraw();
});
for (const kind of ['pointerup', 'pointercancel'])
  canvas.addEventListener(kind, event => {
    pointers.delete(event.pointerId);
    if (kind === 'pointerup' && travelled < 4 && event.button === 0) chooseAt(event.offsetX, event.offsetY);
  });
canvas.addEventListener('contextmenu', event => event.preventDefault());
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  eye.distance *= Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * 0.0015);
  redraw();
}, {passive: false});
canvas.addEventListener('keydown', event => {
  const turn = 0.06;
  const actions = {
    ArrowLeft: () => { eye.azimuth -= turn; }, ArrowRight: () => { eye.azimuth += turn; },
    ArrowUp: () => { eye.elevation += turn; }, ArrowDown: () => { eye.elevation -= turn; },
    '+': () => { eye.distance /= 1.15; }, '-': () => { eye.distance *= 1.15; },
    n: () => { eye.azimuth = 0; }, Home: home, ' ': togglePlay, Escape: () => choose(null)};
  if (!(event.key in actions)) return;
  event.preventDefault();
  actions[event.key]();
  redraw();
});

// What the first view shows: landmarks and tracks, else the terrain.
const focus = (() => {
  let west = Infinity, south = Infinity, east = -Infinity, top = -Infinity;
  const add = (x, y) => {
    west = Math.min(west, x); east = Math.max(east, x);
    south = Math.min(south, y); top = Math.max(top, y);
  };
  for (const layer of scene.layers)
    for (let i = 0; i < layer.count; ++i) add(layer.numbers[i * LANDMARK.size], layer.numbers[i * LANDMARK.size + 1]);
  for (const track of scene.tracks)
    for (let i = 0; i < track.count; ++i) add(track.numbers[i * POSE.size + 1], track.numbers[i * POSE.size + 2]);
  if (!(east > west) && !(top > south)) {
    add(terrain.west, terrain.south);
    add(terrain.west + terrain.width, terrain.south + terrain.length);
  }
  const x = (west + east) / 2, y = (south + top) / 2;
  const above = scene.tracks.length ? 0 : Math.max(0, ...scene.images.map(i => i.centre[2] - groundAt(x, y)));
  const radius = Math.max(Math.hypot(east - west, top - south) / 2, 5);
  return {x, y, lift: 0.34 * above, distance: 2.2 * Math.max(radius, 0.8 * above)};
})();

function home() {
  const fits = Math.min(1, canvas.clientWidth / Math.max(canvas.clientHeight, 1) / 1.25);
  Object.assign(eye, {x: focus.x, y: focus.y, lift: focus.lift, distance: focus.distance / Math.max(fits, 0.3),
                      azimuth: 20 * Math.PI / 180, elevation: (focus.lift > 0 ? 24 : 38) * Math.PI / 180});
}
