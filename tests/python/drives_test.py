# SPDX-License-Identifier: Apache-2.0
import csv
import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import SOURCE, program

import waymark

NOISE = dict(along_per_metre=0.01, across_per_metre=0.003, yaw_per_metre=0.0001, yaw_per_radian=0.002)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A simulated landing site with a drive, and the map of its true landmarks."""
    folder = tmp_path_factory.mktemp("site")
    made = json.loads((SOURCE / "sample_data/mars_mission/scenario.json").read_text())
    made["drive"]["length"] = 150
    made["camera"].update(columns=300, rows=300)
    made["flights"][0]["images"] = 2
    (folder / "scenario.json").write_text(json.dumps(made))
    waymark.simulate(folder / "scenario.json", folder / "site")
    truth = folder / "site/truth/landmarks.csv"
    program("import", truth, "-o", folder / "map.gpkg", "--map-crs", "local")
    return folder


def read_track(file):
    with open(file, newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


@pytest.mark.parametrize("method", ["odometry", "ekf", "pf", "slam"])
def test_estimates_are_those_of_the_program(site, tmp_path, method):
    words = [word for name, value in NOISE.items() for word in ("--set", f"{name}={value}")]
    program("localize", site / "map.gpkg", site / "site/log.jsonl", "-o", tmp_path / "track.csv", "--method", method,
            "--ids", "unknown", *words)
    printed = read_track(tmp_path / "track.csv")
    drive = waymark.localize(waymark.open(site / "map.gpkg"), site / "site/log.jsonl", method=method, settings=NOISE,
                             use_identities=False)
    estimates = list(drive)
    assert len(estimates) == len(printed) > 100
    for column in ("t", "x", "y", "yaw", "var_x", "var_yaw", "matched"):
        np.testing.assert_allclose([one[column] for one in estimates], [float(row[column]) for row in printed],
                                   rtol=1e-5, atol=5.1e-7, err_msg=column)  # six places in the file
    assert drive.track.tolist() == [one.tolist() for one in estimates]
    assert "along_per_metre=0.01" in drive.settings


def test_estimates_come_while_the_log_plays_and_the_loop_may_be_left(site):
    drive = waymark.localize(site / "map.gpkg", site / "site/log.jsonl", settings=NOISE)
    first = next(iter(drive))
    assert first.dtype.names[:4] == ("t", "x", "y", "z")
    drive.close()
    with pytest.raises(KeyboardInterrupt):
        drive.track


def test_a_loop_continues_where_it_was_left(site):
    drive = waymark.localize(site / "map.gpkg", site / "site/log.jsonl", settings=NOISE)
    seen = []
    for estimate in drive:
        seen.append(estimate["t"])
        if len(seen) == 10:
            break
    seen += [estimate["t"] for estimate in drive]
    assert seen == list(drive.track["t"])
    assert list(drive) == []


def test_python_may_end_while_a_log_plays(site):
    done = subprocess.run([sys.executable, "-c", f"""
import waymark
drive = waymark.localize({str(site / 'map.gpkg')!r}, {str(site / 'site/log.jsonl')!r}, method="pf", start="none")
next(iter(drive))
"""], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_errors_of_the_program_are_exceptions(site):
    with pytest.raises(waymark.UsageError, match="ekff") as unknown:
        waymark.localize(site / "map.gpkg", site / "site/log.jsonl", method="ekff").track
    assert "ekf" in str(unknown.value)
    with pytest.raises(waymark.UsageError, match="along_per_meter"):
        waymark.localize(site / "map.gpkg", site / "site/log.jsonl", settings={"along_per_meter": 1}).track
    assert waymark.localize_methods() == sorted(waymark.localize_methods(), key=waymark.localize_methods().index)
    assert "ekf" in waymark.localize_methods()


def test_settings_are_those_of_the_program():
    listed = program("localize", "--method", "pf", "--settings")
    settings = waymark.localize_settings("pf")
    assert len(settings) == len(listed.splitlines()) > 20
    for name, (value, effect) in settings.items():
        assert f"{name}={value}" in listed and effect.strip() in listed


def test_scores_are_those_of_the_program(site, tmp_path):
    track = tmp_path / "track.csv"
    waymark.localize(site / "map.gpkg", site / "site/log.jsonl", settings=NOISE, output=track).track
    log = site / "site/log.jsonl"
    score = waymark.evaluate_track(track, log)
    assert score == json.loads(program("evaluate", "track", track, "--truth", log, "--format", "json"))
    assert 0 < score["ate_rmse"] < 1
    study = waymark.evaluate_track(track, log, drive=[(track, log)])
    assert study == json.loads(program("evaluate", "track", track, "--truth", log, "--drive", f"{track}={log}",
                                       "--format", "json"))
    map, truth = waymark.open(site / "map.gpkg"), site / "site/truth/landmarks.csv"
    scores = waymark.evaluate(map, truth)
    assert scores == json.loads(program("evaluate", "landmarks", map.path, "--truth", truth, "--format", "json"))
    with pytest.raises(waymark.InputError, match="nowhere.csv"):
        waymark.evaluate(map, "nowhere.csv")


def test_a_route_is_that_of_the_program(site, tmp_path):
    map = waymark.open(site / "map.gpkg")
    options = dict(sensor="horizontal_laser", limit_sigma=2.0, worlds=4)
    planned = waymark.route(map, (-30, -30), (30, 30), tmp_path / "python.csv", **options)
    program("route", map.path, "--from", "-30,-30", "--to", "30,30", "-o", tmp_path / "program.csv", "--sensor",
            "horizontal_laser", "--limit-sigma", 2, "--worlds", 4)
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    best = planned["routes"][0]
    assert best["worst_sd"] <= 2 and best["length"] >= planned["lower_bound"] >= np.hypot(60, 60) - 1e-6
    rows = read_track(tmp_path / "program.csv")
    assert len(best["stations"]) == len(rows)
    np.testing.assert_allclose(best["stations"][-1]["x"], 30, atol=2)
    with pytest.raises(waymark.Error):
        waymark.route(map, (-30, -30), (1e7, 30), tmp_path / "none.csv", **options)


def test_hazards_are_those_of_the_program(site, tmp_path):
    dem = site / "site/dem.tif"
    map = waymark.open(site / "map.gpkg")
    made = waymark.hazards(map, tmp_path / "python.tif", dem=dem, vehicle="rover")
    printed = json.loads(program("hazards", map.path, "--dem", dem, "-o", tmp_path / "program.tif", "--format", "json"))
    assert made == {name: printed[name] for name in made}
    assert (tmp_path / "python.tif").read_bytes() == (tmp_path / "program.tif").read_bytes()


def test_a_route_reports_what_is_done_and_stops_on_ctrl_c(site, tmp_path):
    heard = []
    options = dict(sensor="horizontal_laser", least_sigma=True, worlds=4, cell=0.5)
    waymark.route(site / "map.gpkg", (-30, -30), (30, 30), tmp_path / "all.csv", progress=lambda *at: heard.append(at),
                  **options)
    assert [stage for stage, *_ in heard][0] == "information" and heard[-1][0] == "route"
    searched = [done for stage, done, *_ in heard if stage == "route"]
    assert len(searched) > 3 and searched == sorted(searched) and searched[-1] == heard[-1][2] == 17

    def interrupt(stage, *at):
        if stage == "route":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        waymark.route(site / "map.gpkg", (-30, -30), (30, 30), tmp_path / "none.csv", progress=interrupt, **options)
    assert not (tmp_path / "none.csv").exists()
