# SPDX-License-Identifier: MIT
"""What the functions and methods return."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Optional, Tuple

import numpy
from numpy.typing import NDArray

from . import _library
from ._library import library


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


def number_of(text: bytes) -> Optional[float]:
    return float(text) if text else None


def report_of(found: _library.Report) -> Report:
    return Report(
        found.samples,
        found.vertices,
        found.bytes,
        found.tiles,
        float(found.max_error),
        float(found.rms_error),
        float(found.mean_error),
        float(found.max_below),
        float(found.max_above),
        number_of(found.max_below_everywhere),
        number_of(found.max_above_everywhere),
        number_of(found.max_error_at_points),
        number_of(found.max_below_at_points),
        number_of(found.least_bound),
        number_of(found.largest_bound),
        number_of(found.max_bound_ratio),
        tuple(library.microtin_last_warnings().decode(errors="replace").splitlines()),
    )
