# SPDX-License-Identifier: Apache-2.0
"""A plug-in in Python: the shared library that the tests of plug-ins build."""
import os
import pathlib

import numpy as np
import pytest

import waymark

PLUG_IN = pathlib.Path(os.environ["PLUG_INS"]) / "cones.so"


def test_the_detectors_of_the_library_are_declared():
    detectors = waymark.image_detectors()
    assert list(detectors)[:3] == ["craters", "rocks", "trees"]
    assert detectors["trees"]["methods"] == {"imagery": "image", "peaks": "heights", "lmf": "heights"}
    assert "verifier" in detectors["craters"]["settings"] and detectors["rocks"]["settings"] == {}


def test_a_file_that_is_no_plug_in_is_refused(tmp_path):
    with pytest.raises(waymark.InputError, match="there is no such plug-in"):
        waymark.load_plug_in(tmp_path / "nothing.so")


def test_a_setting_of_another_detector_is_refused():
    with pytest.raises(waymark.UsageError, match="--verifier is for craters that the method bowl finds"):
        waymark.detect("rocks", np.zeros((40, 40), dtype=np.uint8), verifier="own.txt")


def test_a_plug_in_detects_with_its_settings():
    if not PLUG_IN.exists():
        pytest.skip(f"{PLUG_IN} is not built")
    waymark.load_plug_in(PLUG_IN)
    assert waymark.image_detectors()["cones"]["type"] == "traffic_cone"
    image = np.full((20, 30), 50, dtype=np.uint8)
    image[3, 4], image[12, 25] = 210, 240
    usual = waymark.detect("cones", image)
    assert sorted(zip(usual["x"], usual["y"])) == [(4, 3), (25, 12)]
    bright = waymark.detect("cones", image, cone_brightness=230)
    assert list(zip(bright["x"], bright["y"])) == [(25, 12)]
    with pytest.raises(waymark.UsageError, match="cone_brightness"):
        waymark.detect("cones", image, cone_brightness=-1)
