# SPDX-License-Identifier: Apache-2.0
"""QGIS plugin of Waymark. Modules that need QGIS are imported by QGIS only: plugin, provider, algorithm, panel."""


def classFactory(iface):  # the name that QGIS calls
    from .plugin import WaymarkPlugin
    return WaymarkPlugin(iface)
