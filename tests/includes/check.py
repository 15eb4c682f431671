#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check.py [ROOT] fails if an include points the wrong way or a layer lists one that it does not include.

A layer of the encoder includes exactly the layers that encoder/layers.hpp lists for it; the decoder and shared/ include
nothing of the encoder; drivers of other programs include its public face alone; a test includes its subject, layers
above its subject in that list, and tests/support; nothing else includes tests.
"""
import pathlib
import re
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = {"importing": "import", "exporting": "export", "verifying": "verify"}
PUBLIC = ("encoder.h", "encoder.hpp", "surface.hpp")  # in encoder/include
DRIVERS = ("gdal", "python", "qgis")
SUPPORT = ("support", "adapters", "whole", "faults", "bench", "package")  # may include all layers


def layers(root):
    """The layers that each layer lists, by the names of folders."""
    text = (root / "encoder/layers.hpp").read_text()
    blocks = re.findall(r"^namespace (\w+) \{((?:\nusing namespace \w+;)*)\n?\}", text, re.M)
    return {
        FOLDERS.get(name, name): {FOLDERS.get(used, used) for used in re.findall(r"using namespace (\w+);", uses)}
        for name, uses in blocks
    }


def may_include(path, target, listed):
    """Whether the file `path` may include `target`, both as parts of paths from the root."""
    if target[0] == "tests":
        return path[0] == "tests" and (path[1] in SUPPORT or target[1] in ("support", "firmware", path[1]))
    if path[0] == "encoder" and path[1] in DRIVERS:
        return target[0] == "microtin" or target[:2] == path[:2]
    if target[0] == "microtin" and target[-1] in PUBLIC:
        if path[:2] == ("encoder", "include"):
            return True
        target = ("encoder", "product")
    if target[0] != "encoder" or target[1] == "layers.hpp":
        return target[0] in ("shared", "microtin") or path[0] != "shared"
    if path[0] == "encoder" and path[1] == "include":
        return False
    if path[0] == "encoder":
        return target[1] == path[1] or target[1] in listed[path[1]]
    if path[0] == "tests" and path[1] in listed:
        order = list(listed)
        return order.index(target[1]) <= order.index(path[1])
    return path[0] == "tests" and path[1] in SUPPORT


def main():
    root = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else REPOSITORY
    listed = layers(root)
    count, upward, unused = 0, [], {(layer, used) for layer, uses in listed.items() for used in uses}
    for folder in ("shared", "decoder", "encoder", "tests"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            parts = path.relative_to(root).parts
            if len(parts) < 3 and folder == "tests" or parts[:2] == ("tests", "includes"):
                continue
            for include in re.findall(r'^#include ["<]((?:shared|decoder|encoder|tests|microtin)/.*)[">]', path.read_text(), re.M):
                count += 1
                target = tuple(include.split("/"))
                if parts[0] == target[0] == "encoder":
                    unused.discard((parts[1], target[1]))
                if not may_include(parts, target, listed):
                    upward.append(f"{'/'.join(parts)} includes {include}")
    print("\n".join(upward + [f"{layer} lists {used}, but does not include it" for layer, used in sorted(unused)]))
    print(f"{count} includes, {len(upward)} upward; {len(unused)} of {sum(map(len, listed.values()))} listed layers unused")
    sys.exit(1 if upward or unused or count == 0 else 0)


main()
