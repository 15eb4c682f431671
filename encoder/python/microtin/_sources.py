# SPDX-License-Identifier: MIT
"""Terrains to be encoded: arrays, points and files."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from . import _library
from ._library import Error, library
from ._options import Crs, ErrorMap, Files, Path, epsg_of, path_of, wkt_of

_BLOCK = 1 << 14  # rows, whose texts take some 6 MB


class Source:
    """A terrain to be encoded, until the end of a with statement."""

    def __init__(self, make: Callable[..., None], *content: Any) -> None:
        self.pointer = ctypes.c_void_p()
        make(*content, self.pointer)

    def __enter__(self) -> "Source":
        return self

    def __exit__(self, *_: Any) -> None:
        library.microtin_source_free(self.pointer)


def _float(number: Any) -> float:
    """The number that a float of any size stands for: 0.1 of numpy.float32(0.1)."""
    return float(str(number)) if isinstance(number, numpy.floating) else float(number)


def _transform_of(transform: Optional[Sequence[float]], rows: int) -> Tuple[float, ...]:
    if transform is None:
        return (-0.5, 1, 0, rows - 0.5, 0, -1)
    numbers: Sequence[Any] = transform.to_gdal() if hasattr(transform, "to_gdal") else transform
    if len(numbers) != 6:
        raise Error("a transform has six numbers")
    return tuple(_float(number) for number in numbers)


def _mask_of(array: ArrayLike) -> Any:
    """A copy of the mask of a masked array, in its shape; all False for others."""
    mask: Any = array.mask if isinstance(array, numpy.ma.MaskedArray) else False
    return numpy.broadcast_to(mask, numpy.shape(array)).copy()


def _expect_exact(numbers: Any, skipped: Any, what: str) -> None:
    """Raises Error if floats of 64 bits cannot hold one of these integers."""
    if numbers.dtype.kind in "iu" and numbers.dtype.itemsize == 8:
        beyond = numbers > 2**53
        if numbers.dtype.kind == "i":
            beyond |= numbers < -(2**53)
        if (beyond & ~skipped).any():
            raise Error(f"{what} is beyond 2^53; use floats, or a larger unit")


def _declared_void(heights: Any, nodata: float) -> Any:
    """Where integers equal nodata, compared as integers."""
    if isinstance(nodata, (int, numpy.integer)):
        return heights == int(nodata)
    return heights == int(float(nodata)) if float(nodata).is_integer() else numpy.zeros(heights.shape, bool)


def _raster_of(
    array: ArrayLike, transform: Optional[Sequence[float]], crs: Optional[Crs], nodata: Optional[float]
) -> _library.Raster:
    void, heights = _mask_of(array), numpy.asarray(array)
    if heights.ndim != 2:
        raise Error(f"a raster has two dimensions, not {heights.ndim}")
    kind, size = heights.dtype.kind, heights.dtype.itemsize
    if kind not in "iuf" or size > 8:
        raise Error(f"heights are integers or floats of up to 64 bits, not {heights.dtype}")
    if nodata is not None and kind != "f":
        void |= _declared_void(heights, nodata)
        nodata = None
    _expect_exact(heights, void, "a height")
    if nodata is not None:
        # The library compares in 32 and 64 bits.
        nodata = float(numpy.float16(nodata)) if size == 2 else _float(nodata)
    number: Any = numpy.float32 if kind == "f" and size == 4 else numpy.float64
    heights = numpy.ascontiguousarray(heights, number)
    if void.any():
        heights = numpy.where(void, numpy.array(numpy.nan, number), heights)
    raster = _library.Raster(columns=heights.shape[1], rows=heights.shape[0], wkt=wkt_of(crs))
    raster.transform[:] = _transform_of(transform, heights.shape[0])
    if nodata is not None:
        raster.no_data = ctypes.pointer(ctypes.c_double(nodata))
    if number == numpy.float32:
        raster.float_heights = heights.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
    else:
        raster.heights = heights.ctypes.data_as(_library.Doubles)
    raster.kept = heights  # as long as the pointer to it
    return raster


def paths_of(array: Any) -> Optional[List[Path]]:
    """The paths that stand in place of an array; None for an array."""
    if isinstance(array, (str, os.PathLike)):
        return [array]
    is_list = isinstance(array, (list, tuple)) and len(array) > 0
    return list(array) if is_list and all(isinstance(one, (str, os.PathLike)) for one in array) else None


def source_from_files(files: Files) -> Source:
    paths = paths_of(files)
    if paths is None:
        raise Error("files are a path, or a list of paths")
    names = [path_of(path) for path in paths]
    return Source(library.microtin_source_from_files, (ctypes.c_char_p * len(names))(*names), len(names))


def source_of(
    array: Union[ArrayLike, Files],
    transform: Optional[Sequence[float]],
    crs: Optional[Crs],
    nodata: Optional[float],
    error_map: Optional[ErrorMap],
) -> Source:
    if isinstance(array, bytes):
        raise Error("bytes are neither an array nor a path; use a str for a path")
    if paths_of(array) is None:
        return _source_from_array(array, transform, crs, nodata, error_map)  # type: ignore[arg-type]
    if transform is not None or nodata is not None or (crs is not None and epsg_of(crs) is None):
        raise Error("files state their own transform, nodata and well-known text; leave these out")
    if error_map is not None and not isinstance(error_map, (str, bytes, os.PathLike)):
        raise Error("error_map: files take the path of a map, not an array")
    return source_from_files(array)  # type: ignore[arg-type]


def _source_from_array(
    array: ArrayLike,
    transform: Optional[Sequence[float]],
    crs: Optional[Crs],
    nodata: Optional[float],
    error_map: Optional[ErrorMap],
) -> Source:
    source = Source(library.microtin_source_from_raster, _raster_of(array, transform, crs, nodata))
    if error_map is None or isinstance(error_map, (str, bytes, os.PathLike)):
        return source
    try:
        if numpy.shape(error_map) != numpy.shape(array):
            raise Error(f"error_map has the shape {numpy.shape(error_map)}, and the array {numpy.shape(array)}")
        library.microtin_source_set_error_map(source.pointer, _raster_of(error_map, transform, None, None))
    except BaseException:
        source.__exit__()
        raise
    return source


def _shortest(numbers: Any) -> Any:
    """The shortest decimals of floats of 32 bits, as floats of 64. The texts of a block of rows exist at a time."""
    exact = numpy.empty(numbers.shape)
    for begin in range(0, len(numbers), _BLOCK):
        exact[begin : begin + _BLOCK] = numbers[begin : begin + _BLOCK].astype("U32")
    return exact


def source_from_points(points: ArrayLike, crs: Optional[Crs], error_map: Optional[ErrorMap]) -> Source:
    if error_map is not None and not isinstance(error_map, (str, bytes, os.PathLike)):
        raise Error("error_map: points take the path of a map, not an array")
    rows = numpy.asarray(points)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise Error("points are rows of x, y and height")
    if rows.dtype.kind in "bcmMV":
        raise Error(f"points are integers or floats, not {rows.dtype}")
    masked = _mask_of(points)
    if masked.any():
        raise Error("points are masked; leave these out: points[~points.mask.any(axis=1)]")
    _expect_exact(rows, masked, "a coordinate")
    rows = _shortest(rows) if rows.dtype.kind == "f" and rows.dtype.itemsize == 4 else rows
    rows = numpy.ascontiguousarray(rows, numpy.float64)
    content = _library.Points(
        count=len(rows), coordinates=rows.ctypes.data_as(_library.Doubles), wkt=wkt_of(crs)
    )
    return Source(library.microtin_source_from_points, content)
