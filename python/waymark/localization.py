# SPDX-License-Identifier: Apache-2.0
"""Localization: the track of a robot, estimate by estimate."""

from . import _waymark
from ._call import Work, assignments, keywords
from ._describe import takes
from .maps import Map


class Localization:
    """The localization of a log. Iterating yields an estimate (a record) per event while the log plays.

    track: all estimates as a structured array; settings: every setting of the method with its effect, as text. Both
    wait until the log has ended. Leaving the loop early and calling close() stops the work.
    """

    def __init__(self, work):
        self._work = work
        self._rows = iter(work)
        self._ended = False

    def __iter__(self):
        yielded = 0
        for rows in self._rows:
            yielded += len(rows)
            yield from rows
        self._ended = True
        # Methods that estimate the whole track at once have no rows before the end.
        yield from self._work.result[0][yielded:]

    def _finish(self):
        if not self._ended:
            for _ in self:
                pass
        return self._work.result

    @property
    def track(self):
        return self._finish()[0]

    @property
    def settings(self):
        return self._finish()[1]

    def close(self):
        """Stops the localization."""
        self._work.stop()


@takes("localize", but=["set"])
def localize(map, log, *, method="ekf", settings: "_Settings" = None, start=None, progress=None, **options):
    """Follows a robot through a map by its log, as `waymark localize`; returns a Localization.

    map is a Map or a file ("none": without a map). start is (x, y, yaw) in metres and radians, "truth" or "none".
    settings: {"option": value} of the method, see `localize_settings`. options: output, sensor, seed,
    use_identities, log_format, dem, write_map, ...
    """
    if start is not None and not isinstance(start, str):
        start = ",".join(repr(float(one)) for one in start)
    given = keywords(map=map.path if isinstance(map, Map) else map, log=log, method=method, start=start,
                     set=assignments(settings or {}), **options)
    return Localization(Work(_waymark.localize, given, progress=progress, watch=True))


def localize_methods():
    """Returns the names of the methods."""
    return _waymark.localize_methods()


def localize_settings(method="ekf"):
    """Returns {setting: (value, effect)} of a method."""
    lines = (line.partition("=") for line in _waymark.localize_settings(method).splitlines())
    return {name.strip(): tuple(rest.partition("  ")[::2]) for name, _, rest in lines}
