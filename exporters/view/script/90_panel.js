// SPDX-License-Identifier: Apache-2.0
// Everything beside the picture: heading, legend, details of a landmark, scale, north, labels, playback.
function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}
const css = rgb => `rgb(${rgb.map(v => Math.round(255 * v)).join(' ')})`;
const narrow = number => number.toLocaleString('en', {maximumFractionDigits: 0}).replaceAll(',', '\u202f');
function coloured(rgb, kind) {
  const dot = element('i', {className: kind});
  dot.style.background = css(rgb);
  return dot;
}

const head = element('header', {}, element('h1', {textContent: scene.title}),
                     element('p', {textContent: scene.place}));
const legend = element('div', {className: 'legend'});
const details = element('aside', {className: 'details', hidden: true});
const labels = element('div', {className: 'labels'});
const scaleText = element('span'), scaleBar = element('div', {className: 'scale'}, scaleText);
const north = element('button', {className: 'north', title: 'North; click to look north', type: 'button'});
north.innerHTML = "<svg viewBox='-20 -20 40 40' width='44' height='44' aria-hidden='true'><g><path class='needle' d='M0 -15L5 2H-5Z'/><path class='tail' d='M0 13L5 2H-5Z'/><text y='-15.5'>N</text></g></svg>";
north.onclick = () => { eye.azimuth = 0; redraw(); };

function checkbox(text, checked, change, mark = null) {
  const box = element('input', {type: 'checkbox', checked});
  box.onchange = () => { change(box.checked); redraw(); };
  const label = element('label', {}, box, ...(mark ? [mark] : []), element('span', {textContent: text}));
  label.box = box;
  return label;
}
function range(text, properties, change) {
  const value = element('output'), input = element('input', {type: 'range', ...properties});
  const show = () => { value.textContent = change(Number(input.value)); redraw(); };
  input.oninput = show;
  setTimeout(show);
  return element('label', {className: 'range'}, element('span', {textContent: text}), input, value);
}

function fillLegend() {
  for (const layer of scene.layers)
    legend.append(checkbox(`${layer.title} (${narrow(layer.total)})`, true, on => { layer.shown = on; },
                           coloured(layer.rgb, 'dot')));
  for (const track of scene.tracks)
    legend.append(checkbox(track.name, true, on => { track.shown = on; }, coloured(trackColour(track), 'line')));
  const more = [];
  const option = (name, text) => more.push(checkbox(text, options[name], on => { options[name] = on; }));
  if (terrain.picture) option('picture', `Terrain: ${terrain.caption}`);
  if (scene.images.length) option('images', 'Images on the terrain');
  if (scene.images.length) option('frusta', 'Views of the images');
  if (scene.tracks.some(t => !t.truth)) option('ellipses', 'Ellipses of 3 sigma');
  if (scene.scans.length) option('rays', 'Laser beams and sightings');
  if (scene.layers.some(l => l.labels.some(t => t))) option('labels', 'Labels');
  if (scene.tracks.some(t => !t.truth))
    more.push(range('Ellipses', {min: 0, max: 5, step: 1, value: 0},
                    v => { options.enlarge = [1, 2, 5, 10, 20, 50][v]; return `\u00d7${options.enlarge}`; }));
  if (terrain.known && terrain.highest > terrain.lowest)
    more.push(range('Heights', {min: 0, max: 4, step: 1, value: STRETCHES.indexOf(options.stretch)},
                    v => { options.stretch = STRETCHES[v]; return `\u00d7${options.stretch}`; }));
  if (scene.layers.length) {
    more.push(range('Confidence', {min: 0, max: 1, step: 0.05, value: 0},
                    v => { options.confidence = v; return `\u2265 ${v.toFixed(2)}`; }));
    more.push(range('Quality', {min: 0, max: 1, step: 0.05, value: 0},
                    v => { options.quality = v; return `\u2265 ${v.toFixed(2)}`; }));
  }
  legend.append(element('hr'), ...more);
  for (const note of scene.notes) legend.append(element('p', {className: 'note', textContent: note}));
}

