# SPDX-License-Identifier: MIT
"""fuzz_test.py GOLDEN: damaged streams and packs end in errors of GDAL's, never in a crash, and those that open can be
read. Skipped (77) without python3-gdal or numpy."""

import glob
import os
import random
import sys
import zlib

try:
    import numpy
    from osgeo import gdal
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

PER_FILE = 150
PATH = "/vsimem/damaged"


def numbers(data, at):
    """The number in groups of seven bits at a place, and what follows it."""
    value = 0
    while True:
        value = value << 7 | data[at] & 127
        at += 1
        if data[at - 1] < 128:
            return value, at


def header_end(data):
    """Where the check of a stream's header begins."""
    length, begin = numbers(data, 5)
    return begin + length


def with_check(data, end):
    return data[:end] + zlib.crc32(bytes(data[:end])).to_bytes(4, "little") + data[end + 4 :]


def damaged(data, chance, end):
    """Bits flipped, bytes changed, cut off or repeated; in half of the cases the header's check is made right again."""
    data = bytearray(data)
    in_header = end is not None and chance.random() < 0.5
    for _ in range(chance.choice((1, 1, 2, 8))):
        at = chance.randrange(5 if in_header else 0, end if in_header else len(data))
        data[at] = chance.choice((data[at] ^ 1 << chance.randrange(8), 0, 127, 255, chance.randrange(256)))
    if in_header:
        return with_check(data, end)
    kind = chance.random()
    if kind < 0.2:
        return data[: chance.randrange(len(data))]
    return data + data[-9:] if kind < 0.3 else data


def read_all(counts):
    options = ["CELL_SIZE=1000"] if counts["cells"] else []
    kinds = gdal.OF_RASTER | gdal.OF_VECTOR | gdal.OF_VERBOSE_ERROR
    dataset = gdal.OpenEx(PATH, kinds, open_options=options)
    if dataset is None:
        if not gdal.GetLastErrorMsg():
            counts["silent"] += 1
        counts["refused"] += 1
        return
    counts["opened"] += 1
    dataset.GetSpatialRef()
    dataset.GetGeoTransform()
    band = dataset.GetRasterBand(1)
    for part in [band, *(band.GetOverview(i) for i in range(band.GetOverviewCount()))]:
        x, y = max(part.XSize - 300, 0), max(part.YSize - 300, 0)
        part.ReadAsArray(x, y, part.XSize - x, part.YSize - y)
        part.ReadAsArray(0, 0, min(part.XSize, 300), min(part.YSize, 300))
    for i in range(dataset.GetLayerCount()):
        for feature in dataset.GetLayer(i):
            feature.GetGeometryRef().GetEnvelope3D()


def encoded(suffix, *options):
    """A stream or a pack of a rough plane."""
    source = gdal.GetDriverByName("MEM").Create("", 60, 50, 1, gdal.GDT_Int16)
    source.SetGeoTransform((0, 1, 0, 50, 0, -1))
    row, column = numpy.mgrid[0:50, 0:60]
    source.GetRasterBand(1).WriteArray((row * column % 97).astype(numpy.int16))
    path = f"/tmp/microtin-fuzz-{os.getpid()}{suffix}"
    gdal.GetDriverByName("MTIN").CreateCopy(path, source, options=["MAX_ERROR=9", *options])
    with open(path, "rb") as file:
        data = file.read()
    os.remove(path)
    return data


def with_lines():
    """A stream that has a layer of lines."""
    path = f"/tmp/microtin-fuzz-{os.getpid()}.csv"
    with open(path, "w") as file:
        file.write("5 5\n50 40\n\n10 40\n40 10\n")
    data = encoded(".mtin", "BREAKLINES=" + path)
    os.remove(path)
    gdal.FileFromMemBuffer(PATH, data)
    assert gdal.OpenEx(PATH, gdal.OF_VECTOR).GetLayerByName("lines") is not None
    return data


def main():
    golden = sys.argv[1]
    inputs = [open(path, "rb").read() for path in sorted(glob.glob(f"{golden}/*.mtin"))]
    for data in inputs:
        assert with_check(bytearray(data), header_end(data)) == data, "the header is not where it is thought to be"
    inputs += [with_lines(), encoded(".mtp", "TILE_VERTICES=200")]
    refused = [open(path, "rb").read() for path in sorted(glob.glob(f"{golden}/refused/*.mtin"))]
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    chance = random.Random(20)
    counts = {"refused": 0, "opened": 0, "silent": 0, "cells": 0}
    for data in inputs + refused:
        is_stream = data[:4] == inputs[0][:4]
        for i in range(PER_FILE if len(data) < 20000 else PER_FILE // 10):
            gdal.ErrorReset()
            counts["cells"] = i % 2
            bad = damaged(data, chance, header_end(data) if is_stream and data in inputs else None) if i else data
            gdal.FileFromMemBuffer(PATH, bytes(bad))
            read_all(counts)
    gdal.Unlink(PATH)
    print(f"{counts['refused']} damaged files refused, {counts['opened']} opened and read")
    # What does not begin as a stream or pack does is no driver's, and GDAL itself says so.
    assert counts["silent"] == 0 and counts["refused"] > 100 and counts["opened"] > 100, counts


main()
