# SPDX-License-Identifier: Apache-2.0
"""Planning: hazard maps, and routes on which a robot can localize itself."""

from . import _waymark
from ._call import call, keywords
from ._describe import takes
from .maps import Map


def _path(map):
    return map.path if isinstance(map, Map) else map


def _position(position):
    return position if isinstance(position, str) else ",".join(repr(float(one)) for one in position)


@takes("route")
def route(map, start, goal, output, *, sensor, via=None, progress=None, **options):
    """Plans a route and writes it to `output`, as `waymark route`.

    start is (x, y) or (x, y, yaw in degrees), goal and each via (x, y), in the map's CRS. One of limit_sigma,
    keep_landmarks and weight says what is wanted. Returns {"routes": [...], "shortest": ..., "lower_bound": ...};
    each route has its length, standard deviations and `stations` as a structured array.
    """
    given = keywords(map=_path(map), start=_position(start), goal=_position(goal), output=output, sensor=sensor,
                     via=[_position(one) for one in via] if via else None, **options)
    return call(_waymark.route, given, progress=progress)


@takes("hazards", but=["input"])
def hazards(map, output, *, progress=None, **options):
    """Writes a hazard map of a map or a DEM, as `waymark hazards`; returns the numbers of its `--format json`: cells by
    class, objects, rock_cover, ... options: vehicle, dem, polygons, nav2, ...
    """
    return call(_waymark.hazards, keywords(input=_path(map), output=output, **options), progress=progress)