// Details of a landmark.
function row(list, name, value, summary = '') {
  list.append(element('dt', {textContent: name, title: summary}), element('dd', {textContent: value}));
}
function numberText(value, feature) {
  return (value * feature.factor).toFixed(feature.decimals) + (feature.unit ? `\u00a0${feature.unit}` : '');
}
function fillDetails(layer, i) {
  const n = layer.numbers.subarray(i * LANDMARK.size, (i + 1) * LANDMARK.size);
  const counts = layer.counts.subarray(4 * i, 4 * i + 4), list = element('dl');
  layer.features.forEach((feature, k) => {
    const at = 2 * (i * layer.features.length + k), value = layer.values[at], sd = layer.values[at + 1];
    if (Number.isNaN(value)) return;
    const spread = sd > 0 ? ` \u00b1 ${(sd * feature.factor).toFixed(Math.max(feature.decimals, 1))}` : '';
    const unitText = feature.unit ? `\u00a0${feature.unit}` : '';
    row(list, feature.title, (value * feature.factor).toFixed(feature.decimals) + spread + unitText, feature.summary);
  });
  const sd = n.subarray(LANDMARK.sd, LANDMARK.sd + 3);
  if (sd[0] > 0 || sd[1] > 0)
    row(list, 'Position sd', `${sd[0].toFixed(2)} east, ${sd[1].toFixed(2)} north, ${sd[2].toFixed(2)} up\u00a0m`);
  row(list, 'Confidence', n[LANDMARK.confidence].toFixed(2), 'Probability that it exists');
  row(list, 'Quality', Number.isNaN(n[LANDMARK.quality]) ? 'not assessed' : n[LANDMARK.quality].toFixed(2),
      'Landmark quality, equal weights');
  if (counts[1] > 0) row(list, 'Seen', `in ${counts[0]} of ${counts[1]} images that could show it`);
  const evidence = element('ul');
  for (let k = 0; k < counts[3]; ++k) {
    const at = 2 * (layer.firstEvidence[i] + k);
    evidence.append(element('li', {
      textContent: `${scene.sources[layer.evidence[at]]}, confidence ${layer.evidence[at + 1].toFixed(2)}`}));
  }
  const close = element('button', {type: 'button', className: 'close', textContent: '\u00d7', title: 'Close'});
  close.onclick = () => choose(null);
  details.replaceChildren(close,
    element('h2', {}, coloured(layer.rgb, 'dot'), element('span', {textContent: layer.labels[i] || layer.title})),
    element('p', {textContent: `${layer.uids[i]}`}), element('p', {textContent: layer.positions[i]}), list);
  if (counts[3] > 0)
    details.append(element('h3', {textContent: counts[2] > counts[3]
      ? `Evidence: ${counts[3]} of ${counts[2]} observations` : `Evidence: ${counts[3]} observation${counts[3] === 1 ? '' : 's'}`}), evidence);
}

function choose(one) {
  selected = one;
  details.hidden = !one;
  if (one) fillDetails(one.layer, one.index);
  redraw();
}
function chooseAt(x, y) {
  aim();
  choose(landmarkAt(view, x * view.ratio, y * view.ratio));
}

// Labels of the foremost landmarks that have one, without overlap.
const labelled = scene.layers.flatMap(layer => layer.uids.map((_, i) => ({layer, index: i}))
  .filter(one => layer.labels[one.index]).slice(0, 60));
