# SPDX-License-Identifier: MIT
"""walk_test.py: from an SRTM cell, a GeoTIFF with voids, a laser scan in US survey feet and a folder of cells, by the
commands of README and encoder/docs, to a map in QGIS and to an array. Each height, void, place, unit and system must be the
source's. Then wrong turns. Skipped (77) without python3-qgis, numpy or python3-gdal."""

import os
import struct
import subprocess
import sys
import tempfile
from typing import NamedTuple

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
try:
    import numpy
    from osgeo import gdal, osr
    from qgis.core import Qgis, QgsApplication, QgsMeshDatasetIndex, QgsMeshLayer, QgsPointXY, QgsRasterLayer, QgsUnitTypes
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

import microtin

TOOL = os.environ["MICROTIN_TOOL"]
# QGIS before 3.38 knows one kind of feet.
US_SURVEY_FEET = getattr(getattr(Qgis, "DistanceUnit", None), "FeetUSSurvey", QgsUnitTypes.DistanceFeet)
ROUNDING = 0.01  # of float32 heights, and of places asked for to 1/256 of the lattice's step


class Expected(NamedTuple):
    heights: numpy.ndarray  # row 0 northernmost, NaN where there is none
    transform: tuple
    code: str
    distances: int
    units: tuple
    bound: float


def check(holds, what):
    if not holds:
        raise SystemExit(f"failed: {what}")


def run(*command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment})
    return done.returncode, done.stdout + done.stderr


def made(*command):
    code, text = run(*command)
    check(code == 0, f"{' '.join(command)}: {text}")
    return text


def refused(sentences, *command, **environment):
    code, text = run(*command, **environment)
    check(code != 0, f"{' '.join(command)} is refused")
    for sentence in sentences:
        check(sentence in text, f"{' '.join(command)} says {sentence!r}: {text}")


# --- Sources, made by hand and by GDAL ---


def system(*codes):
    """Of places, or of places and heights."""
    parts = [osr.SpatialReference() for _ in codes]
    for part, code in zip(parts, codes):
        part.ImportFromEPSG(code)
    if len(parts) == 1:
        return parts[0].ExportToWkt()
    whole = osr.SpatialReference()
    whole.SetCompoundCS("places and heights", *parts)
    return whole.ExportToWkt()


CELL_POSTS = 151


def srtm_cell(folder, latitude, longitude):
    """Whole metres as SRTM has them, big-endian, with a lake of voids; neighbours agree."""
    row, column = numpy.mgrid[0:CELL_POSTS, 0:CELL_POSTS] / (CELL_POSTS - 1)
    x, y = longitude + column, latitude + 1 - row
    heights = numpy.round(700 + 300 * numpy.sin(5 * x) * numpy.cos(4 * y) + 90 * x)
    heights[20:30, 40:60] = -32768
    heights.astype(">i2").tofile(os.path.join(folder, f"N{latitude}E{longitude:03}.hgt"))
    return numpy.where(heights == -32768, numpy.nan, heights)


def in_degrees(heights, west, north, bound):
    cell = 1 / (CELL_POSTS - 1)
    transform = (west - cell / 2, cell, 0, north + cell / 2, 0, -cell)
    return Expected(heights, transform, "EPSG:4326", QgsUnitTypes.DistanceDegrees, ("degree", "metre"), bound)


def from_srtm():
    heights = srtm_cell(".", 43, 7)
    made(TOOL, "encode", "N43E007.hgt", "--max-error", "20", "-o", "area.mtin")
    made(TOOL, "verify", "area.mtin", "N43E007.hgt")
    return "area.mtin", in_degrees(heights, 7, 44, 20)


