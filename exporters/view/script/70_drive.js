// SPDX-License-Identifier: Apache-2.0
// Tracks, covariance ellipses, robots and what their sensors measured at the time shown.
const TRACK_COLOURS = [[0.85, 0.37, 0.01], [0.11, 0.44, 0.7], [0.48, 0.2, 0.58], [0.11, 0.62, 0.47],
                       [0.77, 0.11, 0.49], [0.55, 0.42, 0.12]];
let estimates = 0;
for (const track of scene.tracks) {
  track.rgb = track.truth ? null : TRACK_COLOURS[estimates++ % TRACK_COLOURS.length];  // truth: the ink
  track.lines = new Lines();
  track.marker = makeInstances('robot', new Float32Array(8));
}
const trackColour = track => track.rgb || view.ink;

const clock = (() => {
  const times = scene.tracks.filter(t => t.count).map(t => [t.numbers[0], t.numbers[(t.count - 1) * POSE.size]]);
  if (times.length === 0 && scene.images.length > 1)  // a descent: one step per image
    return {kind: 'images', first: 0, last: scene.images.length - 1};
  if (times.length === 0) return null;
  return {kind: 'time', first: Math.min(...times.map(t => t[0])), last: Math.max(...times.map(t => t[1]))};
})();
let now = clock ? (clock.kind === 'images' ? clock.last : clock.first) : 0;

// Returns the index of the last element not after t; -1 before the first.
function lastBefore(count, timeOf, t) {
  let low = -1, high = count;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (timeOf(middle) <= t) low = middle; else high = middle;
  }
  return low;
}

// Returns the pose of a track at a time, interpolated; the first or last one outside.
function poseAt(track, t) {
  const n = track.numbers, size = POSE.size;
  const i = Math.min(Math.max(lastBefore(track.count, k => n[k * size], t), 0), track.count - 1);
  const j = Math.min(i + 1, track.count - 1), a = n.subarray(i * size, (i + 1) * size);
  const b = n.subarray(j * size, (j + 1) * size);
  const f = b[0] > a[0] ? Math.min(Math.max((t - a[0]) / (b[0] - a[0]), 0), 1) : 0;
  const turn = Math.atan2(Math.sin(b[3] - a[3]), Math.cos(b[3] - a[3]));
  return {x: a[1] + f * (b[1] - a[1]), y: a[2] + f * (b[2] - a[2]), yaw: a[3] + f * turn,
          varX: a[4], varY: a[5], covXY: a[6], lost: a[7] === 1};
}

// Returns points of the ellipse of `sigmas` standard deviations about a pose.
function ellipse(pose, sigmas, count = 48) {
  const angle = 0.5 * Math.atan2(2 * pose.covXY, pose.varX - pose.varY);
  const middle = (pose.varX + pose.varY) / 2;
  const half = Math.hypot((pose.varX - pose.varY) / 2, pose.covXY);
  const major = sigmas * Math.sqrt(Math.max(middle + half, 0)), minor = sigmas * Math.sqrt(Math.max(middle - half, 0));
  const c = Math.cos(angle), s = Math.sin(angle);
  return Array.from({length: count}, (_, i) => {
    const a = 2 * Math.PI * i / count, u = major * Math.cos(a), v = minor * Math.sin(a);
    return [pose.x + c * u - s * v, pose.y + s * u + c * v, 0];
  });
}

function makeTrackLines() {
  for (const track of scene.tracks) {
    const rgb = trackColour(track), n = track.numbers;
    for (let i = 0; i + 1 < track.count; ++i) {
      const a = i * POSE.size, b = a + POSE.size;
      track.lines.add([n[a + 1], n[a + 2], 0], [n[b + 1], n[b + 2], 0], [...rgb, n[a + POSE.lost] === 1 ? 0.35 : 1], n[b]);
    }
    track.lines.finish();
  }
}

const ellipseLines = new Lines(), rayLines = new Lines();
const SCAN_SHOWN = 2.5;  // s after its time

// The track whose pose sensors are drawn from and the camera follows: the truth, else the first one shown.
const leadTrack = () => scene.tracks.find(t => t.truth && t.count) || scene.tracks.find(t => t.count) || null;

