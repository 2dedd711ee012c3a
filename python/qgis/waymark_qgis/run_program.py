# SPDX-License-Identifier: Apache-2.0
"""A run of the program with progress and an end on request."""

import json
import subprocess
import threading
from dataclasses import dataclass


@dataclass(frozen=True)
class Finished:
    code: int
    out: str        # standard output
    errors: str     # what the program said on standard error, without progress
    cancelled: bool = False


# As the program documents them.
EXIT_CODES = {1: "the run failed", 2: "wrong usage or a bad option", 3: "finished, but some units failed"}


def parse_progress(line):
    """Returns (stage, part done in [0, 1]) of a line of `--progress json`; None for other lines."""
    if not line.startswith("{"):
        return None
    try:
        said = json.loads(line)
        total = float(said["total"])
        return said["stage"], min(1.0, float(said["done"]) / total) if total > 0 else 0.0
    except (ValueError, LookupError, TypeError):
        return None


def run(program, words, progress=None, message=None, cancelled=None, environment=None):
    """Runs the program to its end; kills it once `cancelled()` is true.

    progress(stage, part) and message(line) are called in the thread of the caller.
    """
    process = subprocess.Popen([program, *words, "--progress", "json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               stdin=subprocess.DEVNULL, encoding="utf-8", errors="replace", env=environment)
    out = []
    reader = threading.Thread(target=lambda: out.append(process.stdout.read()), daemon=True)
    reader.start()
    ended = threading.Event()
    was_cancelled = threading.Event()

    def watch():
        while not ended.wait(0.1):
            if cancelled():
                was_cancelled.set()
                process.terminate()
                if not ended.wait(3):
                    process.kill()
                return

    watcher = threading.Thread(target=watch, daemon=True) if cancelled else None
    if watcher:
        watcher.start()
    errors = []
    for line in process.stderr:
        line = line.rstrip("\n")
        step = parse_progress(line)
        if step is None:
            errors.append(line)
            if message and line:
                message(line)
        elif progress:
            progress(*step)
    code = process.wait()
    ended.set()
    reader.join()
    if watcher:
        watcher.join()
    return Finished(code, "".join(out), "\n".join(errors), was_cancelled.is_set())
