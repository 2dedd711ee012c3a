// SPDX-License-Identifier: Apache-2.0
// The page of a map: MapLibre draws style.json; this script adds legend, filters, popups, and a scale bar of the map's
// own body.
'use strict';

/// Archive of tiles read by ranges, or whole where the server knows no ranges.
class ArchiveSource {
  constructor(url) {
    this.url = url;
    this.whole = null;
  }
  getKey() {
    return this.url;
  }
  async getBytes(offset, length) {
    if (this.whole === null) {
      const answer = await fetch(this.url, {headers: {Range: `bytes=${offset}-${offset + length - 1}`}});
      if (!answer.ok) throw new Error(`${this.url}: ${answer.status} ${answer.statusText}`);
      const data = await answer.arrayBuffer();
      if (answer.status === 206) return {data};
      this.whole = data;
    }
    return {data: this.whole.slice(offset, offset + length)};
  }
}

const NO_TILE = 'beyond the terrain';

const element = (name, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
};

const problem = (...words) => document.body.append(element('p', {className: 'problem'}, ...words));

const numberText = (value, decimals) => value.toLocaleString('en', {minimumFractionDigits: decimals,
  maximumFractionDigits: decimals}).replaceAll(',', '\u202f').replace('-', '\u2212');

/// Formats a number of a list of features {unit, factor, decimals}, with its standard deviation where that is known.
const featureText = (value, sd, feature) => {
  const texts = [value, sd].filter(one => one !== undefined).map(one => numberText(one * feature.factor, feature.decimals));
  return texts.join(' \u00b1 ') + (feature.unit === '\u00b0' ? feature.unit : feature.unit && '\u00a0' + feature.unit);
};

/// Metres to a decimetre; other numbers, such as degrees, as they are to five decimals.
const attributeText = (value, unit) => unit === 'm' ? numberText(value, 1) : String(Number(value.toFixed(5))).replace('-', '\u2212');

