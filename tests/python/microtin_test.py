# SPDX-License-Identifier: MIT
"""The package, on arrays made here. Skipped (77) without numpy."""

import doctest
import inspect
import os
import pathlib
import pickle
import shlex
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
import zlib

try:
    import numpy
except ImportError:
    print("skipped: numpy is not installed")
    sys.exit(77)

import microtin

ROWS, COLUMNS = 60, 80
ROW, COLUMN = numpy.mgrid[0:ROWS, 0:COLUMNS]
ROUNDING = 1e-9  # of differences of binary numbers
TRANSFORM = (399995.0, 10.0, 0.0, 5600005.0, 0.0, -10.0)


def hills():
    """Not the same when mirrored; decimetres."""
    return numpy.round(40 * numpy.sin(COLUMN / 9) * numpy.cos(ROW / 13) + ROW + COLUMN / 4, 1)


class Streams(unittest.TestCase):
    def test_every_height_within_the_bound_in_its_place(self):
        data = microtin.encode(hills(), max_error=0.5, transform=TRANSFORM, crs=25832)
        tin = microtin.decode(data)
        array, transform = tin.raster()
        self.assertLessEqual(numpy.abs(array - hills()).max(), 0.5 + ROUNDING)
        self.assertEqual(transform, TRANSFORM)
        self.assertEqual((tin.crs, tin.units, tin.bound), (25832, ("metre", "metre"), 0.5))
        self.assertLessEqual(data.report.max_error, 0.5)
        self.assertEqual((data.report.bytes, data.report.vertices), (len(data), len(tin.vertices)))
        errors = array - hills()
        self.assertAlmostEqual(data.report.mean_error, errors.mean(), 6)
        self.assertAlmostEqual(data.report.rms_error, numpy.sqrt((errors**2).mean()), 6)
        self.assertAlmostEqual(data.report.max_below, -errors.min(), 6)
        self.assertAlmostEqual(data.report.max_above, errors.max(), 6)

    def test_without_a_bound_all_heights_are_exact(self):
        for kind in (numpy.float64, numpy.float32, numpy.int16, numpy.uint8):
            heights = hills().astype(kind) if kind is not numpy.uint8 else (ROW + COLUMN).astype(kind)
            array, _ = microtin.decode(microtin.encode(heights)).raster()
            numpy.testing.assert_array_equal(array.astype(kind), heights)

    def test_voids(self):
        void = (ROW < 7) & (COLUMN > 70)
        expected = numpy.where(void, numpy.nan, hills())
        for array, nodata in (
            (expected, None),
            (numpy.where(void, -9999, hills()), -9999),
            (numpy.where(void, -9999.99, hills()).astype(numpy.float32), -9999.99),
            (numpy.where(void, -9999.99, hills()).astype(numpy.float32).astype(numpy.float64), -9999.99),
            (numpy.where(void, numpy.finfo(numpy.float32).min, hills()).astype(numpy.float32), -3.4e38),
            (numpy.ma.masked_array(hills(), void), None),
        ):
            back, _ = microtin.decode(microtin.encode(array, max_error=1, nodata=nodata)).raster()
            numpy.testing.assert_array_equal(numpy.isnan(back), void)
            self.assertLessEqual(numpy.nanmax(numpy.abs(back - expected)), 1 + ROUNDING)

    def test_voids_of_whole_numbers_beyond_those_of_heights(self):
        heights = numpy.arange(12, dtype=numpy.int64).reshape(3, 4)
        heights[1, 2] = -(2**63)
        back, _ = microtin.decode(microtin.encode(heights, nodata=-(2**63))).raster()
        numpy.testing.assert_array_equal(numpy.isnan(back), heights < 0)
        with self.assertRaisesRegex(microtin.Error, "beyond 2.53"):
            microtin.encode(heights, nodata=-9999)

    def test_whole_numbers_are_compared_as_such(self):
        heights = numpy.arange(12, dtype=numpy.int64).reshape(3, 4)
        heights[1, 2] = 2**53 + 1
        for marked in ({"nodata": 2**53 + 1}, {"nodata": numpy.int64(2**53 + 1)}):
            back, _ = microtin.decode(microtin.encode(heights, **marked)).raster()
            numpy.testing.assert_array_equal(numpy.isnan(back), heights > 99)
        masked = numpy.ma.masked_greater(heights, 99)
        back, _ = microtin.decode(microtin.encode(masked)).raster()
        numpy.testing.assert_array_equal(numpy.isnan(back), heights > 99)
        for nodata in (None, 2**53, float(2**53)):
            with self.assertRaisesRegex(microtin.Error, "beyond 2.53"):
                microtin.encode(heights, nodata=nodata)

    def test_the_order_of_bytes_makes_no_difference(self):
        heights = hills()
        heights[3, 4] = -9999.99
        for number in ("f4", "f8"):
            made = {bytes(microtin.encode(heights.astype(order + number), nodata=-9999.99)) for order in "<>"}
            self.assertEqual(len(made), 1)

    def test_floats_of_32_bits_stand_for_their_decimals(self):
        narrow = numpy.array(TRANSFORM, numpy.float32) / 10
        expected = microtin.encode(hills(), 0.1, transform=[float(str(number)) for number in narrow])
        found = microtin.encode(hills(), numpy.float32(0.1), transform=narrow)
        self.assertEqual(bytes(found), bytes(expected))
        points = numpy.column_stack((COLUMN.ravel() / 10, ROW.ravel() / 10, hills().ravel()))[::7]
        self.assertEqual(
            bytes(microtin.encode_points(points.astype(numpy.float32))), bytes(microtin.encode_points(points))
        )

    def test_heights_are_those_of_the_triangles(self):
        tin = microtin.decode(microtin.encode(hills(), max_error=2))
        x, y, z = tin.vertices.T
        numpy.testing.assert_allclose(tin.height_at(x, y), z, atol=1e-9)
        middle = tin.vertices[tin.triangles].mean(axis=1)
        # a place is rounded to 1/256 of a post, the plane at most some 60 decimetres a post steep
        numpy.testing.assert_allclose(tin.height_at(middle[:, 0], middle[:, 1]), middle[:, 2], atol=0.2)
        a, b, c = (tin.vertices[tin.triangles[:, i], :2] for i in range(3))
        doubled = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        self.assertGreater(doubled.min(), 0)
        self.assertEqual(doubled.sum(), 2 * (ROWS - 1) * (COLUMNS - 1))

    def test_shapes_of_places(self):
        tin = microtin.decode(microtin.encode(hills()))
        self.assertIsInstance(tin.height_at(3, 4), float)
        self.assertAlmostEqual(tin.height_at(3, 4), hills()[ROWS - 5, 3])
        self.assertEqual(tin.height_at([[1], [2]], [3, 4, 5]).shape, (2, 3))
        self.assertTrue(numpy.isnan(tin.height_at(-1, 0)))
        masked = numpy.ma.array([1, 2, 3], mask=[False, True, False])
        self.assertEqual(numpy.isnan(tin.height_at(masked, 4)).tolist(), [False, True, False])
        self.assertEqual(numpy.isnan(tin.gradient_at(4, masked)[0]).tolist(), [False, True, False])
        with self.assertRaisesRegex(microtin.Error, "not a number"):
            tin.profile(numpy.ma.array([1, 2], mask=[True, False]), (3, 4))
        self.assertEqual(tin.height_at([], []).shape, (0,))

    def test_cells(self):
        tin = microtin.decode(microtin.encode(hills()))
        array, transform = tin.raster(cell=0.5)
        self.assertEqual(array.shape, (2 * ROWS - 1, 2 * COLUMNS - 1))
        self.assertEqual(transform[:3], (-0.25, 0.5, 0.0))
        numpy.testing.assert_array_almost_equal(array[::2, ::2], hills())

    def test_points(self):
        random = numpy.random.default_rng(4)
        points = numpy.round(random.random((500, 3)) * (300, 200, 20), 2)
        tin = microtin.decode(microtin.encode_points(points))
        self.assertEqual(sorted(map(tuple, tin.vertices.round(2))), sorted(map(tuple, points)))
        with self.assertRaisesRegex(microtin.Error, "give the size of a cell"):
            tin.raster()
        with self.assertRaisesRegex(microtin.Error, "the raster takes 4.[0-9] GB: give a larger cell, or force=True"):
            tin.raster(cell=0.01)

    def test_south_up(self):
        south = (-0.5, 1, 0, -0.5, 0, 1)
        array, _ = microtin.decode(microtin.encode(hills()[::-1], transform=south)).raster()
        numpy.testing.assert_array_almost_equal(array, hills())


