// SPDX-License-Identifier: Apache-2.0
'use strict';
// Makes the report's map and tables react to the pointer. The page is whole without this script, and in print.
const figure = document.querySelector('.map'), svg = figure && figure.querySelector('svg');
const SVG = 'http:' + '//www.w3.org/2000/svg';
const markers = svg ? [...svg.querySelectorAll('[data-uid]')].map(node => {
  const [x, y, radius] = node.getAttribute('transform').match(/-?[\d.]+/g).map(Number);
  const ring = node.parentNode.classList.contains('ring');
  return {node, x, y, radius, ring, uid: node.dataset.uid, text: node.querySelector('title').textContent,
          confidence: Number(node.dataset.confidence), quality: node.dataset.quality === '' ? NaN : Number(node.dataset.quality)};
}) : [];
const markerOf = new Map(markers.map(m => [m.uid, m]));
const rows = [...document.querySelectorAll('.landmarks tbody tr')];
const rowOf = new Map(rows.map(row => [row.dataset.uid, row]));

function element(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

// Sorting: a click on a heading sorts by its numbers, largest first, then the other way round.
function numberIn(cell) {
  const text = (cell.firstChild ? cell.firstChild.textContent : '').replaceAll('\u202f', '').replace('\u2212', '-');
  const value = parseFloat(text.replace(/[^\d.+-]/g, ''));
  return Number.isNaN(value) ? -Infinity : value;
}
for (const table of document.querySelectorAll('.landmarks'))
  [...table.tHead.rows[0].cells].forEach((heading, column) => {
    const button = element('button', {type: 'button', className: 'sort', title: heading.title || 'Sort'});
    button.append(...heading.childNodes);
    heading.append(button);
    button.onclick = () => {
      const rising = heading.ariaSort ? heading.ariaSort === 'descending' : column === 0;
      for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
      heading.ariaSort = rising ? 'ascending' : 'descending';
      const body = table.tBodies[0], sign = rising ? 1 : -1;
      const keyed = [...body.rows].map((row, i) => ({row, i, key: numberIn(row.cells[column])}));
      keyed.sort((a, b) => a.key === b.key ? a.i - b.i : sign * (a.key < b.key ? -1 : 1));
      body.append(...keyed.map(k => k.row));
    };
  });

if (svg) {
  // What zooms goes into one group, clipped by the frame.
  const frame = svg.querySelector('.frame'), width = frame.width.baseVal.value, height = frame.height.baseVal.value;
  const clip = document.createElementNS(SVG, 'clipPath'), ground = document.createElementNS(SVG, 'g');
  const clipped = document.createElementNS(SVG, 'g'), hole = document.createElementNS(SVG, 'rect');
  clip.id = 'frame';
  for (const [name, value] of [['width', width], ['height', height]]) hole.setAttribute(name, value);
  clip.append(hole);
  clipped.setAttribute('clip-path', 'url(' + '#frame)');
  ground.append(...svg.querySelectorAll(':scope > image, :scope > .graticule, :scope > .marker, :scope > .labels'));
  clipped.append(ground);
  svg.querySelector('.ground').after(clip, clipped);
  // A label stays at its landmark, the nearest one.
  const labels = [...ground.querySelectorAll('.labels text')].map(node => {
    const x = Number(node.getAttribute('x')), y = Number(node.getAttribute('y'));
    const away = m => Math.hypot(m.x - x, m.y - y);
    return {node, at: markers.reduce((best, m) => away(m) < away(best) ? m : best)};
  });
  const coordinates = svg.querySelector('.coordinates'), scale = svg.querySelector('.scale text');
  const scaleLength = scale ? parseFloat(scale.textContent.replace(/[\s\u202f]/g, '')) : 0;
  const scaleWords = scale ? scale.textContent : '';

  let zoom = 1, left = 0, top = 0;
  function show() {
    zoom = Math.min(Math.max(zoom, 1), 400);
    left = Math.min(Math.max(left, 0), width - width / zoom);
    top = Math.min(Math.max(top, 0), height - height / zoom);
    ground.setAttribute('transform', `scale(${zoom}) translate(${-left} ${-top})`);
    // Symbols keep their size on the screen; rings grow with the terrain they surround.
    const grown = 1 / zoom ** 0.85;
    for (const m of markers)
      m.node.setAttribute('transform', `translate(${m.x} ${m.y}) scale(${m.ring ? m.radius : m.radius * grown})`);
    for (const l of labels)
      l.node.setAttribute('transform', `translate(${l.at.x * (1 - 1 / zoom)} ${l.at.y * (1 - 1 / zoom)}) scale(${1 / zoom})`);
    if (coordinates) coordinates.style.visibility = zoom > 1.001 ? 'hidden' : '';
    if (scale)
      scale.textContent = zoom > 1.001
        ? `${Number((scaleLength / zoom).toPrecision(3))}\u00a0${scaleWords.includes('km') ? 'km' : 'm'}` : scaleWords;
    reset.hidden = zoom <= 1.001;
  }
  function pointAt(event) {
    const matrix = svg.getScreenCTM(), x = (event.clientX - matrix.e) / matrix.a, y = (event.clientY - matrix.f) / matrix.d;
    return {x, y, mapX: left + x / zoom, mapY: top + y / zoom};
  }
  function zoomAbout(x, y, mapX, mapY, next) {
    zoom = Math.min(Math.max(next, 1), 400);
    left = mapX - x / zoom;
    top = mapY - y / zoom;
    show();
  }
  svg.addEventListener('wheel', event => {
    if (!(event.ctrlKey || zoom > 1 || document.activeElement === svg)) return;  // else the page scrolls
    event.preventDefault();
    const p = pointAt(event);
    zoomAbout(p.x, p.y, p.mapX, p.mapY, zoom * Math.exp(-event.deltaY * 0.002));
  }, {passive: false});
  svg.addEventListener('dblclick', event => {
    event.preventDefault();
    const p = pointAt(event);
    zoomAbout(p.x, p.y, p.mapX, p.mapY, zoom * (event.shiftKey ? 0.5 : 2));
  });
  let held = null, moved = 0;
  svg.addEventListener('pointerdown', event => { held = pointAt(event); moved = 0; });
  svg.addEventListener('pointermove', event => {
    if (!held || !(event.buttons & 1) || zoom === 1) return;
    const p = pointAt(event);
    moved += Math.abs(p.x - held.x) + Math.abs(p.y - held.y);
    left = held.mapX - p.x / zoom;
    top = held.mapY - p.y / zoom;
    show();
  });
  window.addEventListener('pointerup', () => { held = null; });
  svg.tabIndex = 0;
  svg.addEventListener('keydown', event => {
    const step = 60 / zoom, middle = [width / 2, height / 2, left + width / 2 / zoom, top + height / 2 / zoom];
    const actions = {'+': () => zoomAbout(...middle, zoom * 1.5), '-': () => zoomAbout(...middle, zoom / 1.5),
                     ArrowLeft: () => { left -= step; }, ArrowRight: () => { left += step; },
                     ArrowUp: () => { top -= step; }, ArrowDown: () => { top += step; }, Escape: () => { zoom = 1; }};
    if (!(event.key in actions) || (zoom === 1 && event.key.startsWith('Arrow'))) return;
    event.preventDefault();
    actions[event.key]();
    show();
  });

  // A landmark under the pointer says what it is; a click on it marks its row, a click on a row its landmark.
  const tip = element('div', {className: 'tip', hidden: true});
  document.body.append(tip);
  for (const m of markers) m.node.querySelector('title').remove();  // the tip takes its place
  const markerAt = event => {
    const node = event.target.closest('[data-uid]');
    return node && markerOf.get(node.dataset.uid);
  };
  svg.addEventListener('pointerover', event => {
    const m = markerAt(event);
    tip.hidden = !m;
    if (!m) return;
    tip.textContent = `${m.text}\nconfidence ${m.confidence.toFixed(2)}` +
      (Number.isNaN(m.quality) ? '' : `\nquality ${m.quality.toFixed(2)}`);
    const box = m.node.getBoundingClientRect();
    tip.style.left = `${Math.min(box.right + 8 + scrollX, scrollX + innerWidth - tip.offsetWidth - 8)}px`;
    tip.style.top = `${box.top + scrollY}px`;
  });
  svg.addEventListener('pointerleave', () => { tip.hidden = true; });
  function mark(uid) {
    for (const one of document.querySelectorAll('.chosen')) one.classList.remove('chosen');
    const m = markerOf.get(uid), row = rowOf.get(uid);
    if (m) m.node.classList.add('chosen');
    if (row) row.classList.add('chosen');
    return {m, row};
  }
  svg.addEventListener('click', event => {
    const m = markerAt(event);
    if (!m || moved > 5) return;
    const {row} = mark(m.uid);
    if (row) row.scrollIntoView({block: 'center', behavior: 'smooth'});
  });
  for (const row of rows) {
    if (!markerOf.has(row.dataset.uid)) continue;
    const place = row.cells[1], go = element('button', {type: 'button', className: 'go', title: 'Show on the map'});
    go.append(...place.childNodes);
    place.append(go);
    go.onclick = () => {
      const {m} = mark(row.dataset.uid);
      zoomAbout(width / 2, height / 2, m.x, m.y, Math.max(zoom, 4));
      m.node.parentNode.append(m.node);  // on top
      figure.scrollIntoView({block: 'nearest', behavior: 'smooth'});
    };
  }

  // Filters.
  const limits = {confidence: 0, quality: 0}, shown = element('output', {});
  function filter() {
    const passes = m => m.confidence >= limits.confidence && (limits.quality === 0 || m.quality >= limits.quality);
    let count = 0;
    for (const m of markers) {
      m.node.style.display = passes(m) ? '' : 'none';
      count += passes(m);
    }
    for (const row of rows) {
      const own = {confidence: Number(row.dataset.confidence),
                   quality: row.dataset.quality === '' ? NaN : Number(row.dataset.quality)};
      row.hidden = !passes(own);
    }
    shown.textContent = `${count} of ${markers.length} shown`;
  }
  const controls = element('div', {className: 'controls'});
  for (const name of ['confidence', 'quality']) {
    const value = element('output', {textContent: '\u2265 0.00'});
    const input = element('input', {type: 'range', min: 0, max: 1, step: 0.05, value: 0});
    input.oninput = () => {
      limits[name] = Number(input.value);
      value.textContent = `\u2265 ${limits[name].toFixed(2)}`;
      filter();
    };
    controls.append(element('label', {}, name + ' ', input, value));
  }
  const reset = element('button', {type: 'button', textContent: 'Whole map', hidden: true});
  reset.onclick = () => { zoom = 1; show(); };
  controls.append(shown, reset, element('span', {className: 'soft',
    textContent: 'double-click or Ctrl + wheel zooms, drag moves, + and \u2212 on the keyboard'}));
  figure.append(controls);
  filter();
}
