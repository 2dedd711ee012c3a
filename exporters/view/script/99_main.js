// SPDX-License-Identifier: Apache-2.0
// Drawing on demand, and what the page offers to scripts and tests.
let pending = false, lastFrame = 0;

function draw() {
  aim();
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...view.sky, 1);
  gl.enable(gl.DEPTH_TEST);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  drawTerrain(view);
  if (options.images && scene.images.length) drapeImages(view, shownImages());
  drawLandmarks(view);
  if (options.frusta && scene.images.length) drawFrusta(view);
  drawDrive(view);
}

function frame(time) {
  pending = false;
  if (playing) {
    const seconds = lastFrame ? Math.min((time - lastFrame) / 1000, 0.25) : 0;
    now = Math.min(now + seconds * Number(speed.value), clock.last);
    if (now >= clock.last) playing = false;
  }
  lastFrame = time;
  const lead = options.follow ? leadTrack() : null;
  if (lead) {
    const pose = poseAt(lead, now);
    const part = playing ? 0.35 : 1;  // smooth while it moves
    eye.x += part * (pose.x - eye.x);
    eye.y += part * (pose.y - eye.y);
  }
  draw();
  placeLabels();
  placeScale();
  showTime();
  if (playing) redraw();
}
function redraw() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(frame);
}

// State in the address: view.html#t=120&follow=1&x=10&y=5&distance=60&azimuth=30&elevation=40&select=UID
function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const number = (name, use) => {
    const value = parseFloat(given.get(name));
    if (Number.isFinite(value)) use(value);
  };
  for (const name of ['x', 'y', 'distance']) number(name, v => { eye[name] = v; });
  for (const name of ['azimuth', 'elevation']) number(name, v => { eye[name] = v * Math.PI / 180; });
  number('t', v => { if (clock) now = Math.min(Math.max(v, clock.first), clock.last); });
  if (given.get('follow') === '1') setFollow(true);
  if (given.has('select')) choose(findLandmark(given.get('select')));
  redraw();
}
function findLandmark(uid) {
  for (const layer of scene.layers) {
    const index = layer.uids.indexOf(uid);
    if (index >= 0) return {layer, index};
  }
  return null;
}

readColours();
if (scene.tracks.length) options.images = options.frusta = false;
makeTrackLines();
fillLegend();
aim();
home();
readAddress();
window.addEventListener('resize', redraw);
window.addEventListener('hashchange', readAddress);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  makeTrackLines();
  redraw();
});

// For tests and the console.
window.waymark = {
  ready: () => loading === 0 && !pending,
  counts: () => Object.fromEntries(scene.layers.map(layer => [layer.name, layer.count])),
  // Returns CSS pixels of a landmark's middle, or null if it is out of sight.
  pixelOf: uid => {
    aim();
    const one = findLandmark(uid);
    if (!one) return null;
    const n = one.layer.numbers, at = one.index * LANDMARK.size;
    const [radius, height] = drawnSize(one.layer, one.index);
    const onRim = one.layer.shape === 'bowl' ? radius : 0;
    const above = one.layer.shape === 'bowl' ? height : height * 0.5;
    return screenOf(n[at] + onRim, n[at + 1], terrain.known ? null : n[at + 2], above);
  },
  selected: () => selected && selected.layer.uids[selected.index],
  now: () => now,
  eye,
  // Returns milliseconds per frame, waiting for each frame to be finished.
  measure: (frames = 20) => {
    const pixel = new Uint8Array(4);
    const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    draw();
    finish();
    const from = performance.now();
    for (let i = 0; i < frames; ++i) {
      eye.azimuth += 0.01;
      draw();
      finish();
    }
    return (performance.now() - from) / frames;
  },
};
