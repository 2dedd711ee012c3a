# SPDX-License-Identifier: Apache-2.0
"""Detectors: rocks, craters and trees in images; mountain tops, craters, trees and buildings in heights."""

import csv
import difflib
import io
import json
import os
import tempfile

import numpy as np

from . import _waymark
from ._arrays import image_path, raster_files
from ._call import call, keywords
from ._describe import takes
from .mapping import run


def _table(text):
    header, *rows = csv.reader(io.StringIO(text))
    table = np.empty(len(rows), dtype=[(name, np.float64) for name in header])
    for i, row in enumerate(rows):
        table[i] = tuple(float(cell) if cell else np.nan for cell in row)
    return table


def load_plug_in(file):
    """Loads a shared library with landmark types, stages and detectors, as `waymark --plugin FILE.so` does.

    Load it before anything else: no other thread may use the package meanwhile. It stays loaded.
    """
    _waymark.load_plug_in(os.fspath(file))


def image_detectors():
    """Returns the detectors of `detect` by name: {"rocks": {"summary": ..., "type": ..., "methods": ...}, ...}.

    methods has the record that each reads, "image" or "heights"; settings the description of each of its own.
    """
    return _waymark.image_detectors()


@takes("detect")
def detect(kind, image, *, progress=None, **options):
    """Returns the objects of one kind, a name of `image_detectors()`, in an image as a structured array.

    image is a file or an array: (rows, columns) or (rows, columns, bands). The columns are those of
    docs/reference/detection_table.md: pixels, and metres where the pixel size is known. The options are those of
    `waymark detect`, with underscores.
    """
    path, kept = image_path(image)
    table, _ = call(_waymark.detect, keywords(kind=kind, image=path, **options), progress=progress)
    del kept
    return _table(table)


@takes("detect", but=["kind"])
def find_rocks(image, *, progress=None, **options):
    """Returns the rocks of an image: see `detect`. Heights need gsd and sun_elevation."""
    return detect("rocks", image, progress=progress, **options)


@takes("detect", but=["kind"])
def find_craters(image, *, progress=None, **options):
    """Returns the craters of an image: see `detect`."""
    return detect("craters", image, progress=progress, **options)


def _with_options(job, options):
    """Sets each option in the only stage of the job that has it."""
    for name, value in options.items():
        stages = [stage for stage in job["stages"] if name in stage]
        if len(stages) > 1:
            names = ", ".join(stage["stage"] for stage in stages)
            raise TypeError(f"'{name}' is an option of several stages ({names}): use waymark.run with settings")
        if not stages:
            known = [known for stage in job["stages"] for known in stage if known != "stage"]
            near = difflib.get_close_matches(name, known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(dict.fromkeys(known))}"
            raise TypeError(f"there is no option '{name}'; {hint}")
        stages[0][name] = value
    return job


def _shortcut(command, files, canopy, output, progress, options, without=()):
    job = json.loads(_waymark.shortcut_job(command, files, canopy))
    job["stages"] = [stage for stage in job["stages"] if stage["stage"] not in without]
    _with_options(job, options)
    if output is not None:
        return run(job, output, progress=progress).map
    with tempfile.TemporaryDirectory(prefix="waymark_") as folder:
        return run(job, os.path.join(folder, "map.gpkg"), progress=progress).map.landmarks(_FOUND[command])


_FOUND = {"peaks": "mountain_top", "craters": "crater", "trees": "tree", "buildings": "building"}


def find_mountain_tops(dem, *, output=None, transform=None, crs=None, cell=1.0, progress=None, **options):
    """Returns the mountain tops of a DEM with exact prominence and isolation, as `waymark peaks`.

    dem is an array, a file or a list of them. An array takes `transform` and `crs` as rasterio has them; without a
    CRS it is in metres, with square cells of the side `cell`. With `output` the map is written and returned as a Map,
    else the landmarks as a structured array. Options: min_prominence, min_isolation, nodata, base, ...
    """
    with raster_files(dem, transform, crs, cell) as files:
        return _shortcut("peaks", files, {}, output, progress, _crs_of_array(options, crs, dem))


def find_craters_in_dem(dem, *, output=None, transform=None, crs=None, cell=1.0, progress=None, **options):
    """Returns the craters of a DEM, as `waymark craters`; arguments as for `find_mountain_tops`."""
    with raster_files(dem, transform, crs, cell) as files:
        return _shortcut("craters", files, {}, output, progress, _crs_of_array(options, crs, dem))


def find_trees(chm=None, *, dsm=None, dtm=None, las=None, flights=None, crowns=None, output=None, transform=None,
               crs=None, cell=1.0, progress=None, **options):
    """Returns the trees of a canopy, as `waymark trees`.

    chm is a canopy height model (array, file or list), or else give dsm and dtm, or las with or without dtm. Other
    arguments as for `find_mountain_tops`. Options: preset, min_height, allometry, species, ...
    """
    given = {name: raster for name, raster in (("chm", chm), ("dsm", dsm), ("dtm", dtm)) if raster is not None}
    canopy = keywords(las=las, flights=flights, crowns=crowns)
    options = _crs_of_array(options, crs, *given.values())
    return _find_in_canopy("trees", given, canopy, (transform, crs, cell), output, progress, options)


def find_buildings(las=None, *, dsm=None, dtm=None, chm=None, poles=True, trees=False, output=None, transform=None,
                   crs=None, cell=1.0, progress=None, **options):
    """Returns the buildings of a town, as `waymark buildings`; walls, corners, poles and outlines are in its map.

    las is a file of laser points, a folder or a list, with or without dtm; or else give dsm and dtm, or chm. Without
    `poles` none are searched; with `trees` those that are not on roofs are mapped, too. Other arguments as for
    `find_mountain_tops`. Options: min_area, max_extent, roughness, overhang, ...
    """
    given = {name: raster for name, raster in (("chm", chm), ("dsm", dsm), ("dtm", dtm)) if raster is not None}
    without = (() if poles else ("poles_from_points",)) + (() if trees else ("trees_from_canopy", "trees_of_survey"))
    options = _crs_of_array(options, crs, *given.values())
    return _find_in_canopy("buildings", given, keywords(las=las), (transform, crs, cell), output, progress, options,
                           without)


def _find_in_canopy(command, given, canopy, place, output, progress, options, without=()):
    if not given:
        return _shortcut(command, [], canopy, output, progress, options, without)
    name, raster = given.popitem()
    with raster_files(raster, *place) as files:
        return _find_in_canopy(command, given, {**canopy, name: files}, place, output, progress, options, without)


@takes("images", more=True)
def map_images(images, output, *, find="rocks,craters", progress=None, **options):
    """Maps the rocks and craters that images show, as `waymark images`; returns a Run.

    images: files, patterns or folders. Options of the stage load_images: camera_format, sun_azimuth, gsd, ...
    """
    files = {name: options.pop(name) for name in _waymark.images_keywords() if name in options}
    job = json.loads(_waymark.image_job(keywords(images=images, **files), find))
    return run(_with_options(job, options), output, progress=progress)


def _crs_of_array(options, crs, *rasters):
    """An array without a CRS is local; files keep their own unless `crs` is given."""
    if crs is not None:
        return {**options, "crs": str(crs)}
    if any(isinstance(raster, np.ndarray) for raster in rasters):
        return {**options, "crs": "local"}
    return options
