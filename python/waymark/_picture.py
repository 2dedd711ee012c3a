# SPDX-License-Identifier: Apache-2.0
"""The picture of a map in a notebook: a table of its types, and its landmarks as points."""

import html

import numpy as np

_SIDE = 240  # pixels
_MAX_POINTS = 1000  # of each type; an even selection of the rest of the map


def _points(map):
    for name, one in map.types.items():
        if one.count:
            rows = map.landmarks(name)
            step = -(-len(rows) // _MAX_POINTS)
            yield one.colour, rows["x"][::step], rows["y"][::step]


def _svg(layers):
    x = np.concatenate([layer[1] for layer in layers])
    y = np.concatenate([layer[2] for layer in layers])
    extent = max(np.ptp(x), np.ptp(y)) or 1.0
    scale = (_SIDE - 10) / extent
    dots = []
    for colour, xs, ys in layers:
        dots += [f'<circle cx="{5 + (a - x.min()) * scale:.1f}" cy="{5 + (y.max() - b) * scale:.1f}" r="2" '
                 f'fill="{html.escape(colour)}"/>' for a, b in zip(xs, ys)]
    return (f'<svg width="{_SIDE}" height="{_SIDE}" style="border:1px solid #ccc" role="img" '
            f'aria-label="Landmarks of the map">{"".join(dots)}</svg>')


def map_as_html(map):
    """Returns a small table and a picture."""
    rows = "".join(
        f"<tr><td>{html.escape(name)}</td><td>{one.count}</td>"
        f"<td>{html.escape(', '.join(feature.name for feature in one.features))}</td></tr>"
        for name, one in map.types.items() if one.count)
    layers = list(_points(map))
    return (f"<div><b>{html.escape(map.path)}</b> ({html.escape(map.crs_name)})"
            f"<table><tr><th>type</th><th>landmarks</th><th>features</th></tr>{rows}</table>"
            f"{_svg(layers) if layers else ''}</div>")
