# SPDX-License-Identifier: MIT
"""Decoded terrains, and queries of them."""

from __future__ import annotations

import ctypes
import os
import threading
import weakref
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _library
from ._library import Error, library
from ._options import SURFACES, Number, Path, decimal_of, path_of
from ._results import HeightBounds, LineOfSight, Profile, Tile, number_of

UNITS = {0: None, 1: "metre", 2: "degree", 3: "foot", 4: "US survey foot"}
_SIGHTS = numpy.array(["clear", "blocked", "unknown"])
_MISSING = {0: None, 1: "outside", 2: "void"}
_SIDES = (None, "both", "never_below", "never_above")


def _coordinates(places: ArrayLike) -> Any:
    """As 64-bit floats, where masked ones are NaN."""
    numbers: Any = numpy.asarray(places, numpy.float64)
    return numpy.where(places.mask, numpy.nan, numbers) if isinstance(places, numpy.ma.MaskedArray) else numbers


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
            library.microtin_surface_from_file(path_of(source), surface)
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
        self.bound = number_of(info.bound)
        self.max_error = number_of(info.max_error)
        self.max_error_at_points = number_of(info.max_error_at_points)
        self.surface = dict(enumerate(SURFACES))[info.surface]
        self.side: Optional[str] = _SIDES[info.side]
        self.max_below = number_of(info.max_below)
        self.max_above = number_of(info.max_above)
        self.max_below_everywhere = number_of(info.max_below_everywhere)
        self.max_above_everywhere = number_of(info.max_above_everywhere)
        self.least_bound = number_of(info.least_bound)
        self.largest_bound = number_of(info.largest_bound)
        self.max_bound_ratio = number_of(info.max_bound_ratio)
        self.source: str = info.source_name.decode(errors="replace")
        self.date: str = info.date.decode(errors="replace")
        self.lineage: str = info.lineage.decode(errors="replace")
        self.attribution: str = info.attribution.decode(errors="replace")
        self.license: str = info.license.decode(errors="replace")
        self.valid: str = info.valid.decode(errors="replace")
        self.epoch = number_of(info.epoch)
        self.source_accuracy: str = info.source_accuracy.decode()
        self.digest: str = info.digest.decode()
        self.phases = [
            (phase.vertices, phase.bytes, number_of(phase.max_error)) for phase in info.phases[: info.phase_count]
        ]

    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """x, y and height of each vertex. Of a pack all its tiles', those on borders once."""
        return self._whole().vertices

    @property
    def triangles(self) -> NDArray[numpy.uint32]:
        """Numbers of the vertices of each triangle, counter-clockwise from above; void ones are left out."""
        return self._whole().triangles

    def lines(self) -> List[Tuple[str, NDArray[numpy.float64]]]:
        """The class of each line of a stream, such as "ridge", with x, y and height of its vertices. They are the lines that
        `breaklines` of encode named; empty if there are none, as in a pack."""
        found = _library.Lines()
        lines = []
        with self._lock:
            library.microtin_surface_lines(self._surface, found)
            begin = 0
            for i in range(found.count):
                vertices = numpy.empty((found.vertices[i], 3))
                numbers = ctypes.addressof(found.coordinates.contents) + begin * vertices.itemsize
                ctypes.memmove(vertices.ctypes.data, numbers, vertices.nbytes)
                begin += vertices.size
                lines.append((found.classes[i].decode(), vertices))
        return lines

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
        return number_of(margins.max_below_everywhere), number_of(margins.max_above_everywhere)

    def _expect_tile(self, column: int, row: int) -> None:
        if not (0 <= column < self.tiles[0] and 0 <= row < self.tiles[1]):
            raise IndexError(f"there are {self.tiles[0]} x {self.tiles[1]} tiles")

    def height_at(self, xs: ArrayLike, ys: ArrayLike) -> Any:
        """Heights of the exact plane at places: an array of the shape that xs and ys have together, or a float for two
        numbers. NaN outside, in voids, and where a coordinate is masked. About 0.3 us each, and the decoding of the
        tiles that are needed."""
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
        x, y = numpy.broadcast_arrays(*(_coordinates(places) for places in (xs, ys)))
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
        ends = [_coordinates(position) for position in (begin, end)]
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
        ends = [_coordinates(position) for position in (begin, end)]
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
        first, second = numpy.broadcast_arrays(*(_coordinates(ends) for ends in (begin, end)))
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
        library.microtin_surface_grid(self._surface, decimal_of(cell), grid)
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