const lengthText = metres => metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` :
  metres >= 0.01 ? `${Math.round(metres * 100)} cm` : `${Math.round(metres * 1000)} mm`;

/// Metres on the ground per pixel at a latitude of the page. On a plane they are alike everywhere.
const metresPerPixel = (about, latitude, zoom) => {
  const world = 512 * 2 ** zoom;
  if (about.plane) return 2 * Math.PI * about.radius / world;
  const sine = Math.sin(latitude * Math.PI / 180);
  const eccentricity = about.flattening * (2 - about.flattening);
  return 2 * Math.PI * about.radius * Math.sqrt(1 - sine * sine) / Math.sqrt(1 - eccentricity * sine * sine) / world;
};

/// Largest of 1, 2, 5 times a power of ten that is not above a length.
const roundLength = limit => {
  const power = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].map(n => n * power).find(n => n <= limit * (1 + 1e-12));
};

const degreesText = (degrees, positive, negative) =>
  `${Math.abs(degrees).toFixed(5)}\u00b0\u00a0${degrees < 0 ? negative : positive}`;

/// Position on the page in coordinates of the map, as text.
const positionText = (about, at) => {
  if (!about.plane) return `${degreesText(at.lat, 'N', 'S')}  ${degreesText(at.lng, 'E', 'W')}`;
  const perRadian = about.radius / about.metres_per_unit;
  const x = perRadian * at.lng * Math.PI / 180, y = perRadian * Math.asinh(Math.tan(at.lat * Math.PI / 180));
  return `x ${numberText(x, 2)}  y ${numberText(y, 2)}`;
};

const landmarkPosition = (about, p) => about.geographic ?
  `${degreesText(p.y, 'N', 'S')}  ${degreesText(p.x, 'E', 'W')}` : `${numberText(p.x, 2)}, ${numberText(p.y, 2)}`;

const qualityText = p => p.quality === undefined ? 'not assessed' : numberText(p.quality, 2);

/// Content of a popup.
const details = (about, type, p) => {
  const rows = [];
  const row = (title, text, hint = '') => rows.push(element('tr', {title: hint}, element('th', {}, title),
    element('td', {}, text)));
  for (const feature of type.features) {
    const value = p[feature.name], sd = p[feature.name + '_sd'];
    if (value === undefined) continue;
    row(feature.title, featureText(value, sd, feature), feature.summary);
  }
  for (const attribute of type.attributes)
    if (p[attribute.name] !== undefined && attribute.name !== 'name')
      row(attribute.title, (typeof p[attribute.name] === 'number' ? attributeText(p[attribute.name], attribute.unit) : p[attribute.name]) +
        (attribute.unit ? '\u00a0' + attribute.unit : ''));
  row('Quality', qualityText(p), 'how reliably images or surveys see it, 0 to 1');
  row('Confidence', numberText(p.confidence, 2), 'probability that it exists');
  row('Seen', `${p.seen} of ${p.visible} times`);
  if (p.position_sd !== undefined) row('Position', '\u00b1 ' + numberText(p.position_sd, 2) + '\u00a0m');
  row(about.geographic ? 'At' : 'x, y', landmarkPosition(about, p), about.crs_name);
  row('Name', p.uid);
  const box = element('div', {}, element('h2', {}, p.name || type.title), element('table', {}, ...rows));
  if (p.hidden) box.append(element('p', {className: 'note'}, `and ${numberText(p.hidden, 0)} lesser ones of this type nearby: zoom in`));
  return box;
};

/// Content of the popup of a polygon. A column `X_se` is the standard error of `X`.
const shapeDetails = (layer, p) => {
  const rows = [];
  for (const column of layer.columns) {
    const value = p[column.name], error = p[column.name + '_se'];
    if (value === undefined || value === '' || (column.name.endsWith('_se') && layer.columns.some(one => one.name + '_se' === column.name)))
      continue;
    const decimals = typeof value !== 'number' || Number.isInteger(value) ? 0 : Math.abs(value) < 10 ? 2 : Math.abs(value) < 1000 ? 1 : 0;
    const text = typeof value !== 'number' ? value : [value, error].filter(one => one !== undefined)
      .map(one => numberText(one, decimals)).join(' \u00b1 ') + (column.unit && '\u00a0' + column.unit);
    rows.push(element('tr', {title: column.summary}, element('th', {}, column.title), element('td', {}, text)));
  }
  return element('div', {}, element('h2', {}, layer.title), element('table', {}, ...rows));
};

const filterOf = (confidence, quality) => ['all', ['>=', ['coalesce', ['get', 'confidence'], 1], confidence],
  ['any', ['<=', quality, 0], ['>=', ['coalesce', ['get', 'quality'], -1], quality]]];

/// Says how many landmarks of the view only finer zooms show.
function addCountOfHidden(map, about, panel) {
  const note = element('p', {id: 'hidden'});
  panel.append(note);
  map.on('idle', () => {
    const layers = about.types.map(type => type.name);
    const hidden = new Map(map.queryRenderedFeatures({layers}).map(one => [one.properties.uid, one.properties.hidden ?? 0]));
    const count = [...hidden.values()].reduce((sum, one) => sum + one, 0);
    note.textContent = count ? `Zoom in to see up to ${numberText(count, 0)} lesser landmarks.` : '';
  });
}

/// Source of the mesh of the terrain: its heights count from the lowest, where MapLibre's camera stands at first.
const meshSource = about => {
  const factor = about.height_factor;
  return {encoding: 'custom', redFactor: 256 * factor, greenFactor: factor, blueFactor: factor / 256,
    baseShift: (32768 + about.lowest) * factor};
};

function addPanel(map, about) {
  const panel = document.getElementById('panel');
  const layersOf = type => [type.name, type.name + '_label'].filter(id => map.getLayer(id));
  for (const type of about.types) {
    const box = element('input', {type: 'checkbox', checked: true});
    const symbol = element('i');
    symbol.style.borderColor = type.colour;
    if (!type.outlined) symbol.style.background = type.colour;
    box.onchange = () => layersOf(type).forEach(id => map.setLayoutProperty(id, 'visibility', box.checked ? 'visible' : 'none'));
    panel.append(element('label', {title: type.summary}, box, symbol, type.title,
      element('span', {className: 'count'}, numberText(type.count, 0))));
  }
  for (const layer of about.shapes) {
    const box = element('input', {type: 'checkbox', checked: true, id: `shapes_${layer.name}`});
    const symbol = element('i', {className: 'area'});
    symbol.style.borderColor = layer.colour;
    symbol.style.background = layer.fill;
    box.onchange = () => ['_area', '_outline'].forEach(part =>
      map.setLayoutProperty(layer.name + part, 'visibility', box.checked ? 'visible' : 'none'));
    panel.append(element('label', {title: layer.summary}, box, symbol, `${layer.title} (areas)`,
      element('span', {className: 'count'}, numberText(layer.count, 0))));
  }
  const limits = {confidence: 0, quality: 0};
  for (const name of Object.keys(limits)) {
    const shown = element('span', {className: 'count'}, '0.00');
    const slider = element('input', {type: 'range', min: 0, max: 1, step: 0.05, value: 0, id: name});
    slider.oninput = () => {
      limits[name] = Number(slider.value);
      shown.textContent = limits[name].toFixed(2);
      const filter = filterOf(limits.confidence, limits.quality);
      about.types.forEach(type => layersOf(type).forEach(id => map.setFilter(id, filter)));
    };
    panel.append(element('label', {title: name === 'quality' ? 'How reliably it is seen; landmarks not assessed are shown at 0 only'
      : 'Probability that it exists'}, name === 'quality' ? 'Quality from' : 'Confidence from', slider, shown));
  }
  if (about.terrain) {
    const box = element('input', {type: 'checkbox', id: 'relief'});
    box.onchange = () => {
      map.setTerrain(box.checked ? {source: 'terrain_mesh', exaggeration: 1} : null);
      map.easeTo({pitch: box.checked ? 60 : 0, duration: 0});
      map.once('idle', () => map.jumpTo({}));  // to the height of the ground, once that is loaded
    };
    panel.append(element('label', {title: about.terrain}, box, 'Terrain in 3-D'));
  }
  addCountOfHidden(map, about, panel);
  const place = about.body ? `${about.body}, ${about.crs_name}` : 'Local coordinates';
  const notes = [about.plane ? `${place}: x and y are drawn to scale on a plane, so the scale bar holds everywhere.`
    : `${place}. The Mercator projection enlarges towards the poles; the scale bar holds in the middle of the map.`];
  if (about.outside) notes.push(`${about.outside} landmarks beyond the edge of the map are not shown.`);
  panel.append(element('p', {}, notes.join(' ')));
}

function addScale(map, about) {
  const bar = element('span'), text = document.createTextNode('');
  document.getElementById('scale').append(text, bar);
  const update = () => {
    const perPixel = metresPerPixel(about, map.getCenter().lat, map.getZoom());
    const metres = roundLength(130 * perPixel);
    text.textContent = lengthText(metres);
    bar.style.width = `${metres / perPixel}px`;
  };
  map.on('move', update);
  update();
}

function addPopups(map, about) {
  const layers = about.types.map(type => type.name);
  const nearest = point => {
    const reach = 6;
    const found = map.queryRenderedFeatures([[point.x - reach, point.y - reach], [point.x + reach, point.y + reach]], {layers});
    const away = one => {
      const at = map.project(one.geometry.coordinates);
      return Math.hypot(at.x - point.x, at.y - point.y);
    };
    return found.sort((a, b) => away(a) - away(b))[0];
  };
  const areas = about.shapes.map(layer => layer.name + '_area');
  const areaAt = point => areas.length ? map.queryRenderedFeatures(point, {layers: areas})[0] : undefined;
  const popupAt = (position, content) => new maplibregl.Popup({maxWidth: '320px'}).setLngLat(position)
    .setDOMContent(content).addTo(map);
  map.on('click', event => {
    const found = nearest(event.point);
    if (!found) {
      const area = areaAt(event.point);
      const layer = area && about.shapes.find(one => one.name === area.sourceLayer);
      if (layer) popupAt(event.lngLat, shapeDetails(layer, area.properties));
      return;
    }
    const type = about.types.find(one => one.name === found.sourceLayer);
    popupAt(found.geometry.coordinates, details(about, type, found.properties));
  });
  const output = document.getElementById('position');
  map.on('mousemove', event => {
    output.textContent = positionText(about, event.lngLat);
    map.getCanvas().style.cursor = nearest(event.point) || areaAt(event.point) ? 'pointer' : '';
  });
}

async function start() {
  if (location.protocol === 'file:')
    return problem('Browsers read no map tiles from the disk. Serve this folder, for example with ', element('code', {},
      'python3 -m http.server'), ', and open http://localhost:8000.');
  if (!window.maplibregl || !window.pmtiles)
    return problem('The map library is missing, or is not the version that this page was made for. Fetch it once, in the folder of this page: ',
      element('code', {}, 'sh fetch-maplibre lib'));
  const style = await (await fetch('style.json')).json();
  const about = style.metadata.waymark;
  const protocol = new pmtiles.Protocol();
  for (const file of ['landmarks.pmtiles', 'terrain.pmtiles', 'shapes.pmtiles']) protocol.add(new pmtiles.PMTiles(new ArchiveSource(file)));
  maplibregl.addProtocol('pmtiles', async (request, abort) => {
    const answer = await protocol.tile(request, abort);
    // A tile of heights without data would count as loading for ever.
    if (answer.data === null) throw new Error(NO_TILE);
    return answer;
  });
  if (about.terrain) style.sources.terrain_mesh = {...style.sources.terrain, ...meshSource(about)};
  const map = new maplibregl.Map({container: 'map', style, bounds: about.bounds, fitBoundsOptions: {
      padding: {top: 60, bottom: 60, right: 60, left: Math.min(310, innerWidth / 3)}, maxZoom: 21},
    maxZoom: 24, maxPitch: 80, hash: true, attributionControl: false, renderWorldCopies: !about.plane});
  map.addControl(new maplibregl.NavigationControl({visualizePitch: true}));
  map.on('error', event => {
    if (event.error?.message !== NO_TILE) console.error(event.error ? event.error.message : event);
  });
  const state = {map, about, isDrawn: false, ready: () => state.isDrawn && map.loaded()};
  map.on('idle', () => { state.isDrawn = true; });
  map.on('movestart', () => { state.isDrawn = false; });
  map.on('load', () => {
    addPanel(map, about);
    addScale(map, about);
    addPopups(map, about);
  });
  window.waymark = state;
}

start().catch(error => problem(String(error)));
