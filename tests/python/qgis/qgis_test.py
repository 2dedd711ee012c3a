# SPDX-License-Identifier: Apache-2.0
"""The plugin in QGIS: algorithms by qgis_process, the panel by PyQGIS offscreen. Skipped where QGIS is missing."""
import json
import os
import shutil
import subprocess

import pytest
from conftest import PROGRAM, SOURCE, program

# Debian's script hands an option of the desktop to qgis_process, which refuses it (/etc/default/qgis).
QGIS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
pytestmark = pytest.mark.skipif(QGIS is None, reason="QGIS is not installed (qgis, python3-qgis)")
DEM = SOURCE / "sample_data/jacksboro/dem.tif"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The environment of a QGIS that has the plugin switched on, as a user has it."""
    home = tmp_path_factory.mktemp("home")
    plugins = home / "profiles/default/python/plugins"
    plugins.mkdir(parents=True)
    (plugins / "waymark_qgis").symlink_to(SOURCE / "python/qgis/waymark_qgis")
    environment = {**os.environ, "QGIS_CUSTOM_CONFIG_PATH": str(home), "HOME": str(home), "XDG_RUNTIME_DIR": str(home),
                   "PYTHONDONTWRITEBYTECODE": "1", "GDAL_PAM_ENABLED": "NO", "WAYMARK": PROGRAM}
    done = subprocess.run([QGIS, "plugins", "enable", "waymark_qgis"], env=environment, capture_output=True,
                          encoding="utf-8", check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return environment


def qgis(site, *words, **given):
    values = ["--", *(f"{name}={value}" for name, value in given.items())] if given else []
    done = subprocess.run([QGIS, "--json", *words, *values], env=site, capture_output=True, encoding="utf-8", check=False,
                          timeout=200)
    return done.returncode, done.stdout, done.stderr


def test_every_command_is_an_algorithm(site, declared):
    code, out, err = qgis(site, "list")
    assert code == 0, err
    found = set(json.loads(out)["providers"]["waymark"]["algorithms"])
    wanted = {f"waymark:{one['name']}" for one in declared["commands"] if one["group"] in ("make", "use")}
    assert found == wanted


def test_an_algorithm_gives_the_map_of_the_program(site, tmp_path):
    code, out, err = qgis(site, "run", "waymark:peaks", DEM=DEM, OUTPUT=tmp_path / "qgis.gpkg", MIN_PROMINENCE=60,
                          NODATA="unknown")
    assert code == 0, out + err
    assert json.loads(out)["results"]["OUTPUT"] == str(tmp_path / "qgis.gpkg")
    program("peaks", DEM, "-o", tmp_path / "program.gpkg", "--min-prominence", 60, "--nodata", "unknown")
    tables = [program("query", tmp_path / f"{name}.gpkg", "--format", "csv") for name in ("qgis", "program")]
    assert tables[0] == tables[1] and len(tables[0].splitlines()) > 2


def test_an_error_of_the_program_is_shown(site, tmp_path):
    code, out, err = qgis(site, "run", "waymark:peaks", DEM=tmp_path / "none.tif", OUTPUT=tmp_path / "m.gpkg")
    assert code != 0 and "none.tif" in out + err


PANEL = r"""
import json, sys
from qgis.core import QgsApplication, QgsCoordinateReferenceSystem, QgsPointXY, QgsProject, QgsProcessingContext, QgsVectorLayer
QgsApplication.setPrefixPath("/usr", True)
application = QgsApplication([], True)
application.initQgis()
sys.path.insert(0, sys.argv[1])
from waymark_qgis import algorithm, panel
map, picture = sys.argv[2:4]
said = []
dock = panel.LandmarkPanel(None, said.append)
layer = QgsVectorLayer(map + "|layername=rock", "rock", "ogr")
QgsProject.instance().addMapLayer(layer)
dock.follow(layer)
result = {"count": layer.featureCount()}
layer.selectByExpression("uid = 'a'")
result["title"] = dock.title.text()
result["evidence"] = [dock.evidence.item(i).text() for i in range(dock.evidence.count())]
dock.resize(340, 520)
dock.grab().save(picture)
icon = dock.evidence.item(0).icon().pixmap(160, 160).toImage() if dock.evidence.count() else None
if icon is not None:
    # Yellow pixels of the outline, about the middle of the cut-out.
    marked = [(x, y) for x in range(icon.width()) for y in range(icon.height())
              if icon.pixelColor(x, y).red() > 200 and icon.pixelColor(x, y).blue() < 90]
    result["outline"] = [sum(p[0] for p in marked) / len(marked) / icon.width(), sum(p[1] for p in marked) / len(marked) / icon.height()]
