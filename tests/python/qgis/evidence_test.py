# SPDX-License-Identifier: Apache-2.0
"""Layers and evidence of a map, without QGIS."""
import array
import json
import sqlite3
import struct

from waymark_qgis import map_tables
from waymark_qgis.map_tables import Sighting


def add_evidence(map, folder):
    """Three sightings of rock a: the second is the best, the third rejected. One image is beside the map."""
    (folder / "one.tif").write_bytes(b"")
    with sqlite3.connect(map) as db:
        db.create_function("ST_IsEmpty", 1, lambda point: 0)  # the index of the map asks, as every GeoPackage's
        for name, end in (("X", 24), ("Y", 16)):
            for bound in ("Min", "Max"):
                db.create_function(f"ST_{bound}{name}", 1, lambda point, end=end: struct.unpack("<d", point[len(point) - end:][:8])[0])
        db.executemany("INSERT INTO image (name, camera, gsd) VALUES (?, '{}', ?)", [("one.tif", 0.1), ("two.tif", None)])
        db.execute("UPDATE run SET inputs = ?", (json.dumps([{"path": "/gone/one.tif", "bytes": 0, "sha256": "a" * 64}]),))
        db.execute("UPDATE rock SET observations = 2, seen = 2, visible = 2, q_multiplicity = 1, quality = 1 WHERE uid = 'a'")
        for source, weight, rejected in (("two.tif", 0.5, None), ("one.tif", 0.9, None), ("one.tif", 1, "shadow of a rim")):
            row = db.execute(
                "INSERT INTO observation (type, uid, source, pixel_x, pixel_y, x, y, z, weight, features, rejected) "
                "VALUES ('rock', 'a', ?, 40, 30.5, 1, 2, 3, ?, '{\"radius\": 0.5}', ?)", (source, weight, rejected)).lastrowid
            if rejected is None:
                db.execute("INSERT INTO rock_observation SELECT id, ? FROM rock WHERE uid = 'a'", (row,))


def test_the_evidence_is_found_and_the_best_comes_first(rocks, tmp_path):
    add_evidence(rocks, tmp_path)
    found = map_tables.evidence(str(rocks), "a")
    assert found == [
        Sighting("one.tif", 0.9, 1, 2, 40, 30.5, 5.0, str(tmp_path / "one.tif")),  # beside the map; 0.5 m are 5 pixels
        Sighting("two.tif", 0.5, 1, 2, 40, 30.5, None, None)]
    assert map_tables.evidence(str(rocks), "nobody") == []


def test_layers_with_a_style_and_rows_are_listed(rocks, tmp_path):
    assert map_tables.is_map(str(rocks))
    assert map_tables.styled_layers(str(rocks)) == ["rock"]
    (tmp_path / "text.gpkg").write_text("no database")
    assert not map_tables.is_map(str(tmp_path / "text.gpkg"))
    assert not map_tables.is_map(str(tmp_path / "missing.gpkg"))
    assert not (tmp_path / "missing.gpkg").exists()


def test_reading_leaves_no_files(rocks):
    before = sorted(rocks.parent.iterdir())
    map_tables.evidence(str(rocks), "a")
    map_tables.styled_layers(str(rocks))
    assert sorted(rocks.parent.iterdir()) == before


def test_a_cut_out_lies_in_its_image():
    at = Sighting("i", 1, 0, 0, 50, 50, 20, "i.tif")
    assert map_tables.cut_out_window(at, 1000, 1000) == (0, 0, 111, 111)  # 3 radii to each side, from the edge on
    at = Sighting("i", 1, 0, 0, 500, 990, None, "i.tif")
    assert map_tables.cut_out_window(at, 1000, 1000) == (476, 966, 49, 34)
    assert map_tables.cut_out_window(Sighting("i", 1, 0, 0, -500, 0, 1, "i.tif"), 1000, 1000) is None


def test_contrast_is_stretched_over_all_bands():
    low_high = [array.array("f", [10, 20]).tobytes(), array.array("f", [15, float("nan")]).tobytes()]
    # From 10, the 2nd percentile of the three known values, to 15, the 98th; pixel by pixel.
    assert map_tables.stretch(low_high, 2) == bytes([0, 255, 255, 0])
    flat = map_tables.stretch([array.array("f", [7, 7]).tobytes()], 2)
    assert flat == bytes([0, 0])
