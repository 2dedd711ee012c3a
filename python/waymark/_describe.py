# SPDX-License-Identifier: Apache-2.0
"""Signatures and docstrings of functions that take the keywords of a workflow."""

import inspect

from . import _keywords, _waymark


def takes(table, but=(), more=False):
    """Replaces the last parameter, **options, by the keywords of a table, and lists them in the docstring.

    Keywords in `but` are not offered; with `more` the function takes others, too. Names and defaults come from the C++ library when the package is imported; descriptions from _keywords.py, and
    those of the settings of detectors from the library.
    """
    def describe(function):
        own = list(inspect.signature(function).parameters.values())
        names = {parameter.name for parameter in own} | set(but)
        lines, offered = [], []
        for name, default in getattr(_waymark, f"{table}_keywords")().items():
            text = _keywords.DESCRIPTIONS.get(table, {}).get(name, "") + _of_detectors(table, name)
            if name not in names:
                offered.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default,
                                                 annotation=_annotation(default)))
                lines.append(f"{name}: {text}" if text else name)
        rest = own[-1:] if more else []
        function.__signature__ = inspect.Signature([*own[:-1], *offered, *rest])
        function.__doc__ = inspect.cleandoc(function.__doc__) + "\n\nKeywords:\n" + "\n".join(f"    {line}" for line in lines)
        return function

    return describe


def _of_detectors(table, name):
    """Returns what detectors in images declare of a keyword: their methods, and settings of their own."""
    if table != "detect":
        return ""
    detectors = _waymark.image_detectors().items()
    if name == "method":
        return " (" + "; ".join(f"{kind}: {', '.join(about['methods'])}" for kind, about in detectors) + ")"
    return "; ".join(f"{kind}: {about['settings'][name]}" for kind, about in detectors if name in about["settings"])


def _annotation(default):
    if default is None:
        return "int | None"
    if isinstance(default, (bool, int, float)):
        return type(default).__name__
    return "Sequence[Any] | _Path" if isinstance(default, list) else "_Path"
