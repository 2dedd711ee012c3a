# SPDX-License-Identifier: Apache-2.0
"""The provider of the Processing toolbox: one algorithm per command."""

import os

from qgis.core import QgsApplication, QgsMessageLog, QgsProcessingProvider, QgsSettings

from . import command_form, declarations
from .algorithm import CommandAlgorithm


def program():
    """Returns the path of the program, None if it is not found."""
    return declarations.find_program(QgsSettings().value("waymark/program", "", type=str))


class WaymarkProvider(QgsProcessingProvider):
    def id(self):
        return "waymark"

    def name(self):
        return "Waymark"

    def longName(self):
        return "Waymark: semantic navigation maps"

    def loadAlgorithms(self):
        found = program()
        cache = os.path.join(QgsApplication.qgisSettingsDirPath(), "waymark")
        try:
            known, source = declarations.load(found, cache)
        except declarations.DeclarationsMissing as problem:
            QgsMessageLog.logMessage(str(problem), "Waymark")
            return
        if source == "shipped":
            QgsMessageLog.logMessage("The program waymark was not asked: the algorithms are those the plugin came with.",
                                     "Waymark")
        for command in command_form.commands(known):
            self.addAlgorithm(CommandAlgorithm(command, found))
