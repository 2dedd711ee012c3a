# SPDX-License-Identifier: Apache-2.0
"""Keywords, docstrings and stubs follow the declarations of the C++ library."""

import ast
import inspect
import re
import subprocess
import sys

import pytest
from conftest import SOURCE, program

import waymark

# What Python spells otherwise than the command; None: it has no use for it.
SPELLED = {
    "detect": {"format": None},
    "run": {"set": "settings", "shard": None, "format": None, "confined": None},
    "localize": {"ids": "use_identities", "set": "settings", "settings": None, "crs": "in_map_crs",
                 "format": None},
    "route": {"from": "start", "to": "goal", "ids": "identities_known", "format": None},
    "hazards": {"format": None},
    "inventory": {"memory": "max_trees", "trees-at-once": None, "format": None},
    "reconstruct": {"output": "folder", "map-landmarks": "map", "map": "map_image", "format": None},
    "simulate": {"output": "folder", "format": None},
    "evaluate": {"format": None},
}


def test_descriptions_and_stubs_are_current():
    done = subprocess.run([sys.executable, SOURCE / "scripts/update-python", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_python_and_name_what_the_package_offers():
    tree = ast.parse((SOURCE / "python/waymark/__init__.pyi").read_text())
    named = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    assert set(waymark.__all__) - {"stages"} <= named
    stages = ast.parse((SOURCE / "python/waymark/stages.pyi").read_text())
    functions = {node.name: [one.arg for one in node.args.kwonlyargs] for node in stages.body
                 if isinstance(node, ast.FunctionDef) and node.name != "describe"}
    assert sorted(functions) == waymark.stages.__all__


def test_defaults_are_those_of_the_library():
    parameters = inspect.signature(waymark.localize).parameters
    assert parameters["seed"].default == 1 and parameters["method"].default == "ekf"
    assert inspect.signature(waymark.route).parameters["cell"].default == 2
    assert "landmarks less probable than this" in waymark.localize.__doc__
    assert "options" not in parameters and "set" not in parameters


def test_the_option_of_merge_is_a_keyword():
    assert "--output" in program("merge", "--help")
    assert "output" in inspect.signature(waymark.merge).parameters


@pytest.mark.parametrize("command", SPELLED)
def test_options_of_the_command_are_keywords(command):
    words = program(command, "--help").split("\nOptions:\n")[1].split("Options of every command:")[0]
    options = set(re.findall(r"^  (?:-\w, )?--([a-z0-9-]+)", words, re.M))
    assert len(options) > 3
    keywords = set(inspect.signature(getattr(waymark, command)).parameters)
    if command == "evaluate":  # of landmarks and of tracks
        keywords |= set(inspect.signature(waymark.evaluate_track).parameters)
    expected = {SPELLED[command].get(option, option.replace("-", "_")) for option in options} - {None}
    assert expected - keywords == set()
