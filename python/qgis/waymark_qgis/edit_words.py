# SPDX-License-Identifier: Apache-2.0
"""Command lines of `waymark edit`."""


def edit(map, action, uids=(), reason=""):
    """Returns the words that accept or reject landmarks."""
    return ["edit", map, action, *uids, *([f"--reason={reason}"] if reason else [])]


def add(map, type, points, features=None, reason=""):
    """Returns the words that add a landmark at one point, or by three points of its outline; points in the map's CRS.

    Raises ValueError for another number of points.
    """
    if len(points) == 1:
        where = ["--at", *(repr(float(number)) for number in points[0])]
    elif len(points) == 3:
        where = ["--rim", *(repr(float(number)) for point in points for number in point)]
    else:
        raise ValueError(f"a landmark is added by one point or by three of its outline, not by {len(points)}")
    given = [f"--feature={name}={value!r}" for name, value in (features or {}).items()]
    return ["edit", map, "add", f"--type={type}", *where, *given, *([f"--reason={reason}"] if reason else [])]
