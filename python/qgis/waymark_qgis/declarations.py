# SPDX-License-Identifier: Apache-2.0
"""Declarations of the program's commands: asked of the program once per version, kept, and shipped as a fallback."""

import json
import os
import shutil
import subprocess

SHIPPED = os.path.join(os.path.dirname(__file__), "commands.json")


class DeclarationsMissing(Exception):
    """Neither the program nor a file has the declarations."""


def find_program(setting=""):
    """Returns the path of the program: the environment's WAYMARK, a setting, or the search path; None without one."""
    for name in (os.environ.get("WAYMARK"), setting, "waymark"):
        found = shutil.which(name) if name else None
        if found:
            return found
    return None


def _read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def _ask(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, encoding="utf-8", timeout=30).stdout


def _write(path, text):
    """Replaces a file at once: two instances of QGIS may start together."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    aside = f"{path}.{os.getpid()}"
    with open(aside, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(aside, path)


def load(program, cache_folder, shipped=SHIPPED):
    """Returns (declarations, where they come from: "program", "cache" or "shipped").

    The cache is a file named after size and time of the program, so that another build is asked again. A program that
    fails leaves the shipped ones: the algorithms stay in the toolbox and say what is wrong when they run.
    """
    if program:
        about = os.stat(program)
        cached = os.path.join(cache_folder, f"commands-{about.st_size}-{about.st_mtime_ns}.json")
        try:
            return _read(cached), "cache"
        except (OSError, ValueError):
            pass
        try:
            text = _ask(program, "help", "--format", "json")
            known = json.loads(text)
            known["commands"][0]["arguments"]  # as the plugin reads them
            _write(cached, text)
            return known, "program"
        except (OSError, ValueError, LookupError, TypeError, subprocess.SubprocessError):
            pass
    try:
        return _read(shipped), "shipped"
    except (OSError, ValueError) as problem:
        raise DeclarationsMissing(f"the program waymark is not found, and the plugin is incomplete: {problem}") from problem
