# SPDX-License-Identifier: Apache-2.0
"""Declarations and runs of the program, without QGIS."""
import json
import stat
import time

import pytest
from conftest import PROGRAM, SOURCE
from waymark_qgis import declarations, run_program


def script(path, text):
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


def test_declarations_are_asked_once_per_version(tmp_path, declared):
    assert declarations.load(PROGRAM, str(tmp_path / "cache")) == (declared, "program")
    assert declarations.load(PROGRAM, str(tmp_path / "cache")) == (declared, "cache")
    (kept,) = (tmp_path / "cache").iterdir()
    kept.write_text("{")  # a damaged cache is asked again
    assert declarations.load(PROGRAM, str(tmp_path / "cache")) == (declared, "program")


@pytest.mark.parametrize("text", ["exit 1", "echo '[]'", "echo nothing"])
def test_a_program_that_fails_leaves_the_shipped_ones(tmp_path, declared, text):
    shipped = tmp_path / "commands.json"
    shipped.write_text(json.dumps(declared))
    bad = script(tmp_path / "waymark", text)
    assert declarations.load(bad, str(tmp_path / "cache"), str(shipped)) == (declared, "shipped")
    assert declarations.load(None, str(tmp_path / "cache"), str(shipped)) == (declared, "shipped")
    with pytest.raises(declarations.DeclarationsMissing, match="the program waymark is not found"):
        declarations.load(None, str(tmp_path / "cache"), str(tmp_path / "none.json"))


def test_the_program_is_found_by_environment_setting_or_path(tmp_path, monkeypatch):
    here = script(tmp_path / "waymark", "exit 0")
    monkeypatch.setenv("WAYMARK", here)
    assert declarations.find_program("/somewhere/else") == here
    monkeypatch.delenv("WAYMARK")
    assert declarations.find_program(here) == here
    monkeypatch.setenv("PATH", str(tmp_path))
    assert declarations.find_program("") == here
    monkeypatch.setenv("PATH", "")
    assert declarations.find_program("") is None


def test_progress_and_messages_are_separated(tmp_path):
    steps, lines = [], []
    done = run_program.run(PROGRAM, ["peaks", str(SOURCE / "sample_data/jacksboro/dem.tif"), "-o", str(tmp_path / "m.gpkg")],
                           lambda *step: steps.append(step), lines.append)
    assert done.code == 0 and (tmp_path / "m.gpkg").exists()
    assert steps and all(0 <= part <= 1 for _, part in steps) and "find_mountain_tops" in {stage for stage, _ in steps}
    assert lines and not any(line.startswith('{"stage"') for line in lines)


def test_an_error_is_the_programs_own(tmp_path):
    done = run_program.run(PROGRAM, ["peaks", str(tmp_path / "none.tif"), "-o", str(tmp_path / "m.gpkg")])
    assert done.code in (1, 2) and "none.tif" in done.errors


def test_standard_output_larger_than_a_pipe_arrives(tmp_path):
    bad = script(tmp_path / "p", "yes 0123456789 | head -c 300000; echo '{\"stage\": 1}' >&2; echo '{broken' >&2; exit 3")
    done = run_program.run(bad, [])
    assert done.code == 3 and len(done.out) == 300000 and done.errors == '{"stage": 1}\n{broken'


def test_a_run_ends_on_request(tmp_path):
    slow = script(tmp_path / "p", "echo started >&2; exec sleep 60")
    heard = []
    begin = time.monotonic()
    done = run_program.run(slow, [], message=heard.append, cancelled=lambda: bool(heard))
    assert done.cancelled and done.code != 0 and time.monotonic() - begin < 20
