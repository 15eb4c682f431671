#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""arriving.py PROGRAM PICTURE: writes an animated PNG of a terrain that arrives: what a device has after the first bytes of a
stream, drawn by PROGRAM (microtin), ten times from an eighth of the bytes on. All frames share a palette of 64 colours."""

import struct
import subprocess
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

WIDTH = 300
FRAMES = 10
COLOURS = 64
STEP = struct.pack(">HH", 4, 10)  # seconds that a frame stays: 4 / 10
LAST = struct.pack(">HH", 3, 1)


def pixels_of(png):
    """Rows of red, green and blue, from a PNG of 8 bits a colour without interlacing."""
    width, height = struct.unpack(">II", png[16:24])
    data, at = b"", 8
    while at < len(png):
        size = struct.unpack(">I", png[at : at + 4])[0]
        if png[at + 4 : at + 8] == b"IDAT":
            data += png[at + 8 : at + 8 + size]
        at += 12 + size
    data = zlib.decompress(data)
    stride, rows, above = 3 * width, [], bytes(3 * width)
    for start in range(0, len(data), stride + 1):
        above = unfiltered(data[start], bytearray(data[start + 1 : start + 1 + stride]), above)
        rows.append(above)
    if len(rows) != height:
        sys.exit("rejected: the program's pictures have another kind of pixels")
    return rows


def unfiltered(kind, row, above):
    """A row whose bytes are differences, as section 9 of the PNG specification has them."""
    for i, byte in enumerate(row):
        left, up, corner = (row[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
        nearest = min((left, up, corner), key=lambda one: abs(left + up - corner - one))
        row[i] = byte + (0, left, up, (left + up) // 2, nearest)[kind] & 255
    return bytes(row)


def palette_of(counts):
    """COLOURS colours, each the mean of a box; the box with most pixels times range is cut in two at its median."""
    boxes = [list(counts)]
    while len(boxes) < COLOURS:

        def spread(box):
            ranges = [max(c[i] for c in box) - min(c[i] for c in box) for i in range(3)]
            return max(ranges), ranges.index(max(ranges))

        box = max(boxes, key=lambda one: spread(one)[0] ** 2 * sum(counts[c] for c in one))
        axis = spread(box)[1]
        box.sort(key=lambda c: c[axis])
        half, seen, cut = sum(counts[c] for c in box) / 2, 0, 1
        for cut in range(1, len(box)):
            seen += counts[box[cut - 1]]
            if seen >= half:
                break
        boxes.remove(box)
        boxes += [box[:cut], box[cut:]]
    places, palette = {}, b""
    for number, box in enumerate(boxes):
        weight = sum(counts[c] for c in box)
        palette += bytes(round(sum(c[i] * counts[c] for c in box) / weight) for i in range(3))
        places.update((c, number) for c in box)
    return palette, places


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def animated(frames):
    counts = Counter(bytes(row[i : i + 3]) for rows in frames for row in rows for i in range(0, len(row), 3))
    palette, places = palette_of(counts)
    width, height = len(frames[0][0]) // 3, len(frames[0])
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0))
    png += chunk(b"acTL", struct.pack(">II", len(frames), 0)) + chunk(b"PLTE", palette)
    number = 0
    for rows in frames:
        stay = LAST if rows is frames[-1] else STEP
        png += chunk(b"fcTL", struct.pack(">5I", number, width, height, 0, 0) + stay + b"\0\0")
        packed = b"".join(b"\0" + bytes(places[row[i : i + 3]] for i in range(0, len(row), 3)) for row in rows)
        data = zlib.compress(packed, 9)
        png += chunk(b"IDAT", data) if number == 0 else chunk(b"fdAT", struct.pack(">I", number + 1) + data)
        number += 1 if number == 0 else 2
    return png + chunk(b"IEND", b"")


def main():
    program, picture = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        grid, stream, frame = (Path(folder, name) for name in ("terrain.asc", "terrain.mtin", "frame.png"))

        def run(*words):
            subprocess.run([program, *map(str, words)], check=True)

        run("fractal", "--size", 321, "--seed", 9, "-o", grid)
        run("encode", grid, "--units", "metre", "--max-error", 12, "-o", stream)
        size = stream.stat().st_size
        frames = []
        for k in range(FRAMES):
            bytes_shown = size // 8 + (size - size // 8) * k // (FRAMES - 1)
            run("render", stream, "--first-bytes", bytes_shown, "--width", WIDTH, "-o", frame)
            frames.append(pixels_of(frame.read_bytes()))
    Path(picture).write_bytes(animated(frames))
    print(f"{picture}: {len(frames)} frames, {Path(picture).stat().st_size} bytes")


main()
