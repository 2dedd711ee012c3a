# SPDX-License-Identifier: Apache-2.0
import _thread
import inspect
import json
import threading

import numpy as np
import pytest
from conftest import DEM, SOURCE, assert_same_as_csv, program

import waymark
from waymark import stages


def job(**options):
    return {"name": "tops", "stages": [stages.load_dem(files=[str(DEM)]), stages.find_mountain_tops(**options),
                                       *json.loads((SOURCE / "sample_data/jacksboro/job.json").read_text())["stages"][2:]]}


def test_a_job_gives_the_map_of_the_program(tmp_path):
    file = SOURCE / "sample_data/jacksboro/job.json"
    done = waymark.run(file, tmp_path / "python.gpkg", settings={"find_mountain_tops.min_prominence": 60.0})
    program("run", file, "-o", tmp_path / "program.gpkg", "--set", "find_mountain_tops.min_prominence=60")
    assert_same_as_csv(done.map.landmarks(), program("query", tmp_path / "program.gpkg", "--format", "csv"))
    assert done.landmarks == {"mountain_top": len(done.map)}
    assert [stage["stage"] for stage in done.report["stages"]][0] == "load_dem"
    assert done._repr_html_() == done.map._repr_html_()


def test_a_dict_is_a_job_whose_paths_begin_at_the_folder(tmp_path):
    made = json.loads((SOURCE / "sample_data/jacksboro/job.json").read_text())
    done = waymark.run(made, tmp_path / "dict.gpkg", folder=SOURCE / "sample_data/jacksboro")
    same = waymark.run(SOURCE / "sample_data/jacksboro/job.json", tmp_path / "file.gpkg")
    assert done.map.landmarks().tobytes() == same.map.landmarks().tobytes()


def test_a_merge_gives_the_map_of_the_program(tmp_path):
    whole = waymark.run(job(), tmp_path / "whole.gpkg")
    few = waymark.run(job(), tmp_path / "few.gpkg", settings={"find_mountain_tops.min_prominence": 100.0})
    counts = waymark.merge([few.map.path, tmp_path / "whole.gpkg"], tmp_path / "python.gpkg")
    assert counts == {"landmarks": len(whole.map), "fused": 0, "identical": len(few.map)}
    program("merge", tmp_path / "whole.gpkg", few.map.path, "-o", tmp_path / "program.gpkg")
    assert (tmp_path / "python.gpkg").read_bytes() == (tmp_path / "program.gpkg").read_bytes()
    with pytest.raises(waymark.UsageError, match="two maps"):
        waymark.merge([few.map.path], tmp_path / "python.gpkg")


def test_progress_is_reported_in_the_thread_of_the_caller(tmp_path):
    heard = []
    waymark.run(job(), tmp_path / "map.gpkg", progress=lambda *at: heard.append((threading.get_ident(), *at)))
    assert {one[0] for one in heard} == {threading.get_ident()}
    assert heard[0][1] == "load_dem" and all(done <= total for _, _, done, total, _ in heard)


def test_an_exception_of_the_listener_stops_the_run_and_writes_no_map(tmp_path):
    def refuse(*at):
        raise ZeroDivisionError("enough")

    with pytest.raises(ZeroDivisionError, match="enough"):
        waymark.run(job(), tmp_path / "map.gpkg", progress=refuse)


def test_ctrl_c_stops_the_run_and_keeps_the_older_map(tmp_path):
    output = tmp_path / "map.gpkg"
    waymark.run(job(min_prominence=300), output)
    before = output.read_bytes()
    heard = []

    def interrupt(*at):
        if not heard:
            _thread.interrupt_main()
        heard.append(at)

    with pytest.raises(KeyboardInterrupt):
        waymark.run(job(min_prominence=20), output, settings={"load_dem.tile_cells": 64}, threads=1, progress=interrupt)
    assert output.read_bytes() == before


def test_other_threads_run_while_a_job_runs(tmp_path):
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.wait(0.001):
            ticks.append(1)

    ticker = threading.Thread(target=tick)
    ticker.start()
    waymark.run(job(), tmp_path / "map.gpkg")
    stop.set()
    ticker.join()
    assert len(ticks) > 10


def test_stages_have_the_options_of_the_program():
    declared = json.loads(program("stages", "--as", "json"))
    assert sorted(declared) == stages.__all__
    for name, about in declared.items():
        parameters = inspect.signature(getattr(stages, name)).parameters
        assert {key: value.default for key, value in parameters.items()} == \
            {key: option["default"] for key, option in about["options"].items()}
        for option in about["options"].values():
            assert option["description"] in getattr(stages, name).__doc__
    with pytest.raises(TypeError, match="no option 'min'"):
        stages.find_mountain_tops(min=3)


def test_a_wrong_job_is_a_usage_error(tmp_path):
    with pytest.raises(waymark.UsageError, match="find_mountain_top"):
        waymark.run({"name": "x", "stages": [{"stage": "find_mountain_top"}]}, tmp_path / "map.gpkg")
    with pytest.raises(waymark.Error, match="nothing.json"):
        waymark.run(tmp_path / "nothing.json", tmp_path / "map.gpkg")


def test_failed_units_are_an_error_with_the_result(tmp_path):
    broken = tmp_path / "broken.tif"
    broken.write_bytes(DEM.read_bytes()[:-2000])
    made = job()
    made["stages"][0]["files"] = [str(broken)]
    with pytest.raises(waymark.Error) as failed:
        waymark.run(made, tmp_path / "map.gpkg")
    assert failed.value.exit_code in (1, 3)
    assert not (tmp_path / "map.gpkg").exists()


def test_simulate_makes_the_files_of_the_program(tmp_path):
    scenario = SOURCE / "sample_data/forest/scenario.json"
    waymark.simulate(scenario, tmp_path / "python", seed=5)
    program("simulate", scenario, "-o", tmp_path / "program", "--seed", 5)
    truth = [(tmp_path / folder / "truth/landmarks.csv").read_bytes() for folder in ("python", "program")]
    assert truth[0] == truth[1] and len(truth[0]) > 1000


def test_a_simulation_stops_between_images(tmp_path):
    stages = []

    def stop(stage, done, total, rate):
        stages.append(stage)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        waymark.simulate(SOURCE / "sample_data/mars_landing/scenario.json", tmp_path / "site", progress=stop)
    assert stages == ["render_images"]
    assert not (tmp_path / "site/scenario.json").exists()


def test_a_web_map_has_the_bytes_of_the_program(tmp_path):
    made = waymark.run(job(), tmp_path / "map.gpkg")
    counts = waymark.web(made.map, tmp_path / "python", terrain_pixels=64, title="Tops")
    assert counts["landmarks"] == len(made.map) and counts["terrain_tiles"] > 0
    program("web", tmp_path / "map.gpkg", "-o", tmp_path / "program", "--terrain-pixels", 64, "--title", "Tops")
    for file in sorted((tmp_path / "program").iterdir()):
        assert (tmp_path / "python" / file.name).read_bytes() == file.read_bytes(), file.name