def from_folder():
    """Three of four cells; where two meet, one of them is 5 m higher at a post."""
    os.mkdir("cells")
    whole = numpy.full((2 * CELL_POSTS - 1, 2 * CELL_POSTS - 1), numpy.nan)
    for latitude, longitude in ((44, 7), (43, 8), (43, 7)):  # named first counts: written last
        top, left = (CELL_POSTS - 1) * (44 - latitude), (CELL_POSTS - 1) * (longitude - 7)
        whole[top : top + CELL_POSTS, left : left + CELL_POSTS] = srtm_cell("cells", latitude, longitude)
    east = numpy.fromfile("cells/N43E008.hgt", ">i2")
    east[75 * CELL_POSTS] += 5
    east.tofile("cells/N43E008.hgt")
    text = made(TOOL, "encode", "cells/", "--max-error", "10", "--device-ram", "65536", "-o", "area.mtp")
    told = "differ by up to 5, most at x 8, y 43.5 in cells/N43E007.hgt and cells/N43E008.hgt"
    check(told in text, f"the overlap is told: {text}")
    made(TOOL, "verify", "area.mtp", "cells/")
    return "area.mtp", in_degrees(whole, 7, 45, 10)


def from_geotiff():
    row, column = numpy.mgrid[0:160, 0:220]
    heights = numpy.round(60 * numpy.sin(column / 29) * numpy.cos(row / 37) + row + column / 4, 1).astype(numpy.float32)
    heights[10:30, 180:] = -9999
    source = gdal.GetDriverByName("GTiff").Create("dem.tif", 220, 160, 1, gdal.GDT_Float32)
    transform = (600000, 10, 0, 5000000, 0, -10)
    source.SetGeoTransform(transform)
    source.SetProjection(system(25832))
    source.GetRasterBand(1).SetNoDataValue(-9999)
    source.GetRasterBand(1).SetUnitType("m")
    source.GetRasterBand(1).WriteArray(heights)
    source = None
    text = made("gdal_translate", "-of", "MTIN", "-co", "MAX_ERROR=1", "dem.tif", "dem.mtin")
    check("Warning" not in text, f"nothing is guessed: {text}")
    heights = numpy.where(heights == -9999, numpy.nan, heights.astype(float))
    return "dem.mtin", Expected(heights, transform, "EPSG:25832", QgsUnitTypes.DistanceMeters, ("metre",) * 2, 1)


def scan(points):
    """LAS 1.4, points of format 6, hundredths, class 2; system as well-known text."""
    text = system(2227, 6360).encode() + b"\0"
    record = struct.pack("<H16sHH32s", 0, b"LASF_Projection", 2112, len(text), b"") + text
    size = 375
    head = struct.pack("<4sHH16sBB32s32sHHH", b"LASF", 0, 16, b"", 1, 4, b"", b"", 1, 2020, size)
    head += struct.pack("<IIBHI5I", size + len(record), 1, 6, 30, 0, *[0] * 5)
    head += struct.pack("<6d", *[0.01] * 3, 6000000, 2000000, 0)
    head += struct.pack("<6d", *(f(points[:, axis]) for axis in range(3) for f in (numpy.max, numpy.min)))
    head += struct.pack("<QQIQ15Q", 0, 0, 0, len(points), len(points), *[0] * 14)
    steps = numpy.round((points - (6000000, 2000000, 0)) * 100).astype(int)
    return head + record + b"".join(struct.pack("<3iHBBBBhHd", *p, 0, 0x11, 0, 2, 0, 0, 0, 0) for p in steps)


