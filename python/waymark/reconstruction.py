# SPDX-License-Identifier: Apache-2.0
"""Reconstruction: heights, orthophoto and landmarks from images."""

from . import _waymark, errors
from ._call import call, keywords
from ._describe import takes


@takes("reconstruct")
def reconstruct(images, folder, *, until="ortho", progress=None, **options):
    """Makes cameras, a DEM and an orthophoto of images in a folder, as `waymark reconstruct`; returns counts.

    until: "poses", "dem" or "ortho". options: cameras, lens, control, marks, dem, crs, cell, map, threads.
    Raises UnitsFailed if some images have no pose or some units of the map failed; what could be made is there.
    """
    last = getattr(_waymark.ReconstructUntil, until, None)
    if last is None:
        raise errors.UsageError(f"until must be poses, dem or ortho, is '{until}'")
    made = call(_waymark.reconstruct, keywords(images=images, folder=folder, until=last, **options), progress=progress)
    if made.pop("exit_code"):
        failed = errors.UnitsFailed(f"{made['failed']} images of {made['failed'] + made['images']} have no pose",
                                    str(folder), "the other images were used")
        failed.result = made
        raise failed
    return made
