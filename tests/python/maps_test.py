# SPDX-License-Identifier: Apache-2.0
import csv
import io
import sys

import numpy as np
import pytest
from conftest import assert_same_as_csv, program

import waymark


def test_landmarks_have_the_columns_and_values_of_the_command(peaks_map):
    tops = waymark.open(peaks_map).landmarks("mountain_top")
    assert_same_as_csv(tops, program("query", peaks_map, "--format", "csv"))


@pytest.mark.parametrize("conditions, words", [
    (dict(min_prominence=100), ["--min", "prominence=100"]),
    (dict(max_prominence=100, limit=3), ["--max", "prominence=100", "--limit", 3]),
    (dict(largest="prominence", limit=5), ["--largest", "prominence", "--limit", 5]),
    (dict(min_confidence=0.5), ["--min-confidence", 0.5]),
    (dict(crs="EPSG:4326"), ["--crs", "EPSG:4326"]),
])
def test_conditions_are_those_of_the_command(peaks_map, conditions, words):
    tops = waymark.open(peaks_map).landmarks("mountain_top", **conditions)
    assert_same_as_csv(tops, program("query", peaks_map, "--format", "csv", *words))


def test_places_are_those_of_the_command(peaks_map):
    map = waymark.open(peaks_map)
    first = map.landmarks("mountain_top", largest="prominence", limit=1)[0]
    near = [float(first["x"]), float(first["y"]), 5000]
    found = map.landmarks("mountain_top", near=near)
    assert_same_as_csv(found, program("query", peaks_map, "--format", "csv", "--near", *near))
    assert found[0]["uid"] == first["uid"] and found[0]["distance"] == 0
    box = [near[0] - 0.05, near[1] - 0.05, near[0] + 0.05, near[1] + 0.05]
    boxed = map.landmarks("mountain_top", bbox=box)
    assert_same_as_csv(boxed, program("query", peaks_map, "--format", "csv", "--bbox", *box))


def test_types_and_crs_describe_the_map(peaks_map):
    map = waymark.read_map(str(peaks_map))
    top = map.types["mountain_top"]
    assert {"elevation", "prominence", "isolation"} <= {feature.name for feature in top.features}
    assert {feature.unit for feature in top.features if feature.name == "prominence"} == {"m"}
    assert top.count == len(map) == len(map["mountain_top"])
    assert "prominence_sd" in {name for name, unit, summary in top.columns}
    assert map.crs.startswith(("GEOGCRS", "PROJCRS"))
    assert not map.is_local


def test_a_map_holds_the_names_of_its_types(peaks_map):
    map = waymark.open(peaks_map)
    assert "mountain_top" in map and "rock" not in map and 7 not in map
    assert list(map) == ["mountain_top"]
    assert {name: len(map[name]) for name in map} == {"mountain_top": len(map)}


def test_a_missing_geopandas_is_named_with_its_package(peaks_map, monkeypatch):
    monkeypatch.setitem(sys.modules, "geopandas", None)
    with pytest.raises(ImportError, match="apt install python3-geopandas"):
        waymark.open(peaks_map).to_geopandas()


def test_geopandas_has_the_points_and_the_crs(peaks_map):
    geopandas = pytest.importorskip("geopandas")
    map = waymark.open(peaks_map)
    frame = map.to_geopandas(min_prominence=100)
    assert isinstance(frame, geopandas.GeoDataFrame)
    tops = map.landmarks(min_prominence=100)
    assert list(frame.index) == list(tops["uid"])
    np.testing.assert_array_equal(frame.geometry.x, tops["x"])
    np.testing.assert_array_equal(frame.geometry.z, tops["z"])
    np.testing.assert_array_equal(frame["prominence"], tops["prominence"])
    assert map.to_geopandas(crs="EPSG:32616").crs.srs == "EPSG:32616"  # what geopandas prints
    degrees = frame.to_crs("EPSG:4326")
    printed = list(csv.DictReader(io.StringIO(program("query", peaks_map, "--format", "csv", "--crs", "EPSG:4326",
                                                      "--min", "prominence=100"))))
    np.testing.assert_allclose(degrees.geometry.y, [float(row["y"]) for row in printed], atol=1e-9)


def test_a_notebook_shows_a_table_and_a_picture(peaks_map):
    map = waymark.open(peaks_map)
    shown = map._repr_html_()
    assert "<td>mountain_top</td>" in shown and f"<td>{len(map)}</td>" in shown
    assert shown.count("<circle") == min(len(map), 1000)
    assert repr(len(map)) in repr(map)


def test_errors_have_problem_place_and_hint(peaks_map, tmp_path):
    with pytest.raises(waymark.InputError, match="missing.gpkg") as missing:
        waymark.open(tmp_path / "missing.gpkg")
    assert missing.value.exit_code == 1 and isinstance(missing.value, waymark.Error)
    with pytest.raises(waymark.UsageError) as unknown:
        waymark.open(peaks_map).landmarks("mountain_tops")
    assert "mountain_top" in unknown.value.hint and unknown.value.exit_code == 2
    assert unknown.value.problem in str(unknown.value) and unknown.value.hint in str(unknown.value)
    with pytest.raises(TypeError, match="no keyword 'nere'"):
        waymark.open(peaks_map).landmarks("mountain_top", nere=[0, 0, 1])
    with pytest.raises(TypeError, match="'limit' cannot be 'many'"):
        waymark.open(peaks_map).landmarks("mountain_top", limit="many")


def test_an_empty_answer_says_why(peaks_map):
    map = waymark.open(peaks_map)
    with pytest.warns(waymark.Warning, match="no landmark has 'prominence' of at least 1e"):
        assert len(map.landmarks(min_prominence=1e6)) == 0


def test_threads_may_query_one_map(peaks_map):
    from concurrent.futures import ThreadPoolExecutor

    map = waymark.open(peaks_map)
    alone = map.landmarks()
    with ThreadPoolExecutor(4) as pool:
        for together in pool.map(lambda _: map.landmarks(), range(16)):
            assert together.tobytes() == alone.tobytes()
