# SPDX-License-Identifier: Apache-2.0
"""Opens a map in headless QGIS, checks what a user would see, and writes it as a picture.

    QT_QPA_PLATFORM=offscreen python3 qgis_render.py MAP.gpkg PICTURE.png [DEM]

Checks that every landmark layer is valid, has a valid CRS and got the style stored in the map.
Exit codes: 0 done, 1 a check failed, 77 QGIS is not installed.
"""

import math
import os
import sys

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["GDAL_PAM_ENABLED"] = "NO"  # leave no statistics beside the DEM
try:
    from osgeo import ogr
    from qgis.core import (QgsApplication, QgsEllipsoidUtils, QgsExpression, QgsExpressionContext,
                           QgsExpressionContextUtils, QgsHillshadeRenderer, QgsMapRendererSequentialJob,
                           QgsMapSettings, QgsRasterLayer, QgsRenderContext, QgsSingleSymbolRenderer,
                           QgsSymbolLayer, QgsVectorLayer)
    from qgis.PyQt.QtCore import QSize
    from qgis.PyQt.QtGui import QColor
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def layer_names(path):
    """Tables with a style of their own: the landmark types."""
    source = ogr.Open(path)
    styles = source.ExecuteSQL("SELECT DISTINCT f_table_name FROM layer_styles ORDER BY 1")
    names = [row.GetField(0) for row in styles]
    source.ReleaseResultSet(styles)
    return [name for name in names if name not in ("landmark", "image")]


def styles_of(path):
    """The style that the map holds for each layer."""
    source = ogr.Open(path)
    rows = source.ExecuteSQL("SELECT f_table_name, styleQML FROM layer_styles")
    styles = {row.GetField(0): row.GetField(1) for row in rows}
    source.ReleaseResultSet(rows)
    return styles


def complaints(layer, style):
    """What a user would find wrong with a layer on opening it."""
    if not layer.isValid():
        return ["the layer is not valid"]
    found = []
    if not layer.crs().isValid():
        found.append("its CRS is not valid")
    renderer = layer.renderer()
    if isinstance(renderer, QgsSingleSymbolRenderer):
        colour = renderer.symbol().symbolLayer(0).color()
        if f'"{colour.red()},{colour.green()},{colour.blue()},' not in style:
            found.append("the style of the map is not applied")
    context = QgsRenderContext()
    for symbol in renderer.symbols(context):
        drawn = symbol.symbolLayer(0)
        # A bowl has no fill, an outline has no colour of its own.
        if max(drawn.color().alpha(), drawn.strokeColor().alpha()) < 100 or 0 < drawn.strokeColor().alpha() < 100:
            found.append("a symbol cannot be seen")
    renderer.startRender(context, layer.fields())
    undrawn = sum(renderer.symbolForFeature(feature, context) is None for feature in layer.getFeatures())
    renderer.stopRender(context)
    if undrawn:
        found.append(f"{undrawn} rows are in no class of the style")
    return found


def rank(layer):
    """Points are drawn over lines, lines over polygons."""
    return layer.geometryType()


def drawn_value(layer, feature, settings, key):
    """What the style makes of a feature: its size in millimetres, its angle in degrees clockwise from up."""
    context = QgsExpressionContext(settings.expressionContext())
    context.setFields(layer.fields())
    context.setFeature(feature)
    value = layer.renderer().symbol().symbolLayer(0).dataDefinedProperties().property(key)
    return QgsExpression(value.expressionString()).evaluate(context)


def scale_complaints(layer, settings):
    """Craters measure on the map, from north to south, what their radius says, and walls what their length says; walls
    lie across their normals."""
    metres = {"crater": lambda f: 2 * f["radius"], "wall": lambda f: f["length"]}.get(layer.name())
    feature = next(layer.getFeatures(), None)
    if metres is None or feature is None:
        return []
    crs = layer.crs()
    unit = math.pi / 180 * QgsEllipsoidUtils.ellipsoidParameters(crs.ellipsoidAcronym()).semiMajor if crs.isGeographic() else 1
    wanted = metres(feature) / unit / settings.mapUnitsPerPixel() / settings.outputDpi() * 25.4
    drawn = drawn_value(layer, feature, settings, QgsSymbolLayer.PropertySize)
    found = []
    if wanted > 5 and abs(drawn / wanted - 1) > 0.03:
        found.append(f"a {layer.name()} of {wanted:.1f} mm has {drawn:.1f} mm")
    if layer.name() == "wall":
        angle = drawn_value(layer, feature, settings, QgsSymbolLayer.PropertyAngle)
        if abs(math.remainder(angle - math.degrees(feature["direction"]) - 90, 180)) > 0.01:
            found.append(f"a wall whose normal is {math.degrees(feature['direction']):.1f} is drawn at {angle:.1f} degrees")
    return found


def shaded_dem(path):
    layer = QgsRasterLayer(path, "dem")
    layer.setRenderer(QgsHillshadeRenderer(layer.dataProvider(), 1, 315, 45))
    layer.renderer().setZFactor(1 / 111000 if layer.crs().isGeographic() else 1)
    layer.renderer().setOpacity(0.55)
    return layer


def render(layers, picture):
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(layers[0].crs())
    settings.setBackgroundColor(QColor("#f4f1ea"))
    extent = layers[-1].extent()
    extent.scale(1.05)
    settings.setExtent(extent)
    settings.setOutputSize(QSize(900, int(900 * min(1.4, max(0.5, extent.height() / extent.width())))))
    context = QgsExpressionContext()  # as the canvas gives it: styles use @map_scale
    context.appendScope(QgsExpressionContextUtils.globalScope())
    context.appendScope(QgsExpressionContextUtils.mapSettingsScope(settings))
    settings.setExpressionContext(context)
    job = QgsMapRendererSequentialJob(settings)
    job.start()
    job.waitForFinished()
    found = [complaint for layer in layers if isinstance(layer, QgsVectorLayer) for complaint in scale_complaints(layer, settings)]
    print(*found, sep="\n", end="\n" if found else "")
    return not found and job.renderedImage().save(picture)


def main(path, picture, dem=None):
    application = QgsApplication([], False)
    application.initQgis()
    failed = False
    layers = []
    styles = styles_of(path)
    for name in layer_names(path):
        layer = QgsVectorLayer(f"{path}|layername={name}", name, "ogr")
        for complaint in complaints(layer, styles[name]):
            print(f"{name}: {complaint}")
            failed = True
        print(f"{name}: {layer.featureCount()} landmarks, {layer.crs().authid() or layer.crs().description()}, "
              f"{layer.renderer().type()}, labels {'on' if layer.labelsEnabled() else 'off'}")
        if layer.isValid() and layer.featureCount() > 0:
            layers.append(layer)
    layers.sort(key=rank)
    if dem:
        layers.append(shaded_dem(dem))
    if not layers or not render(layers, picture):
        print("nothing was drawn, or not to scale")
        failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.stdout.flush()
    code = main(*sys.argv[1:4])
    sys.stdout.flush()
    os._exit(code)  # QGIS 3.22 crashes while it takes itself down under Python
