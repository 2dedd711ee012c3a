# SPDX-License-Identifier: Apache-2.0
"""Jobs: from files to a map; and simulated sites with known truth."""

import json
import os
import tempfile
from dataclasses import dataclass

from . import _waymark, errors
from ._call import assignments, call, keywords
from ._describe import takes
from .maps import Map


@dataclass(frozen=True)
class Run:
    """What a job did: landmarks written by type, the report of each stage, and the map if one was written."""

    landmarks: dict
    report: dict
    map: Map = None

    def _repr_html_(self):
        return self.map._repr_html_() if self.map else None


@takes("run")
def run(job, output=None, *, settings=None, folder=None, progress=None, **options):
    """Runs a job and returns a Run; `output` is the map to write.

    job is a job file or a dict {"name": ..., "stages": [...]}, made by hand or with waymark.stages. Relative paths of
    a dict start at `folder` (default: the current one). settings: {"stage.option": value}. options: work, stage,
    threads, rerun_from, check, with_dem, sensor. progress(stage, done, total, rate) is called now and then.
    Raises UnitsFailed if some units failed.
    """
    given = keywords(output=output, **options)
    settings = assignments(settings or {})
    if isinstance(job, dict):
        with tempfile.TemporaryDirectory(prefix="waymark_") as room:
            file = os.path.join(room, "job.json")
            with open(file, "w", encoding="utf-8") as text:
                json.dump(job, text, default=os.fspath)
            done = call(_waymark.run, file, os.path.abspath(folder or "."), settings, given, progress=progress)
    else:
        done = call(_waymark.run, os.fspath(job), os.fspath(folder or ""), settings, given, progress=progress)
    report, landmarks, written, exit_code = done
    result = Run(landmarks, json.loads(report), Map(output) if written else None)
    if exit_code:
        _raise(result, exit_code)
    return result


def _raise(result, exit_code):
    failures = result.report.get("failures", [])
    first = failures[0]["message"] if failures else ""
    kind = errors.UsageError if exit_code == 2 else errors.UnitsFailed
    failed = kind(f"{len(failures)} units of the job failed", failures[0]["unit"] if failures else "", first)
    failed.result = result
    raise failed


@takes("merge")
def merge(maps, output, *, progress=None, **options):
    """Merges maps of one CRS into one, as `waymark merge`; returns counts: landmarks, fused, identical.

    options: aoi, changes, max_move. With changes also gone, new, moved, unchanged and not_covered, from the first map
    to the second.
    """
    return call(_waymark.merge, keywords(maps=[os.fspath(map) for map in maps], output=output, **options),
                progress=progress)


@takes("simulate")
def simulate(scenario, folder, *, progress=None, **options):
    """Makes a site with its truth in a folder, as `waymark simulate`; returns counts. options: seed, drive_seed,
    drive_only.
    """
    return call(_waymark.simulate, keywords(scenario=scenario, folder=folder, **options), progress=progress)
