# SPDX-License-Identifier: MIT
"""viewshed_test.py: lines of sight against GDAL's viewshed of the decoded raster. Skipped (77) without python3-gdal or numpy."""

import sys
import unittest

try:
    import numpy
    from osgeo import gdal, osr
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

import microtin

gdal.UseExceptions()
BLOCKED, CLEAR = 0, 255


def viewshed(heights, cell, observer, height, target, curvature, kind):
    """Of posts `cell` metres apart; the observer is at [row, column]."""
    rows, columns = heights.shape
    raster = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Float64)
    raster.SetGeoTransform((600000, cell, 0, 5000000, 0, -cell))
    system = osr.SpatialReference()
    system.ImportFromEPSG(25832)
    raster.SetProjection(system.ExportToWkt())
    raster.GetRasterBand(1).WriteArray(heights)
    x, y = 600000 + (observer[1] + 0.5) * cell, 5000000 - (observer[0] + 0.5) * cell
    found = gdal.ViewshedGenerate(
        raster.GetRasterBand(1), "MEM", "", [], x, y, height, target, CLEAR, BLOCKED, 0, -1, curvature,
        gdal.GVM_Edge, 0, heightMode=kind,
    )
    return found.ReadAsArray()


def surface(heights, cell):
    transform = (600000, cell, 0, 5000000, 0, -cell)
    return microtin.decode(microtin.encode(heights, transform=transform, crs=25832, units=":metre"))


def ends(cells, cell, height):
    rows, columns = numpy.asarray(cells).T
    return numpy.stack((600000 + (columns + 0.5) * cell, 5000000 - (rows + 0.5) * cell, height + 0 * rows), axis=-1)


class Viewshed(unittest.TestCase):
    def test_hills(self):
        """GDAL interpolates between posts where rays pass; triangles are exact. So cells whose target would have to rise or
        sink by more than MARGIN to change GDAL's answer agree, and nearly all others, too."""
        cell, margin, mast, target = 30, 4, 12, 3
        row, column = numpy.mgrid[0:161, 0:201]
        heights = numpy.round(40 * numpy.sin(column / 11) * numpy.cos(row / 13) + 15 * numpy.sin(column / 3.7 + row / 5.1), 1)
        observer = (80, 100)
        needed = viewshed(heights, cell, observer, mast, target, 0.75, gdal.GVOT_MIN_TARGET_HEIGHT_FROM_GROUND)
        dice = numpy.random.default_rng(5)
        cells = numpy.stack((dice.integers(0, 161, 3000), dice.integers(0, 201, 3000)), axis=-1)
        found = surface(heights, cell).line_of_sight(ends([observer], cell, mast), ends(cells, cell, target))
        needed = needed[tuple(cells.T)]
        agree = (found.line == "clear") == (needed <= target)
        print(f"{agree.mean():.2%} of {len(cells)} lines agree, {(found.line == 'clear').mean():.0%} are clear;"
              f" the rest is at most {numpy.abs(needed - target)[~agree].max(initial=0):.2f} m off")
        self.assertGreater(agree.mean(), 0.97)
        self.assertTrue(agree[numpy.abs(needed - target) > margin].all())
        self.assertTrue(0.1 < (found.line == "clear").mean() < 0.9)

    def test_horizon(self):
        """A plain ends at the horizon, which refraction moves away: sqrt(2 K R h)."""
        cell, height = 100, 5
        flat = numpy.zeros((3, 161))
        tin = surface(flat, cell)
        cells = [(1, column) for column in range(161)]
        for factor in (1, 4 / 3):
            seen = viewshed(flat, cell, (1, 0), height, 0, 1 / factor, gdal.GVOT_NORMAL)[1] == CLEAR
            found = tin.line_of_sight(ends([(1, 0)], cell, height), ends(cells, cell, 0), earth_factor=factor).line == "clear"
            horizon = numpy.sqrt(2 * factor * 6371008.8 * height)
            self.assertLess(abs(found.sum() * cell - horizon), 2 * cell)
            self.assertLessEqual(abs(int(found.sum()) - int(seen.sum())), 1, f"{found.sum()} {seen.sum()}")


if __name__ == "__main__":
    unittest.main()