def check_scan():
    """Its posts are of the driver's own choice, so heights are compared at the points."""
    random = numpy.random.default_rng(1)
    x, y = numpy.round(random.random((2, 3000)) * [[2000], [1500]], 2)
    points = numpy.stack((6000000 + x, 2000000 + y, numpy.round(100 + x / 40 + 9 * numpy.sin(y / 300), 2)), axis=1)
    with open("feet.las", "wb") as file:
        file.write(scan(points))
    text = made(TOOL, "encode", "feet.las", "--max-error", "1", "-o", "feet.mtin")
    check("units: x and y US survey foot, z US survey foot" in text and "warning" not in text, f"feet: {text}")
    tin = microtin.decode("feet.mtin")
    check((tin.crs, tin.vertical_epsg, tin.units) == (2227, 6360, ("US survey foot",) * 2), "the scan's units")
    found = tin.height_at(points[:, 0], points[:, 1])
    inside = ~numpy.isnan(found)  # a point of the margin may lie beyond its rounded place
    check(inside.sum() > 2950 and numpy.abs(found - points[:, 2])[inside].max() <= 1 + ROUNDING, "heights of points")
    check(unit_of("feet.mtin") == "us-ft", "the raster's unit of heights")
    west, dx, _, north, _, dy = gdal.Open("feet.mtin").GetGeoTransform()
    x, y = west + 7.5 * dx, north + 4.5 * dy
    for kind, provider in ((QgsRasterLayer, "gdal"), (QgsMeshLayer, "mdal")):
        layer = kind("feet.mtin", "scan", provider)
        check(layer.isValid() and code_of(layer) == "EPSG:2227", f"{provider}: the scan's system")
        check(layer.crs().mapUnits() == US_SURVEY_FEET, f"{provider}: the scan's feet")
        value = at(layer, x, y)
        check(abs(value - tin.height_at(x, y)) <= ROUNDING, f"{provider}: the scan's height {value} at {x}, {y}")
    made(TOOL, "decode", "feet.mtin", "-o", "feet.ply")
    check(code_of(QgsMeshLayer("feet.ply", "scan", "mdal")) == "EPSG:2227", "the system of a .ply")


# --- What has become of them ---


def unit_of(path):
    dataset = gdal.Open(path)  # its band must not outlive it
    return dataset.GetRasterBand(1).GetUnitType()


def at(layer, x, y):
    if isinstance(layer, QgsRasterLayer):
        value, found = layer.dataProvider().sample(QgsPointXY(x, y), 1)
        return value if found else numpy.nan
    layer.updateTriangularMesh()
    return layer.datasetValue(QgsMeshDatasetIndex(0, 0), QgsPointXY(x, y)).scalar()


def check_heights(found, expected, what):
    numpy.testing.assert_array_equal(numpy.isnan(found), numpy.isnan(expected.heights), f"{what}: voids")
    worst = numpy.nanmax(numpy.abs(found - expected.heights))
    check(worst <= expected.bound + ROUNDING, f"{what}: {worst} is above the bound")


def code_of(layer):
    """Of places. From QGIS 3.38 on a layer's system has the vertical system as well."""
    crs = layer.crs()
    return (crs.horizontalCrs() if hasattr(crs, "horizontalCrs") else crs).authid()


def check_system(layer, expected, what):
    check(layer.isValid(), f"{what} is opened")
    check(code_of(layer) == expected.code, f"{what}: {code_of(layer)}")
    check(layer.crs().mapUnits() == expected.distances, f"{what}: units of x and y")


def corners(expected, inset):
    """West, south, east, north; half a cell further in or not."""
    x, dx, _, y, _, dy = expected.transform
    rows, columns = expected.heights.shape
    return x + inset * dx, y + (rows - inset) * dy, x + (columns - inset) * dx, y + inset * dy


def check_extent(layer, expected, inset, what):
    extent = layer.extent()
    found = extent.xMinimum(), extent.yMinimum(), extent.xMaximum(), extent.yMaximum()
    numpy.testing.assert_allclose(found, corners(expected, inset), atol=1e-9, err_msg=what)


def check_raster(path, expected):
    layer = QgsRasterLayer(path, "raster", "gdal")
    check_system(layer, expected, f"{path} as a raster")
    check_extent(layer, expected, 0, f"{path} as a raster")
    rows, columns = expected.heights.shape
    check((layer.height(), layer.width()) == (rows, columns), f"{path}: rows and columns")
    check(layer.dataProvider().sourceHasNoDataValue(1), f"{path}: voids have a value")
    block = layer.dataProvider().block(1, layer.extent(), columns, rows)
    found = numpy.frombuffer(bytes(block.data()), float).reshape(rows, columns)
    void = found == layer.dataProvider().sourceNoDataValue(1)
    check_heights(numpy.where(void, numpy.nan, found), expected, f"{path} as a raster")
    check(unit_of(path) == "m", f"{path}: the unit of heights")


