# SPDX-License-Identifier: MIT
"""rings.py KIND SEED: prints points (x y z) of a mesh for rings.sh; rings.py alone, the kinds."""

import math
import random
import sys

COUNT = 400
KINDS = {
    "uniform": lambda i, r: (r.randrange(1000), r.randrange(1000)),
    "clusters": lambda i, r: (100 * r.randrange(10) + int(r.gauss(40, 6)), 100 * r.randrange(10) + int(r.gauss(40, 6))),
    "grid": lambda i, r: (7 * (i % 20), 7 * (i // 20)),
    "two rows": lambda i, r: (5 * (i // 2) + r.randrange(2), 20 * (i % 2)),
    "three rows": lambda i, r: (5 * (i // 3), 20 * (i % 3)),
    "five rows, askew": lambda i, r: (9 * (i // 5) + 4 * (i % 2), 8 * (i % 5) + r.randrange(2)),
    "circle": lambda i, r: at(2 * math.pi * i / COUNT, 20000),
    "rim and hub": lambda i, r: (20000, 20000) if i == 0 else at(2 * math.pi * i / COUNT + 0.001 * r.random(), 20000),
    "rim and hub aside": lambda i, r: aside(r) if i == 0 else at(2 * math.pi * i / COUNT + 0.001 * r.random(), 20000),
    "fan": lambda i, r: (0, 0) if i == 0 else (20000 + r.randrange(3), 150 * i),
    "line and a point": lambda i, r: (300, 999) if i == 0 else (10 * i, 5),
    "spiral": lambda i, r: at(0.3 * i, 40 * i + r.randrange(9)),
    "hubs": lambda i, r: spoke(i, 40 + r.randrange(3)),
    "steep": lambda i, r: (int(1000 * r.random() ** 3), int(1000 * r.random() ** 3)),
}  # fmt: skip


def at(angle, radius):
    return 20000 + round(radius * math.cos(angle)), 20000 + round(radius * math.sin(angle))


def aside(r):
    return (r.randrange(6500, 19500),) * 2


def spoke(i, spokes):
    wheel, k = divmod(i, spokes)
    x, y = at(2 * math.pi * k / (spokes - 1), 0 if k == 0 else 900)
    return x + 2000 * (wheel % 4), y + 2000 * (wheel // 4)


if len(sys.argv) == 1:
    print("\n".join(KINDS))
else:
    numbers = random.Random(int(sys.argv[2]))
    for x, y in {(max(0, x), max(0, y)) for x, y in (KINDS[sys.argv[1]](i, numbers) for i in range(COUNT))}:
        print(x, y, numbers.randrange(-9, 9))
