# SPDX-License-Identifier: Apache-2.0
"""Panel that shows the evidence of the selected landmark, and accepts, rejects and adds landmarks by `waymark edit`."""

import html

from qgis.core import (
    QgsCoordinateTransform, QgsGeometry, QgsPointXY, QgsProject, QgsProviderRegistry, QgsVectorLayer, QgsWkbTypes)
from qgis.gui import QgsMapTool, QgsRubberBand
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor, QIcon, QImage, QPainter, QPen, QPixmap
from qgis.PyQt.QtWidgets import (
    QDockWidget, QHBoxLayout, QLabel, QLineEdit, QListWidget, QListWidgetItem, QMessageBox, QPushButton, QVBoxLayout, QWidget)

from . import edit_words, map_tables, run_program
from .provider import program

CUT_OUT = 160  # pixels


def map_of(layer):
    """Returns (map file, landmark type) of a layer; None for other layers."""
    if not isinstance(layer, QgsVectorLayer) or layer.fields().indexOf("uid") < 0:
        return None
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    path, name = parts.get("path"), parts.get("layerName")
    return (path, name or layer.name()) if path and map_tables.is_map(path) else None


def picture(sighting):
    """Returns the part of the image about a sighting with the landmark's outline; None without the image."""
    cut = map_tables.read_cut_out(sighting, CUT_OUT)
    if cut is None:
        return None
    pixels, bands, width, height, window = cut
    format_of = getattr(QImage, "Format", QImage)
    image = QImage(pixels, width, height, bands * width,
                   format_of.Format_RGB888 if bands == 3 else format_of.Format_Grayscale8).copy()
    enlarged = max(1.0, CUT_OUT / max(width, height))
    image = image.scaled(round(enlarged * width), round(enlarged * height))
    marked = QPixmap.fromImage(image)
    painter = QPainter(marked)
    painter.setPen(QPen(QColor("#ffcc00"), 1.5))
    scale = image.width() / window[2]
    # (0, 0) is the centre of the first pixel, and the corner of a pixmap.
    x, y = (sighting.column + 0.5 - window[0]) * scale, (sighting.row + 0.5 - window[1]) * scale
    radius = max(4.0, (sighting.radius or 0) * scale)
    painter.drawEllipse(int(x - radius), int(y - radius), int(2 * radius), int(2 * radius))
    painter.end()
    return marked


class PointsTool(QgsMapTool):
    """Collects points on the canvas and gives them away when there are enough."""

    def __init__(self, canvas, count, finished):
        super().__init__(canvas)
        self.count, self.finished, self.points = count, finished, []
        self.band = QgsRubberBand(canvas, QgsWkbTypes.PointGeometry)

    def canvasReleaseEvent(self, event):
        self.add(event.mapPoint())

    def add(self, point):
        self.points.append(QgsPointXY(point))
        self.band.addPoint(QgsPointXY(point))
        if len(self.points) == self.count:
            points, self.points = self.points, []
            self.band.reset(QgsWkbTypes.PointGeometry)
            self.finished(points)

    def deactivate(self):
        self.points = []
        self.band.reset(QgsWkbTypes.PointGeometry)
        super().deactivate()