def check_mesh(path, expected):
    layer = QgsMeshLayer(path, "mesh", "mdal")
    check_system(layer, expected, f"{path} as a mesh")
    check_extent(layer, expected, 0.5, f"{path} as a mesh")
    x, dx, _, y, _, dy = expected.transform
    rows, columns = expected.heights.shape
    for row in range(1, rows - 1, 13):
        for column in range(1, columns - 1, 17):
            # Next to a void triangles may end between a post and its neighbour.
            if numpy.isnan(expected.heights[row - 1 : row + 2, column - 1 : column + 2]).any():
                continue
            value = at(layer, x + (column + 0.5) * dx, y + (row + 0.5) * dy)
            difference = abs(value - expected.heights[row, column])
            check(difference <= expected.bound + 0.1, f"{path} as a mesh at {row}, {column}: {difference}")


def check_array(path, expected):
    tin = microtin.decode(path)
    array, transform = tin.raster()
    numpy.testing.assert_allclose(transform, expected.transform, atol=1e-9)
    check_heights(array, expected, f"{path} as an array")
    check((f"EPSG:{tin.crs}", tin.units) == (expected.code, expected.units), f"{path}: its system and units")
    numpy.testing.assert_allclose(tin.bounds, corners(expected, 0.5), atol=1e-9)


# --- Wrong turns ---


def check_wrong_turns():
    missing = {"GDAL_DRIVER_PATH": "", "MDAL_DRIVER_PATH": ""}
    refused(["`MTIN' not recognised"], "gdal_translate", "-of", "MTIN", "dem.tif", "a.mtin", **missing)
    refused(["`dem.mtin' not recognized as "], "gdalinfo", "dem.mtin", **missing)
    gdal.Translate("two.tif", "dem.tif", bandList=[1, 1])
    refused(["2: choose one with -b"], "gdal_translate", "-of", "MTIN", "two.tif", "a.mtin")
    refused(["a.tif: name a stream .mtin and a pack .mtp"], TOOL, "encode", "N43E007.hgt", "-o", "a.tif")
    refused(["a.tif: not a kind of file that is written", "gdal_translate"], TOOL, "decode", "dem.mtin", "-o", "a.tif")
    with open("dem.mtin", "rb") as file:
        data = bytearray(file.read())
    data[len(data) // 2] ^= 1
    with open("damaged.mtin", "wb") as file:
        file.write(data)
    layer = QgsRasterLayer("damaged.mtin", "damaged", "gdal")
    check(not layer.isValid() and "damaged.mtin: damaged" in layer.error().message(), "QGIS says what is damaged")
    check(not QgsMeshLayer("damaged.mtin", "damaged", "mdal").isValid(), "a damaged mesh is refused")
    try:
        microtin.decode("damaged.mtin")
        check(False, "a damaged stream is refused in Python")
    except microtin.Error as error:
        check("damaged.mtin: damaged" in str(error), f"Python says what is damaged: {error}")


def walk():
    for path, expected in (from_srtm(), from_folder(), from_geotiff()):
        check_raster(path, expected)
        check_mesh(path, expected)
        check_array(path, expected)
    check_scan()
    check_wrong_turns()


def main():
    application = QgsApplication([], False)
    application.initQgis()
    gdal.UseExceptions()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        walk()
        os.chdir("/")
    print("a cell, a folder of cells, a GeoTIFF and a scan in feet are maps in QGIS and arrays in numpy")
    sys.stdout.flush()
    application.exitQgis()


main()
