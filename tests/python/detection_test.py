# SPDX-License-Identifier: Apache-2.0
import csv
import io
import json

import numpy as np
import pytest
from conftest import DEM, SOURCE, assert_same_as_csv, program

import waymark


@pytest.fixture(scope="module")
def photo(tmp_path_factory):
    """An image of a simulated landing site, as a file and as an array, and its light."""
    gdal = pytest.importorskip("osgeo.gdal")
    folder = tmp_path_factory.mktemp("photo") / "site"
    scenario = json.loads((SOURCE / "sample_data/mars_landing/scenario.json").read_text())
    end = {f"{word}_{axis}": scenario["flights"][0][f"to_{axis}"]
           for word in ("from", "to") for axis in ("east", "north", "altitude")}
    scenario["flights"][0].update(end, images=1)  # the last one alone
    file = folder.parent / "scenario.json"
    file.write_text(json.dumps(scenario))
    counts = waymark.simulate(file, folder)
    images = sorted((folder / "images").glob("*.png")) or sorted((folder / "images").glob("*.tif"))
    assert len(images) == counts["images"] > 0
    pixels = gdal.Open(str(images[-1])).ReadAsArray()
    return images[-1], pixels


def detections(command, path, tmp_path, *words):
    out = tmp_path / "out.csv"
    program("detect", command, path, "-o", out, *words)
    return out.read_text()


@pytest.mark.parametrize("kind", ["rocks", "craters"])
def test_an_array_gives_the_objects_of_its_file(photo, tmp_path, kind):
    path, pixels = photo
    expected = detections(kind, path, tmp_path, "--gsd", 0.5, "--image-sun-angle", -15, "--sun-elevation", 35)
    light = dict(gsd=0.5, image_sun_angle=-15, sun_elevation=35)
    found = {"rocks": waymark.find_rocks, "craters": waymark.find_craters}[kind](pixels, **light)
    assert_same_as_csv(found, expected)
    assert_same_as_csv(waymark.detect(kind, path, **light), expected)


def test_any_layout_of_memory_gives_the_same(photo):
    pixels = photo[1]
    light = dict(image_sun_angle=-15)
    found = waymark.find_rocks(pixels, **light)
    assert len(found) > 0
    for same in (np.asfortranarray(pixels), pixels.astype(np.uint16).astype(">u2"), np.repeat(pixels, 2, axis=1)[:, ::2]):
        if same.dtype == pixels.dtype:
            assert waymark.find_rocks(same, **light).tobytes() == found.tobytes()
        else:
            assert len(waymark.find_rocks(same, **light)) > 0


def test_an_image_that_cannot_be_read_is_a_clear_error(photo):
    with pytest.raises(TypeError, match="complex128"):
        waymark.find_rocks(np.zeros((8, 8), complex))
    with pytest.raises(TypeError, match=r"\(64,\)"):
        waymark.find_rocks(np.zeros(64, np.uint8))
    with pytest.raises(waymark.UsageError):
        waymark.detect("houses", photo[1])


def test_no_contrast_is_a_warning_and_no_rocks():
    with pytest.warns(waymark.Warning):
        assert len(waymark.find_rocks(np.full((64, 64), 7, np.uint8), image_sun_angle=0)) == 0


def test_a_dem_array_has_the_mountain_tops_of_its_file(peaks_map):
    gdal = pytest.importorskip("osgeo.gdal")
    file = gdal.Open(str(DEM))
    left, width, _, top, _, height = file.GetGeoTransform()
    band = file.GetRasterBand(1)
    heights = np.ma.masked_equal(band.ReadAsArray(), band.GetNoDataValue())
    found = waymark.find_mountain_tops(heights, transform=(width, 0, left, 0, height, top), crs="EPSG:4269",
                                       min_prominence=50)
    expected = waymark.open(peaks_map).landmarks()
    np.testing.assert_array_equal(found["prominence"], expected["prominence"])
    np.testing.assert_allclose(found["x"], expected["x"], atol=1e-9)
    from_file = waymark.find_mountain_tops(DEM, min_prominence=50)
    assert from_file.tobytes() == expected.tobytes()


