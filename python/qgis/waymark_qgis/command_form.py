# SPDX-License-Identifier: Apache-2.0
"""Forms of commands: the parameters that a declaration asks for, and the command line of their values."""

import re
from dataclasses import dataclass, field

# Commands that explain the program rather than work with data.
GROUPS = {"make": "Make maps", "use": "Use maps"}

# Suffixes of outputs by placeholder, where it names a single kind.
FILTERS = {".gpkg": "GeoPackage (*.gpkg)", ".tif": "GeoTIFF (*.tif)", ".html": "Web page (*.html)",
           ".json": "JSON (*.json)", ".csv": "CSV (*.csv)", ".yaml": "YAML (*.yaml)"}


@dataclass(frozen=True)
class Parameter:
    """A field of the form.

    kind: file, files, text, texts (one per line), choice, integer, number, numbers (separated by blanks or commas),
    flag, output_file, output_folder.
    """
    name: str
    kind: str
    label: str
    required: bool
    option: str = ""  # "--threads"; empty: a positional word
    count: int = 1    # of numbers
    choices: tuple = ()
    suffixes: tuple = ()
    help: str = field(default="", compare=False)


def commands(declarations):
    """Returns the declarations of the commands that become algorithms."""
    return [one for one in declarations["commands"] if one["group"] in GROUPS]


def _suffixes(argument):
    return tuple(re.findall(r"\.[a-z]+\b", argument["value"]))


def _kind(argument):
    kind, offer = argument["kind"], argument.get("offer")
    if argument["names"][:1] == ["-o"]:
        is_folder = offer == "folder" or argument["value"] == "DIR"
        return "output_folder" if is_folder else "output_file"
    if kind in ("flag", "integer", "number", "numbers"):
        return kind
    if offer in ("file", "folder"):
        return "files" if kind == "texts" else "file"
    return "choice" if argument.get("choices") and kind == "text" else kind


def _name(argument):
    word = argument["names"][-1] if argument["names"] else argument["value"]
    return re.sub(r"\W+", "_", word).strip("_").upper()


def parameters(command):
    """Returns the parameters of a command, in the order of its declaration."""
    found = []
    for argument in command["arguments"]:
        label = argument["help"] if len(argument["help"]) < 90 else argument["help"].split(";")[0]
        default = f" (default: {argument['default']})" if "default" in argument else ""
        found.append(Parameter(
            name=_name(argument), kind=_kind(argument), label=label + default, required=argument["required"],
            option=argument["names"][-1] if argument["names"] else "", count=len(argument["value"].split()),
            choices=tuple(argument.get("choices", ())), suffixes=_suffixes(argument), help=argument["help"]))
    names = [one.name for one in found]
    assert len(set(names)) == len(names), f"two arguments of {command['name']} have one name: {names}"
    return found


def file_filter(parameter):
    """Returns a file filter as Qt wants it."""
    known = [FILTERS[one] for one in parameter.suffixes if one in FILTERS]
    return ";;".join([*known, "All files (*)"])


def _words(parameter, value):
    """Returns the words of one value after the option, one list per use of the option."""
    if parameter.kind == "numbers":
        words = re.split(r"[\s,]+", str(value).strip())
        if parameter.count and len(words) != parameter.count:
            raise ValueError(f"{parameter.label}: {parameter.count} numbers are needed, separated by blanks")
        for word in words:
            float(word)
        return [words]
    if parameter.kind in ("files", "texts"):
        lines = value if isinstance(value, (list, tuple)) else str(value).splitlines()
        return [[str(line).strip()] for line in lines if str(line).strip()]
    return [[str(value)]]


def _plain(word):
    """Returns a positional word that no reader of options takes for one."""
    return "./" + word if word.startswith("-") else word


def command_line(command, values):
    """Returns the words after the program's name. `values`: by the names of parameters; None and "" are not given.

    Raises ValueError for a list of numbers that has too few or no numbers.
    """
    positional, options = [], []
    for parameter in parameters(command):
        value = values.get(parameter.name)
        if value is None or value == "" or value == [] or value is False:
            continue
        if parameter.kind == "flag":
            options.append(parameter.option)
            continue
        for words in _words(parameter, value):
            if parameter.option:
                options += [parameter.option, *words] if parameter.kind == "numbers" else [f"{parameter.option}={words[0]}"]
            else:
                positional += [_plain(word) for word in words]
    return [command["name"], *positional, *options]


def outputs(command, values):
    """Returns the paths of the outputs that a run with these values writes."""
    return {one.name: values[one.name] for one in parameters(command)
            if one.kind.startswith("output") and values.get(one.name)}
