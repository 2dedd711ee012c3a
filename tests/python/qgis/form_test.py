# SPDX-License-Identifier: Apache-2.0
"""Forms and command lines, without QGIS."""
import subprocess

import pytest
from conftest import PROGRAM
from waymark_qgis import command_form, edit_words


def kinds(command):
    return {one.name: one.kind for one in command_form.parameters(command)}


def test_every_command_has_a_form(declared):
    names = [one["name"] for one in command_form.commands(declared)]
    assert {"peaks", "detect", "query", "edit", "web", "route"} <= set(names)
    assert not {"help", "man", "completion", "types"} & set(names)
    for one in command_form.commands(declared):
        for parameter in command_form.parameters(one):
            assert parameter.kind in {"file", "files", "text", "texts", "choice", "integer", "number", "numbers", "flag",
                                      "output_file", "output_folder"}, parameter
            assert parameter.name.isidentifier() and parameter.label


def test_arguments_become_fields_of_their_kind(command):
    peaks, query = kinds(command("peaks")), kinds(command("query"))
    assert peaks["DEM"] == "files"
    assert peaks["OUTPUT"] == "output_file"
    assert peaks["NODATA"] == "choice"
    assert query["MAP_GPKG"] == "file" and query["NEAR"] == "numbers" and query["LIMIT"] == "integer"
    assert kinds(command("web"))["OUTPUT"] == "output_folder"
    assert kinds(command("reconstruct"))["OUTPUT"] == "output_folder"
    outputs = [one for one in command_form.parameters(command("peaks")) if one.kind == "output_file"]
    assert command_form.file_filter(outputs[0]) == "GeoPackage (*.gpkg);;All files (*)"


def test_values_become_words(command):
    words = command_form.command_line(command("peaks"), {
        "DEM": ["a.tif", "b c.tif"], "OUTPUT": "out.gpkg", "MIN_PROMINENCE": 60, "NODATA": "fill", "AOI": None})
    assert words[:3] == ["peaks", "a.tif", "b c.tif"]
    assert sorted(words[3:]) == ["--min-prominence=60", "--nodata=fill", "--output=out.gpkg"]
    words = command_form.command_line(command("query"), {
        "MAP_GPKG": "-odd.gpkg", "NEAR": "-7.5, 46  5000", "TYPE": "rock\n\n crater \n", "LIMIT": 3})
    assert words[:2] == ["query", "./-odd.gpkg"]
    near = words.index("--near")
    assert words[near:near + 4] == ["--near", "-7.5", "46", "5000"]
    assert {"--type=rock", "--type=crater", "--limit=3"} <= set(words)


def test_flags_are_given_or_left_out(command):
    flag = next(one for one in command_form.parameters(command("run")) if one.kind == "flag")
    assert flag.option in command_form.command_line(command("run"), {flag.name: True})
    assert flag.option not in command_form.command_line(command("run"), {flag.name: False})


@pytest.mark.parametrize("given", ["1 2", "1 2 3 4", "one 2 3"])
def test_a_list_that_is_no_list_of_numbers_is_refused(command, given):
    with pytest.raises(ValueError):
        command_form.command_line(command("query"), {"MAP_GPKG": "m.gpkg", "NEAR": given})


def test_the_program_takes_the_words(command, rocks):
    """Negative numbers and repeated options arrive as they were meant."""
    words = command_form.command_line(command("query"), {
        "MAP_GPKG": str(rocks), "BBOX": "-100 -100 15 100", "MIN": "radius=0.6", "FORMAT": "csv"})
    out = subprocess.run([PROGRAM, *words], capture_output=True, encoding="utf-8", check=True).stdout
    assert len(out.splitlines()) == 2 and "b" in out.splitlines()[1].split(",")


def test_edits_are_those_of_the_command(rocks, tmp_path):
    def run(words):
        return subprocess.run([PROGRAM, *words], capture_output=True, encoding="utf-8", check=True).stdout.split()

    map = str(rocks)
    assert run(edit_words.edit(map, "reject", ["a", "b"], "tents")) == ["a", "b"]
    assert len(run(edit_words.add(map, "rock", [(50.0, -60.5)], {"radius": 0.25}))) == 1
    crater = run(edit_words.add(map, "rock", [(10, 0), (0, 10), (-10, 0)]))
    out = subprocess.run([PROGRAM, "query", map, "--near", "0", "0", "1", "--format", "csv"], capture_output=True,
                         encoding="utf-8", check=True).stdout
    assert crater[0] in out and len(out.splitlines()) == 2
    with pytest.raises(ValueError, match="by one point or by three"):
        edit_words.add(map, "rock", [(1, 2), (3, 4)])
