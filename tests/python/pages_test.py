# SPDX-License-Identifier: Apache-2.0
"""The Python examples of the documentation run, beside the sample data."""

import ast
import json
import os
import re
import shutil
from pathlib import Path

import pytest
from conftest import SOURCE

import waymark

PAGES = ["tutorials/python.md", "how_to/detect_in_arrays.md"]


@pytest.fixture
def room(tmp_path, monkeypatch):
    (tmp_path / "sample_data").symlink_to(SOURCE / "sample_data")
    monkeypatch.chdir(tmp_path)
    simulate = waymark.simulate

    def scene_or_simulation(scenario, folder):
        """Copies the scene of tests/docs/scenes_are_made, if it made it."""
        made = Path(os.environ.get("WAYMARK_SCENES", "none")) / scenario
        return shutil.copytree(made, folder) if made.is_dir() else simulate(scenario, folder)

    monkeypatch.setattr(waymark, "simulate", scene_or_simulation)
    return tmp_path


@pytest.mark.parametrize("page", PAGES)
def test_a_page_runs(page, room):
    if "osgeo" in (SOURCE / "docs" / page).read_text():
        pytest.importorskip("osgeo.gdal")
    blocks = re.findall(r"^```python\n(.*?)^```", (SOURCE / "docs" / page).read_text(), re.M | re.S)
    assert len(blocks) >= 4
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)


NOTEBOOK = SOURCE / "docs/tutorials/python.ipynb"


def test_the_notebook_runs(room):
    cells = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 4
    try:
        import nbformat
        from nbclient import NotebookClient
        from jupyter_client.kernelspec import KernelSpecManager
        kernels = KernelSpecManager().find_kernel_specs()
    except ImportError:
        kernels = {}
    if "python3" in kernels:
        client = NotebookClient(nbformat.read(NOTEBOOK, as_version=4), timeout=200, kernel_name="python3",
                                resources={"metadata": {"path": str(room)}})
        done = client.execute()
        shown = [output for cell in done.cells if cell.cell_type == "code" for output in cell.outputs]
        assert any("<svg" in output.get("data", {}).get("text/html", "") for output in shown)
        return
    names = {}
    for cell in cells:  # the last expression of a cell is what a notebook shows
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, "python.ipynb", "exec"), names)
        if last is not None:
            shown = eval(compile(ast.Expression(last.value), "python.ipynb", "eval"), names)
            if hasattr(shown, "_repr_html_"):
                assert shown._repr_html_()


def test_the_notebook_has_no_outputs():
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        assert not cell.get("outputs") and not cell.get("execution_count")
