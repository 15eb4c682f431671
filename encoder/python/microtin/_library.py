# SPDX-License-Identifier: MIT
"""microtin/encoder.h for ctypes, line by line."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from ctypes import POINTER, c_char, c_char_p, c_double, c_float, c_int, c_int64, c_size_t
from ctypes import c_uint8, c_uint32, c_uint64, c_void_p
from pathlib import Path
from typing import Any, Optional

MAJOR_VERSION = 1  # of the library whose structs are below


class Error(RuntimeError):
    """What was asked for cannot be done, or a file not be read; the message says why."""


Progress = ctypes.CFUNCTYPE(c_int, c_void_p, c_double)


class _Sized(ctypes.Structure):
    """A struct that begins with its size."""

    def __init__(self, **fields: Any) -> None:
        super().__init__(size=ctypes.sizeof(self), **fields)


class Axis(ctypes.Structure):
    _fields_ = [("offset", c_int64), ("numerator", c_uint64), ("denominator", c_uint64)]


class Raster(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("heights", POINTER(c_double)),
        ("float_heights", POINTER(c_float)),
        ("transform", c_double * 6),
        ("wkt", c_char_p),
        ("no_data", POINTER(c_double)),
    ]


class Points(_Sized):
    _fields_ = [("size", c_size_t), ("count", c_uint64), ("coordinates", POINTER(c_double)), ("wkt", c_char_p)]


class Options(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("max_error", c_char_p),
        ("z_step", c_char_p),
        ("xy_step", c_char_p),
        ("never_below", c_uint32),
        ("effort", c_uint32),
        ("max_degree", c_uint32),
        ("coding", c_uint32),
        ("bound_at", c_uint32),
        ("duplicates", c_uint32),
        ("units", c_char_p),
        ("horizontal_epsg", c_uint32),
        ("vertical_epsg", c_uint32),
        ("source_name", c_char_p),
        ("date", c_char_p),
        ("lineage", c_char_p),
        ("max_vertices", c_uint32),
        ("max_bytes", c_uint32),
        ("tile_vertices", c_uint32),
        ("tile_size", c_uint32),
        ("progress", Progress),
        ("context", c_void_p),
        ("depths", c_uint32),
        ("surface", c_uint32),
        ("attribution", c_char_p),
        ("license", c_char_p),
        ("valid", c_char_p),
        ("epoch", c_char_p),
        ("source_accuracy", c_char_p),
        ("digest", c_uint32),
        ("phases", c_uint32),
        ("error_map", c_char_p),
        ("area", c_char_p),
        ("route", c_char_p),
        ("route_width", c_char_p),
        ("breaklines", c_char_p),
        ("obstacles", c_char_p),
        ("route_edge_error", c_char_p),
    ]


class Report(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("samples", c_uint64),
        ("vertices", c_uint64),
        ("bytes", c_uint64),
        ("tiles", c_uint32),
        ("bound", c_char * 24),
        ("max_error", c_char * 24),
        ("rms_error", c_char * 24),
        ("mean_error", c_char * 24),
        ("max_below", c_char * 24),
        ("max_error_at_points", c_char * 24),
        ("max_below_at_points", c_char * 24),
        ("max_above", c_char * 24),
        ("max_below_everywhere", c_char * 24),
        ("max_above_everywhere", c_char * 24),
        ("least_bound", c_char * 24),
        ("largest_bound", c_char * 24),
        ("max_bound_ratio", c_char * 24),
    ]


class Shard(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("tile_size", c_uint32),
        ("first_tile", c_uint32),
        ("last_tile", c_uint32),
        ("z_step", c_char * 24),
    ]


class Grid(_Sized):
    _fields_ = [("size", c_size_t), ("columns", c_uint32), ("rows", c_uint32), ("x", Axis), ("y", Axis)]


class Phase(ctypes.Structure):
    _fields_ = [("vertices", c_uint64), ("bytes", c_uint64), ("max_error", c_char_p)]


class SurfaceInfo(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("bytes", c_uint64),
        ("vertices", c_uint64),
        ("is_pack", c_uint32),
        ("tile_columns", c_uint32),
        ("tile_rows", c_uint32),
        ("west", c_double),
        ("south", c_double),
        ("east", c_double),
        ("north", c_double),
        ("lowest", c_double),
        ("highest", c_double),
        ("x", Axis),
        ("y", Axis),
        ("z", Axis),
        ("horizontal_unit", c_uint32),
        ("vertical_unit", c_uint32),
        ("horizontal_epsg", c_uint32),
        ("vertical_epsg", c_uint32),
        ("wkt", c_char_p),
        ("source_name", c_char_p),
        ("date", c_char_p),
        ("lineage", c_char_p),
        ("bound", c_char_p),
        ("max_error", c_char_p),
        ("rms_error", c_char_p),
        ("mean_error", c_char_p),
        ("max_error_at_points", c_char_p),
        ("surface", c_uint32),
        ("side", c_uint32),
        ("max_below", c_char_p),
        ("max_above", c_char_p),
        ("max_below_everywhere", c_char_p),
        ("max_above_everywhere", c_char_p),
        ("attribution", c_char_p),
        ("license", c_char_p),
        ("valid", c_char_p),
        ("epoch", c_char_p),
        ("source_accuracy", c_char_p),
        ("digest", c_char_p),
        ("phases", POINTER(Phase)),
        ("phase_count", c_uint64),
        ("least_bound", c_char_p),
        ("largest_bound", c_char_p),
        ("max_bound_ratio", c_char_p),
    ]


class TileMargins(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("max_below_everywhere", c_char * 24),
        ("max_above_everywhere", c_char * 24),
    ]


class HeightBounds(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("lowest", c_double),
        ("highest", c_double),
        ("source_lowest", c_double),
        ("source_highest", c_double),
        ("is_complete", c_uint32),
    ]


class Triangles(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("vertices", c_uint64),
        ("triangles", c_uint64),
        ("coordinates", POINTER(c_double)),
        ("corners", POINTER(c_uint32)),
    ]


class Lines(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("count", c_uint64),
        ("classes", POINTER(c_char_p)),
        ("vertices", POINTER(c_uint64)),
        ("coordinates", POINTER(c_double)),
    ]


class Profile(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("count", c_uint64),
        ("places", POINTER(c_double)),
        ("is_known_before", POINTER(c_uint8)),
        ("length", c_double),
        ("earth_radius", c_double),
        ("geodesic_deviation", c_double),
        ("result", c_uint32),
    ]


class SightOptions(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("earth_factor", c_double),
        ("frequency", c_double),
        ("zone_share", c_double),
        ("is_safe", c_uint32),
        ("from_datum", c_uint32),
        ("to_datum", c_uint32),
    ]


class Sights(_Sized):
    _fields_ = [
        ("size", c_size_t),
        ("line", POINTER(c_uint8)),
        ("zone", POINTER(c_uint8)),
        ("least_clearance", POINTER(c_double)),
        ("least_clearance_at", POINTER(c_double)),
        ("first_obstruction", POINTER(c_double)),
        ("first_zone_obstruction", POINTER(c_double)),
        ("free_share", POINTER(c_double)),
        ("free_share_at", POINTER(c_double)),
    ]


OK, NO_MEMORY, CANCELLED, INTERNAL = 0, 65, 66, 67
Doubles = POINTER(c_double)

_FUNCTIONS = {
    "source_from_raster": [POINTER(Raster), POINTER(c_void_p)],
    "source_from_points": [POINTER(Points), POINTER(c_void_p)],
    "source_set_error_map": [c_void_p, POINTER(Raster)],
    "source_from_file": [c_char_p, POINTER(c_void_p)],
    "source_from_files": [POINTER(c_char_p), c_uint64, POINTER(c_void_p)],
    "encode_stream": [c_void_p, POINTER(Options), POINTER(POINTER(c_uint8)), POINTER(c_uint64), POINTER(Report)],
    "encode_pack": [c_void_p, POINTER(Options), c_char_p, POINTER(Report)],
    "plan_shards": [c_void_p, POINTER(Options), c_uint32, POINTER(Shard), POINTER(c_uint32)],
    "encode_shard": [c_void_p, POINTER(Options), POINTER(Shard), c_char_p, POINTER(Report)],
    "merge_packs": [POINTER(c_char_p), c_uint64, c_char_p, POINTER(Report)],
    "surface_from_file": [c_char_p, POINTER(c_void_p)],
    "surface_from_bytes": [c_char_p, c_uint64, c_char_p, POINTER(c_void_p)],
    "surface_get_info": [c_void_p, POINTER(SurfaceInfo)],
    "surface_mesh": [c_void_p, POINTER(Triangles)],
    "surface_lines": [c_void_p, POINTER(Lines)],
    "surface_tile": [c_void_p, c_uint32, c_uint32, POINTER(Triangles)],
    "surface_tile_margins": [c_void_p, c_uint32, c_uint32, POINTER(TileMargins)],
    "surface_heights": [c_void_p, c_uint64, Doubles, Doubles, Doubles],
    "surface_gradients": [c_void_p, c_uint64, Doubles, Doubles, Doubles, Doubles],
    "surface_bounds_in_box": [c_void_p, c_double, c_double, c_double, c_double, POINTER(HeightBounds)],
    "surface_bounds_on_line": [c_void_p, c_double, c_double, c_double, c_double, POINTER(HeightBounds)],
    "surface_profile": [c_void_p, c_double, c_double, c_double, c_double, POINTER(Profile)],
    "surface_lines_of_sight": [c_void_p, c_uint64, Doubles, POINTER(SightOptions), POINTER(Sights)],
    "surface_grid": [c_void_p, c_char_p, POINTER(Grid)],
    "surface_sample_grid": [c_void_p, POINTER(Grid), Doubles],
}

_WITHOUT_STATUS = {
    "source_free": ([c_void_p], None),
    "bytes_free": ([POINTER(c_uint8)], None),
    "surface_free": ([c_void_p], None),
    "last_error": ([], c_char_p),
    "last_warnings": ([], c_char_p),
    "version_string": ([], c_char_p),
}


def _checked(status: int, _function: Any, _arguments: Any) -> None:
    if status == OK:
        return
    message = library.microtin_last_error().decode(errors="replace")  # names of files may be any bytes
    if status == NO_MEMORY:
        raise MemoryError(message)
    raise Error(message if status != INTERNAL else f"a fault of microtin's own: {message}")


def _installed() -> Optional[str]:
    """The system's library: of the major version whose structs are here, if the loader finds that; or any."""
    name = f"libmicrotin.so.{MAJOR_VERSION}"
    try:
        ctypes.CDLL(name)
    except OSError:
        return ctypes.util.find_library("microtin")
    return name


def _load() -> ctypes.CDLL:
    """The library of the environment's MICROTIN_LIBRARY, of this package, or of the system."""
    packed = Path(__file__).with_name("libmicrotin.so")
    name = os.environ.get("MICROTIN_LIBRARY") or (str(packed) if packed.exists() else _installed())
    if name is None:
        raise ImportError("libmicrotin.so is neither in the package nor installed; MICROTIN_LIBRARY names another")
    loaded = ctypes.CDLL(name)
    for function, arguments in _FUNCTIONS.items():
        getattr(loaded, f"microtin_{function}").argtypes = arguments
        getattr(loaded, f"microtin_{function}").errcheck = _checked
    for function, (arguments, result) in _WITHOUT_STATUS.items():
        getattr(loaded, f"microtin_{function}").argtypes = arguments
        getattr(loaded, f"microtin_{function}").restype = result
    return loaded


library = _load()
