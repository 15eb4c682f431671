# SPDX-License-Identifier: MIT
"""driver_test.py GOLDEN: the driver in GDAL's programs and in Python. Skipped (77) without python3-gdal or numpy."""

import functools
import http.server
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import xml.etree.ElementTree
import zipfile

try:
    import numpy
    from osgeo import gdal, ogr, osr
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

gdal.UseExceptions()
TOOL = os.environ["MICROTIN_TOOL"]
ROWS, COLUMNS = 300, 420
ROW, COLUMN = numpy.mgrid[0:ROWS, 0:COLUMNS]
TRANSFORM = (600000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0)
VOID = (ROW < 20) & (COLUMN > 300)
NONE = -32768
ROUNDING = 1e-9  # of differences of binary numbers
BOUND = 0.5
OF_STREAMS = ("MAX_VERTICES", "MAX_BYTES", "XY_STEP", "DIGEST", "PHASES")
OF_PACKS = ("TILE_VERTICES", "TILE_SIZE")


def hills():
    """Not the same when mirrored."""
    heights = numpy.round(60 * numpy.sin(COLUMN / 29) * numpy.cos(ROW / 37) + ROW + COLUMN / 4, 1)
    return numpy.where(VOID, NONE, heights)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Driver(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        source = gdal.GetDriverByName("GTiff").Create(cls.path("hills.tif"), COLUMNS, ROWS, 1, gdal.GDT_Float64)
        source.SetGeoTransform(TRANSFORM)
        system = osr.SpatialReference()
        system.ImportFromEPSG(25832)
        source.SetProjection(system.ExportToWkt())
        source.GetRasterBand(1).SetNoDataValue(NONE)
        source.GetRasterBand(1).WriteArray(hills())
        source = None
        for name, options in (("hills.mtin", []), ("hills.mtp", ["TILE_VERTICES=300"])):
            gdal.Translate(
                cls.path(name), cls.path("hills.tif"), format="MTIN", creationOptions=[f"MAX_ERROR={BOUND}", *options]
            )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def both(self):
        for name in ("hills.mtin", "hills.mtp"):
            with self.subTest(name):
                yield self.path(name)

    def expect_hills(self, dataset):
        band = dataset.GetRasterBand(1)
        array = band.ReadAsArray()
        numpy.testing.assert_array_equal(array == band.GetNoDataValue(), VOID)
        self.assertLessEqual(numpy.abs(array - hills())[~VOID].max(), BOUND + ROUNDING)

    def test_opens_that_try_to_update_first_end_in_reading_without_an_error(self):
        for name in ("hills.mtin", "hills.mtp"):
            opened = subprocess.run(["ogrinfo", self.path(name)], check=True, capture_output=True, text=True)
            self.assertEqual(opened.stderr, "")
            self.assertIn("vertices", opened.stdout)
            with self.assertRaisesRegex(RuntimeError, "files are not updated; translate them"):
                gdal.OpenEx(self.path(name), gdal.OF_VECTOR | gdal.OF_UPDATE)

    def test_raster(self):
        for path in self.both():
            dataset = gdal.Open(path)
            self.assertEqual(dataset.GetGeoTransform(), TRANSFORM)
            self.assertEqual(dataset.GetSpatialRef().GetAuthorityCode(None), "25832")
            self.assertEqual(dataset.GetMetadataItem("AREA_OR_POINT"), "Point")
            self.assertEqual(float(dataset.GetMetadataItem("MAX_ERROR_ASKED")), BOUND)
            self.assertEqual(dataset.GetRasterBand(1).GetUnitType(), "m")
            self.expect_hills(dataset)

    def feature(self, kind, coordinates, **properties):
        """The path of a GeoJSON file."""
        path = self.path(f"{kind}{len(properties)}.geojson")
        with open(path, "w") as file:
            geometry = {"type": kind, "coordinates": coordinates}
            json.dump({"type": "Feature", "properties": properties, "geometry": geometry}, file)
        return path

    def error_maps(self):
        """Polygons, and a raster of coarser cells: its bounds are kept."""
        raster = self.path("bounds.tif")
        west, north, side = 600000, 4999000, 700
        ring = [[west, north], [west + side, north], [west + side, north - side], [west, north]]
        polygons = self.feature("Polygon", [ring], max_error=0.5)
        bounds = gdal.GetDriverByName("GTiff").Create(raster, 16, 15, 1, gdal.GDT_Float32)
        bounds.SetGeoTransform((west, 100, 0, north, 0, -100))
        bounds.GetRasterBand(1).WriteArray(numpy.where(numpy.mgrid[0:15, 0:16][1] < 5, 0.5, 3))
        return [polygons, raster]

    def test_a_raster_of_bounds_is_kept(self):
        small, path = self.path("part.tif"), self.path("part.mtin")
        gdal.Translate(small, self.path("hills.tif"), srcWin=[0, 100, 160, 150])
        heights = gdal.Open(small).ReadAsArray()
        gdal.Translate(path, small, format="MTIN", creationOptions=["ERROR_MAP=" + self.error_maps()[1]])
        made = gdal.Open(path)
        error = abs(made.ReadAsArray() - heights)
        self.assertLessEqual(error[:, :50].max(), 0.5 + ROUNDING)
        self.assertLessEqual(error.max(), 3 + ROUNDING)
        self.assertGreater(error.max(), 1)
        self.assertEqual((made.GetMetadataItem("LEAST_BOUND"), made.GetMetadataItem("LARGEST_BOUND")), ("0.5", "3"))

    def test_each_creation_option_makes_a_difference(self):
        """Those that the driver lists, with a row for each of their values, alone and with a bound."""
        west, north = 600000, 4999000
        ring = [[west, north], [west + 900, north], [west + 900, north - 900], [west, north]]
        square = self.feature("Polygon", [ring])
        line = self.feature("LineString", [[west + 100, north - 100], [west + 1200, north - 1000]])
        tower = self.feature("Point", [west + 500, north - 500], height=80)
        rows = {
            "MAX_ERROR": ["1"],
            "MAX_VERTICES": ["200"],
            "MAX_BYTES": ["900"],
            "NEVER_BELOW": ["YES"],
            "Z_STEP": ["0.7"],
            "XY_STEP": ["0.5"],
            "EFFORT": ["FAST", "BEST"],
            "CODING": ["QUICK", "DENSE"],
            "MAX_DEGREE": ["6"],
            "UNITS": ["metre:foot"],
            "DEPTHS": ["YES"],
            "SURFACE": ["GROUND", "TOP", "BED", "GEOID", "OBSTACLES"],
            "TILE_VERTICES": ["100"],
            "TILE_SIZE": ["40"],
            "SOURCE_NAME": ["a survey"],
            "DATE": ["2026-11"],
            "LINEAGE": ["thinned"],
            "ATTRIBUTION": ["by a survey"],
            "LICENSE": ["CC-BY-4.0"],
            "VALID": ["2024-01/.."],
            "EPOCH": ["2020.5"],
            "SOURCE_ACCURACY": ["LE90 4"],
            "DIGEST": ["YES"],
            "PHASES": ["YES"],
            "ERROR_MAP": self.error_maps(),
            "BOUND_AT": ["EVERYWHERE"],
            "AREA": [square],
            "ROUTE": [line],
            "ROUTE_WIDTH": ["500"],
            "ROUTE_EDGE_ERROR": ["9"],
            "BREAKLINES": [line],
            "OBSTACLES": [tower],
        }
        together = {"ROUTE": {"ROUTE_WIDTH": "900"}, "ROUTE_WIDTH": {"ROUTE": line}}
        together["ROUTE_EDGE_ERROR"] = {"ROUTE": line, "ROUTE_WIDTH": "500"}
        text = gdal.GetDriverByName("MTIN").GetMetadataItem("DMD_CREATIONOPTIONLIST")
        listed = xml.etree.ElementTree.fromstring(text).iter("Option")
        self.assertEqual({option.get("name") for option in listed}, set(rows))
        with open(os.path.join(os.path.dirname(__file__), "../../encoder/docs/gdal-qgis.md")) as page:
            line = next(line for line in page if line.startswith("| creation options |"))
        self.assertEqual(set(re.findall("`([A-Z_]+)`", line)), set(rows))
        small = self.path("small.tif")
        gdal.Translate(small, self.path("hills.tif"), srcWin=[0, 100, 160, 150])

        def encoded(suffix, options):
            path = self.path("option" + suffix)
            gdal.Translate(path, small, format="MTIN", creationOptions=[f"{k}={v}" for k, v in options.items()])
            with open(path, "rb") as file:
                return file.read()

        for suffix in (".mtin", ".mtp"):
            base = {"MAX_ERROR": "2"} if suffix == ".mtin" else {"MAX_ERROR": "2", "TILE_VERTICES": "16"}
            without = encoded(suffix, base)
            for name, values in rows.items():
                if name in (OF_PACKS if suffix == ".mtin" else OF_STREAMS):
                    with self.assertRaisesRegex(RuntimeError, "is an option of|is for streams|packs"):
                        encoded(suffix, dict(base, **{name: values[0]}))
                    continue
                others = {} if name in ("MAX_VERTICES", "MAX_BYTES") else dict(base, **together.get(name, {}))
                made = [encoded(suffix, dict(others, **{name: value})) for value in values]
                with self.subTest(suffix + " " + name):
                    self.assertEqual(len({without, *made}), 1 + len(made))

    def made_with(self, option, path, **others):
        """The bytes of a stream of part of the hills."""
        small, made = self.path("part.tif"), self.path("part.mtin")
        gdal.Translate(small, self.path("hills.tif"), srcWin=[0, 100, 160, 150])
        options = dict({"MAX_ERROR": "2", option: path}, **others)
        gdal.Translate(made, small, format="MTIN", creationOptions=[f"{k}={v}" for k, v in options.items()])
        with open(made, "rb") as file:
            return file.read()

    def test_files_of_options_are_all_that_gdal_reads(self):
        """GeoPackages and shapefiles make the bytes that GeoJSON makes."""
        west, north = 600000, 4999000
        ring = [[west, north], [west + 900.25, north], [west + 900, north - 900], [west, north]]
        line = [[west + 105, north - 105, 145.5], [west + 605, north - 305, 190], [west + 905, north - 505.5, 210]]
        files = {
            "AREA": self.feature("MultiPolygon", [[ring]]),
            "ROUTE": self.feature("MultiLineString", [line]),
            "OBSTACLES": self.feature("Point", [west + 500, north - 500], height=80.25, radius=20),
            "ERROR_MAP": self.feature("Polygon", [ring], max_error=0.1),
            "BREAKLINES": self.feature("LineString", line, **{"class": "dam", "id": 1, "top": 5}),
        }
        for option, path in files.items():
            others = {"ROUTE_WIDTH": "500"} if option == "ROUTE" else {"MAX_ERROR": "60"} if option == "BREAKLINES" else {}
            expected = self.made_with(option, path, **others)
            for kind in (".gpkg", ".shp"):
                name = self.path(option.lower() + kind)
                run("ogr2ogr", name, path, "-a_srs", "EPSG:25832")
                with self.subTest(option + kind):
                    self.assertEqual(self.made_with(option, name, **others), expected)
                    with self.assertRaisesRegex(RuntimeError, "is not the terrain's .ETRS89 / UTM zone 32N.: transform"):
                        run("ogr2ogr", self.path("other" + kind), path, "-a_srs", "EPSG:32633", "-overwrite")
                        self.made_with(option, self.path("other" + kind), **others)

    def test_files_of_options_that_cannot_be_read_are_named(self):
        def geometries(name, *texts, field=None):
            source = ogr.GetDriverByName("GPKG").CreateDataSource(self.path(name))
            layer = source.CreateLayer("one", geom_type=ogr.wkbUnknown)
            if field is not None:
                kind = ogr.OFTString if isinstance(field[1], str) else ogr.OFTInteger
                layer.CreateField(ogr.FieldDefn(field[0], kind))
            for text in texts:
                feature = ogr.Feature(layer.GetLayerDefn())
                if field is not None:
                    feature.SetField(*field)
                feature.SetGeometry(ogr.CreateGeometryFromWkt(text))
                layer.CreateFeature(feature)
            layer = source = None  # which writes the file
            return self.path(name)

        line = "LINESTRING (600105 4998895, 600905 4998495)"
        rows = (
            ("AREA", geometries("line.gpkg", line), "line.gpkg: has no polygon; draw one"),
            ("AREA", geometries("tin.gpkg", "TIN (((0 0, 1 0, 1 1, 0 0)))"), "tin.gpkg: has a TIN: convert it"),
            ("AREA", self.path("nosuch.gpkg"), "nosuch.gpkg: has no polygons, lines or points that GDAL reads"),
            ("ERROR_MAP", self.path("nosuch.gpkg"), "nosuch.gpkg: is neither a raster of bounds nor a file of"),
            ("BREAKLINES", geometries("class.gpkg", line, line, field=("class", "wal")), "class.gpkg:1: 'wal' is not a class"),
            ("BREAKLINES", geometries("number.gpkg", line, field=("class", 3)), "number.gpkg:1: '3' is not a class of lines"),
            ("OBSTACLES", geometries("top.gpkg", "POINT (9 9)", field=("top", "tall")), "top.gpkg:1: top is not a number"),
        )
        for option, path, words in rows:
            with self.subTest(words), self.assertRaisesRegex(RuntimeError, words):
                self.made_with(option, path)
        curve = geometries("curve.gpkg", "CIRCULARSTRING (600105 4998895, 600505 4998795, 600905 4998495)", "LINESTRING EMPTY")
        self.assertNotEqual(self.made_with("BREAKLINES", curve), self.made_with("MAX_ERROR", "2"))
        run("ogr2ogr", "-update", self.path("line.gpkg"), self.path("line.gpkg"), "-nln", "two")
        with self.assertRaisesRegex(RuntimeError, "line.gpkg: has 2 layers with geometries .one, two.: copy one"):
            self.made_with("BREAKLINES", self.path("line.gpkg"))

    def test_the_metadata_state_what_the_header_promises(self):
        small = self.path("promise.tif")
        gdal.Translate(small, self.path("hills.tif"), srcWin=[0, 100, 160, 150])
        for suffix in (".mtin", ".mtp"):
            path = self.path("promise" + suffix)
            options = ["MAX_ERROR=2", "NEVER_BELOW=YES", "SURFACE=top"]
            dataset = gdal.Translate(path, small, format="MTIN", creationOptions=options)
            promised = {key: dataset.GetMetadataItem(key) for key in ("SURFACE", "SIDE", "MAX_BELOW")}
            self.assertEqual(promised, {"SURFACE": "top", "SIDE": "never_below", "MAX_BELOW": "0"})
            self.assertEqual(dataset.GetMetadataItem("MAX_ABOVE"), dataset.GetMetadataItem("MAX_ERROR"))

    def test_digest_and_phases_of_a_stream_are_metadata(self):
        small, path = self.path("measured.tif"), self.path("measured.mtin")
        gdal.Translate(small, self.path("hills.tif"), srcWin=[0, 100, 160, 150])
        dataset = gdal.Translate(path, small, format="MTIN", creationOptions=["MAX_ERROR=2", "DIGEST=YES", "PHASES=YES"])
        self.assertRegex(dataset.GetMetadataItem("DIGEST"), "^[0-9a-f]{16}$")
        last = dataset.GetMetadataItem("PHASES").split("; ")[-1].split()
        self.assertEqual(last[:2], [dataset.GetMetadataItem("VERTICES"), str(os.path.getsize(path))])
        self.assertEqual(last[2], dataset.GetMetadataItem("MAX_ERROR"))

    def test_notes_of_a_tiff_pass_through_streams_and_packs_and_back(self):
        source = self.path("noted.tif")
        dataset = gdal.Translate(source, self.path("hills.tif"), srcWin=[0, 100, 160, 150])
        tags = {
            "TIFFTAG_COPYRIGHT": "\u00a9 the survey",
            "TIFFTAG_IMAGEDESCRIPTION": "DGM1",
            "TIFFTAG_DATETIME": "2021:05:03 10:20:30",
            "LICENSE": "CC-BY-4.0",
        }
        dataset.SetMetadata(tags)
        system = dataset.GetSpatialRef()
        system.SetCoordinateEpoch(2020.5)
        dataset.SetSpatialRef(system)
        dataset = None
        wanted = {
            "ATTRIBUTION": "\u00a9 the survey",
            "TIFFTAG_COPYRIGHT": "\u00a9 the survey",
            "SOURCE": "DGM1",
            "DATE": "2021-05-03",
            "LICENSE": "CC-BY-4.0",
            "VALID": "2024-01/..",
            "SOURCE_ACCURACY": "LE90 4",
        }
        for suffix in (".mtin", ".mtp"):
            path, back = self.path("noted" + suffix), self.path("back.tif")
            options = ["MAX_ERROR=2", "VALID=2024-01/..", "SOURCE_ACCURACY=LE90 4"]
            gdal.Translate(path, source, format="MTIN", creationOptions=options)
            gdal.Translate(back, path)
            gdal.Translate(self.path("again" + suffix), back, format="MTIN", creationOptions=["MAX_ERROR=2"])
            for name in (path, back, self.path("again" + suffix)):
                with self.subTest(name):
                    found = gdal.Open(name)
                    self.assertEqual({key: found.GetMetadataItem(key) for key in wanted}, wanted)
                    self.assertEqual(found.GetSpatialRef().GetCoordinateEpoch(), 2020.5)
            own = ["MAX_ERROR=2", "ATTRIBUTION=another", "EPOCH=2015"]
            overridden = gdal.Translate(self.path("own" + suffix), source, format="MTIN", creationOptions=own)
            self.assertEqual(overridden.GetMetadataItem("ATTRIBUTION"), "another")
            self.assertEqual(overridden.GetSpatialRef().GetCoordinateEpoch(), 2015)

    def test_a_source_of_more_posts_than_its_bytes_can_hold_is_refused(self):
        path = self.path("sparse.tif")
        sparse = gdal.GetDriverByName("GTiff").Create(path, 60000, 60000, 1, gdal.GDT_Float64, ["SPARSE_OK=TRUE"])
        sparse.SetGeoTransform(TRANSFORM)
        sparse = None
        for suffix in (".mtin", ".mtp"):
            with self.assertRaisesRegex(RuntimeError, "bytes cannot hold 60000 x 60000 posts"):
                gdal.Translate(self.path("new" + suffix), path, format="MTIN", creationOptions=["MAX_ERROR=1"])

    def test_overviews_lie_where_the_raster_does(self):
        for path in self.both():
            dataset = gdal.Open(path)
            band = dataset.GetRasterBand(1)
            self.assertEqual(band.GetOverviewCount(), 1)
            coarse = band.GetOverview(0).ReadAsArray()
            self.assertEqual(coarse.shape, (ROWS // 2, COLUMNS // 2))
            # The middle of four posts is a post of a raster of half the cell size.
            finer = gdal.OpenEx(path, gdal.OF_RASTER, open_options=["CELL_SIZE=5"]).ReadAsArray()
            numpy.testing.assert_allclose(coarse, finer[1::4, 1::4], atol=ROUNDING)

    def test_overviews_of_an_odd_number_of_rows_and_columns(self):
        """The northernmost rows keep their place."""
        path = self.path("odd.mtin")
        gdal.Translate(
            path, self.path("hills.tif"), format="MTIN", srcWin=[0, 0, COLUMNS - 1, ROWS - 1], creationOptions=["MAX_ERROR=1"]
        )
        dataset = gdal.Open(path)  # its bands must not outlive it
        coarse = dataset.GetRasterBand(1).GetOverview(0).ReadAsArray()
        self.assertEqual(coarse.shape, (ROWS // 2, COLUMNS // 2))
        finer = gdal.OpenEx(path, gdal.OF_RASTER, open_options=["CELL_SIZE=5"]).ReadAsArray()[1::4, 1::4]
        numpy.testing.assert_allclose(coarse[: len(finer), : len(finer[0])], finer, atol=ROUNDING)

    def test_no_height_is_the_no_data_value(self):
        source = gdal.GetDriverByName("MEM").Create("", 9, 9, 1, gdal.GDT_Float64)
        source.SetGeoTransform(TRANSFORM)
        heights = -9999.0 - numpy.arange(81).reshape(9, 9)
        heights[8, 8] = numpy.nan
        source.GetRasterBand(1).WriteArray(heights)
        copy = gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/low.mtin", source)
        band = copy.GetRasterBand(1)
        self.assertEqual(band.GetNoDataValue(), -99999)
        numpy.testing.assert_array_equal(band.ReadAsArray(), numpy.where(numpy.isnan(heights), -99999, heights))

    def test_features_of_packs_name_their_tile(self):
        dataset = gdal.OpenEx(self.path("hills.mtp"), gdal.OF_VECTOR)
        columns, rows = map(int, dataset.GetMetadataItem("TILES").split(" x "))
        for name in ("vertices", "triangles"):
            features = list(dataset.GetLayerByName(name))
            self.assertEqual([feature.GetFID() for feature in features], list(range(len(features))))
            tiles = {(feature.GetField("tile_column"), feature.GetField("tile_row")) for feature in features}
            self.assertEqual(tiles, {(column, row) for column in range(columns) for row in range(rows)})

    def test_cell_size(self):
        for path in self.both():
            dataset = gdal.OpenEx(path, gdal.OF_RASTER, open_options=["CELL_SIZE=5"])
            self.assertEqual(dataset.GetGeoTransform(), (600002.5, 5.0, 0.0, 4999997.5, 0.0, -5.0))
            array = dataset.ReadAsArray()
            self.assertEqual(array.shape, (2 * ROWS - 1, 2 * COLUMNS - 1))
            numpy.testing.assert_allclose(array[::2, ::2], gdal.Open(path).ReadAsArray(), atol=ROUNDING)
            with self.assertRaisesRegex(RuntimeError, "cell: 0 is not a length above 0"):
                gdal.OpenEx(path, gdal.OF_RASTER, open_options=["CELL_SIZE=0"])

    def test_layers(self):
        for path in self.both():
            dataset = gdal.OpenEx(path, gdal.OF_VECTOR)
            vertices, triangles = (dataset.GetLayerByName(name) for name in ("vertices", "triangles"))
            self.assertEqual(vertices.GetGeomType(), ogr.wkbPoint25D)
            self.assertEqual(triangles.GetGeomType(), ogr.wkbPolygon25D)
            self.assertEqual(vertices.GetSpatialRef().GetAuthorityCode(None), "25832")
            places = {feature.GetGeometryRef().GetPoint() for feature in vertices}
            corners = {p for feature in triangles for p in feature.GetGeometryRef().GetGeometryRef(0).GetPoints()}
            self.assertLessEqual(corners, places)
            self.assertEqual(vertices.GetFeatureCount(), sum(1 for _ in vertices))
            area = sum(feature.GetGeometryRef().GetArea() for feature in triangles)
            self.assertLess(abs(area / (100 * ((ROWS - 1) * (COLUMNS - 1) - VOID.sum())) - 1), 0.005)

    def test_the_lines_of_a_file_are_a_layer(self):
        """The ones that the tool's `decode` writes, which GDAL reads as GeoJSON."""
        path, decoded = self.path("lines.mtin"), self.path("lines.geojson")
        ridge = [[600100, 4999800, 75], [601200, 4999800, 80], [601900, 4999100, 90]]
        dam = [[602100, 4999500], [602900, 4998700]]
        with open(decoded, "w") as file:
            features = [
                {"type": "Feature", "properties": {"class": kind}, "geometry": {"type": "LineString", "coordinates": line}}
                for kind, line in (("ridge", ridge), ("dam", dam))
            ]
            json.dump({"type": "FeatureCollection", "features": features}, file)
        options = ["MAX_ERROR=40", "BREAKLINES=" + decoded]
        gdal.Translate(path, self.path("hills.tif"), format="MTIN", creationOptions=options)
        run(TOOL, "decode", path, "-o", decoded)
        dataset = gdal.OpenEx(path, gdal.OF_VECTOR)
        names = [dataset.GetLayer(i).GetName() for i in range(dataset.GetLayerCount())]
        self.assertEqual(names, ["vertices", "triangles", "lines"])
        lines, expected = dataset.GetLayer(2), gdal.OpenEx(decoded, gdal.OF_VECTOR)
        self.assertEqual(lines.GetGeomType(), ogr.wkbLineString25D)
        self.assertEqual(lines.GetSpatialRef().GetAuthorityCode(None), "25832")

        def content(layer):
            return [(f.GetField("class"), f.GetGeometryRef().GetPoints()) for f in layer]

        self.assertEqual(content(lines), content(expected.GetLayer(0)))
        self.assertEqual(content(lines), content(lines), "read again")
        self.assertEqual(lines.GetFeatureCount(), 2)
        self.assertEqual([f.GetFID() for f in lines], [0, 1])
        lines.SetAttributeFilter("class = 'dam'")
        self.assertEqual((lines.GetFeatureCount(), len(content(lines))), (1, 1))
        lines.SetAttributeFilter(None)
        lines.SetSpatialFilterRect(600000, 4999000, 602000, 5000000)
        self.assertEqual([kind for kind, _ in content(lines)], ["ridge"])
        vertices = {f.GetGeometryRef().GetPoint() for f in dataset.GetLayer(0)}
        lines.SetSpatialFilter(None)
        self.assertLessEqual({place for _, places in content(lines) for place in places}, vertices)

    def test_filters(self):
        for path in self.both():
            dataset = gdal.OpenEx(path, gdal.OF_VECTOR)
            layer = dataset.GetLayerByName("vertices")
            expected = {f.GetFID() for f in layer if f.GetGeometryRef().GetX() < 601000}
            layer.SetSpatialFilterRect(599000, 4990000, 601000 - 1e-6, 5010000)
            self.assertTrue(expected)
            found = {f.GetGeometryRef().GetPoint() for f in layer}
            layer.SetSpatialFilter(None)
            self.assertEqual(found, {f.GetGeometryRef().GetPoint() for f in layer if f.GetFID() in expected})

    def test_programs(self):
        for path in self.both():
            self.assertIn("Size is 420, 300", run("gdalinfo", path))
            value = float(run("gdallocationinfo", "-valonly", path, "100", "200"))
            self.assertLessEqual(abs(value - hills()[200, 100]), BOUND + ROUNDING)
            for command in ("gdaldem hillshade", "gdal_contour -i 50 -a height", "gdal_translate -of GTiff"):
                name = self.path("out.gpkg" if "contour" in command else "out.tif")
                run(*command.split(), path, name)
                self.assertGreater(os.path.getsize(name), 10000)
                os.remove(name)
            name = self.path("out.gpkg")
            run("ogr2ogr", name, path)
            layers = gdal.OpenEx(name, gdal.OF_VECTOR)
            self.assertEqual(
                [layers.GetLayer(i).GetName() for i in range(layers.GetLayerCount())], ["vertices", "triangles"]
            )
            self.assertGreater(layers.GetLayer(1).GetFeatureCount(), 100)
            layers = None
            os.remove(name)

    def test_the_tool_and_the_driver_agree(self):
        gdal.Translate(self.path("source.asc"), self.path("hills.tif"), format="AAIGrid")
        for path in self.both():
            run(TOOL, "verify", path, self.path("source.asc"))  # every post; fails if one is beyond the bound

    def test_zip_and_web(self):
        with zipfile.ZipFile(self.path("hills.zip"), "w", zipfile.ZIP_DEFLATED) as archive:
            for path in (self.path("hills.mtin"), self.path("hills.mtp")):
                archive.write(path, os.path.basename(path))
        handler = functools.partial(QuietHandler, directory=self.folder.name)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            for name in ("hills.mtin", "hills.mtp"):
                self.expect_hills(gdal.Open(f"/vsizip/{self.path('hills.zip')}/{name}"))
                self.expect_hills(gdal.Open(f"/vsicurl/http://127.0.0.1:{server.server_port}/{name}"))
        finally:
            server.shutdown()
            server.server_close()

    def test_points_get_a_cell_of_their_own(self):
        with open(self.path("points.xyz"), "w") as file:
            for i in range(2000):
                file.write(f"{i * 7919 % 1000} {i * 104729 % 997} {i % 50}\n")
        run(TOOL, "encode", self.path("points.xyz"), "-o", self.path("points.mtin"))
        transform = gdal.Open(self.path("points.mtin")).GetGeoTransform()
        self.assertEqual((transform[1], transform[5]), (10, -10))  # half of 22 is 11

    def test_floats_masks_and_south_up(self):
        memory = gdal.GetDriverByName("MEM")
        source = memory.Create("", COLUMNS, ROWS, 1, gdal.GDT_Float32)
        source.SetGeoTransform((0, 1, 0, 0, 0, 1))
        source.GetRasterBand(1).WriteArray(hills()[::-1].astype(numpy.float32))
        source.CreateMaskBand(gdal.GMF_PER_DATASET)
        source.GetRasterBand(1).GetMaskBand().WriteArray(numpy.where(VOID[::-1], 0, 255).astype(numpy.uint8))
        copy = gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/south.mtin", source, options=["MAX_ERROR=0.5"])
        self.assertEqual(copy.GetGeoTransform(), (0, 1, 0, ROWS, 0, -1))
        self.expect_hills(copy)

    def test_no_data_values_are_compared_in_the_type_of_the_cells(self):
        for value, cell in ((-9999.99, -9999.99), (-3.4e38, numpy.finfo(numpy.float32).min), (-9999, -9999)):
            source = gdal.GetDriverByName("MEM").Create("", COLUMNS, ROWS, 1, gdal.GDT_Float32)
            source.SetGeoTransform((0, 1, 1e-18, ROWS, 0, -1))
            source.GetRasterBand(1).WriteArray(numpy.where(VOID, cell, hills()).astype(numpy.float32))
            source.GetRasterBand(1).SetNoDataValue(value)
            self.expect_hills(gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/n.mtin", source, options=["MAX_ERROR=0.5"]))

    def test_what_cannot_be_encoded(self):
        memory, driver = gdal.GetDriverByName("MEM"), gdal.GetDriverByName("MTIN")

        def refused(
            sentence, bands=1, kind=gdal.GDT_Float64, transform=TRANSFORM, epsg=None, unit="", options=(), name="refused.mtin"
        ):
            source = memory.Create("", 4, 4, bands, kind)
            if transform:
                source.SetGeoTransform(transform)
            if epsg:
                system = osr.SpatialReference()
                system.ImportFromEPSG(epsg)
                source.SetProjection(system.ExportToWkt())
            source.GetRasterBand(1).SetUnitType(unit)
            with self.assertRaisesRegex(RuntimeError, sentence):
                driver.CreateCopy(self.path(name), source, options=list(options))
            self.assertFalse(os.path.exists(self.path(name)))

        refused("choose one with -b", bands=2)
        for scale, offset in ((2, 0), (1, 5)):
            scaled = memory.Create("", 4, 4, 1, gdal.GDT_Float64)
            scaled.SetGeoTransform(TRANSFORM)
            scaled.GetRasterBand(1).SetScale(scale)
            scaled.GetRasterBand(1).SetOffset(offset)
            with self.assertRaisesRegex(RuntimeError, "scale or an offset: apply them with -unscale"):
                driver.CreateCopy(self.path("refused.mtin"), scaled)
        refused("has no position: add it with -a_ullr", transform=None)
        for transform in ((0, 1, 0.5, 0, 0, -1), (0, 1, 0, 0, 0.5, -1), (9, -1, 0, 0, 0, -1)):
            refused("rows do not run from west to east: .* gdalwarp", transform=transform)
        refused("complex numbers: take their real parts with -ot Float64", kind=gdal.GDT_CFloat32)
        refused("TILE_VERTICES is an option of packs", options=["TILE_VERTICES=50"])
        refused("TILE_VERTICES: use 16 to 16777216", options=["TILE_VERTICES=15"], name="refused.mtp")
        for most in ("99999999999", "100abc", "-1", ""):
            refused(f"TILE_VERTICES: '{most}' is not allowed; use a whole number", options=[f"TILE_VERTICES={most}"], name="refused.mtp")
        refused("EFFORT: 'some' is not allowed; use fast, normal or best", options=["EFFORT=some"])
        signed = memory.Create("", 4, 4, 1, gdal.GDT_Byte)
        signed.SetGeoTransform(TRANSFORM)
        signed.GetRasterBand(1).SetMetadataItem("PIXELTYPE", "SIGNEDBYTE", "IMAGE_STRUCTURE")
        with self.assertRaisesRegex(RuntimeError, "signed bytes, which GDAL reads as unsigned"):
            driver.CreateCopy(self.path("refused.mtin"), signed)
        refused("MAX_ERROR: 'much' is not allowed", options=["MAX_ERROR=much"])
        refused("heights", epsg=4326)
        refused('the unit of heights is "furlong", which is not known', unit="furlong")
        refused("UNITS: 'furlong' is not allowed", options=["UNITS=furlong"])
        refused("name a stream .mtin or a pack .mtp", name="refused.tif")

    def test_feet(self):
        source = gdal.GetDriverByName("MEM").Create("", 9, 9, 1, gdal.GDT_Int16)
        source.SetGeoTransform((7, 0.001, 0, 43, 0, -0.001))
        system = osr.SpatialReference()
        system.ImportFromEPSG(4326)
        source.SetProjection(system.ExportToWkt())
        for unit in ("ft", "feet", "foot"):
            source.GetRasterBand(1).SetUnitType(unit)
            copy = gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/feet.mtin", source)
            self.assertEqual(copy.GetRasterBand(1).GetUnitType(), "ft")
            self.assertEqual(copy.GetGeoTransform(), (7, 0.001, 0, 43, 0, -0.001))

    def depths(self, codes, unit=""):
        source = gdal.GetDriverByName("MEM").Create("", 9, 9, 1, gdal.GDT_Int16)
        source.SetGeoTransform(TRANSFORM)
        system = osr.SpatialReference()
        system.SetFromUserInput(codes)
        source.SetProjection(system.ExportToWkt())
        source.GetRasterBand(1).WriteArray(numpy.arange(81).reshape(9, 9))
        source.GetRasterBand(1).SetUnitType(unit)
        return source

    def test_units_of_bands_are_converted(self):
        driver, told = gdal.GetDriverByName("MTIN"), []
        gdal.PushErrorHandler(lambda _kind, _number, text: told.append(text))
        try:
            copy = driver.CreateCopy("/vsimem/cm.mtin", self.depths("EPSG:32633", "cm"))
            raw = driver.CreateCopy("/vsimem/m.mtin", self.depths("EPSG:32633", "cm"), options=["UNITS=:metre"])
        finally:
            gdal.PopErrorHandler()
        band = copy.GetRasterBand(1)
        self.assertEqual((band.GetUnitType(), band.ReadAsArray()[8, 8]), ("m", 0.8))
        self.assertEqual(raw.GetRasterBand(1).ReadAsArray()[8, 8], 80)
        self.assertEqual(
            [text.split(": ", 2)[2] for text in told],
            ["heights in the unit centimetre are converted to metre: times 0.01",
             "heights are taken as metre; the file says centimetre"],
        )

    def test_depths(self):
        driver = gdal.GetDriverByName("MTIN")
        for codes in ("EPSG:32633+5715", "EPSG:32633+5861"):
            with self.assertRaisesRegex(RuntimeError, "heights are depths .*: negate them with DEPTHS"):
                driver.CreateCopy("/vsimem/depth.mtin", self.depths(codes))
            with gdal.quiet_errors() if hasattr(gdal, "quiet_errors") else tempfile.TemporaryDirectory():
                copy = driver.CreateCopy("/vsimem/depth.mtin", self.depths(codes), options=["DEPTHS=YES"])
            self.assertEqual(copy.GetRasterBand(1).ReadAsArray()[8, 8], -80)
            self.assertEqual("MSL height" in copy.GetProjection(), codes.endswith("5715"))
            self.assertNotIn("DOWN", copy.GetProjection())

    def test_guesses_are_told(self):
        source = gdal.GetDriverByName("MEM").Create("", 9, 9, 1, gdal.GDT_Int16)
        source.SetGeoTransform(TRANSFORM)
        system = osr.SpatialReference()
        system.ImportFromEPSG(2227)
        source.SetProjection(system.ExportToWkt())
        told = []
        gdal.PushErrorHandler(lambda _kind, _number, text: told.append(text))
        try:
            for options, unit in (([], "us-ft"), (["UNITS=:metre"], "m")):
                copy = gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/guess.mtin", source, options=options)
                self.assertEqual(copy.GetRasterBand(1).GetUnitType(), unit)
        finally:
            gdal.PopErrorHandler()
        self.assertEqual(
            told,
            ["MTIN: /vsimem/guess.mtin: heights are taken as US survey foot, as x and y are; if they are not, set units, such as :metre"],
        )

    def test_undeclared_voids_are_told(self):
        source = gdal.GetDriverByName("MEM").Create("", 9, 9, 1, gdal.GDT_Float32)
        source.SetGeoTransform(TRANSFORM)
        source.GetRasterBand(1).WriteRaster(3, 3, 2, 1, b"\x00\x3c\x1c\xc6" * 2)
        told = []
        gdal.PushErrorHandler(lambda _kind, _number, text: told.append(text))
        try:
            gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/fill.mtin", source, options=["UNITS=metre:metre"])
        finally:
            gdal.PopErrorHandler()
        self.assertEqual(len(told), 1)
        self.assertIn("taken as they are: 2 posts of height -9999, far from all others", told[0])
        self.assertIn("gdal_translate -a_nodata -9999", told[0])
        source.GetRasterBand(1).WriteRaster(3, 3, 1, 1, b"\xff\xff\x7f\xff")
        with self.assertRaisesRegex(RuntimeError, "row 3, column 3: -3.402.* -a_nodata -3.4028234663852886e.38"):
            gdal.GetDriverByName("MTIN").CreateCopy("/vsimem/fill.mtin", source)

    def test_shards_are_told(self):
        gdal.Translate(self.path("source.asc"), self.path("hills.tif"), format="AAIGrid")
        run(TOOL, "encode", self.path("source.asc"), "--tile-vertices", "9999", "--shard", "0:0", "-o", self.path("a.shard"))
        with self.assertRaisesRegex(RuntimeError, "a.shard: is a shard, a part of a pack"):
            gdal.Open(self.path("a.shard"))


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


if __name__ == "__main__":
    del sys.argv[1:]
    unittest.main()
