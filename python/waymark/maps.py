# SPDX-License-Identifier: Apache-2.0
"""Maps: landmarks as structured arrays and GeoDataFrames."""

import os
import warnings
from dataclasses import dataclass

import numpy as np

from . import _picture, _waymark, errors
from ._call import keywords
from ._describe import takes

_KINDS = {"real": np.float64, "integer": np.int64}


@dataclass(frozen=True)
class Feature:
    """A feature of a landmark type. Values outside [min, max] are implausible."""

    name: str
    unit: str
    scale: str
    min: float
    max: float
    summary: str


@dataclass(frozen=True)
class LandmarkType:
    """A landmark type of a map: its features, and (name, unit, summary) of every column."""

    name: str
    summary: str
    count: int
    colour: str
    features: tuple
    columns: tuple


def _structured(columns):
    arrays = {}
    for name, kind, values in columns:
        text = kind == "text"
        arrays[name] = np.array(values, dtype=np.str_) if text else values.astype(_KINDS[kind], copy=False)
        if text and not arrays[name].dtype.itemsize:
            arrays[name] = arrays[name].astype("U1")
    rows = len(next(iter(arrays.values())))
    table = np.empty(rows, dtype=[(name, values.dtype) for name, values in arrays.items()])
    for name, values in arrays.items():
        table[name] = values
    return table


def _named(wkt):
    """Returns "EPSG:32632" for a CRS that has such a code, as geopandas prints what it was given."""
    import pyproj

    code = pyproj.CRS.from_user_input(wkt).to_authority(auth_name="EPSG", min_confidence=100)
    return ":".join(code) if code else wkt


class Map:
    """A map file, opened for reading. The file is not changed, and nothing of it stays open."""

    def __init__(self, path):
        self.path = os.fspath(path)
        about = _waymark.describe_map(self.path)
        self.crs = about["crs"]
        self.crs_name = about["crs_id"]
        self.is_local = about["local"]
        self.schema_version = about["schema_version"]
        self.types = {}
        for one in about["types"]:
            one["features"] = tuple(Feature(**feature) for feature in one["features"])
            one["columns"] = tuple(one["columns"])
            self.types[one["name"]] = LandmarkType(**one)

    def __len__(self):
        return sum(one.count for one in self.types.values())

    def __getitem__(self, type):
        return self.landmarks(type)

    def __iter__(self):
        """Yields the names of the types that the map has landmarks of."""
        return (name for name, one in self.types.items() if one.count)

    def __contains__(self, type):
        """Whether the map has landmarks of a type."""
        return type in self.types and self.types[type].count > 0

    def __repr__(self):
        counts = ", ".join(f"{one.count} {name}" for name, one in self.types.items() if one.count)
        return f"<waymark.Map {self.path!r}: {counts or 'no landmarks'}, {self.crs_name}>"

    def _repr_html_(self):
        return _picture.map_as_html(self)

    def _query(self, types, conditions):
        known = _waymark.query_keywords()
        given, bounds = {}, {"min": [], "max": []}
        for name, value in conditions.items():
            side, _, column = name.partition("_")
            if name not in known and side in bounds and column:
                bounds[side].append(f"{column}={float(value)!r}")
            else:
                given[name] = value
        for side, texts in bounds.items():
            if texts:
                given[side] = texts
        found = _waymark.query(self.path, keywords(types=types, **given))
        for reason in found["why_empty"]:
            warnings.warn(reason, errors.Warning, stacklevel=3)
        return found

    @takes("query", more=True)
    def query(self, types=None, **conditions):
        """Returns a structured array per type: {"rock": array, ...}. 

        min_FEATURE and max_FEATURE bound any number of the landmarks: min_prominence=300.
        """
        if isinstance(types, str):
            types = [types]
        found = self._query(types, conditions)
        return {name: _structured(columns) for name, columns in found["types"].items()}

    @takes("query", but=["types"], more=True)
    def landmarks(self, type=None, **conditions):
        """Returns the landmarks of one type as a structured array with the columns of `waymark query`.

        type may be left out if the map has landmarks of one type only. Unknown numbers are NaN.
        min_FEATURE and max_FEATURE bound any number of the landmarks: min_prominence=300.
        """
        type = type or self._only_type()
        return self.query([type], **conditions)[type]

    @takes("query", but=["types"], more=True)
    def to_geopandas(self, type=None, **conditions):
        """Returns the landmarks of one type as a GeoDataFrame of points, indexed by uid."""
        try:
            import geopandas
        except ImportError as missing:
            raise ImportError("to_geopandas needs geopandas: apt install python3-geopandas") from missing
        import pandas

        type = type or self._only_type()
        found = self._query([type], conditions)
        table = _structured(found["types"][type])
        frame = pandas.DataFrame({name: table[name] for name in table.dtype.names if name not in ("x", "y", "z")})
        points = geopandas.points_from_xy(table["x"], table["y"], table["z"])
        return geopandas.GeoDataFrame(frame.set_index("uid"), geometry=points, crs=_named(found["crs"]))

    def _only_type(self):
        filled = [name for name, one in self.types.items() if one.count]
        if len(filled) != 1:
            raise TypeError(f"name the landmark type: the map has {', '.join(filled) or 'no landmarks'}")
        return filled[0]


def open(path):
    """Opens a map file. Raises waymark.Error if it is missing, damaged or of a newer version."""
    return Map(path)


read_map = open
