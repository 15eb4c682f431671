# SPDX-License-Identifier: MIT
"""Streams, packs and shards from terrains."""

from __future__ import annotations

import ctypes
import os
import warnings
from typing import Any, List, Mapping, Optional, Sequence, Union

from numpy.typing import ArrayLike

from . import _library
from ._library import Error, library
from ._options import Crs, Files, Number, Path, options_of, path_of, text_of
from ._results import Report, Shard, Stream, report_of
from ._sources import Source, paths_of, source_from_files, source_from_points, source_of


def encode(
    array: Union[ArrayLike, Files],
    max_error: Optional[Number] = None,
    *,
    transform: Optional[Sequence[float]] = None,
    crs: Optional[Crs] = None,
    nodata: Optional[float] = None,
    max_vertices: int = 0,
    max_bytes: int = 0,
    **options: Any,
) -> Stream:
    """Encodes a raster of heights as a stream.

    array         heights in rows and columns, row 0 northernmost; NaN and masked ones are void. Or the path of a file or of
                  a folder, or a list of paths: they make one terrain, of points too. Then transform and nodata are the
                  files', and crs is a code or None
    nodata        of more void ones, compared in the type of the heights
    max_error     no height of the surface is further from the array's; a float stands for its shortest decimal
    transform     the place of the cells, whose centres have the heights: six numbers in GDAL's order, or an Affine
    crs           of x, y: an EPSG code, well-known text, or an object that has to_wkt()
    max_vertices  the best vertices, at most N, instead of max_error
    max_bytes     the smallest bound that N bytes allow, instead of both; takes minutes

    Options: never_below=True, bound_at="points" | "everywhere" (between posts, too), z_step, xy_step,
    effort="fast" | "normal" | "best", max_degree, coding="quick" | "balanced" | "dense", units="degree:metre" or ":foot",
    depths=True, vertical_epsg, surface="ground" | "top" | "bed" | "geoid" | "obstacles", source_name, date, lineage,
    attribution, license (an SPDX expression or a URL), valid="2024-01/..", epoch (of the coordinates, a year),
    source_accuracy="LE90 4" (or LE95, RMSE), digest=True, phases=True (of streams: noted as measured), and progress, a
    function of 0 .. 1; what it raises ends the work. Degrees ask for the unit of heights. Heights in other units of
    length, units=":cm", are converted to metres; depths=True negates heights that grow downwards.

    error_map gives each height a bound of its own: an array of the heights' shape, NaN for none, or the path of a raster of
    bounds or of polygons with a property max_error. Elsewhere max_error holds. A limit scales all bounds.

    Paths of files in the system of the heights, GeoJSON or what a library with GDAL reads: area (polygons; other heights are void), route with
    route_width=METRES (lines; heights far from them are void) and maybe route_edge_error (the bound at the edges, to
    which it grows from max_error), obstacles (with max_error: what stands on the terrain, with `top` or `height` and
    `radius`; the surface is below none of it), and with max_error breaklines (lines that become edges; not in packs of
    points).

    Without a bound and a limit every height is a vertex. Takes some 20 us a height, on all processors. Raises Error, also if
    an array is not two-dimensional or a height out of range.
    """
    with source_of(array, transform, crs, nodata, options.get("error_map")) as terrain:
        stream = _encode_stream(terrain, max_error, crs, max_vertices=max_vertices, max_bytes=max_bytes, **options)
    _warn(stream.report, crs, options)
    return stream


def encode_points(
    points: ArrayLike,
    max_error: Optional[Number] = None,
    *,
    crs: Optional[Crs] = None,
    max_vertices: int = 0,
    max_bytes: int = 0,
    **options: Any,
) -> Stream:
    """Encodes points, an array of rows x, y, height in any order, as a stream. All else is as for `encode`.

    More options: duplicates="middle" | "lowest" | "highest" | "mean", which of the points that share a place stands for
    all (middle: all count); bound_at="points" | "lattice", whether max_error holds where points truly lie, or at the
    places of the lattice alone, which has 16 bits.
    """
    with source_from_points(points, crs, options.get("error_map")) as terrain:
        stream = _encode_stream(terrain, max_error, crs, max_vertices=max_vertices, max_bytes=max_bytes, **options)
    _warn(stream.report, crs, options)
    return stream


