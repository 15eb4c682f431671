# SPDX-License-Identifier: MIT
"""world.py MICROTIN FOLDER [PAGE | --check]: what the land of the Earth takes, estimated from measured terrains; writes PAGE's
table. --check compares the sizes of autopilots' grids with files that MICROTIN writes, without the terrains.

Terrains of ../shared/data are resampled to posts 100 m apart and, where the source has posts 30 m apart, to these.
MICROTIN encodes each as a pack within four bounds. Time is that of processors. What the estimate assumes:

- The shares of land are those of Meybeck, Green and Voeroesmarty, "A New Typology for Mountains and Other Relief
  Classes", Mountain Research and Development 21 (2001): of 133.0 million square kilometres that no ice covers, plains and
  lowlands have 52.4, hills, platforms and plateaus 47.3, mountains 33.3.
- A cell with sea takes, for each square kilometre, what the steep coast takes: too much for flat coasts.
- Posts 30 m apart take as many times the bytes of posts 100 m apart as in the terrains that have both.
- Low and high: each class as its smallest and largest terrain. A class with one terrain has the spread of the widest
  class. The smallest and the largest of the ratios of 30 to 100 m count too.

land.txt has the cells with land. The sizes of autopilots' grids follow from the blocks that ArduPilot and INAV read.
"""
import array
import gzip
import json
import math
import os
import subprocess
import sys
import textwrap

import land

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared/data")
BOUNDS = (5, 10, 20, 30)
SHARES = {"plain": 52.4 / 133, "hills": 47.3 / 133, "mountains": 33.3 / 133}
TERRAINS = [("osnabrueck", "plain"), ("scottish_borders", "hills"), ("jacksboro", "hills"), ("andorra", "mountains"),
            ("bigtujunga", "mountains"), ("sthelens", "mountains"), ("riviera", "coast")]
VOID = -32768
LIMITS = -56, 60  # degrees of latitude, as SRTM has them
MARK = "<!-- world: written by tests/bench/run world -->", "<!-- end of world -->"


class Terrain:
    """Rows of heights, the northernmost first, and the distance of posts in metres."""

    def __init__(self, name):
        with open(os.path.join(DATA, name + ".json"), encoding="utf-8") as text:
            facts = json.load(text)
        with gzip.open(os.path.join(DATA, name + ".hgt16.gz")) as packed:
            posts = array.array("h", packed.read())
        width = facts["width"]
        self.rows = [posts[row * width:(row + 1) * width] for row in range(facts["height"])]
        self.steps = facts.get("cell_x_m", facts["cell_m"]), facts.get("cell_y_m", facts["cell_m"])
        self.cell = facts["cell_m"]

    def resampled(self, spacing):
        """Bilinear heights in whole metres, as rows."""
        columns = int((len(self.rows[0]) - 1) * self.steps[0] / spacing) + 1
        rows = int((len(self.rows) - 1) * self.steps[1] / spacing) + 1
        for row in range(rows):
            y = min(row * spacing / self.steps[1], len(self.rows) - 1.001)
            north, south = self.rows[int(y)], self.rows[int(y) + 1]
            line = []
            for column in range(columns):
                x = min(column * spacing / self.steps[0], len(north) - 1.001)
                i = int(x)
                corners = north[i], north[i + 1], south[i], south[i + 1]
                u, v = x - i, y - int(y)
                line.append(VOID if VOID in corners else round(
                    (1 - v) * ((1 - u) * corners[0] + u * corners[1]) + v * ((1 - u) * corners[2] + u * corners[3])))
            yield line


def write_grid(path, rows, spacing):
    rows = list(rows)
    with open(path, "w", encoding="ascii") as text:
        text.write(f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner 0\nyllcorner 0\ncellsize {spacing}\n"
                   f"NODATA_value {VOID}\n")
        text.writelines(" ".join(map(str, row)) + "\n" for row in rows)
    return len(rows) * len(rows[0])


