# SPDX-License-Identifier: MIT
"""Terrain TINs in the fewest bits: numpy arrays in, numpy arrays out.

    >>> import microtin, numpy
    >>> heights = numpy.hypot(*numpy.mgrid[-50:51, -50:51])
    >>> data = microtin.encode(heights, max_error=0.5)     # bytes: write them to a .mtin file
    >>> tin = microtin.decode(data)
    >>> tin.vertices.shape[1], tin.triangles.shape[1]
    (3, 3)
    >>> array, transform = tin.raster()
    >>> bool(numpy.abs(array - heights).max() <= 0.5)
    True

Arrays of heights are maps: row 0 is the northernmost. Without a transform the height of [row, column] lies at x = column,
y = rows - 1 - row, so that y runs north, not with the rows as pydelatin has it.
"""

from __future__ import annotations

import ctypes
import decimal
import os
import re
import threading
import warnings
import weakref
from dataclasses import dataclass
from typing import Any, Callable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _library
from ._library import Error, library

__all__ = ["Error", "HeightBounds", "LineOfSight", "Profile", "Report", "Shard", "Stream", "Surface", "Tile", "decode", "encode", "encode_pack", "encode_points", "encode_shard", "merge_packs", "plan_shards"]
__version__: str = library.microtin_version_string().decode()

Number = Union[int, float, str, decimal.Decimal]
Crs = Union[int, str, Any]
Path = Union[str, "os.PathLike[str]"]
ErrorMap = Union[str, "os.PathLike[str]", ArrayLike]
Files = Union[Path, Sequence[Path]]

_EFFORTS = {"fast": 1, "normal": 2, "best": 3}
_CODINGS = {"quick": 1, "balanced": 2, "dense": 3}
_BOUND_AT = {"points": 1, "lattice": 2, "everywhere": 3}
_DUPLICATES = {"middle": 1, "lowest": 2, "highest": 3, "mean": 4}
_SURFACES = {"unknown": 0, "ground": 1, "top": 2, "bed": 3, "geoid": 4, "obstacles": 5}
_SIGHTS = numpy.array(["clear", "blocked", "unknown"])
_MISSING = {0: None, 1: "outside", 2: "void"}
_SIDES = (None, "both", "never_below", "never_above")
UNITS = {0: None, 1: "metre", 2: "degree", 3: "foot", 4: "US survey foot"}


@dataclass(frozen=True)
class Report:
    """What came of an encoding. Errors are in units of heights, measured at every sample, and rounded up."""

    samples: int
    vertices: int
    bytes: int
    tiles: int  # 0: a stream
    max_error: float
    rms_error: float
    mean_error: float  # above 0: the surface is too high
    max_below: float  # how far the surface is below a height at most
    max_above: float  # how far the surface is above a height at most
    max_below_everywhere: Optional[float] = None  # from the bilinear surface of a raster's posts, as the header states
    max_above_everywhere: Optional[float] = None
    max_error_at_points: Optional[float] = None  # where points truly lie, if the lattice moves them
    max_below_at_points: Optional[float] = None
    least_bound: Optional[float] = None  # with an error map: the least and the largest bound of a height
    largest_bound: Optional[float] = None
    max_bound_ratio: Optional[float] = None  # the largest part of its bound that an error is
    warnings: Tuple[str, ...] = ()  # what is guessed or not known of units and systems; doubtful heights


class Stream(bytes):
    """An encoded terrain, the content of a .mtin file, with a `report`."""

    report: Report


class Shard(NamedTuple):
    """A part of the tiles of a pack, as `plan_shards` makes it. It can be pickled, for other processes and machines."""

    tile_size: int  # of the pack, in lattice steps between posts
    z_step: str  # of the pack
    first_tile: int
    last_tile: int


class Tile(NamedTuple):
    """A part of a terrain; its triangles count its own vertices."""

    vertices: NDArray[numpy.float64]
    triangles: NDArray[numpy.uint32]


