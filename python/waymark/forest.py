# SPDX-License-Identifier: Apache-2.0
"""Forests: the trees of a map counted by stand."""

import json

from . import _waymark, errors
from ._call import call, keywords
from ._describe import takes
from .maps import Map


@takes("inventory")
def inventory(map, stands=None, *, output=None, progress=None, **options):
    """Counts the trees of a map by stand, as `waymark inventory`; returns a list with a dict for each stand.

    stands is a layer of polygons in any CRS; without it and without `grid` the whole map is one stand. The keys are
    the columns of docs/reference/inventory_table.md, so pandas.DataFrame(waymark.inventory(map)) is the table. An
    unknown number is None. Raises UnitsFailed if some stands have no area; its `result` has the others.
    """
    given = keywords(map=map.path if isinstance(map, Map) else map, stands=stands, output=output, **options)
    rows, left_out = call(_waymark.inventory, given, progress=progress)
    result = json.loads(rows)
    if left_out:
        failed = errors.UnitsFailed(f"{len(left_out)} stands are left out", given.get("stands", ""), left_out[0])
        failed.result = result
        raise failed
    return result
