# SPDX-License-Identifier: Apache-2.0
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(os.environ["SOURCE"])
PROGRAM = os.environ["WAYMARK"]
sys.path.insert(0, str(SOURCE / "python/qgis"))


def program(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def declared():
    return json.loads(program("help", "--format", "json"))


@pytest.fixture(scope="session")
def command(declared):
    commands = {one["name"]: one for one in declared["commands"]}
    return commands.__getitem__


@pytest.fixture
def rocks(tmp_path):
    """A map of three rocks."""
    table = tmp_path / "rocks.csv"
    table.write_text("uid,x,y,z,radius\na,10,20,0,0.5\nb,12,21.5,0,0.7\nc,30,40,0,1.5\n")
    program("import", table, "-o", tmp_path / "rocks.gpkg", "--type", "rock", "--map-crs", "EPSG:32632")
    return tmp_path / "rocks.gpkg"
