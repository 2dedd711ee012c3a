# SPDX-License-Identifier: Apache-2.0
"""The plugin: its provider, and its panel where QGIS has windows."""

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import Qt

from .provider import WaymarkProvider


class WaymarkPlugin:
    def __init__(self, iface):
        self.iface = iface
        self.provider = None
        self.panel = None

    def initProcessing(self):
        self.provider = WaymarkProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):
        from .panel import LandmarkPanel
        self.initProcessing()
        self.panel = LandmarkPanel(self.iface)
        area = Qt.DockWidgetArea.RightDockWidgetArea if hasattr(Qt, "DockWidgetArea") else Qt.RightDockWidgetArea
        self.iface.addDockWidget(area, self.panel)
        self.panel.hide()
        self.iface.addPluginToMenu("Waymark", self.panel.toggleViewAction())

    def unload(self):
        if self.panel:
            self.iface.removePluginMenu("Waymark", self.panel.toggleViewAction())
            self.iface.removeDockWidget(self.panel)
            self.panel.close_up()
            self.panel = None
        if self.provider:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
