# SPDX-License-Identifier: Apache-2.0
"""Evaluation: landmarks and tracks against the truth."""

import json

from . import _waymark
from ._call import call, keywords
from .maps import Map


def _path(result):
    return result.path if isinstance(result, Map) else result


def evaluate(result, truth, *, progress=None, **options):
    """Compares a map or table of landmarks with the truth, as `waymark evaluate landmarks --format json`.

    Returns scores by type. options: ignore, type, match_by, max_distance, min_tolerance, min_diameter, size_edges.
    """
    given = keywords(result=_path(result), truth=_path(truth), **options)
    return json.loads(call(_waymark.evaluate_landmarks, given, progress=progress))


def evaluate_track(track, truth, **options):
    """Compares a track file with a log or track that has the truth, as `waymark evaluate track --format json`.

    options: align, log_format, robot, max_gap, picture, map, also.
    """
    return json.loads(_waymark.evaluate_track(keywords(track=track, truth=truth, map=_path(options.pop("map", None)),
                                                       **options)))
