# SPDX-License-Identifier: MIT
"""wheels.py: prints points (x y z) of wheels, a hub within a rim of 30, with wild heights. Encoded at the largest
degree and densely, hubs make a decoder's steps as dear as a stream can."""

import math

SPOKES, SIDE, PITCH, RADIUS = 30, 8, 8191, 2500

state = 1
for wheel in range(SIDE * SIDE):
    x, y = PITCH * (wheel % SIDE) + PITCH // 2, PITCH * (wheel // SIDE) + PITCH // 2
    rim = [2 * math.pi * (i + 0.5) / SPOKES for i in range(SPOKES)]
    for dx, dy in [(0, 0)] + [(RADIUS * math.cos(a), RADIUS * math.sin(a)) for a in rim]:
        state = (state * 1664525 + 1013904223) % 2**32
        print(x + round(dx), y + round(dy), (state >> 16) - 32768)
