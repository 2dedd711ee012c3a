# SPDX-License-Identifier: Apache-2.0
"""Prints what QGIS makes of a layer of a map: python3 open_in_qgis.py MAP.gpkg LAYER"""
import sys

from qgis.core import QgsApplication, QgsProperty, QgsSymbolLayer, QgsVectorLayer

application = QgsApplication([], False)
application.initQgis()
layer = QgsVectorLayer(f"{sys.argv[1]}|layername={sys.argv[2]}", sys.argv[2], "ogr")
print("valid:", layer.isValid())
print("crs:", layer.crs().authid())
marker = layer.renderer().symbol().symbolLayer(0)
print("colour:", marker.color().name())
print("size:", marker.dataDefinedProperties().property(QgsSymbolLayer.PropertySize).expressionString())
print("labels:", layer.labelsEnabled())
if layer.labelsEnabled():
    print("label:", layer.labeling().settings().fieldName)
sys.stdout.flush()
application.exitQgis()
