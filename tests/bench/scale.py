# SPDX-License-Identifier: MIT
"""scale.py MICROTIN FOLDER: time and memory of streams and packs of large rasters, as a table.

The first raster is what `fractal --size 3601` makes; the second, of 40,000 x 40,000 posts, consists
of its mirror images side by side. Both stay in FOLDER for the next time (3.2 GB).
"""
import array
import multiprocessing
import os
import subprocess
import sys
import time

microtin, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
CELL, MOSAIC = "N10E010.hgt", "N20E020.hgt"


def write_rows(path, rows):
    with open(path + ".part", "wb") as file:
        for row in rows:
            row.byteswap()
            file.write(row.tobytes())
    os.rename(path + ".part", path)


def fractal_rows():
    subprocess.run([microtin, "fractal", "--size", "3601", "-o", "fractal.asc"], check=True)
    with open("fractal.asc") as text:
        return [array.array("h", map(int, line.split())) for line in text.readlines()[5:]]


def mosaic_rows(side, posts=40000):
    with open(CELL, "rb") as file:
        rows = [array.array("h", file.read(2 * side)) for _ in range(side)]
    for row in rows:
        row.byteswap()
    around = list(range(side - 1)) + list(range(side - 1, 0, -1))
    for y in range(posts):
        row = rows[around[y % len(around)]]
        there_and_back = row[:-1] + row[:0:-1]
        yield (there_and_back * (posts // len(around) + 1))[:posts]


def make(path, rows, *arguments):
    """In a process of its own: memory of this one would count as that of the programs measured."""
    process = multiprocessing.Process(target=lambda: write_rows(path, rows(*arguments)))
    process.start()
    process.join()
    if process.exitcode != 0:
        sys.exit("failed: " + path)


def measure(arguments):
    """Seconds, seconds of processors, and the most memory of one run."""
    start = time.monotonic()
    child = subprocess.Popen([microtin] + arguments.split(), stdout=subprocess.PIPE)
    output = child.stdout.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit("failed: " + arguments)
    return output, time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss


def row(arguments):
    output, wall, processors, memory = measure(arguments)
    print("| `%s` | %.0f | %.0f | %.0f |" % (arguments, wall, processors, memory / 1024), flush=True)
    return output


os.makedirs(folder, exist_ok=True)
os.chdir(folder)
if not os.path.exists(CELL):
    make(CELL, fractal_rows)
if not os.path.exists(MOSAIC):
    make(MOSAIC, mosaic_rows, 3601)
print("%d processors; peak memory of the process\n" % os.cpu_count())
print("| 3601 x 3601 (%s), 40,000 x 40,000 (%s) | seconds | of processors | MB |" % (CELL, MOSAIC))
print("|---|---|---|---|", flush=True)
row("encode %s --max-error 20 -o cell.mtin" % CELL)
row("encode %s --max-error 10 --tile-vertices 1000 -o cell.mtp" % CELL)
row("encode %s --max-error 20 --fast --tile-vertices 1000 -o fast.mtp" % CELL)
row("verify fast.mtp %s" % CELL)
wide = "%s --max-error 50 --fast --tile-vertices 1000" % MOSAIC
shards = row("plan %s --shards 50" % wide).splitlines()
row("encode %s %s -o shard" % (wide, shards[24]))
if "--all" in sys.argv[3:]:
    row("encode %s -o all.mtp" % wide)
    row("verify all.mtp %s" % MOSAIC)
