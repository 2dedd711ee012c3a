# SPDX-License-Identifier: Apache-2.0
"""Prints what QGIS makes of a layer of a map: python3 open_in_qgis.py MAP.gpkg LAYER"""
import sys

from qgis.core import (QgsApplication, QgsExpression, QgsExpressionContext, QgsExpressionContextUtils, QgsSymbolLayer,
                       QgsVectorLayer, QgsVectorLayerUtils)

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
print("alias of height:", layer.attributeAlias(layer.fields().indexOf("height")))
context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
feature = next(layer.getFeatures())
context.setFeature(feature)
print("display name:", QgsExpression(layer.displayExpression()).evaluate(context))
print("map tip:", layer.mapTipTemplate())
# A person draws a point and leaves the form as it is.
layer.startEditing()
drawn = QgsVectorLayerUtils.createFeature(layer, feature.geometry())
before = layer.featureCount()
added = layer.addFeature(drawn) and layer.commitChanges()
if not added:
    print(layer.commitErrors())
named = all(f["uid"] for f in QgsVectorLayer(layer.source(), "again", "ogr").getFeatures())
print(f"added: {added and layer.featureCount() == before + 1}, named: {named}")
sys.stdout.flush()
application.exitQgis()
