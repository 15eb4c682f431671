#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""heights.py: the heights that devices report of the golden streams are those that the second decoder computes
(format-stream.md, section 12)."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True
FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))
from reference_decoder import Decoder  # noqa: E402

REASONS = {"outside": "none: 1", "void": "none: 2"}


def main():
    compared = wrong = 0
    for file in sorted(FOLDER.glob("1.0/*.mtin")):
        decoder = Decoder(file.read_bytes()).decode()
        for line in file.with_suffix(".report").read_text().splitlines()[3:]:
            x, y, expected = line.split(" ", 2)
            height = decoder.mesh.height_at((int(x), int(y)), decoder.void)
            compared += 1
            if str(REASONS.get(height, height)) != expected:
                wrong += 1
                print(f"rejected: {file.name} has {height} at {x} {y}, not {expected}")
    print(f"{compared} heights, {wrong} rejected")
    return 1 if wrong or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
