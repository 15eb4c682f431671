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

from ._encoding import encode, encode_pack, encode_points, encode_shard, merge_packs, plan_shards
from ._library import Error, library
from ._options import Crs, ErrorMap, Files, Number, Path
from ._results import HeightBounds, LineOfSight, Profile, Report, Shard, Stream, Tile
from ._surface import UNITS, Surface, decode

__all__ = ["Error", "HeightBounds", "LineOfSight", "Profile", "Report", "Shard", "Stream", "Surface", "Tile", "decode", "encode", "encode_pack", "encode_points", "encode_shard", "merge_packs", "plan_shards"]
__version__: str = library.microtin_version_string().decode()

# The modules are no part of the interface: pickles and messages have the names of the package.
for _name in __all__:
    globals()[_name].__module__ = __name__