def test_a_dem_without_a_crs_is_in_metres():
    """Two cones 40 and 30 m high, 100 cells apart; the saddle between them is at 0."""
    row, column = np.mgrid[0:100, 0:200]
    cone = lambda r, c, height: np.maximum(height - np.hypot(row - r, column - c), 0)
    tops = waymark.find_mountain_tops(cone(50, 50, 40) + cone(50, 150, 30), cell=2.0, min_prominence=5)
    assert sorted(tops["elevation"]) == [30, 40]
    low = tops[tops["elevation"] == 30][0]
    assert low["prominence"] == 30
    assert (low["x"], low["y"]) == (2 * 150, -2 * 50)  # the first cell is at 0, 0
    # The nearest higher cell of the higher cone: 31 m or more within 9 cells of its top.
    assert low["isolation"] == pytest.approx(2 * 91, abs=2)


def test_trees_of_a_canopy_array_are_where_they_were_put(tmp_path):
    row, column = np.mgrid[0:120, 0:120]
    places = [(30, 30), (30, 80), (80, 50)]
    canopy = np.max([np.maximum(20 - 1.5 * np.hypot(row - r, column - c), 0) for r, c in places], axis=0)
    trees = waymark.find_trees(canopy, cell=0.5, preset="conifer")
    found = sorted((round(-tree["y"] / 0.5), round(tree["x"] / 0.5)) for tree in trees)
    assert found == sorted(places)
    np.testing.assert_allclose(trees["height"], 20)
    map = waymark.find_trees(canopy, cell=0.5, preset="conifer", output=tmp_path / "trees.gpkg")
    assert_same_as_csv(map.landmarks("tree"), program("query", map.path, "--format", "csv"))


def test_options_of_no_stage_are_refused():
    with pytest.raises(TypeError, match="no option 'min_prominenz'; did you mean 'min_prominence'"):
        waymark.find_mountain_tops(DEM, min_prominenz=5)
    with pytest.raises(TypeError, match="no option 'qqqq'; known are .*min_prominence"):
        waymark.find_mountain_tops(DEM, qqqq=5)
    with pytest.raises(waymark.UsageError, match="min_prominence"):
        waymark.find_mountain_tops(DEM, min_prominence=-5)


def test_a_bowl_in_a_dem_array_is_a_crater(tmp_path):
    """A crater 60 m across and 12 m deep, with a rim that falls off outside, in cells of 2 m."""
    row, column = np.mgrid[0:100, 0:100]
    r = np.hypot(row - 50, column - 40) / 15
    heights = 12 * np.where(r < 1, r**2, np.clip(1 - 0.5 * np.maximum(r - 1, 0) ** 0.5, 0.6, 1)) + 0.01 * np.sin(row * 1.7 + column)
    craters = waymark.find_craters_in_dem(heights, cell=2.0, output=tmp_path / "craters.gpkg").landmarks("crater")
    assert len(craters) == 1
    assert craters["x"][0] == pytest.approx(80, abs=2) and craters["y"][0] == pytest.approx(-100, abs=2)
    assert craters["radius"][0] == pytest.approx(30, rel=0.15)
    assert_same_as_csv(craters, program("query", tmp_path / "craters.gpkg", "--type", "crater", "--format", "csv"))


def test_buildings_of_an_array_of_heights(tmp_path):
    heights = np.zeros((200, 240), np.float32)
    heights[40:72, 50:90] = 6  # 16 m by 20 m on cells of 0.5 m
    heights[120:144, 150:190] = np.linspace(3, 6, 24)[:, None]
    buildings = waymark.find_buildings(chm=heights, cell=0.5, poles=False)
    assert sorted(round(float(h)) for h in buildings["height"]) == [6, 6]
    map = waymark.find_buildings(chm=heights, cell=0.5, poles=False, output=tmp_path / "town.gpkg")
    assert len(map.landmarks("wall_corner")) == 8
    assert len(map.landmarks("wall")) == 8