@dataclass(frozen=True)
class Profile:
    """The heights along a line, in arrays of its places. Distances are metres; heights have the surface's unit.

    along         the part of the line before each place, 0 .. 1
    distance      from the begin of the line
    x, y          in the surface's coordinates
    height        NaN if there is none; linear between two places where known_before is true
    known_before  whether the surface has heights from the place before up to this one
    below, above  how far the source lies at most above and below the surface there; NaN if it is not stated
    length        of the line
    missing       why a part of the line has no heights: "outside", "void" or "damaged"; None if the whole line has heights
    earth_radius  of the sphere that fits best at the line's middle
    geodesic_deviation  how far the line is from the shortest one on the Earth; NaN unless x and y are in degrees
    """

    along: NDArray[numpy.float64]
    distance: NDArray[numpy.float64]
    x: NDArray[numpy.float64]
    y: NDArray[numpy.float64]
    height: NDArray[numpy.float64]
    known_before: NDArray[numpy.bool_]
    below: NDArray[numpy.float64]
    above: NDArray[numpy.float64]
    length: float
    missing: Optional[str]
    earth_radius: float
    geodesic_deviation: float

    def heights(self, count: int) -> NDArray[numpy.float64]:
        """Heights at `count` places in equal parts of the line, both ends included; NaN where there is none."""
        at = numpy.linspace(0.0, 1.0, count)
        after = numpy.clip(numpy.searchsorted(self.along, at), 1, len(self.along) - 1)
        before = after - 1
        width = self.along[after] - self.along[before]
        part = numpy.divide(at - self.along[before], width, out=numpy.ones(count), where=width > 0)
        mixed = numpy.where(
            self.known_before[after],
            self.height[before] * (1 - part) + self.height[after] * part,
            numpy.nan,
        )
        mixed = numpy.where(part == 1, self.height[after], mixed)
        return numpy.where(part == 0, self.height[before], mixed)


class HeightBounds(NamedTuple):
    """Between which heights an area lies, by those of the tiles that it touches.

    lowest, highest  of vertices; NaN if no tile of the area has terrain
    source_lowest, source_highest  how low and how high the source is at most; NaN if the margins are not stated
    complete         the area is inside, and all of its tiles have terrain; voids within tiles have no height
    """

    lowest: float
    highest: float
    source_lowest: float
    source_highest: float
    complete: bool

    def is_below(self, height: float, *, safe: bool = False) -> bool:
        """Whether everything in the area is surely below a height: the surface, or with safe=True the source. False if it is
        not known."""
        return bool(self.complete and (self.source_highest if safe else self.highest) < height)


class LineOfSight(NamedTuple):
    """Arrays of one shape. Distances are metres from the begin; clearances have the unit of heights; NaN: there is none."""

    line: NDArray[numpy.str_]  # "clear", "blocked" or "unknown": no known height is in the way, but a part has no heights
    zone: NDArray[numpy.str_]  # the same of the share of the first Fresnel zone; without a frequency that of the line
    least_clearance: NDArray[numpy.float64]
    least_clearance_at: NDArray[numpy.float64]
    first_obstruction: NDArray[numpy.float64]  # where the terrain first blocks the line
    first_zone_obstruction: NDArray[numpy.float64]
    free_share: NDArray[numpy.float64]  # of the radius of the zone, at most 99; 0 if the line is blocked
    free_share_at: NDArray[numpy.float64]


