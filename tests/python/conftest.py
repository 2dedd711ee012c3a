# SPDX-License-Identifier: Apache-2.0
"""The program, and a map made once for all tests of a file."""

import csv
import io
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

SOURCE = Path(os.environ["SOURCE"])
DEM = SOURCE / "sample_data/jacksboro/dem.tif"


def program(*words):
    """Returns what the command prints on standard output."""
    done = subprocess.run([os.environ["WAYMARK"], *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def assert_same_as_csv(table, text):
    """Each cell of the structured array is the cell that the program printed."""
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == len(table)
    assert len(rows) > 0
    for column in rows[0]:
        if column == "type":
            continue
        printed = [row[column] for row in rows]
        if table.dtype[column].kind == "U":
            assert printed == list(table[column])
        else:
            np.testing.assert_array_equal([float(cell) if cell else np.nan for cell in printed], table[column], column)
    assert set(rows[0]) - {"type"} == set(table.dtype.names)


@pytest.fixture(scope="session")
def peaks_map(tmp_path_factory):
    path = tmp_path_factory.mktemp("maps") / "peaks.gpkg"
    program("peaks", DEM, "-o", path, "--min-prominence", "50")
    return path