class LandmarkPanel(QDockWidget):
    """`say` shows a problem to the user; tests replace it."""

    def __init__(self, iface, say=None):
        super().__init__("Waymark")
        self.setObjectName("WaymarkLandmarks")
        self.iface = iface
        self.say = say or (lambda text: QMessageBox.warning(self, "Waymark", text))
        self.layer = None
        self.tool = None
        self.title = QLabel("Select a landmark of a Waymark map.")
        self.title.setWordWrap(True)
        self.evidence = QListWidget()
        self.evidence.setIconSize(QSize(CUT_OUT, CUT_OUT))
        self.reason = QLineEdit()
        self.reason.setPlaceholderText("Reason, recorded with the map")
        self.accept = QPushButton("Accept")
        self.reject = QPushButton("Reject")
        self.add_point = QPushButton("Add by a point")
        self.add_rim = QPushButton("Add by three points of the rim")
        self.accept.clicked.connect(lambda: self.edit_selected("accept"))
        self.reject.clicked.connect(lambda: self.edit_selected("reject"))
        self.add_point.clicked.connect(lambda: self.collect(1))
        self.add_rim.clicked.connect(lambda: self.collect(3))
        self._lay_out()
        if iface is not None:
            iface.currentLayerChanged.connect(self.follow)
            self.follow(iface.activeLayer())

    def _lay_out(self):
        box = QWidget()
        rows = QVBoxLayout(box)
        rows.addWidget(self.title)
        rows.addWidget(self.evidence)
        rows.addWidget(self.reason)
        for buttons in ((self.accept, self.reject), (self.add_point, self.add_rim)):
            row = QHBoxLayout()
            for button in buttons:
                row.addWidget(button)
            rows.addLayout(row)
        self.setWidget(box)

    def close_up(self):
        self._leave()
        if self.iface is not None:
            self.iface.currentLayerChanged.disconnect(self.follow)
        self.deleteLater()

    def _leave(self):
        if self.layer is not None:
            try:
                self.layer.selectionChanged.disconnect(self.show_selected)
            except (RuntimeError, TypeError):  # the layer has been removed from the project
                pass
        self.layer = None

    def follow(self, layer):
        """Shows the selection of a layer from now on."""
        self._leave()
        if map_of(layer):
            self.layer = layer
            layer.selectionChanged.connect(self.show_selected)
        for button in (self.accept, self.reject, self.add_point, self.add_rim):
            button.setEnabled(self.layer is not None)
        self.show_selected()

    def selected(self):
        """Returns the selected landmarks."""
        return list(self.layer.selectedFeatures()) if self.layer is not None else []

    def show_selected(self, *_):
        self.evidence.clear()
        chosen = self.selected()
        if len(chosen) != 1:
            self.title.setText(f"{len(chosen)} landmarks are selected." if chosen else
                               "Select a landmark." if self.layer else "Select a layer of a Waymark map.")
            return
        path, _ = map_of(self.layer)
        landmark = chosen[0]
        self.title.setText(f"<b>{html.escape(str(landmark['uid']))}</b>, confidence {float(landmark['confidence']):.2f}, "
                           f"seen {landmark['seen']} of {landmark['visible']} times")
        for sighting in map_tables.evidence(path, landmark["uid"]):
            item = QListWidgetItem(f"{sighting.source}\nweight {sighting.weight:.2f}")
            shown = picture(sighting)
            if shown is not None:
                item.setIcon(QIcon(shown))
            self.evidence.addItem(item)
        if self.evidence.count() == 0:
            self.evidence.addItem("No single sightings are recorded.")

    def run(self, words):
        """Runs the program and shows the layer as it is now; returns whether it succeeded."""
        found = program()
        if not found:
            self.say("The program waymark is not found.")
            return False
        done = run_program.run(found, words)
        if done.code != 0:
            self.say(done.errors)
            return False
        self.layer.dataProvider().reloadData()
        self.layer.removeSelection()
        self.layer.triggerRepaint()
        return True

    def edit_selected(self, action):
        uids = [landmark["uid"] for landmark in self.selected()]
        if not uids:
            return self.say("No landmark is selected.")
        return self.run(edit_words.edit(map_of(self.layer)[0], action, uids, self.reason.text()))

    def collect(self, count):
        """Lets the user click points in the map."""
        canvas = self.iface.mapCanvas()
        crs = canvas.mapSettings().destinationCrs()
        self.tool = PointsTool(canvas, count, lambda points: self.add_landmark(points, crs))
        canvas.setMapTool(self.tool)

    def add_landmark(self, points, crs):
        """Adds a landmark of the layer's type; points in a CRS of the canvas."""
        to_map = QgsCoordinateTransform(crs, self.layer.crs(), QgsProject.instance()) if crs.isValid() and \
            self.layer.crs().isValid() else None
        placed = []
        for point in points:
            shape = QgsGeometry.fromPointXY(point)
            if to_map is not None:
                shape.transform(to_map)
            placed.append((shape.asPoint().x(), shape.asPoint().y()))
        path, name = map_of(self.layer)
        return self.run(edit_words.add(path, name, placed, reason=self.reason.text()))