# --- Encoding ---


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
    bounds or of polygons with a property max_error (.geojson). Elsewhere max_error holds. A limit scales all bounds.

    Paths of GeoJSON files, in the system of the heights: area (polygons; other heights are void), route with
    route_width=METRES (lines; heights far from them are void) and maybe route_edge_error (the bound at the edges, to
    which it grows from max_error), obstacles (with max_error: what stands on the terrain, with `top` or `height` and
    `radius`; the surface is below none of it), and with max_error breaklines (lines that become edges; not in packs of
    points).

    Without a bound and a limit every height is a vertex. Takes some 20 us a height, on all processors. Raises Error, also if
    an array is not two-dimensional or a height out of range.
    """
    with _source_of(array, transform, crs, nodata, options.get("error_map")) as terrain:
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
    with _source_from_points(points, crs, options.get("error_map")) as terrain:
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
    filled, caller = _options(max_error, crs, tile_vertices=tile_vertices, tile_size=tile_size, **options)
    report = _library.Report()
    if points and _paths_of(array) is None:
        made = _source_from_points(array, crs, options.get("error_map"))  # type: ignore[arg-type]
    else:
        made = _source_of(array, transform, crs, nodata, options.get("error_map"))
    with made as terrain, caller:
        library.microtin_encode_pack(terrain.pointer, filled, os.fsencode(path), report)
    told = _report(report)
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
    filled, caller = _options(max_error, crs, tile_vertices=tile_vertices, tile_size=tile_size, **options)
    if not 0 < count < 1 << 20:
        raise Error(f"count: {count} is out of range")
    found = (_library.Shard * count)()
    found[0].size = ctypes.sizeof(_library.Shard)
    planned = ctypes.c_uint32()
    with _source_from_files(files) as terrain, caller:
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
    filled, caller = _options(max_error, crs, tile_vertices=tile_vertices, **options)
    size, z_step, first, last = shard
    part = _library.Shard(tile_size=size, z_step=z_step.encode(), first_tile=first, last_tile=last)
    with _source_from_files(files) as terrain, caller:
        library.microtin_encode_shard(terrain.pointer, filled, part, os.fsencode(path), None)


def merge_packs(parts: Sequence[Path], path: Path) -> Report:
    """Joins the files of all shards, in any order, to the bytes that `encode_pack` writes; or joins packs of one plan. The
    report has no samples."""
    names = [os.fsencode(part) for part in parts]
    report = _library.Report()
    library.microtin_merge_packs((ctypes.c_char_p * len(names))(*names), len(names), os.fsencode(path), report)
    return _report(report)


class _Source:
    """A terrain to be encoded, until the end of a with statement."""

    def __init__(self, make: Callable[..., None], *content: Any) -> None:
        self.pointer = ctypes.c_void_p()
        make(*content, self.pointer)

    def __enter__(self) -> "_Source":
        return self

    def __exit__(self, *_: Any) -> None:
        library.microtin_source_free(self.pointer)


class _Caller:
    """Calls a function of the caller's from the library's threads, and hands on what it raises."""

    def __init__(self, progress: Optional[Callable[[float], Any]]) -> None:
        self._progress = progress
        self._raised: Optional[BaseException] = None
        self.function = _library.Progress(self._call) if progress else _library.Progress(0)

    def _call(self, _context: Any, done: float) -> int:
        try:
            self._progress(done)  # type: ignore[misc]
            return 0
        except BaseException as error:  # the caller's, whatever it is
            self._raised = error
            return 1

    def __enter__(self) -> "_Caller":
        return self

    def __exit__(self, _type: Any, raised: Optional[BaseException], _trace: Any) -> None:
        if self._raised is not None and raised is not None:
            raise self._raised


def _encode_stream(terrain: _Source, max_error: Optional[Number], crs: Optional[Crs], **options: Any) -> Stream:
    filled, caller = _options(max_error, crs, **options)
    pointer, size, report = ctypes.POINTER(ctypes.c_uint8)(), ctypes.c_uint64(), _library.Report()
    with caller:
        library.microtin_encode_stream(terrain.pointer, filled, pointer, size, report)
    try:
        stream = Stream(ctypes.string_at(pointer, size.value))
    finally:
        library.microtin_bytes_free(pointer)
    stream.report = _report(report)
    return stream


def _options(
    max_error: Optional[Number],
    crs: Optional[Crs],
    *,
    effort: str = "normal",
    coding: str = "balanced",
    bound_at: str = "points",
    duplicates: str = "middle",
    surface: str = "unknown",
    progress: Optional[Callable[[float], Any]] = None,
    never_below: bool = False,
    z_step: Optional[Number] = None,
    xy_step: Optional[Number] = None,
    units: str = "",
    depths: bool = False,
    source_name: str = "",
    date: str = "",
    lineage: str = "",
    attribution: str = "",
    license: str = "",
    valid: str = "",
    epoch: Optional[Number] = None,
    source_accuracy: str = "",
    digest: bool = False,
    phases: bool = False,
    error_map: Optional[ErrorMap] = None,
    area: Optional[Path] = None,
    route: Optional[Path] = None,
    route_width: Optional[Number] = None,
    breaklines: Optional[Path] = None,
    obstacles: Optional[Path] = None,
    route_edge_error: Optional[Number] = None,
    **numbers: int,
) -> Tuple[_library.Options, _Caller]:
    chosen = (
        (effort, _EFFORTS),
        (coding, _CODINGS),
        (bound_at, _BOUND_AT),
        (duplicates, _DUPLICATES),
        (surface, _SURFACES),
    )
    for value, choices in chosen:
        if value not in choices:
            raise Error(f"{value!r} is not allowed; use one of {', '.join(choices)}")
    allowed = ("max_degree", "vertical_epsg", "max_vertices", "max_bytes", "tile_vertices", "tile_size")
    for name, number in numbers.items():
        if name not in allowed:
            raise TypeError(f"there is no option {name}")
        if not 0 <= number < 1 << 32:
            raise Error(f"{name}: {number} is out of range")
    caller = _Caller(progress)
    filled = _library.Options(
        max_error=_decimal(max_error),
        z_step=_decimal(z_step),
        xy_step=_decimal(xy_step),
        never_below=never_below,
        effort=_EFFORTS[effort],
        coding=_CODINGS[coding],
        bound_at=_BOUND_AT[bound_at],
        duplicates=_DUPLICATES[duplicates],
        units=units.encode(),
        depths=depths,
        surface=_SURFACES[surface],
        horizontal_epsg=_epsg_of(crs) or 0,
        source_name=source_name.encode(),
        date=date.encode(),
        lineage=lineage.encode(),
        attribution=attribution.encode(),
        license=license.encode(),
        valid=valid.encode(),
        epoch=_decimal(epoch),
        source_accuracy=source_accuracy.encode(),
        digest=digest,
        phases=phases,
        error_map=os.fsencode(error_map) if isinstance(error_map, (str, bytes, os.PathLike)) else None,
        area=_file(area),
        route=_file(route),
        route_width=_decimal(route_width),
        breaklines=_file(breaklines),
        obstacles=_file(obstacles),
        route_edge_error=_decimal(route_edge_error),
        progress=caller.function,
        **numbers,
    )
    return filled, caller


def _number(text: bytes) -> Optional[float]:
    return float(text) if text else None


def _report(report: _library.Report) -> Report:
    return Report(
        report.samples,
        report.vertices,
        report.bytes,
        report.tiles,
        float(report.max_error),
        float(report.rms_error),
        float(report.mean_error),
        float(report.max_below),
        float(report.max_above),
        _number(report.max_below_everywhere),
        _number(report.max_above_everywhere),
        _number(report.max_error_at_points),
        _number(report.max_below_at_points),
        _number(report.least_bound),
        _number(report.largest_bound),
        _number(report.max_bound_ratio),
        tuple(library.microtin_last_warnings().decode(errors="replace").splitlines()),
    )


def _warn(report: Report, crs: Optional[Crs], options: Mapping[str, Any]) -> None:
    """To the caller of the function that calls this. Unknown units are no news where nothing is said of them."""
    is_placed = crs is not None or options.get("units")
    for warning in report.warnings:
        if is_placed or not warning.startswith("the unit of x and y is not known"):
            warnings.warn(warning, stacklevel=3)


def _decimal(number: Optional[Number]) -> Optional[bytes]:
    if number is None:
        return None
    return (repr(float(number)) if isinstance(number, (float, numpy.floating)) else str(number)).encode()


def _file(path: Optional[Path]) -> Optional[bytes]:
    return None if path is None else os.fsencode(path)


def _epsg_of(crs: Optional[Crs]) -> Optional[int]:
    if isinstance(crs, str) and crs.upper().startswith("EPSG:"):
        code = int(crs[5:]) if crs[5:].isdigit() else 0
    elif isinstance(crs, (int, numpy.integer)):
        code = int(crs)
    else:
        return None
    if not 0 < code < 1 << 32:
        raise Error(f"{crs!r} is not the code of a horizontal system; use vertical_epsg for that of heights")
    return code


# KEYWORD["name", ...], with brackets of either kind.
_WELL_KNOWN_TEXT = re.compile(r"\s*\w+\s*[\[(].*[\])]\s*", re.DOTALL)


def _wkt_of(crs: Optional[Crs]) -> Optional[bytes]:
    if crs is None or _epsg_of(crs) is not None:
        return None
    if isinstance(crs, int) or not (isinstance(crs, str) or hasattr(crs, "to_wkt")):
        raise Error(f"crs is a code, well-known text or has to_wkt(), not {type(crs).__name__}")
    text = crs if isinstance(crs, str) else str(crs.to_wkt())
    if not _WELL_KNOWN_TEXT.fullmatch(text):
        raise Error(f"{text[:40]!r} is neither EPSG:CODE nor well-known text")
    return text.encode()


def _transform_of(transform: Optional[Sequence[float]], rows: int) -> Tuple[float, ...]:
    if transform is None:
        return (-0.5, 1, 0, rows - 0.5, 0, -1)
    if hasattr(transform, "to_gdal"):
        return tuple(transform.to_gdal())
    if len(transform) != 6:
        raise Error("a transform has six numbers")
    return tuple(transform)


def _raster_of(
    array: ArrayLike, transform: Optional[Sequence[float]], crs: Optional[Crs], nodata: Optional[float]
) -> _library.Raster:
    mask = numpy.broadcast_to(array.mask, array.shape) if isinstance(array, numpy.ma.MaskedArray) else None
    heights = numpy.asarray(array)
    if heights.ndim != 2:
        raise Error(f"a raster has two dimensions, not {heights.ndim}")
    kind = numpy.float32 if heights.dtype == numpy.float32 else numpy.float64
    if heights.dtype.kind in "iu":
        beyond = numpy.abs(heights.astype(numpy.float64)) > 2**53
        if (beyond if nodata is None else beyond & (heights != nodata)).any():
            raise Error("a height is beyond 2^53")
    if heights.dtype.kind not in "iuf" or heights.dtype.itemsize > 8:
        raise Error(f"heights are integers or floats of up to 64 bits, not {heights.dtype}")
    if nodata is not None and heights.dtype == numpy.float16:
        nodata = float(numpy.float16(nodata))  # the library compares in 32 and 64 bits
    if mask is not None and mask.any():
        heights = numpy.where(mask, numpy.nan, heights)
    heights = numpy.ascontiguousarray(heights, kind)
    raster = _library.Raster(columns=heights.shape[1], rows=heights.shape[0], wkt=_wkt_of(crs))
    raster.transform[:] = _transform_of(transform, heights.shape[0])
    if nodata is not None:
        raster.no_data = ctypes.pointer(ctypes.c_double(float(nodata)))
    if kind == numpy.float32:
        raster.float_heights = heights.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
    else:
        raster.heights = heights.ctypes.data_as(_library.Doubles)
    raster.kept = heights  # as long as the pointer to it
    return raster


def _paths_of(array: Any) -> Optional[List[Path]]:
    """The paths that stand in place of an array; None for an array."""
    if isinstance(array, (str, os.PathLike)):
        return [array]
    is_list = isinstance(array, (list, tuple)) and len(array) > 0
    return list(array) if is_list and all(isinstance(one, (str, os.PathLike)) for one in array) else None


def _source_from_files(files: Files) -> _Source:
    paths = _paths_of(files)
    if paths is None:
        raise Error("files are a path, or a list of paths")
    names = [os.fsencode(path) for path in paths]
    return _Source(library.microtin_source_from_files, (ctypes.c_char_p * len(names))(*names), len(names))


def _source_of(
    array: Union[ArrayLike, Files],
    transform: Optional[Sequence[float]],
    crs: Optional[Crs],
    nodata: Optional[float],
    error_map: Optional[ErrorMap],
) -> _Source:
    if _paths_of(array) is None:
        return _source_from_array(array, transform, crs, nodata, error_map)  # type: ignore[arg-type]
    if transform is not None or nodata is not None or (crs is not None and _epsg_of(crs) is None):
        raise Error("files state their own transform, nodata and well-known text; leave these out")
    if error_map is not None and not isinstance(error_map, (str, bytes, os.PathLike)):
        raise Error("error_map: files take the path of a map, not an array")
    return _source_from_files(array)  # type: ignore[arg-type]


def _source_from_array(
    array: ArrayLike,
    transform: Optional[Sequence[float]],
    crs: Optional[Crs],
    nodata: Optional[float],
    error_map: Optional[ErrorMap],
) -> _Source:
    source = _Source(library.microtin_source_from_raster, _raster_of(array, transform, crs, nodata))
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


def _source_from_points(points: ArrayLike, crs: Optional[Crs], error_map: Optional[ErrorMap]) -> _Source:
    if error_map is not None and not isinstance(error_map, (str, bytes, os.PathLike)):
        raise Error("error_map: points take the path of a map, not an array")
    rows = numpy.ascontiguousarray(points, numpy.float64)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise Error("points are rows of x, y and height")
    content = _library.Points(
        count=len(rows), coordinates=rows.ctypes.data_as(_library.Doubles), wkt=_wkt_of(crs)
    )
    return _Source(library.microtin_source_from_points, content)


# --- Decoding ---


def decode(source: Union[bytes, bytearray, memoryview, Path]) -> "Surface":
    """Reads a stream or a pack: its bytes, or the path of a file. A stream is decoded at once, tiles of a pack when they are
    asked for. Raises Error if it is damaged or none of them."""
    return Surface(source)


class Surface:
    """A decoded terrain. Methods may be called from several threads.

    bounds            west, south, east, north: of the vertices, or of a pack's tiles
    crs               an EPSG code, well-known text, or None
    vertical_epsg     0 if it is not stated
    units             of x and y, and of heights: "metre", "degree", "foot", "US survey foot" or None
    bound, max_error  the error asked for, and the largest that was measured; None if they are not stated
    max_error_at_points  the largest where points truly lie; None if the lattice holds them where they are
    surface           what the heights are: "ground", "top", "bed", "geoid", "obstacles" or "unknown"
    side              where the surface may be, as far as the bound: "both", "never_below", "never_above" or None
    max_below, max_above  the largest distances of the surface below and above a height; None if they are not stated
    max_below_everywhere, max_above_everywhere  the same from the bilinear surface of a raster's posts, also between posts
    tiles             (columns, rows) of a pack, (1, 1) of a stream
    source, date, lineage  where the terrain comes from, when, and what was done to it; "" if they are not stated
    attribution       a text to be shown to users; "" if there is none
    license           an SPDX expression or a URL; "" if it is not stated
    valid             when the terrain is valid: "2024-01/2025-06", "2024-01/.." or "../2025"; "" if it is not stated
    epoch             of the coordinates, a year; None if it is not stated
    source_accuracy   of the source itself: "LE90 4"; "" if it is not stated
    digest            of a stream's mesh, 16 hexadecimal digits; "" if it is not stated
    phases            of a stream: (vertices, bytes of the file, largest error) after each of them that is stated
    """

    def __init__(self, source: Union[bytes, bytearray, memoryview, Path]) -> None:
        surface = ctypes.c_void_p()
        if isinstance(source, (bytes, bytearray, memoryview)):
            data = bytes(source)
            library.microtin_surface_from_bytes(data, len(data), b"bytes", surface)
        else:
            library.microtin_surface_from_file(os.fsencode(source), surface)
        weakref.finalize(self, library.microtin_surface_free, surface)
        self._surface = surface
        self._lock = threading.Lock()
        self._mesh: Optional[Tile] = None
        info = _library.SurfaceInfo()
        library.microtin_surface_get_info(surface, info)
        self.is_pack = bool(info.is_pack)
        self.tiles: Tuple[int, int] = (info.tile_columns, info.tile_rows)
        self.bounds: Tuple[float, float, float, float] = (info.west, info.south, info.east, info.north)
        self.crs: Union[int, str, None] = info.horizontal_epsg or info.wkt.decode(errors="replace") or None
        self.vertical_epsg: int = info.vertical_epsg
        self.units = (UNITS[info.horizontal_unit], UNITS[info.vertical_unit])
        self.bound = _number(info.bound)
        self.max_error = _number(info.max_error)
        self.max_error_at_points = _number(info.max_error_at_points)
        self.surface = dict(enumerate(_SURFACES))[info.surface]
        self.side: Optional[str] = _SIDES[info.side]
        self.max_below = _number(info.max_below)
        self.max_above = _number(info.max_above)
        self.max_below_everywhere = _number(info.max_below_everywhere)
        self.max_above_everywhere = _number(info.max_above_everywhere)
        self.least_bound = _number(info.least_bound)
        self.largest_bound = _number(info.largest_bound)
        self.max_bound_ratio = _number(info.max_bound_ratio)
        self.source: str = info.source_name.decode(errors="replace")
        self.date: str = info.date.decode(errors="replace")
        self.lineage: str = info.lineage.decode(errors="replace")
        self.attribution: str = info.attribution.decode(errors="replace")
        self.license: str = info.license.decode(errors="replace")
        self.valid: str = info.valid.decode(errors="replace")
        self.epoch = _number(info.epoch)
        self.source_accuracy: str = info.source_accuracy.decode()
        self.digest: str = info.digest.decode()
        self.phases = [
            (phase.vertices, phase.bytes, _number(phase.max_error)) for phase in info.phases[: info.phase_count]
        ]

    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """x, y and height of each vertex. Of a pack all its tiles', those on borders once."""
        return self._whole().vertices

    @property
    def triangles(self) -> NDArray[numpy.uint32]:
        """Numbers of the vertices of each triangle, counter-clockwise from above; void ones are left out."""
        return self._whole().triangles

    def tile(self, column: int, row: int) -> Tile:
        """A tile of a pack, columns from the west, rows from the south; without vertices if it has no terrain. Raises
        IndexError."""
        self._expect_tile(column, row)
        return self._triangles(library.microtin_surface_tile, column, row)

    def tile_margins(self, column: int, row: int) -> Tuple[Optional[float], Optional[float]]:
        """max_below_everywhere and max_above_everywhere of a tile, counted as for `tile`; None if it does not state them or
        has no terrain. Raises IndexError."""
        self._expect_tile(column, row)
        margins = _library.TileMargins()
        with self._lock:
            library.microtin_surface_tile_margins(self._surface, column, row, margins)
        return _number(margins.max_below_everywhere), _number(margins.max_above_everywhere)

    def _expect_tile(self, column: int, row: int) -> None:
        if not (0 <= column < self.tiles[0] and 0 <= row < self.tiles[1]):
            raise IndexError(f"there are {self.tiles[0]} x {self.tiles[1]} tiles")

    def height_at(self, xs: ArrayLike, ys: ArrayLike) -> Any:
        """Heights of the exact plane at places: an array of the shape that xs and ys have together, or a float for two numbers. NaN outside
        and in voids. About 0.3 us each, and the decoding of the tiles that are needed."""
        return self._at(library.microtin_surface_heights, xs, ys, 1)[0]

    def gradient_at(self, xs: ArrayLike, ys: ArrayLike) -> Tuple[Any, Any]:
        """How many metres the surface rises for each metre east, and for each metre north, at places as for `height_at`. NaN
        outside, in voids and at a vertex among voids. The gradient is that of the exact triangle; on an edge or a vertex it
        is that of the triangle whose centre lies farthest east, and of those with the same x farthest north."""
        east, north = self._at(library.microtin_surface_gradients, xs, ys, 2)
        return east, north

    def slope_at(self, xs: ArrayLike, ys: ArrayLike) -> Any:
        """How steep the surface is at places, in degrees: 0 is level. NaN where there is no gradient; see `gradient_at`."""
        slope = numpy.degrees(numpy.arctan(numpy.hypot(*self.gradient_at(xs, ys))))
        return slope if numpy.ndim(slope) else float(slope)

    def aspect_at(self, xs: ArrayLike, ys: ArrayLike) -> Any:
        """In which direction the surface falls at places, in degrees clockwise from north, 0 <= aspect < 360. NaN where it is
        level, and where there is no gradient; see `gradient_at`."""
        east, north = self.gradient_at(xs, ys)
        aspect = numpy.degrees(numpy.arctan2(numpy.negative(east), numpy.negative(north)))
        aspect = numpy.where(numpy.hypot(east, north) == 0, numpy.nan, aspect % 360)
        return aspect if numpy.ndim(aspect) else float(aspect)

    def _at(self, write: Callable[..., None], xs: ArrayLike, ys: ArrayLike, numbers: int) -> Sequence[Any]:
        x, y = numpy.broadcast_arrays(*(numpy.asarray(places, numpy.float64) for places in (xs, ys)))
        x, y = numpy.ascontiguousarray(x), numpy.ascontiguousarray(y)
        found: List[Any] = [numpy.empty(x.shape) for _ in range(numbers)]
        pointers = (places.ctypes.data_as(_library.Doubles) for places in (x, y, *found))
        with self._lock:
            write(self._surface, x.size, *pointers)
        return found if numpy.ndim(xs) or numpy.ndim(ys) else [float(number.reshape(-1)[0]) for number in found]

    def bounds_in_box(self, west: float, south: float, east: float, north: float) -> HeightBounds:
        """Between which heights a box lies. A pack's index has the lowest and the highest height of each tile, so no tile is
        decoded; a stream is one tile. Raises Error if a coordinate is not a number."""
        return self._height_bounds(library.microtin_surface_bounds_in_box, west, south, east, north)

    def bounds_on_line(self, begin: ArrayLike, end: ArrayLike) -> HeightBounds:
        """Between which heights the straight line between two positions (x, y) lies, as `bounds_in_box`."""
        ends = [numpy.asarray(position, numpy.float64) for position in (begin, end)]
        if any(position.shape != (2,) for position in ends):
            raise Error("an end of a line is a pair of x and y")
        return self._height_bounds(library.microtin_surface_bounds_on_line, *ends[0], *ends[1])

    def _height_bounds(self, find: Callable[..., None], *area: float) -> HeightBounds:
        found = _library.HeightBounds()
        with self._lock:
            find(self._surface, *area, found)
        return HeightBounds(
            found.lowest, found.highest, found.source_lowest, found.source_highest, bool(found.is_complete)
        )

    def profile(self, begin: ArrayLike, end: ArrayLike) -> Profile:
        """The heights along the straight line between two positions (x, y), which may lie outside. In degrees the line takes
        the shorter way around the Earth, and is straight in degrees. Raises Error if a position is not a number, or far from
        the surface."""
        ends = [numpy.asarray(position, numpy.float64) for position in (begin, end)]
        if any(position.shape != (2,) for position in ends):
            raise Error("an end of a profile is a pair of x and y")
        found = _library.Profile()
        with self._lock:
            library.microtin_surface_profile(self._surface, *ends[0], *ends[1], found)
            places = numpy.ctypeslib.as_array(found.places, (found.count, 7)).T.copy()
            known = numpy.ctypeslib.as_array(found.is_known_before, (found.count,)).astype(numpy.bool_)
        along, distance, x, y, height, below, above = places
        missing = _MISSING.get(found.result, "damaged")
        numbers = (found.length, missing, found.earth_radius, found.geodesic_deviation)
        return Profile(along, distance, x, y, height, known, below, above, *numbers)

    def line_of_sight(
        self,
        begin: ArrayLike,
        end: ArrayLike,
        *,
        frequency: float = 0,
        zone_share: float = 0.6,
        earth_factor: float = 4 / 3,
        safe: bool = False,
        begin_above: str = "ground",
        end_above: str = "ground",
    ) -> LineOfSight:
        """Whether ends see each other: arrays of positions (x, y, height) whose last axis has three numbers, and whose other
        axes are broadcast together.

        begin_above, end_above  "ground" or "datum": from where the heights of these ends count
        frequency     in MHz: judge the first Fresnel zone, too, of whose radius `zone_share` has to be free
        earth_factor  multiplies the radius of the Earth, for refraction: 4/3 for radio, 1 for none, inf for a flat Earth
        safe          judge by the highest that the source can be; raises Error if the surface does not state its margins

        The model and its error: encoder/docs/profiles.md. Takes some 0.1 ms for a line across 100 triangles, and the
        decoding of tiles. Raises Error if a number is out of range."""
        first, second = numpy.broadcast_arrays(*(numpy.asarray(ends, numpy.float64) for ends in (begin, end)))
        if first.ndim == 0 or first.shape[-1] != 3:
            raise Error("an end of a line of sight is x, y and height")
        for above in (begin_above, end_above):
            if above not in ("ground", "datum"):
                raise Error(f"{above!r} is not allowed; use ground or datum")
        if zone_share == 0 or earth_factor == 0:
            raise Error("zone_share and earth_factor are above 0")
        ends = numpy.ascontiguousarray(numpy.concatenate((first, second), axis=-1))
        shape = ends.shape[:-1]
        options = _library.SightOptions(
            earth_factor=earth_factor,
            frequency=frequency,
            zone_share=zone_share,
            is_safe=safe,
            from_datum=begin_above == "datum",
            to_datum=end_above == "datum",
        )
        codes = [numpy.empty(shape, numpy.uint8) for _ in range(2)]
        numbers = [numpy.empty(shape) for _ in LineOfSight._fields[2:]]
        sights = _library.Sights(
            **dict(zip(LineOfSight._fields, (code.ctypes.data_as(ctypes.POINTER(ctypes.c_uint8)) for code in codes))),
            **dict(zip(LineOfSight._fields[2:], (number.ctypes.data_as(_library.Doubles) for number in numbers))),
        )
        with self._lock:
            library.microtin_surface_lines_of_sight(
                self._surface, codes[0].size, ends.ctypes.data_as(_library.Doubles), options, sights
            )
        return LineOfSight(_SIGHTS[codes[0]], _SIGHTS[codes[1]], *numbers)

    def raster(self, cell: Optional[Number] = None, force: bool = False) -> Tuple[NDArray[numpy.float64], Tuple[float, ...]]:
        """Heights of all posts of the source, or of posts `cell` apart, row 0 northernmost, NaN where there is none; and
        the transform, in GDAL's order, of the cells around them. Raises Error if the surface is of points and no cell
        size is given, or if the array takes more than 1 GB, which `force` allows."""
        grid = _library.Grid()
        library.microtin_surface_grid(self._surface, _decimal(cell), grid)
        size = grid.rows * grid.columns * numpy.dtype(numpy.float64).itemsize
        if size > 10**9 and not force:
            raise Error(f"the raster takes {size / 1e9:.1f} GB: give a larger cell, or force=True")
        heights = numpy.empty((grid.rows, grid.columns))
        with self._lock:
            library.microtin_surface_sample_grid(self._surface, grid, heights.ctypes.data_as(_library.Doubles))
        dx, dy = (axis.numerator / axis.denominator for axis in (grid.x, grid.y))
        west = (2 * grid.x.offset - grid.x.numerator) / (2 * grid.x.denominator)
        north = (2 * grid.y.offset + (2 * grid.rows - 1) * grid.y.numerator) / (2 * grid.y.denominator)
        return heights, (west, dx, 0.0, north, 0.0, -dy)

    def _whole(self) -> Tile:
        if self._mesh is None:
            self._mesh = self._triangles(library.microtin_surface_mesh)
        return self._mesh

    def _triangles(self, read: Callable[..., None], *which: int) -> Tile:
        found = _library.Triangles()
        with self._lock:
            read(self._surface, *which, found)
            vertices, triangles = numpy.empty((found.vertices, 3)), numpy.empty((found.triangles, 3), numpy.uint32)
            ctypes.memmove(vertices.ctypes.data, found.coordinates, vertices.nbytes)
            ctypes.memmove(triangles.ctypes.data, found.corners, triangles.nbytes)
        return Tile(vertices, triangles)
