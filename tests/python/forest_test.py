# SPDX-License-Identifier: Apache-2.0
import json

import pytest
from conftest import SOURCE, program

import waymark


@pytest.fixture(scope="module")
def forest(tmp_path_factory):
    folder = tmp_path_factory.mktemp("forest")
    waymark.simulate(SOURCE / "sample_data/forest/scenario.json", folder)
    waymark.find_trees(folder / "chm.tif", output=folder / "trees.gpkg")
    return folder


def test_an_inventory_has_the_rows_and_files_of_the_program(forest, tmp_path):
    words = ["--stands", forest / "stands.geojson", "--report"]
    printed = json.loads(program("inventory", forest / "trees.gpkg", *words, tmp_path / "program.html", "-o",
                                 tmp_path / "program.csv", "--format", "json"))
    rows = waymark.inventory(waymark.open(forest / "trees.gpkg"), forest / "stands.geojson",
                             output=tmp_path / "python.csv", report=tmp_path / "python.html")
    assert rows == printed and len(rows) == 3
    assert all(row["stems_per_ha"] > row["stems_per_ha_detected"] > 0 for row in rows)
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    assert (tmp_path / "python.html").exists()
    assert len(waymark.inventory(forest / "trees.gpkg")) == 1


def test_stands_without_area_are_an_error_with_the_others(forest, tmp_path):
    stands = json.loads((forest / "stands.geojson").read_text())
    corner = stands["features"][0]["geometry"]["coordinates"][0][0]
    stands["features"][0]["geometry"] = {"type": "Point", "coordinates": corner}
    (tmp_path / "stands.geojson").write_text(json.dumps(stands))
    with pytest.raises(waymark.UnitsFailed) as failed:
        waymark.inventory(forest / "trees.gpkg", tmp_path / "stands.geojson")
    assert len(failed.value.result) == 2 and failed.value.exit_code == 3