for (const one of labelled) {
  one.box = element('span', {textContent: one.layer.labels[one.index]});
  one.width = 7 * one.box.textContent.length;
  labels.append(one.box);
}
function placeLabels() {
  const taken = [];
  for (const one of labelled) {
    const at = one.index * LANDMARK.size, n = one.layer.numbers;
    const p = options.labels && one.layer.shown
      ? screenOf(n[at], n[at + 1], terrain.known ? null : n[at + 2], n[at + LANDMARK.height]) : null;
    const inside = p && p.x > 0 && p.y > 20 && p.x < canvas.clientWidth && p.y < canvas.clientHeight;
    const box = inside ? [p.x - one.width / 2, p.y - 26, p.x + one.width / 2, p.y - 8] : null;
    const free = box && taken.length < 30 &&
      !taken.some(t => box[0] < t[2] && t[0] < box[2] && box[1] < t[3] && t[1] < box[3]);
    one.box.hidden = !free;
    if (!free) continue;
    taken.push(box);
    one.box.style.transform = `translate(${Math.round(box[0])}px, ${Math.round(box[1])}px)`;
  }
}

function placeScale() {
  const pixel = view.pixel * eye.distance / view.ratio, length = roundLength(140 * pixel);
  scaleBar.style.width = `${length / pixel}px`;
  scaleText.textContent = length >= 1000 ? `${length / 1000} km` : `${length} m`;
  north.querySelector('g').setAttribute('transform', `rotate(${-eye.azimuth * 180 / Math.PI})`);
}

// Playback.
const player = element('footer', {hidden: !clock});
const playButton = element('button', {type: 'button', className: 'play', title: 'Play or pause (space)'});
const slider = element('input', {type: 'range', className: 'time', step: 'any'});
slider.setAttribute('aria-label', 'Time');
const timeText = element('output'), statusText = element('p', {className: 'status'});
const speed = element('select', {title: 'Speed'});
const followBox = checkbox('follow', false, on => setFollow(on));
let playing = false;

function clockText() {
  if (clock.kind === 'images') return `image ${Math.round(now) + 1} of ${scene.images.length}`;
  const s = now - clock.first, minutes = Math.floor(s / 60);
  return `${minutes}:${(s - 60 * minutes).toFixed(1).padStart(4, '0')}`;
}
function trackStatus() {
  if (!clock) return '';
  if (clock.kind === 'images') return scene.images[Math.round(now)].name;
  const truth = scene.tracks.find(t => t.truth && t.count);
  return scene.tracks.filter(t => t.shown && !t.truth && t.count).map(track => {
    const pose = poseAt(track, now);
    const sigma = Math.sqrt(Math.max(0, (pose.varX + pose.varY) / 2 +
                                     Math.hypot((pose.varX - pose.varY) / 2, pose.covXY)));
    const true_ = truth ? poseAt(truth, now) : null;
    const error = true_ ? `error ${Math.hypot(pose.x - true_.x, pose.y - true_.y).toFixed(2)} m, ` : '';
    return `${track.name}: ${pose.lost ? 'lost, ' : ''}${error}sd ${sigma.toFixed(2)} m`;
  }).join('   ');
}
function showTime() {
  if (!clock) return;
  slider.value = now;
  timeText.textContent = clockText();
  statusText.textContent = trackStatus();
  playButton.textContent = playing ? '\u275a\u275a' : '\u25b6';
}
function togglePlay() {
  if (!clock) return;
  playing = !playing;
  if (playing && now >= clock.last) now = clock.first;
  lastFrame = 0;
  redraw();
}
function setFollow(on) {
  options.follow = on;
  followBox.box.checked = on;
}
if (clock) {
  slider.min = clock.first;
  slider.max = clock.last;
  slider.oninput = () => { now = Number(slider.value); redraw(); };
  playButton.onclick = togglePlay;
  const speeds = clock.kind === 'images' ? [0.5, 1, 2, 4] : [1, 2, 5, 10, 20, 50, 100];
  for (const v of speeds) speed.append(element('option', {value: v, textContent: `${v}\u00d7`}));
  speed.value = clock.kind === 'images' ? 1 : speeds.findLast(v => v * 60 <= clock.last - clock.first) || 1;
  player.append(playButton, slider, timeText, speed, ...(scene.tracks.length ? [followBox] : []), statusText);
}

document.body.append(labels, element('div', {className: 'side'}, head, legend), details, element('div', {className: 'corner'}, north, scaleBar), player);
