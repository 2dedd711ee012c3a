# SPDX-License-Identifier: Apache-2.0
"""Publishing: folders that show a map in web browsers."""

from . import _waymark
from ._call import call, keywords
from ._describe import takes
from .maps import Map


@takes("web")
def web(map, output, *, progress=None, **options):
    """Writes a folder that shows a map in web browsers, as `waymark web`; returns the numbers of its `--format json`:
    landmarks, outside, max_zoom, landmark_tiles, terrain_tiles, areas, area_tiles, has_library.
    """
    return call(_waymark.web, keywords(map=map.path if isinstance(map, Map) else map, output=output, **options),
                progress=progress)
