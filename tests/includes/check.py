#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check.py [ROOT] fails if an include points the wrong way, and else says how many there are.

A layer of the encoder includes those above it in encoder/layers.hpp alone, the command line neither fit nor pack; the
decoder and shared/ include nothing of the encoder; drivers of other programs its public face alone; a test includes what
its subject may include, its subject, and tests/support; nothing else includes tests.
"""
import pathlib
import re
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = {"importing": "import", "exporting": "export"}
HIDDEN = {"cli": ("fit", "pack")}  # behind the product
PUBLIC = ("encoder.h", "encoder.hpp", "surface.hpp")  # in encoder/include
DRIVERS = ("gdal", "python", "qgis")
SUPPORT = ("support", "whole", "faults", "bench", "package")  # may include all layers


def layers():
    names = re.findall(r"^namespace (\w+) \{", (REPOSITORY / "encoder/layers.hpp").read_text(), re.M)
    return [FOLDERS.get(name, name) for name in names if name != "microtin"]


def may_include(path, target, order):
    """Whether the file `path` may include `target`, both as parts of paths from the root."""
    if target[0] == "tests":
        return path[0] == "tests" and (path[1] in SUPPORT or target[1] in ("support", "firmware", path[1]))
    if path[0] == "encoder" and path[1] in DRIVERS:
        return target[0] == "microtin" or target[:2] == path[:2]
    if target[0] == "microtin" and target[-1] in PUBLIC:
        target = ("encoder", "product")
    if target[0] != "encoder" or target[1] == "layers.hpp":
        return target[0] in ("shared", "microtin") or path[0] != "shared"
    if path[0] == "encoder" and path[1] == "include":
        return False
    if path[0] == "encoder" or (path[0] == "tests" and path[1] in order):
        return order.index(target[1]) <= order.index(path[1]) and target[1] not in HIDDEN.get(path[1], ())
    return path[0] == "tests" and path[1] in SUPPORT


def main():
    root = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else REPOSITORY
    order = layers()
    count, upward = 0, []
    for folder in ("shared", "decoder", "encoder", "tests"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            parts = path.relative_to(root).parts
            if len(parts) < 3 and folder == "tests" or parts[:2] == ("tests", "includes"):
                continue
            for include in re.findall(r'^#include ["<]((?:shared|decoder|encoder|tests|microtin)/.*)[">]', path.read_text(), re.M):
                count += 1
                if not may_include(parts, tuple(include.split("/")), order):
                    upward.append(f"{'/'.join(parts)} includes {include}")
    print("\n".join(upward + [f"{count} includes, {len(upward)} upward"]))
    sys.exit(1 if upward or count == 0 else 0)


main()
