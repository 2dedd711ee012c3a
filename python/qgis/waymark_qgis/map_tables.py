# SPDX-License-Identifier: Apache-2.0
"""What a map says of its layers and of the evidence of a landmark. Reads only: QGIS has the file open."""

import json
import os
import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Sighting:
    """Observation of a landmark. (0, 0) is the centre of the first pixel."""
    source: str
    weight: float
    x: float
    y: float
    column: float = None
    row: float = None
    radius: float = None  # of the landmark's body in pixels, if it is known
    image: str = None     # file, if it is found


def _connect(path):
    return closing(sqlite3.connect(Path(os.path.abspath(path)).as_uri() + "?mode=ro", uri=True))


def is_map(path):
    """Returns whether a file is a map of Waymark."""
    try:
        with _connect(path) as map:
            return bool(map.execute("SELECT 1 FROM sqlite_master WHERE name = 'waymark_schema'").fetchall())
    except sqlite3.Error:
        return False


def styled_layers(path):
    """Lists the layers of a map that have a style and rows: landmark types first, as the map orders them."""
    with _connect(path) as map:
        types = [row[0] for row in map.execute("SELECT name FROM waymark_type ORDER BY rowid")]
        styled = {row[0] for row in map.execute("SELECT f_table_name FROM layer_styles")}
        spatial = [row[0] for row in map.execute(
            "SELECT table_name FROM gpkg_contents WHERE data_type = 'features' ORDER BY rowid")]
        found = [name for name in [*types, *(one for one in spatial if one not in types)]
                 if name in styled and name in spatial and name != "landmark"]
        return [name for name in found if map.execute(f'SELECT 1 FROM "{name}" LIMIT 1').fetchall()]


def _images(map, folder):
    """Returns the files of the images by name: where the runs read them, or beside the map."""
    files = {}
    for (inputs,) in map.execute("SELECT inputs FROM run ORDER BY id"):
        for one in json.loads(inputs):
            recorded = one["path"]
            for path in (recorded, os.path.join(folder, recorded), os.path.join(folder, os.path.basename(recorded))):
                if os.path.isfile(path):
                    name = os.path.basename(recorded)
                    files[name] = files[os.path.splitext(name)[0]] = path
                    break
    return files


def evidence(path, uid):
    """Returns the accepted sightings of a landmark, the best first."""
    with _connect(path) as map:
        files = _images(map, os.path.dirname(os.path.abspath(path)))
        sizes = dict(map.execute("SELECT name, gsd FROM image"))
        rows = map.execute("SELECT source, weight, x, y, pixel_x, pixel_y, features FROM observation "
                           "WHERE uid = ? AND rejected IS NULL ORDER BY weight DESC, id", (uid,)).fetchall()
    found = []
    for source, weight, x, y, column, row, features in rows:
        values, gsd = json.loads(features), sizes.get(source)
        size = values.get("radius") or (values["crown_diameter"] / 2 if values.get("crown_diameter") else None)
        found.append(Sighting(source, weight, x, y, column, row, size / gsd if size and gsd else None,
                              files.get(source) if column is not None else None))
    return found


def cut_out_window(sighting, columns, rows, min_half=24):
    """Returns (column, row, width, height) of the part of an image about a sighting: three radii, at least
    `min_half` pixels to each side, inside the image; None if the sighting lies outside."""
    half = max(min_half, 3 * (sighting.radius or 0))
    west, east = max(0, round(sighting.column - half)), min(columns, round(sighting.column + half) + 1)
    north, south = max(0, round(sighting.row - half)), min(rows, round(sighting.row + half) + 1)
    return (west, north, east - west, south - north) if west < east and north < south else None


def read_cut_out(sighting, pixels=160):
    """Returns (bytes of grey or RGB pixels, bands, width, height, window) of the part of an image about a sighting, at
    most `pixels` wide and stretched to full contrast; None if the file cannot be read. Needs GDAL."""
    from osgeo import gdal
    if not sighting.image:
        return None
    image = gdal.Open(sighting.image)
    if image is None:
        return None
    window = cut_out_window(sighting, image.RasterXSize, image.RasterYSize)
    if window is None:
        return None
    bands = 3 if image.RasterCount >= 3 else 1
    scale = min(1.0, pixels / max(window[2:]))
    width, height = max(1, round(window[2] * scale)), max(1, round(window[3] * scale))
    content = [image.GetRasterBand(band + 1).ReadRaster(*window, width, height, gdal.GDT_Float32) for band in range(bands)]
    return stretch(content, width * height), bands, width, height, window


def stretch(bands, count):
    """Returns interleaved bytes from the 2nd to the 98th percentile of all bands; the bands are 32-bit floats."""
    import array
    values = [array.array("f", band) for band in bands]
    known = sorted(value for band in values for value in band if value == value)
    low, high = (known[int(0.02 * (len(known) - 1))], known[int(0.98 * (len(known) - 1))]) if known else (0, 1)
    factor = 255 / (high - low) if high > low else 0
    out = bytearray(len(values) * count)
    for number, band in enumerate(values):
        out[number::len(values)] = bytes(
            max(0, min(255, int((value - low) * factor))) if value == value else 0 for value in band)
    return bytes(out)
