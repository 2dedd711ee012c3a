# SPDX-License-Identifier: Apache-2.0
"""Stages of jobs: one function per stage, made from the declarations of the library.

waymark.stages.find_mountain_tops(min_prominence=50) returns {"stage": "find_mountain_tops", "min_prominence": 50}.
The functions take the options of the stage as keywords; help() lists them.
"""

import inspect
import json

from . import _waymark

_STAGES = json.loads(_waymark.stages_as_json())


def describe(name):
    """Returns the declaration of a stage, as `waymark stages NAME --as json`."""
    return _STAGES[name]


def option_line(name, option):
    """Returns the line of an option in a docstring."""
    unit = f" [{option['x-unit']}]" if "x-unit" in option else ""
    bounds = ", ".join(f"{word} {option[key]:g}" for key, word in (("minimum", "at least"), ("maximum", "at most"))
                       if key in option)
    choices = "one of " + ", ".join(option["enum"]) if "enum" in option else ""
    limits = "; ".join(part for part in (bounds, choices) if part)
    return f"{name}{unit}: {option['description']}" + (f" ({limits})" if limits else "")


def docstring(declared):
    """Returns the docstring of a stage."""
    lines = [option_line(name, option) for name, option in declared["options"].items()]
    return "\n".join([declared["summary"] + ".", "", *lines]).rstrip()


def _function(name, declared):
    def stage(**options):
        unknown = set(options) - set(declared["options"])
        if unknown:
            raise TypeError(f"{name} has no option '{sorted(unknown)[0]}'")
        return {"stage": name, **options}

    stage.__name__ = stage.__qualname__ = name
    stage.__doc__ = docstring(declared)
    stage.__signature__ = inspect.Signature(
        [inspect.Parameter(option, inspect.Parameter.KEYWORD_ONLY, default=about["default"])
         for option, about in declared["options"].items()], return_annotation=dict)
    return stage


__all__ = sorted(_STAGES)
globals().update({name: _function(name, declared) for name, declared in _STAGES.items()})
