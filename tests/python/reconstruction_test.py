# SPDX-License-Identifier: Apache-2.0
import json

import pytest
from conftest import program

import waymark


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """Two lines of three images that look straight down."""
    folder = tmp_path_factory.mktemp("flight")
    scenario = {"waymark_scenario": 1, "seed": 3, "ground": {"cell": 0.5}, "dem": {"cell": 4},
                "camera": {"columns": 300, "rows": 300, "field_of_view": 60},
                "flights": [{"images": 3, "lines": 2, "line_spacing": 25, "from_east": -25, "to_east": 25,
                             "from_north": 12, "to_north": 12, "from_altitude": 90, "to_altitude": 90,
                             "track_sd": 0.5}]}
    (folder / "scenario.json").write_text(json.dumps(scenario))
    waymark.simulate(folder / "scenario.json", folder / "site")
    return folder / "site"


def test_heights_are_those_of_the_program(flight, tmp_path):
    cameras = flight / "truth/cameras.json"
    stages = []
    made = waymark.reconstruct(flight / "images", tmp_path / "python", cameras=cameras, until="dem",
                               progress=lambda stage, *rest: stages.append(stage))
    program("reconstruct", flight / "images", "--cameras", cameras, "--until", "dem", "-o", tmp_path / "program")
    files = [(tmp_path / folder / "dem.tif").read_bytes() for folder in ("python", "program")]
    assert files[0] == files[1]
    assert made["images"] == 6 and made["failed"] == 0 and 0 < made["kept"] <= made["cells"]
    assert not (tmp_path / "python/orthophoto.tif").exists()
    assert stages


def test_wrong_requests_are_usage_errors(flight, tmp_path):
    with pytest.raises(waymark.UsageError, match="'ortho photo'"):
        waymark.reconstruct(flight / "images", tmp_path / "out", until="ortho photo")
    with pytest.raises(TypeError, match="camera_file"):
        waymark.reconstruct(flight / "images", tmp_path / "out", camera_file="x")
    with pytest.raises(waymark.InputError, match="nowhere"):
        waymark.reconstruct(flight / "nowhere", tmp_path / "out", cameras=flight / "truth/cameras.json")