function fillEllipses(rgbOf) {
  for (const track of scene.tracks) {
    if (!track.shown || track.truth || track.count === 0) continue;
    const rgb = rgbOf(track), last = track.numbers[(track.count - 1) * POSE.size], first = track.numbers[0];
    if (options.ellipses) {
      for (let k = 1; k < 16; ++k) {
        const t = first + (last - first) * k / 16;
        if (t < now) ellipseLines.chain(ellipse(poseAt(track, t), 3 * options.enlarge, 32), [...rgb, 0.55], {closed: true});
      }
      ellipseLines.chain(ellipse(poseAt(track, now), 3 * options.enlarge), [...rgb, 1], {closed: true});
    }
  }
  ellipseLines.finish();
}

function fillRays() {
  const lead = leadTrack();
  if (lead && options.rays) {
    for (const laser of [true, false]) {
      let i = lastBefore(scene.scans.length, k => scene.scans[k].t, now);
      while (i >= 0 && scene.scans[i].laser !== laser && now - scene.scans[i].t < SCAN_SHOWN) --i;
      const scan = scene.scans[i];
      if (!scan || scan.laser !== laser || now - scan.t >= SCAN_SHOWN) continue;
      const pose = poseAt(lead, scan.t), c = Math.cos(pose.yaw), s = Math.sin(pose.yaw);
      const from = [pose.x + c * scan.mount[0] - s * scan.mount[1], pose.y + s * scan.mount[0] + c * scan.mount[1]];
      const eye = [...from, groundAt(...from) + 0.5];
      for (let r = 0; r < scan.rays.length; r += 2) {
        const a = pose.yaw + scan.rays[r];
        const x = from[0] + scan.rays[r + 1] * Math.cos(a), y = from[1] + scan.rays[r + 1] * Math.sin(a);
        rayLines.add(eye, [x, y, groundAt(x, y) + 0.3], laser ? [0.9, 0.1, 0.15, 0.45] : [1, 0.75, 0, 0.95]);
      }
    }
  }
  rayLines.finish();
}

function drawDrive(view) {
  for (const track of scene.tracks)
    if (track.shown)
      track.lines.draw(view, {width: track.truth ? 4 : 2.5, drape: true, lift: 0.15, now, later: 0.22});
  fillEllipses(trackColour);
  fillRays();
  ellipseLines.draw(view, {width: 2, drape: true, lift: 0.2});
  rayLines.draw(view, {width: 1.4});
  useProgram(solidProgram, view);
  gl.uniform2f(solidProgram.uniforms.least, 0, 0);
  for (const track of scene.tracks) {
    if (!track.shown || track.count === 0) continue;
    const pose = poseAt(track, now);
    gl.bindBuffer(gl.ARRAY_BUFFER, track.marker.buffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, new Float32Array([pose.x, pose.y, 0, 0.9, 0.45, 1, 1, 0]));
    drawInstances(view, track.marker, trackColour(track), {heading: pose.yaw});
  }
}

// View pyramids of the images, the one shown last in full colour.
const frustumLines = new Lines();
function shownImages() {
  if (!clock || clock.kind !== 'images') return scene.images;
  return scene.images.slice(0, Math.round(now) + 1);
}
function drawFrusta(view) {
  const shown = shownImages(), current = shown[shown.length - 1];
  scene.images.forEach((image, i) => {
    const strong = image === current && clock && clock.kind === 'images';
    const rgba = strong ? [1, 0.78, 0.1, 1] : [...view.ink, shown.includes(image) ? 0.55 : 0.18];
    const side = image.edge.length / 4;
    if (shown.includes(image))
      for (let k = 0; k < 4 && side > 0; ++k) frustumLines.add(image.centre, image.edge[Math.floor(k * side)], rgba);
    if (shown.includes(image))
      frustumLines.chain(image.edge.map(p => [p[0], p[1], groundAt(p[0], p[1])]), rgba, {closed: true});
    if (i > 0) frustumLines.add(scene.images[i - 1].centre, image.centre, [0.85, 0.37, 0.01, 1]);
  });
  frustumLines.finish().draw(view, {width: 1.6, lift: 0.05});
}
