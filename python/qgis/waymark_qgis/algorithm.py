# SPDX-License-Identifier: Apache-2.0
"""One command of the program as an algorithm of the Processing toolbox."""

import os
import shlex

from qgis.core import (
    QgsProcessing, QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingException, QgsProcessingParameterBoolean,
    QgsProcessingParameterEnum, QgsProcessingParameterFile, QgsProcessingParameterFileDestination,
    QgsProcessingParameterFolderDestination, QgsProcessingParameterMultipleLayers, QgsProcessingParameterNumber,
    QgsProcessingParameterString)

from . import command_form, map_tables, run_program


def _first(*values):
    """Returns the first value that this version of QGIS has: enumerations moved between 3 and 4."""
    for owner, name in values:
        if hasattr(owner, name):
            return getattr(owner, name)
    raise AttributeError(values[0][1])


INTEGER = _first((QgsProcessingParameterNumber, "Integer"))
DOUBLE = _first((QgsProcessingParameterNumber, "Double"))
FILES = _first((QgsProcessing, "TypeFile"))


def field(parameter):
    """Returns the field of a form for a parameter."""
    name, label, optional = parameter.name, parameter.label, not parameter.required
    if parameter.kind == "flag":
        return QgsProcessingParameterBoolean(name, label, defaultValue=False, optional=True)
    if parameter.kind in ("integer", "number"):
        return QgsProcessingParameterNumber(name, label, INTEGER if parameter.kind == "integer" else DOUBLE,
                                            defaultValue=None, optional=optional)
    if parameter.kind == "choice":
        return QgsProcessingParameterEnum(name, label, options=list(parameter.choices), optional=optional,
                                          usesStaticStrings=True)
    if parameter.kind == "files":
        return QgsProcessingParameterMultipleLayers(name, label, FILES, optional=optional)
    if parameter.kind == "file":
        # A text with a button: folders, databases and paths of GDAL are files, too.
        return QgsProcessingParameterFile(name, label, optional=optional, fileFilter=command_form.file_filter(parameter))
    if parameter.kind == "output_file":
        return QgsProcessingParameterFileDestination(name, label, command_form.file_filter(parameter), optional=optional)
    if parameter.kind == "output_folder":
        return QgsProcessingParameterFolderDestination(name, label, optional=optional)
    return QgsProcessingParameterString(name, label, optional=optional, multiLine=parameter.kind == "texts")


class CommandAlgorithm(QgsProcessingAlgorithm):
    """`waymark NAME`."""

    def __init__(self, command, program):
        super().__init__()
        self.command = command
        self.program = program
        self.form = command_form.parameters(command)

    def createInstance(self):
        return CommandAlgorithm(self.command, self.program)

    def name(self):
        return self.command["name"]

    def displayName(self):
        return self.command["summary"]

    def group(self):
        return command_form.GROUPS[self.command["group"]]

    def groupId(self):
        return self.command["group"]

    def tags(self):
        return ["waymark", self.command["name"]]

    def shortDescription(self):
        return f"waymark {self.command['name']}"

    def shortHelpString(self):
        examples = "\n".join(f"{one['command']}\n    {one['summary']}" for one in self.command["examples"])
        options = "\n".join(f"{one.option or one.name}: {one.help}" for one in self.form)
        return "\n\n".join(part for part in (self.command["about"], options, examples and "Examples\n" + examples) if part)

    def initAlgorithm(self, configuration=None):
        for parameter in self.form:
            self.addParameter(field(parameter))

    def checkParameterValues(self, parameters, context):
        try:
            command_form.command_line(self.command, self._values(parameters, context))
        except ValueError as problem:
            return False, str(problem)
        return super().checkParameterValues(parameters, context)

    def _values(self, parameters, context):
        """Returns the values that were given, by name; destinations get their paths."""
        values = {}
        for one in self.form:
            given = parameters.get(one.name)
            if given is None or given == "":
                continue
            if one.kind == "flag":
                values[one.name] = self.parameterAsBool(parameters, one.name, context)
            elif one.kind == "integer":
                values[one.name] = self.parameterAsInt(parameters, one.name, context)
            elif one.kind == "number":
                values[one.name] = repr(self.parameterAsDouble(parameters, one.name, context))
            elif one.kind == "choice":
                values[one.name] = self.parameterAsEnumString(parameters, one.name, context)
            elif one.kind == "files":
                values[one.name] = self.parameterAsFileList(parameters, one.name, context)
            elif one.kind == "output_file":
                values[one.name] = self.parameterAsFileOutput(parameters, one.name, context)
            else:
                values[one.name] = self.parameterAsString(parameters, one.name, context)
        return values

    def processAlgorithm(self, parameters, context, feedback):
        if not self.program:
            raise QgsProcessingException(
                "The program waymark is not found. Install it, or name it in Settings > Options > Waymark or the "
                "environment variable WAYMARK.")
        values = self._values(parameters, context)
        words = command_form.command_line(self.command, values)
        feedback.pushCommandInfo(shlex.join(["waymark", *words]))

        def progress(stage, part):
            feedback.setProgressText(stage)
            feedback.setProgress(100 * part)

        done = run_program.run(self.program, words, progress, feedback.pushInfo, feedback.isCanceled)
        if done.out:
            feedback.pushConsoleInfo(done.out)
        if done.cancelled:
            return {}
        if done.code == 3:  # the outputs exist
            feedback.reportError("Some units failed; a second run does only those.", False)
        elif done.code != 0:
            reason = run_program.EXIT_CODES.get(done.code, f"the program ended with code {done.code}")
            raise QgsProcessingException(f"waymark {self.command['name']}: {reason}\n{done.errors}")
        results = command_form.outputs(self.command, values)
        for path in results.values():
            load_layers(path, context)
        return {**results, "STANDARD_OUTPUT": done.out}


def layer_sources(path):
    """Returns (name, source) of the layers that an output offers: the styled layers of a map, or a raster."""
    if not os.path.isfile(path):
        return []
    if map_tables.is_map(path):
        return [(name, f"{path}|layername={name}") for name in map_tables.styled_layers(path)]
    return [(os.path.splitext(os.path.basename(path))[0], path)] if path.endswith((".tif", ".geojson")) else []


def load_layers(path, context):
    """Lets the layers of an output be added to the project; each brings the style that the map holds."""
    project = context.project()
    if project is None:
        return
    for name, source in layer_sources(path):
        context.addLayerToLoadOnCompletion(source, QgsProcessingContext.LayerDetails(name, project, name))
