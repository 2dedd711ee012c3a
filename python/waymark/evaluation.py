# SPDX-License-Identifier: Apache-2.0
"""Evaluation: landmarks and tracks against the truth."""

import json
import os

from . import _waymark
from ._call import call, keywords
from ._describe import takes
from .maps import Map


def _path(result):
    return result.path if isinstance(result, Map) else result


@takes("evaluate_landmarks")
def evaluate(result, truth, *, progress=None, **options):
    """Compares a map or table of landmarks with the truth, as `waymark evaluate landmarks --format json`.

    Returns scores by type. options: ignore, type, by, tolerance, min_diameter, ...
    """
    given = keywords(result=_path(result), truth=_path(truth), **options)
    return json.loads(call(_waymark.evaluate_landmarks, given, progress=progress))


@takes("evaluate_track")
def evaluate_track(track, truth, *, drive=(), **options):
    """Compares a track file with a log or track that has the truth, as `waymark evaluate track --format json`.

    drive: more pairs (track, truth), whose summary is then returned. also: more tracks of the picture, NAME=TRACK.
    """
    given = keywords(track=track, truth=truth, map=_path(options.pop("map", None)), **options)
    more = [f"{os.fspath(one)}={os.fspath(log)}" for one, log in drive]
    return json.loads(_waymark.evaluate_track(given, more))
