# SPDX-License-Identifier: MIT
"""breaklines.py MICROTIN FOLDER [--posts N]: what edges along streams and ridges cost.

MICROTIN is the program. Streams are the posts that drain at least N others (each to the lowest of its eight neighbours),
and ridges are those of the terrain upside down. Each is a line from post to post, without heights. The table has vertices and
bytes with and without these lines, at the same bound. Files stay in FOLDER. Crops of real terrain need the folder of
../shared/data; without it the synthetic one remains.
"""
import argparse
import json
import os
import re
import subprocess

import search

# Terrain, column and row where the crop begins, width, height, bounds in metres.
CROPS = [
    ("jacksboro", 60, 40, 257, 257, "3", "10"),
    ("scottish_borders", 100, 200, 385, 385, "10", "30"),
    ("bigtujunga", 400, 100, 385, 385, "10", "20"),
    ("fractal", 7, 0, 257, 257, "20"),
]


def posts_of(path):
    """Width, height, the first post's x, the last row's y, the cell size, and the heights from north to south."""
    with open(path, encoding="ascii") as text:
        lines = text.read().split("\n")
    header, rows = {}, []
    for line in lines:
        words = line.split()
        if len(words) == 2 and words[0][0].isalpha():
            header[words[0].lower()] = float(words[1])
        elif words:
            rows.append([float(word) for word in words])
    cell = header["cellsize"]
    half = 0 if "xllcenter" in header else cell / 2
    west = header.get("xllcenter", header.get("xllcorner", 0.0)) + half
    south = header.get("yllcenter", header.get("yllcorner", 0.0)) + half
    return int(header["ncols"]), int(header["nrows"]), west, south, cell, [z for row in rows for z in row]


def receivers(width, height, heights):
    """For each post the lowest of its lower neighbours, else -1."""
    found = [-1] * (width * height)
    for row in range(height):
        for column in range(width):
            post = row * width + column
            lowest = heights[post]
            for y in range(max(row - 1, 0), min(row + 2, height)):
                for x in range(max(column - 1, 0), min(column + 2, width)):
                    if heights[y * width + x] < lowest:
                        lowest = heights[y * width + x]
                        found[post] = y * width + x
    return found


def streams(width, height, heights, least):
    """Lines of posts along which at least `least` posts drain, from heads and confluences to confluences and ends."""
    receiver = receivers(width, height, heights)
    drained = [1] * len(heights)
    for post in sorted(range(len(heights)), key=lambda post: -heights[post]):
        if receiver[post] >= 0:
            drained[receiver[post]] += drained[post]
    givers = [0] * len(heights)
    for post, other in enumerate(receiver):
        if drained[post] >= least and other >= 0:
            givers[other] += 1
    lines = []
    for post, count in enumerate(drained):
        if count < least or givers[post] == 1:
            continue
        line = [post]
        while receiver[line[-1]] >= 0 and (len(line) == 1 or givers[line[-1]] == 1):
            line.append(receiver[line[-1]])
        if len(line) > 2:
            lines.append(line)
    return lines


def write_lines(terrain, path, least):
    """Writes the streams and ridges of a terrain; returns how many there are and their length in posts."""
    width, height, west, south, cell, heights = posts_of(terrain)
    lines = streams(width, height, heights, least) + streams(width, height, [-z for z in heights], least)
    with open(path, "w", encoding="ascii") as text:
        text.write("x,y\n")
        for line in lines:
            for post in line:
                text.write(f"{west + cell * (post % width):.9g},{south + cell * (height - 1 - post // width):.9g}\n")
            text.write("\n")
    return len(lines), sum(len(line) - 1 for line in lines)


def encoded(program, terrain, bound, stream, words):
    """Vertices and bytes."""
    command = [program, "encode", terrain, "--units", "metre", "--max-error", bound, "-o", stream, *words]
    report = subprocess.run(command, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout
    vertices, size = re.search(r"stream: (\d+) vertices, (\d+) bytes", report).groups()
    return int(vertices), int(size)


def marks(program, stream):
    """Marked edges, and bytes of their chunk."""
    command = [program, "info", "--json", stream]
    found = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout)["lines"]
    return found["edges"], found["bytes"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="MICROTIN")
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("--posts", type=int, default=500, metavar="N")
    given = parser.parse_args()
    os.makedirs(given.folder, exist_ok=True)
    print("| terrain | bound | lines | posts along them | vertices without | with | more | bytes without | with | more |"
          " marked edges | bytes of marks |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for name, x, y, width, height, *bounds in CROPS:
        terrain = search.source(given.program, given.folder, name, x, y, width, height)
        if terrain is None:
            continue
        path = os.path.join(given.folder, name + "-lines.csv")
        lines, posts = write_lines(terrain, path, given.posts)
        for bound in bounds:
            stream = os.path.join(given.folder, "stream.mtin")
            before = encoded(given.program, terrain, bound, stream, [])
            after = encoded(given.program, terrain, bound, stream, ["--breaklines", path])
            subprocess.run([given.program, "verify", stream, terrain, "--units", "metre", "--breaklines", path],
                           check=True, stdout=subprocess.DEVNULL)
            edges, size = marks(given.program, stream)
            more = [f"{100 * (b / a - 1):.1f} %" for a, b in zip(before, after)]
            print(f"| {name} | {bound} | {lines} | {posts} | {before[0]} | {after[0]} | {more[0]} |"
                  f" {before[1]} | {after[1]} | {more[1]} | {edges} | {size} |", flush=True)


if __name__ == "__main__":
    main()