def encode(microtin, source, bound):
    """Bytes and vertices of a pack, and seconds of processors without planning, as for a shard of many tiles."""
    pack = source[:-4] + ".mtp"
    options = [source, "--units", "metre", "--max-error", str(bound), "--tile-vertices", "1000"]
    plan = subprocess.run([microtin, "plan", *options], check=True, capture_output=True, text=True).stdout
    options += plan.split(" --shard")[0].split()
    child = subprocess.Popen([microtin, "encode", *options, "-o", pack], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit("failed: " + source)
    facts = json.loads(subprocess.run([microtin, "info", "--json", pack], check=True, capture_output=True).stdout)
    return os.path.getsize(pack), facts["vertices"], usage.ru_utime + usage.ru_stime


def measure(microtin, folder):
    """[(name, kind, spacing, posts, {bound: (bytes a square kilometre, vertices, seconds)})]"""
    found = []
    for name, kind in TERRAINS:
        terrain = Terrain(name)
        for spacing in (30, 100) if terrain.cell <= 30 else (100,):
            source = os.path.join(folder, f"{name}-{spacing}.asc")
            posts = write_grid(source, terrain.resampled(spacing), spacing)
            area = posts * spacing ** 2 / 1e6
            runs = {}
            for bound in BOUNDS:
                size, vertices, seconds = encode(microtin, source, bound)
                runs[bound] = size / area, vertices, seconds
            found.append((name, kind, spacing, posts, runs))
            print_terrain(*found[-1])
    return found


def print_terrain(name, kind, spacing, posts, runs):
    cells = " | ".join("%.1f" % runs[bound][0] for bound in BOUNDS)
    slow, quick = (runs[bound][2] / posts * 1e6 for bound in (BOUNDS[0], BOUNDS[-1]))
    print(f"| {name} | {kind} | {spacing} | {posts:,} | {cells} | {quick:.1f} to {slow:.1f} |", flush=True)


def amounts(posts, vertices):
    """What time grows with: each post is read, each vertex is placed, and around a vertex lie posts that it is tried at."""
    return posts, math.sqrt(posts * vertices), vertices


def solved(rows):
    """The solution of as many linear equations, rows of coefficients and the right side."""
    for i, pivot in enumerate(rows):
        rows[i] = [value / pivot[i] for value in pivot]
        for j, row in enumerate(rows):
            if j != i:
                rows[j] = [value - row[i] * own for value, own in zip(row, rows[i])]
    return [row[-1] for row in rows]


def costs(found):
    """Seconds of processors for each of the amounts, by least squares of relative errors; their root mean square, and the
    largest factor."""
    runs = [[amount / seconds for amount in amounts(posts, vertices)]
            for _, _, _, posts, of_bounds in found for _, vertices, seconds in of_bounds.values()]
    normal = [[sum(row[i] * row[j] for row in runs) for j in range(3)] + [sum(row[i] for row in runs)] for i in range(3)]
    factors = solved(normal)
    errors = [math.log(sum(factor * value for factor, value in zip(factors, row))) for row in runs]
    return factors, math.sqrt(sum(error ** 2 for error in errors) / len(errors)), math.exp(max(map(abs, errors)))


def span(values):
    """The mean, and the least and the largest divided by it."""
    mean = sum(values) / len(values)
    return mean, min(values) / mean, max(values) / mean


class Estimate:
    """What a square kilometre of each class takes at a spacing and a bound: bytes, or vertices."""

    def __init__(self, found, spacing, bound, is_bytes):
        of_class, of_terrain = {}, {}
        for name, kind, at, posts, runs in found:
            size, vertices, _ = runs[bound]
            value = size if is_bytes else vertices / (posts * at * at / 1e6)
            of_terrain.setdefault(name, {})[at] = value
            if at == 100:
                of_class.setdefault(kind, []).append(value)
        ratios = [both[30] / both[100] for both in of_terrain.values() if len(both) == 2] if spacing == 30 else [1]
        spans = {kind: span(values) for kind, values in of_class.items()}
        least, most = min(low for _, low, _ in spans.values()), max(high for _, _, high in spans.values())
        for kind, values in of_class.items():
            if len(values) == 1:
                spans[kind] = values[0], least, most
        usual = math.exp(sum(map(math.log, ratios)) / len(ratios))
        self.usual = {kind: mean * usual for kind, (mean, _, _) in spans.items()}
        self.low = {kind: mean * low * min(ratios) for kind, (mean, low, _) in spans.items()}
        self.high = {kind: mean * high * max(ratios) for kind, (mean, _, high) in spans.items()}


def total(classes, inland, shore):
    """Of square kilometres of cells without and with sea."""
    return inland * sum(SHARES[kind] * classes[kind] for kind in SHARES) + shore * classes["coast"]


def areas(south, north):
    """The number of cells, and square kilometres of those without and with sea."""
    rows = land.table(south, north)
    shore = sum(land.cell_area(latitude) * coastal for latitude, _, coastal, _ in rows)
    whole = sum(land.cell_area(latitude) * cells for latitude, cells, _, _ in rows)
    return sum(cells for _, cells, _, _ in rows), whole - shore, shore


def grid_bytes(is_inav, latitude, spacing):
    """The size of the file of a cell: 2,048 bytes for each block of 28 x 32 posts, of which 24 x 28 are its own.

    The number of blocks is that of AutopilotLayout (encoder/export/autopilot.cpp), which the test `bench.world` compares."""
    scale, metres = max(math.cos(math.radians(latitude)), 0.01), 0.011131884502145034
    more = 2 * spacing * 32
    east = int(more / (111319.5 * scale) * 1e7 if is_inav else more / metres / scale)
    columns = int((10 ** 7 + east) * metres * scale / (spacing * 28))
    rows = math.ceil(10 ** 7 * metres / (24 * spacing))
    return 2048 * rows * columns


def grids(south, north):
    """Bytes of all cells, by the name of the grid."""
    kinds = [("ArduPilot, posts 30 m apart", False, 30), ("ArduPilot, posts 100 m apart", False, 100),
             ("INAV, posts 30 m apart", True, 30)]
    return {name: sum(cells * grid_bytes(is_inav, latitude, spacing) for latitude, cells, _, _ in land.table(south, north))
            for name, is_inav, spacing in kinds}


def card(size):
    """The smallest usual card for so many bytes, in GB."""
    return 2 ** max(0, math.ceil(math.log2(size / 1e9)))


def gigabytes(size):
    return f"{size / 1e9:,.0f}" if size >= 2e10 else f"{size / 1e9:.2g}"


def estimates(found):
    """Lines of the table, and the headline."""
    factors, error, worst = costs(found)
    lines = ["| posts | within | estimate, GB | low to high, GB | card, GB | processor hours |", "|---|---|---|---|---|---|"]
    cells, inland, shore = areas(*LIMITS)
    headline = None
    for spacing in (30, 100):
        for bound in BOUNDS:
            sizes = Estimate(found, spacing, bound, True)
            usual, low, high = (total(one, inland, shore) for one in (sizes.usual, sizes.low, sizes.high))
            vertices = total(Estimate(found, spacing, bound, False).usual, inland, shore)
            posts = (inland + shore) * 1e6 / spacing ** 2
            hours = sum(factor * amount for factor, amount in zip(factors, amounts(posts, vertices))) / 3600
            lines.append(f"| {spacing} m apart | {bound} m | {gigabytes(usual)} | {gigabytes(low)} to {gigabytes(high)} | "
                         f"{card(high)} | {hours:,.0f} |")
            if (spacing, bound) == (30, 20):
                headline = usual, low, high
    for name, size in grids(*LIMITS).items():
        lines.append(f"| {name} | - | {gigabytes(size)} | exact | {card(size)} | - |")
    ardupilot, _, inav = grids(*LIMITS).values()
    usual, low, high = headline
    text = (f"The land of the Earth from 56 degrees south to 60 degrees north, within 20 metres, takes about "
            f"{gigabytes(usual)} GB ({gigabytes(low)} to {gigabytes(high)} GB). Grids of 30 m take "
            f"{gigabytes(ardupilot)} GB in ArduPilot's files and {gigabytes(inav)} GB in INAV's.")
    facts = (f"{cells:,} cells of one degree, {(inland + shore) / 1e6:.1f} million square kilometres, "
             f"{shore / 1e6:.1f} of them in cells with sea. The formula of hours misses measured runs by {error * 100:.0f} % "
             f"(root mean square), and none by more than a factor of {worst:.1f}.")
    return text, lines, facts


def check(microtin, folder):
    """Compares the sizes of grids with files that the program writes."""
    for name, latitude in (("N00E010", 0), ("N43E007", 43), ("N59E010", 59), ("S56W070", -56)):
        source = os.path.join(folder, name + ".hgt")
        with open(source, "wb") as file:
            file.write(b"\0\1" * 81)
        pack = os.path.join(folder, name + ".mtin")
        subprocess.run([microtin, "encode", source, "-o", pack], check=True, stdout=subprocess.DEVNULL)
        for suffix, spacing in ((".DAT", 30), (".DAT", 100), (".TER", 30)):
            grid = os.path.join(folder, name + suffix)
            subprocess.run([microtin, "decode", pack, "--cell", str(spacing), "-o", grid], check=True,
                           stdout=subprocess.DEVNULL)
            expected = grid_bytes(suffix == ".TER", latitude, spacing)
            if os.path.getsize(grid) != expected:
                sys.exit(f"rejected: {name}{suffix} has {os.path.getsize(grid)} bytes, expected {expected}")
    cells, inland, shore = areas(*LIMITS)
    if not (13000 < cells < 15000 and 0.15 < shore / (inland + shore) < 0.35):
        sys.exit("rejected: land.txt")
    print("12 grids")


def main():
    microtin, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
    os.makedirs(folder, exist_ok=True)
    if sys.argv[3:] == ["--check"]:
        check(microtin, folder)
        return
    if not os.path.isdir(DATA):
        print("skipped: ../shared/data is not there")
        return
    print("| terrain | class | posts, m apart | posts | " +
          " | ".join(f"bytes a km2, {bound} m" for bound in BOUNDS) + " | us a post |\n|---|---|---|---|" + "---|" * 5)
    text, lines, facts = estimates(measure(microtin, folder))
    print("\n" + "\n".join([text, "", *lines, "", facts]))
    if len(sys.argv) > 3:
        with open(sys.argv[3], encoding="utf-8") as page:
            before, rest = page.read().split(MARK[0])
        after = rest.split(MARK[1])[1]
        with open(sys.argv[3], "w", encoding="utf-8") as page:
            page.write("\n".join([before + MARK[0], "", *textwrap.wrap(text, 120), "", *lines, "",
                                  *textwrap.wrap(facts, 120), "", MARK[1] + after]))


if __name__ == "__main__":
    main()