def encode_pack(
    array: Union[ArrayLike, Files],
    path: Path,
    max_error: Optional[Number] = None,
    *,
    tile_vertices: int = 0,
    tile_size: int = 0,
    points: bool = False,
    transform: Optional[Sequence[float]] = None,
    crs: Optional[Crs] = None,
    nodata: Optional[float] = None,
    **options: Any,
) -> Report:
    """Encodes a raster, with points=True points, or files, as a pack of tiles and writes it to a .mtp file, which appears complete
    or not at all. No tile has more than `tile_vertices` (16 .. 2^24, default 2000) vertices; `tile_size` fixes the extent of
    a raster's tiles. All else is as for `encode`."""
    filled, caller = options_of(max_error, crs, tile_vertices=tile_vertices, tile_size=tile_size, **options)
    report = _library.Report()
    if points and paths_of(array) is None:
        made = source_from_points(array, crs, options.get("error_map"))  # type: ignore[arg-type]
    else:
        made = source_of(array, transform, crs, nodata, options.get("error_map"))
    with made as terrain, caller:
        library.microtin_encode_pack(terrain.pointer, filled, path_of(path), report)
    told = report_of(report)
    _warn(told, crs, options)
    return told


def plan_shards(
    files: Files,
    count: int,
    max_error: Optional[Number] = None,
    *,
    tile_vertices: int = 0,
    tile_size: int = 0,
    crs: Optional[Crs] = None,
    **options: Any,
) -> List[Shard]:
    """Divides the pack of rasters in files and folders into at most `count` shards of equal work. Takes the time of encoding
    a few tiles. Options are those of `encode_pack`."""
    filled, caller = options_of(max_error, crs, tile_vertices=tile_vertices, tile_size=tile_size, **options)
    if not 0 < count < 1 << 20:
        raise Error(f"count: {count} is out of range; use 1 to 1048575")
    found = (_library.Shard * count)()
    found[0].size = ctypes.sizeof(_library.Shard)
    planned = ctypes.c_uint32()
    with source_from_files(files) as terrain, caller:
        library.microtin_plan_shards(terrain.pointer, filled, count, found, planned)
    return [
        Shard(one.tile_size, one.z_step.decode(), one.first_tile, one.last_tile) for one in found[: planned.value]
    ]


def encode_shard(
    files: Files,
    shard: Shard,
    path: Path,
    max_error: Optional[Number] = None,
    *,
    tile_vertices: int = 0,
    crs: Optional[Crs] = None,
    **options: Any,
) -> None:
    """Encodes the tiles of a shard, and writes them to a file, which appears complete or not at all. Files and options are
    those of `plan_shards`. Needs the memory of a few tiles, besides what is kept of the files."""
    filled, caller = options_of(max_error, crs, tile_vertices=tile_vertices, **options)
    size, z_step, first, last = shard
    part = _library.Shard(tile_size=size, z_step=text_of(z_step), first_tile=first, last_tile=last)
    with source_from_files(files) as terrain, caller:
        library.microtin_encode_shard(terrain.pointer, filled, part, path_of(path), None)


def merge_packs(parts: Sequence[Path], path: Path) -> Report:
    """Joins the files of all shards, in any order, to the bytes that `encode_pack` writes; or joins packs of one plan. The
    report has no samples."""
    names = [path_of(part) for part in parts]
    report = _library.Report()
    library.microtin_merge_packs((ctypes.c_char_p * len(names))(*names), len(names), path_of(path), report)
    return report_of(report)


def _encode_stream(terrain: Source, max_error: Optional[Number], crs: Optional[Crs], **options: Any) -> Stream:
    filled, caller = options_of(max_error, crs, **options)
    pointer, size, report = ctypes.POINTER(ctypes.c_uint8)(), ctypes.c_uint64(), _library.Report()
    with caller:
        library.microtin_encode_stream(terrain.pointer, filled, pointer, size, report)
    try:
        stream = Stream(ctypes.string_at(pointer, size.value))
    finally:
        library.microtin_bytes_free(pointer)
    stream.report = report_of(report)
    return stream


def _warn(report: Report, crs: Optional[Crs], options: Mapping[str, Any]) -> None:
    """To the caller of the function that calls this. Unknown units are no news where nothing is said of them."""
    is_placed = crs is not None or options.get("units")
    for warning in report.warnings:
        if is_placed or not warning.startswith("the unit of x and y is not known"):
            warnings.warn(warning, stacklevel=3)