class Options(unittest.TestCase):
    """Each keyword of `_options` makes other bytes, and those of the command line if MICROTIN_TOOL names it."""

    BOUND = {"max_error": 2}
    # Keyword: what is given with it, the same on the command line, and values with their flags.
    ROWS = {
        "max_error": ({}, "", {1: "--max-error 1"}),
        "z_step": (BOUND, "--max-error 2", {0.7: "--z-step 0.7"}),
        "xy_step": (BOUND, "--max-error 2", {0.5: "--xy-step 0.5"}),
        "never_below": (BOUND, "--max-error 2", {True: "--never-below"}),
        "effort": (BOUND, "--max-error 2", {"fast": "--fast", "best": "--best"}),
        "max_degree": (BOUND, "--max-error 2", {6: "--max-degree 6"}),
        "coding": (BOUND, "--max-error 2", {"quick": "--coding quick", "dense": "--coding dense"}),
        "bound_at": (BOUND, "--max-error 2", {"lattice": "--bound-at lattice"}),
        "duplicates": (BOUND, "--max-error 2", {name: f"--duplicates {name}" for name in ("lowest", "highest", "mean")}),
        "depths": (BOUND, "--max-error 2", {True: "--depths"}),
        "units": (BOUND, "--max-error 2", {"foot": "--units foot"}),
        "crs": (BOUND, "--max-error 2", {25832: "--epsg 25832"}),
        "vertical_epsg": (dict(BOUND, crs=25832), "--max-error 2", {7837: "--epsg 25832:7837"}),
        "surface": (
            BOUND,
            "--max-error 2",
            {name: f"--surface {name}" for name in ("ground", "top", "bed", "geoid", "obstacles")},
        ),
        "source_name": (BOUND, "--max-error 2", {"survey": "--source-name survey"}),
        "date": (BOUND, "--max-error 2", {"2026": "--date 2026"}),
        "lineage": (BOUND, "--max-error 2", {"thinned": "--lineage thinned"}),
        "attribution": (BOUND, "--max-error 2", {"survey": "--attribution survey"}),
        "license": (BOUND, "--max-error 2", {"CC-BY-4.0": "--license CC-BY-4.0"}),
        "valid": (BOUND, "--max-error 2", {"2024-01/..": "--valid 2024-01/.."}),
        "epoch": (BOUND, "--max-error 2", {2020.5: "--epoch 2020.5"}),
        "digest": (BOUND, "--max-error 2", {True: "--digest"}),
        "phases": (BOUND, "--max-error 2", {True: "--phases"}),
        "source_accuracy": (BOUND, "--max-error 2", {"LE90 4": "--source-accuracy 'LE90 4'"}),
        "max_vertices": ({"effort": "fast"}, "--fast", {60: "--max-vertices 60"}),
        "max_bytes": ({"effort": "fast"}, "--fast", {900: "--max-bytes 900"}),
    }
    OF_PACKS = {"tile_vertices", "tile_size"}
    FILES = {"area", "route", "route_width", "route_edge_error", "breaklines", "obstacles"}
    ELSEWHERE = {"progress", "numbers", "error_map"} | FILES

    def points(self):
        """Of three decimals that 16 bits do not hold, some at the same place."""
        i = numpy.arange(300)
        points = numpy.stack([i % 20 * 10 + i * 7919 % 4993 / 1000, i // 20 * 10 + i % 8 / 1000, i * i % 13], axis=1)
        twins = points[20:24] + (0, 0, 1.5)
        return numpy.concatenate([points, twins, twins - (0, 0, 0.5)]).round(3)

    def by_tool(self, flags):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "points.xyz")
            numpy.savetxt(path, self.points(), fmt="%.3f")
            output = os.path.join(folder, "points.mtin")
            command = [os.environ["MICROTIN_TOOL"], "encode", path, "-o", output, *shlex.split(flags)]
            subprocess.run(command, check=True, capture_output=True)
            with open(output, "rb") as file:
                return file.read()

    def test_each_keyword_makes_the_difference_that_the_command_line_makes(self):
        for keyword, (beside, words, values) in self.ROWS.items():
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                without = bytes(microtin.encode_points(self.points(), **beside))
                for value, flags in values.items():
                    with self.subTest(f"{keyword}={value}"):
                        stream = bytes(microtin.encode_points(self.points(), **dict(beside, **{keyword: value})))
                        self.assertNotEqual(stream, without)
                        if "MICROTIN_TOOL" in os.environ:
                            self.assertEqual(stream, self.by_tool(f"{words} {flags}"))

    def test_an_array_of_bounds_is_kept(self):
        heights = hills()
        bounds = numpy.where(numpy.arange(COLUMNS) < COLUMNS // 2, 0.5, 6) + numpy.zeros(heights.shape)
        bounds[0, 0] = numpy.nan  # free
        stream = microtin.encode(heights, error_map=bounds)
        array, _ = microtin.decode(stream).raster()
        self.assertTrue((abs(array - heights) <= bounds + 1e-9)[~numpy.isnan(bounds)].all())
        self.assertGreater(numpy.nanmax(abs(array - heights)), 1)
        self.assertEqual((stream.report.least_bound, stream.report.largest_bound), (0.5, 6))
        self.assertLessEqual(microtin.decode(stream).max_bound_ratio, 1)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.mtp")
            report = microtin.encode_pack(heights, path, error_map=bounds, tile_vertices=60)
            self.assertEqual(report.largest_bound, 6)
            polygon = os.path.join(folder, "a.geojson")
            with open(polygon, "w") as file:
                file.write('{"type": "Feature", "properties": {"max_error": 0.25}, "geometry": {"type": "Polygon", "coordinates":'
                           ' [[[0, 0], [9, 0], [9, 9], [0, 0]]]}}')
            self.assertEqual(microtin.encode(heights, 4, error_map=polygon).report.least_bound, 0.25)
        with self.assertRaisesRegex(microtin.Error, "shape"):
            microtin.encode(heights, error_map=bounds[1:])
        with self.assertRaisesRegex(microtin.Error, "points take the path"):
            microtin.encode_points(self.points(), error_map=bounds)

    def test_files_shape_the_terrain(self):
        heights = hills()
        with tempfile.TemporaryDirectory() as folder:

            def feature(kind, coordinates, properties="{}"):
                path = os.path.join(folder, kind + ".geojson")
                with open(path, "w") as file:
                    file.write(f'{{"type": "Feature", "properties": {properties}, "geometry": ')
                    file.write(f'{{"type": "{kind}", "coordinates": {coordinates}}}}}')
                return path

            square = feature("Polygon", "[[[2, 2], [20, 2], [20, 20], [2, 20], [2, 2]]]")
            line = feature("LineString", "[[3, 3], [15, 12]]")
            tower = feature("Point", "[10, 10]", '{"height": 50}')
            inside, _ = microtin.decode(microtin.encode(heights, 2, area=square)).raster()
            self.assertEqual((~numpy.isnan(inside)).sum(), 19 * 19)
            near, _ = microtin.decode(microtin.encode(heights, 2, route=line, route_width=4)).raster()
            self.assertTrue(0 < (~numpy.isnan(near)).sum() < 19 * 19)
            loose = microtin.encode(heights, 2, route=line, route_width=12, route_edge_error=9)
            self.assertEqual((loose.report.least_bound, loose.report.largest_bound), (2, 9))
            plain = microtin.encode(heights, 2)
            self.assertNotEqual(bytes(microtin.encode(heights, 2, breaklines=line)), bytes(plain))
            raised = microtin.decode(microtin.encode(heights, 2, obstacles=tower))
            self.assertGreaterEqual(raised.height_at([10], [10])[0], microtin.decode(plain).height_at([10], [10])[0] + 45)
            with self.assertRaisesRegex(microtin.Error, "route and route_width go together"):
                microtin.encode(heights, 2, route=line)
            with self.assertRaisesRegex(microtin.Error, "route_edge_error needs route"):
                microtin.encode(heights, 2, route_edge_error=9)
            with self.assertRaisesRegex(microtin.Error, "obstacles needs max_error"):
                microtin.encode(heights, obstacles=tower)
            path = os.path.join(folder, "a.mtp")
            microtin.encode_pack(heights, path, 2, tile_size=16)
            with open(path, "rb") as file:
                plain = file.read()
            microtin.encode_pack(heights, path, 2, tile_size=16, breaklines=line)
            with open(path, "rb") as file:
                self.assertNotEqual(file.read(), plain)
            microtin.encode_pack(heights, path, 2, obstacles=tower)
            self.assertGreaterEqual(microtin.decode(path).height_at([10], [10])[0], heights[-11, 10] + 50)

    def test_each_keyword_of_packs_makes_a_difference(self):
        with tempfile.TemporaryDirectory() as folder:
            def pack(**options):
                path = os.path.join(folder, "pack.mtp")
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    microtin.encode_pack(hills(), path, max_error=2, **options)
                with open(path, "rb") as file:
                    return file.read()

            self.assertNotEqual(pack(tile_vertices=60), pack(tile_vertices=300))
            self.assertNotEqual(pack(tile_vertices=60), pack(tile_vertices=60, tile_size=9))

    def test_notes_are_read_back(self):
        notes = {
            "attribution": "\u00a9 a survey",
            "license": "CC-BY-4.0",
            "valid": "2024-01/..",
            "epoch": 2020.5,
            "source_accuracy": "LE90 4",
            "date": "2026",
            "lineage": "thinned",
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            noted = microtin.decode(microtin.encode_points(self.points(), max_error=2, **notes))
            bare = microtin.decode(microtin.encode_points(self.points(), max_error=2))
            stream = microtin.encode_points(self.points(), max_error=2, digest=True, phases=True)
        self.assertEqual({name: getattr(noted, name) for name in notes}, notes)
        none = {name: None if name == "epoch" else "" for name in notes}
        self.assertEqual({name: getattr(bare, name) for name in notes}, none)
        measured = microtin.decode(stream)
        self.assertRegex(measured.digest, "^[0-9a-f]{16}$")
        self.assertEqual(measured.phases[-1], (stream.report.vertices, len(stream), stream.report.max_error))
        self.assertEqual((bare.digest, bare.phases), ("", []))
        with self.assertRaisesRegex(microtin.Error, "epoch: '20' is not allowed"):
            microtin.encode_points(self.points(), max_error=2, epoch=20)

    def test_no_keyword_is_without_a_row(self):
        known = set(self.ROWS) | self.OF_PACKS
        numbers = {"max_degree", "vertical_epsg", "max_vertices", "max_bytes", "tile_vertices", "tile_size"}
        keywords = set(inspect.signature(microtin._options.options_of).parameters) | numbers
        self.assertEqual(keywords - self.ELSEWHERE, known)
        in_c = {name for name, _ in microtin._library.Options._fields_}
        self.assertEqual(in_c - {"size", "progress", "context"} | {"crs"}, known | {"horizontal_epsg", "error_map"} | self.FILES)


class Packs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "hills.mtp")
        self.report = microtin.encode_pack(
            hills(), self.path, max_error=0.5, tile_vertices=200, tile_size=20, transform=TRANSFORM
        )

    def tearDown(self):
        self.folder.cleanup()

    def test_by_tile_and_as_a_whole(self):
        tin = microtin.decode(self.path)
        self.assertTrue(tin.is_pack)
        self.assertEqual(tin.tiles, (4, 3))
        self.assertEqual(self.report.tiles, 12)
        tiles = [tin.tile(column, row) for row in range(3) for column in range(4)]
        self.assertEqual(sum(len(tile.triangles) for tile in tiles), len(tin.triangles))
        self.assertEqual(sum(len(tile.vertices) for tile in tiles), self.report.vertices)
        self.assertLess(len(tin.vertices), self.report.vertices)
        array, transform = tin.raster()
        self.assertLessEqual(numpy.abs(array - hills()).max(), 0.5 + ROUNDING)
        self.assertEqual(transform, TRANSFORM)
        columns, rows = tin.tiles
        for column, row in ((columns, 0), (0, rows), (-1, 0), (0, -1)):
            with self.assertRaises(IndexError):
                tin.tile(column, row)
            with self.assertRaises(IndexError):
                tin.tile_margins(column, row)
        margins = [tin.tile_margins(column, row) for row in range(rows) for column in range(columns)]
        self.assertEqual(max(below for below, _ in margins), tin.max_below_everywhere)
        self.assertEqual(max(above for _, above in margins), tin.max_above_everywhere)
        self.assertGreater(len(set(margins)), 1)

    def test_a_pack_has_no_lines(self):
        self.assertEqual(microtin.decode(self.path).lines(), [])

    def test_lines_of_a_stream(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "lines.csv")
            with open(path, "w") as file:
                file.write("x,y,class\n3,4,ridge\n70,50,ridge\n\n5,50,\n40,44,\n\n")
            tin = microtin.decode(microtin.encode(hills(), 0.5, breaklines=path))
        self.assertEqual(microtin.decode(microtin.encode(hills(), 0.5)).lines(), [])
        lines = dict(tin.lines())
        self.assertEqual(sorted(lines), ["other", "ridge"])
        for kind, ends in (("ridge", {(3, 4), (70, 50)}), ("other", {(5, 50), (40, 44)})):
            vertices = lines[kind]
            self.assertEqual({tuple(vertices[0, :2]), tuple(vertices[-1, :2])}, ends)
            numpy.testing.assert_allclose(tin.height_at(vertices[:, 0], vertices[:, 1]), vertices[:, 2])
            self.assertTrue((vertices[:, None] == tin.vertices).all(axis=2).any(axis=1).all())

    def test_threads_share_a_terrain(self):
        tin = microtin.decode(self.path)
        expected, _ = tin.raster()
        x, y = TRANSFORM[0] + 5 + 10 * COLUMN, TRANSFORM[3] - 5 - 10 * ROW
        found = [None] * 4

        def ask(i):
            found[i] = tin.height_at(x, y)

        threads = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for heights in found:
            numpy.testing.assert_array_equal(heights, expected)

    def test_damaged_tiles_are_told(self):
        with open(self.path, "rb") as file:
            data = bytearray(file.read())
        data[-3] ^= 1
        tin = microtin.decode(data)
        with self.assertRaisesRegex(microtin.Error, "bytes: tile 11: damaged"):
            tin.raster()
        self.assertGreater(len(tin.tile(0, 0).vertices), 0)


class Files(unittest.TestCase):
    """Files in place of arrays, as the command line reads them, and packs in shards."""

    OPTIONS = {"max_error": 2, "units": "metre", "tile_vertices": 60}

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.cells = self.path("cells")
        os.mkdir(self.cells)
        for name, west, east in (("w", 0, 41), ("e", 40, COLUMNS)):
            head = f"ncols {east - west}\nnrows {ROWS}\nxllcenter {west}\nyllcenter 0\ncellsize 1"
            numpy.savetxt(self.path(f"cells/{name}.asc"), hills()[:, west:east], fmt="%.1f", header=head, comments="")

    def path(self, name):
        return os.path.join(self.folder, name)

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_files_and_folders_are_one_terrain(self):
        two = [self.path("cells/w.asc"), pathlib.Path(self.cells) / "e.asc"]
        for files in (self.cells, [self.cells], two):
            array, _ = microtin.decode(microtin.encode(files, 0.5, units="metre")).raster()
            self.assertLessEqual(numpy.abs(array - hills()).max(), 0.5 + ROUNDING)
        report = microtin.encode_pack(self.cells, self.path("t.mtp"), **self.OPTIONS)
        self.assertEqual(report.samples, ROWS * COLUMNS)
        if "MICROTIN_TOOL" in os.environ:
            command = f"encode {self.cells} --units metre --max-error 2 --tile-vertices 60 -o {self.path('tool.mtp')}"
            subprocess.run([os.environ["MICROTIN_TOOL"], *shlex.split(command)], check=True, capture_output=True)
            self.assertEqual(self.bytes_of("t.mtp"), self.bytes_of("tool.mtp"))

    def test_points_in_files(self):
        numpy.savetxt(self.path("points.xyz"), [[0, 0, 1], [9, 0, 2], [0, 9, 3], [9, 9, 4]], fmt="%d")
        self.assertEqual(microtin.encode(self.path("points.xyz")).report.vertices, 4)

    def test_shards_join_to_the_bytes_of_a_single_run(self):
        microtin.encode_pack(self.cells, self.path("one.mtp"), **self.OPTIONS)
        shards = pickle.loads(pickle.dumps(microtin.plan_shards([self.cells], 4, **self.OPTIONS)))
        self.assertEqual(len(shards), 4)
        parts = [self.path(f"{shard.first_tile}.shard") for shard in shards]
        for shard, part in zip(shards, parts):
            microtin.encode_shard([self.cells], shard, part, **self.OPTIONS)
        report = microtin.merge_packs(parts[::-1], self.path("merged.mtp"))
        self.assertEqual(self.bytes_of("merged.mtp"), self.bytes_of("one.mtp"))
        self.assertEqual(report.bytes, len(self.bytes_of("one.mtp")))
        with self.assertRaisesRegex(microtin.Error, "tile 0 is in no shard"):
            microtin.merge_packs(parts[1:], self.path("merged.mtp"))

    def test_what_files_do_not_take_is_refused(self):
        with self.assertRaisesRegex(microtin.Error, "files state their own transform"):
            microtin.encode(self.cells, transform=TRANSFORM)
        with self.assertRaisesRegex(microtin.Error, "files state their own transform"):
            microtin.encode(self.cells, crs='LOCAL_CS["somewhere"]')
        with self.assertRaisesRegex(microtin.Error, "files take the path of a map"):
            microtin.encode(self.cells, error_map=hills())
        with self.assertRaisesRegex(microtin.Error, "nosuch.asc"):
            microtin.encode([self.path("nosuch.asc")])
        with self.assertRaisesRegex(microtin.Error, "use a str for a path"):
            microtin.encode(b"n.asc", 5)
        with self.assertRaisesRegex(microtin.Error, "files are a path, or a list of paths"):
            microtin.plan_shards(hills(), 2)
        with self.assertRaisesRegex(microtin.Error, "count: 0 is out of range"):
            microtin.plan_shards(self.cells, 0)


class Profiles(unittest.TestCase):
    """Of a ridge of 50 m at x = 500, which is 20 m wide, and 1000 m of plain."""

    def setUp(self):
        ridge = [(x, y, 50 * (x == 500)) for x in (0, 490, 500, 510, 1000) for y in (0, 100)]
        self.tin = microtin.decode(microtin.encode_points(ridge, 0.01, units="metre"))

    def test_places(self):
        profile = self.tin.profile((0, 0), (1000, 0))
        self.assertEqual(profile.length, 1000)
        self.assertIsNone(profile.missing)
        numpy.testing.assert_allclose(profile.distance, [0, 490, 500, 510, 1000], atol=1e-5)
        self.assertEqual(list(profile.height), [0, 0, 50, 0, 0])
        self.assertEqual(list(profile.known_before), [False, True, True, True, True])
        self.assertTrue(numpy.isnan(profile.geodesic_deviation))
        numpy.testing.assert_allclose(profile.heights(201), self.tin.height_at(numpy.linspace(0, 1000, 201), 0), atol=1e-4)
        beyond = self.tin.profile((500, 50), (1500, 50))
        self.assertEqual(beyond.missing, "outside")
        self.assertEqual(list(numpy.isnan(beyond.heights(5))), [False, False, False, True, True])

    def test_slopes(self):
        xs = numpy.array([[200.0, 495.0], [505.0, -1.0]])
        east, north = self.tin.gradient_at(xs, 50)
        numpy.testing.assert_allclose(east, [[0, 5], [-5, numpy.nan]], atol=1e-12)
        numpy.testing.assert_allclose(north, [[0, 0], [0, numpy.nan]], atol=1e-12)
        steep = numpy.degrees(numpy.arctan(5))
        numpy.testing.assert_allclose(self.tin.slope_at(xs, 50), [[0, steep], [steep, numpy.nan]])
        numpy.testing.assert_allclose(self.tin.aspect_at(xs, 50), [[numpy.nan, 270], [90, numpy.nan]])
        self.assertEqual(self.tin.gradient_at(200, 50), (0.0, 0.0))
        self.assertIsInstance(self.tin.slope_at(495, 50), float)
        self.assertIsInstance(self.tin.aspect_at(495, 50), float)
        plane = microtin.decode(microtin.encode_points([(0, 0, 0), (10, 0, 0), (0, 10, 10), (10, 10, 10)], 0.01, units="metre"))
        self.assertEqual(plane.aspect_at(4, 3), 180)
        turned = microtin.decode(microtin.encode_points([(0, 0, 9), (9, 0, 9), (0, 9, 0), (9, 9, 0)], 0.01, units="metre"))
        self.assertEqual(turned.aspect_at(4, 3), 0)

    def test_height_bounds(self):
        found = self.tin.bounds_in_box(0, 0, 100, 50)
        self.assertEqual((found.lowest, found.highest, found.complete), (0, 50, True))
        self.assertTrue(numpy.isnan(found.source_highest))
        self.assertTrue(found.is_below(50.1))
        self.assertFalse(found.is_below(50))
        self.assertFalse(found.is_below(1000, safe=True))
        self.assertFalse(self.tin.bounds_on_line((0, 0), (1001, 0)).is_below(1000))
        self.assertTrue(self.tin.bounds_on_line((0, 0), (1000, 0)).is_below(51))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "hills.mtp")
            microtin.encode_pack(hills(), path, max_error=1, tile_vertices=100)
            pack = microtin.decode(path)
        west, south, east, north = pack.bounds
        first = pack.tile(0, 0).vertices[:, 2]
        found = pack.bounds_in_box(west, south, west + 1, south + 1)
        self.assertEqual((found.lowest, found.highest), (first.min(), first.max()))
        self.assertGreaterEqual(found.source_highest, found.highest)
        self.assertTrue(found.is_below(found.source_highest + 0.1, safe=True))
        whole = pack.bounds_on_line((west, south), (east, north))
        self.assertTrue(whole.complete)
        self.assertGreaterEqual(whole.highest, found.highest)
        with self.assertRaisesRegex(microtin.Error, "not a number"):
            pack.bounds_in_box(numpy.nan, 0, 1, 1)
        with self.assertRaisesRegex(microtin.Error, "pair of x and y"):
            pack.bounds_on_line((0, 0, 0), (1, 1))

    def test_lines_of_sight(self):
        masts = [(0, 0, 49), (0, 0, 51), (0, 0, 80)]
        found = self.tin.line_of_sight(masts, (1000, 0, 51), earth_factor=numpy.inf, frequency=868)
        self.assertEqual(list(found.line), ["clear", "clear", "clear"])
        self.assertEqual(list(found.zone), ["blocked", "blocked", "clear"])
        numpy.testing.assert_allclose(found.least_clearance, [0, 1, 15.5], atol=1e-3)
        numpy.testing.assert_allclose(found.least_clearance_at, 500, atol=1e-3)
        self.assertEqual(found.free_share.shape, (3,))
        pairs = self.tin.line_of_sight(numpy.reshape(masts, (3, 1, 3)), numpy.array([(1000, 0, 1), (1500, 0, 99)]), end_above="datum")
        self.assertEqual(pairs.line.tolist(), [["blocked", "unknown"]] * 3)
        one = self.tin.line_of_sight((0, 0, 49), (1000, 0, 49))
        self.assertEqual(one.line, "blocked")
        self.assertAlmostEqual(float(one.first_obstruction), 499.8, places=1)
        self.assertEqual(self.tin.line_of_sight(numpy.empty((0, 3)), (1, 1, 1)).line.shape, (0,))

    def test_safe(self):
        tin = microtin.decode(microtin.encode(hills(), max_error=1))
        line = (0, 0, 3), (20, 20, 3)
        self.assertLess(tin.line_of_sight(*line, safe=True).least_clearance, tin.line_of_sight(*line).least_clearance)
        with self.assertRaisesRegex(microtin.Error, "does not state how far"):
            self.tin.line_of_sight((0, 0, 1), (9, 9, 1), safe=True)

    def test_refusals(self):
        for begin in ((0, 0), 3, (0, 0, 0, 0)):
            with self.assertRaisesRegex(microtin.Error, "x, y and height|shape"):
                self.tin.line_of_sight(begin, begin)
        with self.assertRaisesRegex(microtin.Error, "pair of x and y"):
            self.tin.profile((0, 0, 0), (1, 1))
        with self.assertRaisesRegex(microtin.Error, "not a number near"):
            self.tin.profile((numpy.nan, 0), (1, 1))
        with self.assertRaisesRegex(microtin.Error, "frequency: is not a number"):
            self.tin.line_of_sight((0, 0, 1), (9, 9, 1), frequency=-1)
        with self.assertRaisesRegex(microtin.Error, "use ground or datum"):
            self.tin.line_of_sight((0, 0, 1), (9, 9, 1), end_above="sea")


class Library(unittest.TestCase):
    def test_the_installed_library_has_the_version_of_the_structs(self):
        self.assertEqual(microtin._library.MAJOR_VERSION, int(microtin.__version__.partition(".")[0]))


class Refusals(unittest.TestCase):
    def refused(self, sentence, *arguments, **options):
        with self.assertRaisesRegex(microtin.Error, sentence):
            microtin.encode(*arguments, **options)

    def test_arrays(self):
        self.refused("two dimensions, not 1", [1, 2, 3])
        self.refused("not complex128", [[1j, 2], [3, 4]])
        self.refused("row 1, column 0", [[1.0, 2.0], [float("inf"), 4.0]])
        self.refused("beyond 2\\^53", numpy.array([[0, 2**60], [0, 0]]))
        self.refused("six numbers", [[1, 2], [3, 4]], transform=(0, 1))

    def test_points(self):
        points = numpy.array([[0.0, 0, 1], [9, 0, 2], [0, 9, 3], [9, 9, 4]])
        for given, sentence in (
            (numpy.ma.masked_equal(points, 4), "masked; leave these out"),
            (points > 1, "not bool"),
            (points * 1j, "not complex128"),
            ((points * 2.0**51).astype(numpy.int64), "a coordinate is beyond 2\\^53"),
        ):
            with self.assertRaisesRegex(microtin.Error, sentence):
                microtin.encode_points(given)

    def test_empty_texts_and_zeros(self):
        array = [[1.0, 2.0], [3.0, 4.0]]
        for option in ("area", "error_map", "obstacles", "breaklines", "route"):
            self.refused("'' is not the name of a file", array, max_error=1, **{option: ""})
        self.refused("'' is not a number", array, max_error="")
        self.refused("has a character 0", array, source_name="a\0b")
        self.refused("has a character 0", array, max_error=1, area="a.geojson\0")
        with self.assertRaisesRegex(microtin.Error, "has a character 0"):
            microtin.decode("a.mtin\0")
        with self.assertRaisesRegex(microtin.Error, "is not the name of a file"):
            microtin.encode("")

    def test_options(self):
        array = [[1.0, 2.0], [3.0, 4.0]]
        self.refused("max_error: .one. is not allowed", array, max_error="one")
        self.refused("exclude each other", array, max_error=1, max_vertices=4)
        self.refused("'slow' is not allowed; use one of fast, normal, best", array, effort="slow")
        self.refused("units of x and y|unit of heights|heights", array, crs=4326)
        self.refused("'nonsense' is neither EPSG:CODE nor well-known text", array, crs="nonsense")
        with self.assertRaisesRegex(TypeError, "no option colour"):
            microtin.encode(array, colour=1)

    def test_guesses_are_told(self):
        array = [[1.0, 2.0], [3.0, 4.0]]
        with self.assertWarnsRegex(UserWarning, "heights are taken as foot, as x and y are"):
            stream = microtin.encode(array, crs='LOCAL_CS["a",UNIT["Foot",0.3048]]')
        self.assertEqual(len(stream.report.warnings), 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(microtin.encode(array, crs=25832, units=":metre").report.warnings, ())
            self.assertEqual(microtin.encode(array, crs=25832).report.warnings, ())
            self.assertEqual(len(microtin.encode(array).report.warnings), 1)  # nothing is said, so nothing is guessed

    def test_units_are_converted_and_depths_turned(self):
        array = [[100.0, 200.0], [300.0, 400.0]]
        with self.assertWarnsRegex(UserWarning, "in the unit centimetre are converted to metre: times 0.01"):
            tin = microtin.decode(microtin.encode(array, crs=25832, units=":cm"))
        self.assertEqual((tin.units, tin.height_at(0, 0)), (("metre", "metre"), 3.0))
        self.refused("heights are depths .EPSG 5715., .* negate them with depths", array, crs=25832, vertical_epsg=5715)
        for depths in ({"vertical_epsg": 5715}, {"units": ":metre"}):
            with self.assertWarnsRegex(UserWarning, "depths are turned into heights"):
                tin = microtin.decode(microtin.encode(array, crs=25832, depths=True, **depths))
            self.assertEqual(tin.height_at(0, 0), -300.0)
            self.assertEqual(tin.vertical_epsg, 5714 if "vertical_epsg" in depths else 0)
        points = [[0, 0, 1], [9, 0, 2], [0, 9, 3]]
        with self.assertWarnsRegex(UserWarning, "depths are turned into heights"):
            tin = microtin.decode(microtin.encode_points(points, units="m", depths=True))
        self.assertEqual(tin.height_at(0, 9), -3.0)

    def test_marks_of_voids_are_told_without_a_place_too(self):
        with self.assertWarnsRegex(UserWarning, "1 post of height -9999"):
            microtin.encode(numpy.where((ROW == 3) & (COLUMN == 4), -9999, hills()), max_error=1)

    def test_points_that_share_a_place(self):
        points = [[0, 0, 1], [0, 0, 9], [2, 3, 1], [4, 1, 1]]
        with self.assertRaisesRegex(microtin.Error, "max_error cannot be kept at 1 positions"):
            microtin.encode_points(points, 1)
        for rule, height in (("lowest", 1), ("highest", 9), ("mean", 5)):
            tin = microtin.decode(microtin.encode_points(points, 0.25, duplicates=rule))
            self.assertAlmostEqual(tin.height_at(0, 0), height, delta=0.25)
        with self.assertRaisesRegex(microtin.Error, "'first' is not allowed; use one of middle, lowest, highest, mean"):
            microtin.encode_points(points, 1, duplicates="first")

    def test_the_bound_may_hold_on_the_lattice_alone(self):
        walls = [(0.01 + x, y, 900 * up) for x in range(0, 9000, 1000) for y in range(0, 9000, 1000) for up in (0, 1)]
        points = [(x + 0.27 * (z > 0), y + 0.13, z) for x, y, z in walls]
        with self.assertRaisesRegex(microtin.Error, "bound_at lattice"):
            microtin.encode_points(points, 0.5)
        self.assertLessEqual(microtin.encode_points(points, 0.5, bound_at="lattice").report.max_error, 0.5)

    def test_options_of_streams_are_none_of_packs(self):
        self.refused("tile_vertices is an option of packs", hills(), tile_vertices=50)
        with self.assertRaisesRegex(microtin.Error, "max_(vertices|bytes) is an option of streams"):
            microtin.encode_pack(hills(), "none.mtp", tile_vertices=50, max_bytes=500)
        self.assertFalse(os.path.exists("none.mtp"))

    def test_systems(self):
        for wrong in (-5, 0, 1 << 32, "EPSG:25832+5783"):
            self.refused("is not the code of a horizontal system", hills(), crs=wrong)
        self.refused("crs is a code, well-known text or has to_wkt.., not float", hills(), crs=1.5)
        for code in ("EPSG:25832", "epsg:25832", numpy.int32(25832)):
            self.assertEqual(microtin.decode(microtin.encode(hills(), max_error=1, crs=code)).crs, 25832)

    def test_each_failure_of_the_library_has_its_exception(self):
        check = microtin._library._checked
        check(microtin._library.OK, None, ())
        with self.assertRaises(MemoryError):
            check(microtin._library.NO_MEMORY, None, ())
        with self.assertRaisesRegex(microtin.Error, "a fault of microtin's own: "):
            check(microtin._library.INTERNAL, None, ())

    def test_damaged_streams(self):
        data = bytearray(microtin.encode(hills(), max_error=1))
        for wrong in (b"", b"something else", data[:-1], data + b"x"):
            with self.assertRaises(microtin.Error):
                microtin.decode(bytes(wrong))
        with self.assertRaisesRegex(microtin.Error, "/nowhere/a.mtin"):
            microtin.decode("/nowhere/a.mtin")

    def test_texts_that_are_no_utf_8(self):
        with self.assertRaisesRegex(microtin.Error, "nowhere"):
            microtin.decode(os.fsdecode(b"/nowhere/\xff.mtin"))
        stream = microtin.encode(hills(), max_error=1, crs='LOCAL_CS["Stra\xdfe",UNIT["metre",1]]')
        end = next(i for i in range(len(stream)) if stream[i : i + 4] == zlib.crc32(stream[:i]).to_bytes(4, "little"))
        header = stream[:end].replace("\xdf".encode(), b"\xdf\xdf")  # as a .prj in Latin-1 has it
        forged = header + zlib.crc32(header).to_bytes(4, "little") + stream[end + 4 :]
        self.assertEqual(microtin.decode(forged).crs, 'LOCAL_CS["Stra\ufffd\ufffde",UNIT["metre",1]]')

    def test_what_progress_raises_ends_the_work(self):
        def stop(_done):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            microtin.encode(hills(), max_error=0.1, progress=stop)
        seen = []
        microtin.encode(hills(), max_error=0.1, progress=seen.append)
        self.assertEqual(seen, sorted(seen))
        self.assertLessEqual(seen[-1], 1)


def load_tests(_loader, tests, _pattern):
    tests.addTests(doctest.DocTestSuite(microtin))
    return tests


if __name__ == "__main__":
    unittest.main()
