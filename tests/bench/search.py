# SPDX-License-Identifier: MIT
"""search.py BEFORE AFTER FOLDER [--half HALF] [--effort EFFORT]: compares two builds of the encoder.

BEFORE and AFTER are programs `microtin`. They encode the same crops of terrains alternately; the table has the bytes,
the processor time, and the mean error divided by the bound. Constants of the search are chosen on the half
`development`; the half `unseen` is for the result alone. Crops stay in FOLDER. Crops of real terrain need the folder of
../shared/data; without it the synthetic ones remain.
"""
import argparse
import array
import gzip
import json
import math
import os
import re
import resource
import subprocess

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../shared/data")

# Terrain, column and row where the crop begins, width, height, bounds in metres. No terrain is in both halves.
HALVES = {
    "development": [
        ("scottish_borders", 100, 200, 385, 385, "10", "30"),
        ("jacksboro", 60, 40, 257, 257, "3", "10"),
        ("riviera", 300, 60, 321, 321, "30"),
        ("osnabrueck", 500, 200, 385, 385, "5"),
        ("tidal_marsh", 20, 90, 257, 257, "0.2"),
        ("fractal", 7, 0, 257, 257, "20"),
    ],
    "unseen": [
        ("bigtujunga", 400, 100, 385, 385, "20"),
        ("andorra", 500, 500, 385, 385, "30"),
        ("sthelens", 20, 60, 257, 257, "10"),
        ("jd211_multibeam", 300, 300, 321, 321, "0.1"),
        ("bijou_gully", 0, 0, 105, 77, "0.5"),
        ("fractal", 8, 0, 385, 385, "10", "40"),
    ],
}
EFFORTS = {"fast": ["--fast"], "default": [], "best": ["--best"]}


def crop(name, x, y, width, height):
    """A crop of a real terrain as the text of an ESRI grid."""
    with open(os.path.join(DATA, name + ".json"), encoding="utf-8") as text:
        facts = json.load(text)
    with gzip.open(os.path.join(DATA, name + ".hgt16.gz")) as packed:
        posts = array.array("h", packed.read())
    lines = [f"ncols {width}", f"nrows {height}", "xllcorner 0", "yllcorner 0", f"cellsize {facts['cell_m']}",
             "NODATA_value -32768"]
    digits = 2 if facts["z_unit_m"] == 0.01 else 0
    for row in range(y, y + height):
        begin = row * facts["width"] + x
        lines.append(" ".join(
            "-32768" if z == facts["nodata"] else f"{z * facts['z_unit_m']:.{digits}f}" for z in posts[begin:begin + width]))
    return "\n".join(lines) + "\n"


def source(program, folder, name, x, y, width, height):
    path = os.path.join(folder, f"{name}-{x}-{y}-{width}-{height}.asc")
    if os.path.exists(path):
        return path
    if name == "fractal":
        subprocess.run([program, "fractal", "--size", str(width), "--seed", str(x), "-o", path], check=True)
    else:
        with open(path, "w", encoding="ascii") as file:
            file.write(crop(name, x, y, width, height))
    return path


def encode(program, path, bound, options):
    """Bytes, seconds of processor time, and the mean error divided by the bound."""
    stream = path + ".mtin"
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    printed = subprocess.run([program, "encode", path, "--max-error", bound, "-o", stream, *options],
                             check=True, capture_output=True, text=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    mean = re.search(r"mean (-?[0-9.e-]+)", printed.stdout + printed.stderr)
    return os.path.getsize(stream), seconds, abs(float(mean.group(1))) / float(bound) if mean else math.nan


def compare(programs, crops, folder, options):
    print("| terrain, bound in metres | bytes before | bytes after | bytes, ratio | seconds before | seconds after |"
          " seconds, ratio | mean before / bound | mean after / bound |")
    print("|" + "---|" * 9)
    logarithms, totals, size = 0.0, [0, 0, 0.0, 0.0], 0
    for name, x, y, width, height, *bounds in crops:
        if name != "fractal" and not os.path.exists(os.path.join(DATA, name + ".json")):
            print(f"skipped: no {name} in {DATA}")
            continue
        path = source(programs[1], folder, name, x, y, width, height)
        for bound in bounds:
            before, after = (encode(program, path, bound, options) for program in programs)
            totals = [t + n for t, n in zip(totals, (before[0], after[0], before[1], after[1]))]
            logarithms, size = logarithms + math.log(after[0] / before[0]), size + 1
            print(f"| {name} {bound} | {before[0]} | {after[0]} | {after[0] / before[0]:.3f} | {before[1]:.2f} |"
                  f" {after[1]:.2f} | {after[1] / before[1]:.2f} | {before[2]:.3f} | {after[2]:.3f} |", flush=True)
    print(f"| all; ratio of the sums | {totals[0]} | {totals[1]} | {totals[1] / totals[0]:.3f} | {totals[2]:.2f} |"
          f" {totals[3]:.2f} | {totals[3] / totals[2]:.2f} | | |")
    print(f"\nGeometric mean of the ratios of bytes: {math.exp(logarithms / size):.3f}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("folder")
    parser.add_argument("--half", choices=HALVES, action="append")
    parser.add_argument("--effort", choices=EFFORTS, action="append")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    for half in arguments.half or HALVES:
        for effort in arguments.effort or EFFORTS:
            print(f"### {half}, {effort}\n")
            compare((arguments.before, arguments.after), HALVES[half], arguments.folder, EFFORTS[effort])


if __name__ == "__main__":
    main()
