# SPDX-License-Identifier: MIT
"""The options of an encoding, as the library takes them."""

from __future__ import annotations

import ctypes
import decimal
import os
import re
from typing import Any, Callable, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from . import _library
from ._library import Error

Number = Union[int, float, str, decimal.Decimal]
Crs = Union[int, str, Any]
Path = Union[str, "os.PathLike[str]"]
ErrorMap = Union[str, "os.PathLike[str]", ArrayLike]
Files = Union[Path, Sequence[Path]]

_EFFORTS = {"fast": 1, "normal": 2, "best": 3}
_CODINGS = {"quick": 1, "balanced": 2, "dense": 3}
_BOUND_AT = {"points": 1, "lattice": 2, "everywhere": 3}
_DUPLICATES = {"middle": 1, "lowest": 2, "highest": 3, "mean": 4}
SURFACES = {"unknown": 0, "ground": 1, "top": 2, "bed": 3, "geoid": 4, "obstacles": 5}


class Caller:
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

    def __enter__(self) -> "Caller":
        return self

    def __exit__(self, _type: Any, raised: Optional[BaseException], _trace: Any) -> None:
        if self._raised is not None and raised is not None:
            raise self._raised


def options_of(
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
) -> Tuple[_library.Options, Caller]:
    chosen = (
        (effort, _EFFORTS),
        (coding, _CODINGS),
        (bound_at, _BOUND_AT),
        (duplicates, _DUPLICATES),
        (surface, SURFACES),
    )
    for value, choices in chosen:
        if value not in choices:
            raise Error(f"{value!r} is not allowed; use one of {', '.join(choices)}")
    allowed = ("max_degree", "vertical_epsg", "max_vertices", "max_bytes", "tile_vertices", "tile_size")
    for name, number in numbers.items():
        if name not in allowed:
            raise TypeError(f"there is no option {name}")
        if not 0 <= number < 1 << 32:
            raise Error(f"{name}: {number} is out of range; use 0 to 4294967295")
    caller = Caller(progress)
    filled = _library.Options(
        max_error=decimal_of(max_error),
        z_step=decimal_of(z_step),
        xy_step=decimal_of(xy_step),
        never_below=never_below,
        effort=_EFFORTS[effort],
        coding=_CODINGS[coding],
        bound_at=_BOUND_AT[bound_at],
        duplicates=_DUPLICATES[duplicates],
        units=text_of(units),
        depths=depths,
        surface=SURFACES[surface],
        horizontal_epsg=epsg_of(crs) or 0,
        source_name=text_of(source_name),
        date=text_of(date),
        lineage=text_of(lineage),
        attribution=text_of(attribution),
        license=text_of(license),
        valid=text_of(valid),
        epoch=decimal_of(epoch),
        source_accuracy=text_of(source_accuracy),
        digest=digest,
        phases=phases,
        error_map=path_of(error_map) if isinstance(error_map, (str, bytes, os.PathLike)) else None,
        area=_file(area),
        route=_file(route),
        route_width=decimal_of(route_width),
        breaklines=_file(breaklines),
        obstacles=_file(obstacles),
        route_edge_error=decimal_of(route_edge_error),
        progress=caller.function,
        **numbers,
    )
    return filled, caller


def decimal_of(number: Optional[Number]) -> Optional[bytes]:
    """The shortest decimal of a float of any size; None for None."""
    if number is None:
        return None
    if isinstance(number, str) and not number:
        raise Error("'' is not a number; leave the option out")
    return text_of(str(number))


def text_of(text: str) -> bytes:
    """A text for C, where the character 0 would end it."""
    return _without_zero(text.encode())


def path_of(path: Union[Path, bytes]) -> bytes:
    """The name of a file for C."""
    name = _without_zero(os.fsencode(path))
    if not name:
        raise Error("'' is not the name of a file")
    return name


def _without_zero(text: bytes) -> bytes:
    if b"\0" in text:
        raise Error(f"{text!r} has a character 0; leave it out")
    return text


def _file(path: Optional[Path]) -> Optional[bytes]:
    return None if path is None else path_of(path)


def epsg_of(crs: Optional[Crs]) -> Optional[int]:
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


def wkt_of(crs: Optional[Crs]) -> Optional[bytes]:
    if crs is None or epsg_of(crs) is not None:
        return None
    if isinstance(crs, int) or not (isinstance(crs, str) or hasattr(crs, "to_wkt")):
        raise Error(f"crs is a code, well-known text or has to_wkt(), not {type(crs).__name__}")
    text = crs if isinstance(crs, str) else str(crs.to_wkt())
    if not _WELL_KNOWN_TEXT.fullmatch(text):
        raise Error(f"{text[:40]!r} is neither EPSG:CODE nor well-known text")
    return text_of(text)
