# SPDX-License-Identifier: MIT
"""land.py [LAND.JSON]: the land of the Earth by degrees of latitude, in land.txt.

With a file it counts anew, and writes land.txt: LAND.JSON is the TopoJSON `world/50m.json` of the npm package world-atlas
1.1.4, which has Natural Earth's land at 1:50 million (public domain).
"""
import json
import math
import os
import sys

TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "land.txt")
STEPS = 20  # rows of places in a degree, and places in a row
DEGREE_KM = 111.195  # of a sphere with the Earth's mean radius


def cell_area(latitude):
    """Square kilometres of a cell of one degree from this latitude north."""
    north, south = math.radians(latitude + 1), math.radians(latitude)
    return DEGREE_KM ** 2 * 180 / math.pi * (math.sin(north) - math.sin(south))


def rings(topology):
    """The outlines of all polygons, lists of longitude and latitude."""
    scale, shift = topology["transform"]["scale"], topology["transform"]["translate"]
    arcs = []
    for arc in topology["arcs"]:
        x = y = 0
        places = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            places.append((x * scale[0] + shift[0], y * scale[1] + shift[1]))
        arcs.append(places)
    for land in topology["objects"]["land"].get("geometries", [topology["objects"]["land"]]):
        for polygon in land["arcs"]:
            for ring in polygon:
                yield [place for arc in ring for place in (arcs[arc] if arc >= 0 else arcs[~arc][::-1])]


def crossings(outlines, rows):
    """The longitudes where outlines cross each row of places, sorted: land lies between pairs of them."""
    found = [[] for _ in range(rows)]
    for ring in outlines:
        for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1]):
            low, high = sorted(((y0 + 90) * STEPS - 0.5, (y1 + 90) * STEPS - 0.5))
            for row in range(max(0, math.ceil(low)), min(rows, math.ceil(high))):
                latitude = (row + 0.5) / STEPS - 90
                found[row].append(x0 + (x1 - x0) * (latitude - y0) / (y1 - y0))
    return [sorted(row) for row in found]


def count(path):
    with open(path, encoding="utf-8") as text:
        rows = crossings(rings(json.load(text)), 180 * STEPS)
    lines = []
    for degree in range(180):
        places = [0] * 360
        for row in rows[degree * STEPS:(degree + 1) * STEPS]:
            for west, east in zip(row[::2], row[1::2]):
                for step in range(math.ceil((west + 180) * STEPS - 0.5), math.ceil((east + 180) * STEPS - 0.5)):
                    places[step // STEPS % 360] += 1
        cells = [land for land in places if land > 0]
        if cells:
            shore = sum(land < 0.98 * STEPS * STEPS for land in cells)
            lines.append("%d %d %d %.3f\n" % (degree - 90, len(cells), shore, sum(cells) / STEPS ** 2))
    return lines


def table(south, north):
    """(latitude, cells with land, cells with sea among them, land in cells) of each degree between two latitudes."""
    with open(TABLE, encoding="utf-8") as text:
        rows = [line.split() for line in text if not line.startswith("#")]
    return [(int(row[0]), int(row[1]), int(row[2]), float(row[3])) for row in rows if south <= int(row[0]) < north]


if __name__ == "__main__" and len(sys.argv) > 1:
    counted = count(sys.argv[1])
    with open(TABLE, "w", encoding="utf-8") as text:
        text.write("# Written by land.py: latitude of the south edge, cells of one degree with land, cells with sea among them\n"
                   "# (less than 98 % of land), land as a number of whole cells. Natural Earth, 1:50 million, public domain.\n")
        text.writelines(counted)