dock.reason.setText("by the test")
result["accepted"] = dock.edit_selected("accept")
layer.selectByExpression("uid = 'b'")
result["of_b"] = [dock.title.text(), [dock.evidence.item(i).text() for i in range(dock.evidence.count())]]
result["rejected"] = dock.edit_selected("reject")
result["left"] = sorted(f["uid"] for f in layer.getFeatures())
result["none"] = dock.edit_selected("reject")
utm = QgsCoordinateReferenceSystem("EPSG:32632")
result["added"] = dock.add_landmark([QgsPointXY(100, 0), QgsPointXY(90, 10), QgsPointXY(80, 0)], utm)
result["count_after"] = layer.featureCount()
result["said"] = said
context = QgsProcessingContext()
context.setProject(QgsProject.instance())
algorithm.load_layers(map, context)
result["loads"] = [details.name for details in context.layersToLoadOnCompletion().values()]
added = QgsVectorLayer(list(context.layersToLoadOnCompletion())[0], "x", "ogr")
result["colour"] = added.renderer().symbol().color().name()
print("RESULT" + json.dumps(result))
sys.stdout.flush()
import os
os._exit(0)
"""


def made_image(folder):
    """A grey image with a bright disk about column 40, row 30."""
    from osgeo import gdal
    image = gdal.GetDriverByName("GTiff").Create(str(folder / "one.tif"), 100, 80, 1, gdal.GDT_Byte)
    rows = b"".join(bytes(220 if (c - 40) ** 2 + (r - 30) ** 2 < 25 else 60 + (c + r) % 20 for c in range(100)) for r in range(80))
    image.GetRasterBand(1).WriteRaster(0, 0, 100, 80, rows)


def test_the_panel_shows_evidence_and_edits_by_the_program(site, rocks, tmp_path):
    from evidence_test import add_evidence
    add_evidence(rocks, tmp_path)
    made_image(tmp_path)
    (tmp_path / "panel.py").write_text(PANEL)
    done = subprocess.run(["/usr/bin/python3", str(tmp_path / "panel.py"), str(SOURCE / "python/qgis"), str(rocks),
                           str(tmp_path / "panel.png")], env=site, capture_output=True, encoding="utf-8", check=False, timeout=120)
    assert "RESULT" in done.stdout, done.stdout + done.stderr
    result = json.loads(done.stdout.split("RESULT")[1])
    assert result["count"] == 3
    assert "<b>a</b>" in result["title"]
    assert result["evidence"] == ["one.tif\nweight 0.90", "two.tif\nweight 0.50"]
    assert all(abs(part - 0.5) < 0.06 for part in result["outline"]), result["outline"]
    assert not result["said"][:-1], result["said"]
    assert result["of_b"][1] == ["No single sightings are recorded."]
    assert result["accepted"] and result["rejected"] and result["added"]
    assert result["left"] == ["a", "c"] and result["count_after"] == 3
    assert not result["none"] and result["said"] == ["No landmark is selected."]
    assert result["loads"] == ["rock"]
    assert result["colour"] == json.loads(program("types", "rock", "--format", "json"))["colour"].lower()
    table = program("query", rocks, "--near", 90, 0, 1, "--format", "csv").splitlines()
    assert len(table) == 2  # the circle through the three points
    runs = subprocess.run(["/usr/bin/python3", "-c", "import sqlite3, sys; print(*[r[0] for r in sqlite3.connect(sys.argv[1])"
                           ".execute('SELECT command_line FROM run ORDER BY id')], sep='\\n')", str(rocks)],
                          capture_output=True, encoding="utf-8", check=True).stdout.splitlines()
    assert len(runs) == 4 and all("by the test" in one for one in runs[1:])
    program("validate", rocks)
