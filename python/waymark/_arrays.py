# SPDX-License-Identifier: Apache-2.0
"""Arrays as rasters that the workflows read."""

import contextlib
import os
import tempfile

import numpy as np

from . import _waymark

_GDAL_TYPES = {"u1": "Byte", "u2": "UInt16", "i2": "Int16", "u4": "UInt32", "i4": "Int32", "f4": "Float32",
               "f8": "Float64"}


def image_path(image):
    """Returns (path, array to keep alive): GDAL reads the array in place."""
    if isinstance(image, (str, os.PathLike)):
        return os.fspath(image), None
    array = np.asarray(image)
    kind = array.dtype.str[1:]
    if array.dtype == bool or kind not in _GDAL_TYPES:
        raise TypeError(f"an image of {array.dtype} cannot be read; convert it, e.g. to uint8 or float32")
    if array.ndim not in (2, 3):
        raise TypeError(f"an image is (rows, columns) or (rows, columns, bands), not {array.shape}")
    array = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))
    rows, columns = array.shape[:2]
    bands = array.shape[2] if array.ndim == 3 else 1
    size = array.itemsize
    return (f"MEM:::DATAPOINTER={array.ctypes.data},PIXELS={columns},LINES={rows},BANDS={bands},"
            f"DATATYPE={_GDAL_TYPES[kind]},PIXELOFFSET={size * bands},LINEOFFSET={size * bands * columns},"
            f"BANDOFFSET={size}"), array


def _place(transform, cell):
    if transform is None:
        return [0.0, 0.0, cell, -cell]
    a, b, c, d, e, f = tuple(transform)[:6]
    if b or d or not (a > 0 > e):
        raise ValueError("the transform must be north-up: a > 0, b = d = 0, e < 0")
    return [c + a / 2, f + e / 2, a, e]


@contextlib.contextmanager
def raster_files(rasters, transform=None, crs=None, cell=1.0):
    """Yields the rasters as a list of files; arrays are written to a temporary folder.

    transform is that of rasterio (a, b, c, d, e, f of the corner); without one, cells have the side `cell`.
    """
    if isinstance(rasters, (str, os.PathLike, np.ndarray)):
        rasters = [rasters]
    with tempfile.TemporaryDirectory(prefix="waymark_") as folder:
        files = []
        for raster in rasters:
            if isinstance(raster, (str, os.PathLike)):
                files.append(os.path.abspath(raster) if os.path.exists(raster) else os.fspath(raster))
                continue
            array = np.ma.filled(np.ma.asarray(raster, dtype=np.float32), np.nan)
            if array.ndim != 2 or not array.size:
                raise TypeError(f"a raster is (rows, columns), not {array.shape}")
            files.append(os.path.join(folder, f"raster_{len(files)}.tif"))
            _waymark.write_raster(files[-1], array, _place(transform, cell), str(crs or ""))
        yield files
