# SPDX-License-Identifier: Apache-2.0
"""Waymark: semantic navigation maps from elevation models, imagery and laser data.

    import waymark
    tops = waymark.open("alps.gpkg").landmarks("mountain_top", min_prominence=300)

Each function is a command of the program and gives the same results; docs/reference/python.md lists them.
"""

from . import stages
from ._waymark import version as _version
from .detection import (
    detect, find_buildings, find_craters, find_craters_in_dem, find_mountain_tops, find_rocks, find_trees,
    image_detectors, load_plug_in, map_images)
from .errors import EnvironmentError, Error, InputError, OutputError, UnitsFailed, UsageError, Warning
from .evaluation import evaluate, evaluate_track
from .forest import inventory
from .localization import Localization, localize, localize_methods, localize_settings
from .mapping import Run, merge, run, simulate
from .maps import Feature, LandmarkType, Map, open, read_map
from .planning import hazards, route
from .publishing import web
from .reconstruction import reconstruct

__version__ = _version.removeprefix("waymark ").split()[0]
__all__ = [
    "EnvironmentError", "Error", "Feature", "InputError", "LandmarkType", "Localization", "Map", "OutputError", "Run",
    "UnitsFailed", "UsageError", "Warning", "detect", "evaluate", "evaluate_track", "find_buildings", "find_craters",
    "find_craters_in_dem", "find_mountain_tops", "find_rocks", "find_trees", "hazards", "image_detectors", "inventory",
    "load_plug_in", "localize", "localize_methods", "localize_settings", "map_images", "merge", "open", "read_map",
    "reconstruct", "route", "run", "simulate", "stages", "web",
]
