#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A slow second decoder of microtin streams, written from shared/FORMAT.md and not from the C++ code.

Usage: reference_decoder.py FILE.mtin

Prints the digest of the mesh, then x, y and z of each vertex in decoded order. Section numbers in this file
are those of shared/FORMAT.md; names are its names wherever it has any.
"""

import itertools
import sys
import zlib
from collections import deque
from pathlib import Path
from typing import NamedTuple

INFINITY = -1
SEED_SIZE = 3
FIRST_SECTION_VERTICES = 256


class Malformed(Exception):
    """The stream breaks a rule of the specification."""


def require(condition, complaint):
    if not condition:
        raise Malformed(complaint)


# Section 2: exactness


def minus(p, q):
    return (p[0] - q[0], p[1] - q[1])


def cross(s, t):
    return s[0] * t[1] - s[1] * t[0]


def dot(s, t):
    return s[0] * t[0] + s[1] * t[1]


def twice_area(a, b, c):
    """Positive if the triangle is counter-clockwise."""
    return cross(minus(b, a), minus(c, a))


def angle_at(p, a, b):
    """The dot product at p of the directions to a and b."""
    return dot(minus(a, p), minus(b, p))


def incircle(a, b, c, p):
    return angle_at(c, a, b) * twice_area(p, a, b) - angle_at(p, a, b) * twice_area(c, a, b)


def in_conflict_with_triangle(corners, p):
    d = incircle(*corners, p)
    if d != 0:
        return d > 0
    largest = max(*corners, p)
    if largest == p:
        return False
    return twice_area(*(p if corner == largest else corner for corner in corners)) > 0


def in_conflict_with_ghost(u, w, p):
    side = twice_area(u, w, p)
    return side > 0 or (side == 0 and angle_at(p, u, w) < 0)


# Section 9: integer functions


def divide(a, b):
    """The specification's a / b, which rounds towards zero."""
    return a // b if (a < 0) == (b < 0) else -(-a // b)


def keep_within(low, value, high):
    return max(low, min(value, high))


def highest_bit(v):
    return v.bit_length() - 1


def log2(v):
    b = highest_bit(v)
    m = ((v << 16) >> b) & 65535
    bend = (m * (65536 - m) >> 16) * (27800 - (10600 * m >> 16)) >> 16
    return 256 * b + ((m + bend + 128) >> 8)


def exp2(exponent):
    if exponent <= 0:
        return 1
    if exponent >= 30 * 256:
        return 1 << 30
    f = exponent & 255
    mantissa = 32768 + 128 * f - (f * (256 - f) * (9980 + 10 * f) >> 16)
    return (mantissa << 16) >> (31 - (exponent >> 8))


def root_above(u):
    return exp2((log2(u) + 3) // 2) + 1


LARGEST_COTANGENT = 89 * 256


def cotangent(q, h):
    s = max(0, highest_bit(h) - 15)
    q, h = q >> s, h >> s
    return divide(keep_within(-89 * h, q, 89 * h) * 256, h)


def cotangent_at(place, p, q):
    """Of the angle under which a place sees the side p -> q, to the right of it."""
    return cotangent(angle_at(place, p, q), twice_area(place, p, q))


def disc(c, k):
    return ((c * ((65536 + k * k) >> 8)) >> 8) * 201


def segment(k):
    m = abs(k)
    smaller = 89478480 // (16 * m + 330400 // (m + 188))
    return smaller if k <= 0 else ((65536 + k * k) * 3217 >> 11) - smaller


def circle(p, q, k, m):
    """C, X and Y of the circle over the side p -> q that sees it under the cotangent k, at a doubled place m."""
    s, t = (minus(m, (2 * end[0], 2 * end[1])) for end in (p, q))
    u = minus(s, t)
    power = dot(s, t) - (k * cross(u, s) >> 8)
    return power, 16 * (s[0] + t[0]) + (k * u[1] >> 4), 16 * (s[1] + t[1]) - (k * u[0] >> 4)


# Section 8: range coder


class RangeDecoder:
    def __init__(self, payload):
        self.payload_size = len(payload)
        self.bytes = payload + bytes(4)
        self.position = 4
        self.range = (1 << 32) - 1
        self.code = int.from_bytes(self.bytes[:4], "big")
        require(self.code != self.range, "code equals range")

    def finish(self):
        require(self.position >= self.payload_size, "payload is left")

    def normalise(self):
        while self.range < 1 << 24:
            require(self.position < len(self.bytes), "payload is too short")
            self.range <<= 8
            self.code = (self.code << 8) + self.bytes[self.position]
            self.position += 1

    def bit(self, p):
        bound = (self.range >> 15) * p
        one = self.code < bound
        if one:
            self.range = bound
        else:
            self.range -= bound
            self.code -= bound
        self.normalise()
        return int(one)

    def uniform(self, count):
        if count == 1:
            return 0
        self.range //= count
        number = self.code // self.range
        require(number < count, "uniform number is too large")
        self.code -= number * self.range
        self.normalise()
        return number


class AdaptiveBit:
    def __init__(self, start):
        self.fast = self.slow = 128 * start + 64

    def sum(self):
        return self.fast + self.slow

    def decode(self, coder):
        bit = coder.bit(self.sum() >> 1)
        self.learn(bit)
        return bit

    def learn(self, bit):
        target = 32704 if bit else 64
        self.fast += (target - self.fast) >> 5
        self.slow += (target - self.slow) >> 8


def decode_between(coder, row, i, f):
    """A bit whose probability lies f / 256 of the way from entry i of the row to the next."""
    left, right = row[i], row[i + 1]
    bit = coder.bit((left.sum() + ((right.sum() - left.sum()) * f >> 8)) >> 1)
    (left if f < 128 else right).learn(bit)
    return bit


def decode_on_curve(coder, row, position):
    position = keep_within(0, position, 256 * (len(row) - 1) - 1)
    return decode_between(coder, row, position >> 8, position & 255)


LONGEST = 17


def decode_length(coder, row, typical):
    def is_longer_than(bits):
        return row[keep_within(0, bits - typical + 3, 6)].decode(coder)

    length = typical
    if is_longer_than(length):
        length += 1
        while length < LONGEST and is_longer_than(length):
            length += 1
    else:
        while length > 0 and not is_longer_than(length - 1):
            length -= 1
    return length


def decode_magnitude(coder, row, second, typical):
    bits = decode_length(coder, row, typical)
    if bits < 2:
        return bits
    leading = 2 + second[min(bits, 9)].decode(coder)
    return (leading << (bits - 2)) + coder.uniform(1 << (bits - 2))


# Section 4: file


class ByteReader:
    def __init__(self, data):
        self.data = data
        self.position = 0

    def take(self, size):
        start = self.position
        require(start + size <= len(self.data), "stream is cut off")
        self.position += size
        return self.data[start : self.position]

    def is_at_end(self):
        return self.position == len(self.data)

    def number(self, size):
        return int.from_bytes(self.take(size), "little")

    def varint(self):
        value = 0
        while True:
            byte = self.number(1)
            require(byte != 128 or value > 0, "varint is not in its shortest form")
            value = value << 7 | byte & 127
            if byte < 128:
                return value

    def length(self):
        value = self.varint()
        require(value < 1 << 31, "a length is out of bounds")
        return value

    def expect_check(self, start):
        checked = self.data[start : self.position]
        require(self.number(4) == zlib.crc32(checked), "CRC-32 is wrong")

    def section(self):
        start = self.position
        payload = self.take(self.length())
        self.expect_check(start)
        return RangeDecoder(payload)


class Header(NamedTuple):
    heights_are_sent: bool
    void_flags_are_sent: bool
    degree: int
    levels: int
    vertices: int
    columns: int
    rows: int


def read_header(reader):
    require(reader.take(4) == b"mtin", "not a microtin stream")
    require(reader.number(1) == 5, "unknown version")
    payload = ByteReader(reader.take(reader.length()))
    reader.expect_check(0)
    properties = payload.varint()
    require(properties < 1 << 13, "unknown properties")
    vertices = payload.varint()
    columns, rows = payload.varint() + 1, payload.varint() + 1
    levels, degree = properties >> 3 & 3, properties >> 5 & 63
    require(6 <= degree <= 32, "degree is out of bounds")
    require(levels >= 1, "there is no level of cells")
    require(3 <= vertices <= 1 << 24, "number of vertices is out of bounds")
    require(max(columns, rows) <= 1 << 16, "a side is out of bounds")
    if properties & 4:
        check_placement(payload)
    return Header(bool(properties & 1), bool(properties & 2), degree, levels, vertices, columns, rows)


def check_placement(reader):
    for _ in range(3):
        require(reader.varint() < 1 << 64, "offset is out of bounds")
        for _ in ("numerator", "denominator"):
            require(1 <= reader.varint() < 1 << 40, "step is out of bounds")


# Section 7: insertion


def after(half_edge):
    return half_edge - 2 if half_edge % 3 == 2 else half_edge + 1


def before(half_edge):
    return half_edge + 2 if half_edge % 3 == 0 else half_edge - 1


class Mesh:
    def __init__(self, seed):
        self.points = list(seed)
        self.start = [0, 1, 2]
        for i in range(3):
            self.start += [(i + 1) % 3, i, INFINITY]
        half_edges = {(self.start[e], self.end(e)): e for e in range(12)}
        self.twin = [half_edges[self.end(e), self.start[e]] for e in range(12)]

    def end(self, half_edge):
        return self.start[after(half_edge)]

    def apex(self, half_edge):
        return self.start[before(half_edge)]

    def corners(self, triangle):
        return self.start[3 * triangle : 3 * triangle + 3]

    def is_ghost(self, triangle):
        return INFINITY in self.corners(triangle)

    def places(self, vertices):
        return [self.points[vertex] for vertex in vertices]

    def real_triangles(self):
        return [t for t in range(len(self.start) // 3) if not self.is_ghost(t)]

    def degree(self, half_edge):
        """Of the vertex at its start, infinity counted."""
        around = [half_edge]
        while (following := self.twin[before(around[-1])]) != half_edge:
            around.append(following)
        return len(around)

    def half_edge_between(self, u, w):
        return next(e for e, start in enumerate(self.start) if start == u and self.end(e) == w)

    def in_conflict(self, triangle, p):
        corners = self.corners(triangle)
        if INFINITY not in corners:
            return in_conflict_with_triangle(self.places(corners), p)
        i = corners.index(INFINITY)
        return in_conflict_with_ghost(*self.places((corners[i - 2], corners[i - 1])), p)

    def explore_cavity(self, chord, p, may_cross):
        cavity, boundary = [chord // 3], []
        stack = [before(chord), after(chord), chord]
        while stack:
            half_edge = stack.pop()
            across = self.twin[half_edge]
            if self.in_conflict(across // 3, p):
                require(may_cross(half_edge, len(cavity)), "cavity is not legal")
                cavity.append(across // 3)
                stack += [before(across), after(across)]
            else:
                boundary.append(half_edge)
        return cavity, boundary

    def insert(self, p, cavity, boundary):
        b = len(self.points)
        self.points.append(p)
        rim = [(self.start[e], self.end(e), self.twin[e]) for e in boundary]
        first_new = len(self.start) // 3
        self.start += [0] * 6
        self.twin += [0] * 6
        numbers = cavity + [first_new, first_new + 1]
        for i, ((u, w, outside), triangle) in enumerate(zip(rim, numbers)):
            e = 3 * triangle
            self.start[e : e + 3] = u, w, b
            self.twin[e], self.twin[outside] = outside, e
            following = 3 * numbers[(i + 1) % len(numbers)] + 2
            self.twin[e + 1], self.twin[following] = following, e + 1


# Section 10: hits, places, heights


def start_table():
    """The numbers at the end of FORMAT.md."""
    text = (Path(__file__).parent.parent / "shared" / "FORMAT.md").read_text(encoding="utf-8")
    appendix = text[text.index("## 14. Start table") :]
    return [int(word) for line in appendix.splitlines() if line.startswith("    ") for word in line.split()]


class Models:
    """What the adaptive bits have learnt. It outlives phases and sections."""

    def __init__(self):
        starts = iter(start_table())

        def bits(*sizes):
            if not sizes:
                return AdaptiveBit(next(starts))
            return [bits(*sizes[1:]) for _ in range(sizes[0])]

        self.hit = bits(7, 15)
        self.cell = bits(4, 9)
        self.height = bits(12, 7)
        self.second = bits(10)
        self.negative = bits(10, 3)
        self.gap = bits(7)
        self.void = bits(7)
        self.crowding = 2048


class Density:
    def __init__(self, header, vertices, batch):
        self.share = log2(batch) - log2(vertices) - 220
        self.mean = 256 * (log2(batch) - log2(header.columns * header.rows))

    def value(self):
        return divide(self.mean, 256)

    def add(self, area):
        self.mean += divide(256 * (self.share - log2(area)) - self.mean, 16)


class HullEdge:
    def __init__(self, header, a, c):
        self.header = header
        self.a = a
        self.d = minus(c, a)

    def is_border(self):
        largest = self.header.columns - 1, self.header.rows - 1
        return any(d == 0 and at in (0, most) for d, at, most in zip(self.d, self.a, largest))

    def length(self):
        return abs(self.d[0]) | abs(self.d[1])

    def decode_hit(self, coder, models, density):
        if self.is_border() and self.length() == 1:
            return False
        return decode_on_curve(coder, models.hit[6], 2 * log2(self.length()) + density + 1536)

    def decode_place(self, coder, models, density):
        if not self.is_border():
            return tuple(decode_outer_coordinate(coder, n) for n in (self.header.columns, self.header.rows))
        k = 1 + decode_magnitude(coder, models.gap, models.second, max(0, -density) // 512)
        require(k < self.length(), "vertex is beyond its hull edge")
        return tuple(at + k * (d // self.length()) for at, d in zip(self.a, self.d))


def decode_outer_coordinate(coder, count):
    """Likely to be the smallest or the largest."""
    if coder.bit(24576):
        return (count - 1) * coder.bit(16384)
    return coder.uniform(count)


class Side(NamedTuple):
    start: tuple
    end: tuple
    certified: bool
    apex: tuple  # None behind a hull edge
    own: int  # cotangents of the triangle's circle and of that behind
    behind: int

    def squared_length(self):
        s = minus(self.end, self.start)
        return dot(s, s)

    def lost_area(self):
        lost = segment(-self.own) + (segment(self.behind) if self.apex else 0)
        return self.squared_length() * lost >> 9

    def circle(self, k):
        return lambda m: circle(self.start, self.end, k, m)

    def has_circle_behind(self):
        return self.certified and self.apex is not None


class Candidate:
    """The triangle of a chord that is not certified, seen from the chord."""

    def __init__(self, mesh, chord, is_final):
        half_edges = [after(chord), before(chord), chord]
        self.v, self.c, self.a = mesh.places([mesh.start[e] for e in half_edges])
        self.sides = [self.side(mesh, e, e == chord or is_final(mesh.twin[e] // 3)) for e in half_edges]
        self.chord = self.sides[2]

    @staticmethod
    def side(mesh, half_edge, certified):
        start, end, opposite = mesh.places((mesh.start[half_edge], mesh.end(half_edge), mesh.apex(half_edge)))
        own = cotangent_at(opposite, start, end)
        apex = behind = None
        if mesh.apex(mesh.twin[half_edge]) != INFINITY:
            apex = mesh.points[mesh.apex(mesh.twin[half_edge])]
            behind = -cotangent_at(apex, end, start)
        return Side(start, end, certified, apex, own, behind)

    def free_area(self):
        whole = disc(self.chord.squared_length(), self.chord.own)
        free = whole - sum(side.lost_area() for side in self.sides if side.certified)
        return max(free, (whole >> 8) + 1)

    def open_sides(self):
        return [side for side in self.sides if not side.certified]


class Box(NamedTuple):
    x: int
    y: int
    columns: int
    rows: int

    def cell(self, column, row):
        left, right = starts(self.columns)[column : column + 2]
        bottom, top = starts(self.rows)[row : row + 2]
        return Box(self.x + left, self.y + bottom, right - left, top - bottom)

    def is_point(self):
        return self.columns == 1 and self.rows == 1

    def doubled_middle(self):
        return 2 * self.x + self.columns - 1, 2 * self.y + self.rows - 1


def starts(count):
    return [count * i // 4 for i in range(5)]


class LargeCircle(NamedTuple):
    """The candidate's circle in sixteenths of a lattice step, seen from v: not smaller than it is."""

    x: int
    y: int
    radius: int
    slack: int

    @classmethod
    def of(cls, candidate):
        x, y = minus(candidate.a, candidate.v)
        k = candidate.chord.own
        margin = (abs(x) + abs(y)) // 8 + 2
        radius = root_above(candidate.chord.squared_length() * (65536 + k * k) >> 10) + margin
        slack = 2 * margin + 5 + (radius >> 7)
        return cls(8 * x + (k * y >> 5), 8 * y - (k * x >> 5), radius, slack)

    def is_beyond(self, extreme, side, v):
        (x, y), u = minus(side.start, v), minus(side.end, side.start)
        return cross(u, minus(extreme, (16 * x, 16 * y))) < self.slack * (abs(u[0]) + abs(u[1]))


def interval(values, count):
    """The first value and the number of values, within a lattice of count values."""
    low, high = (keep_within(0, extreme, count - 1) for extreme in (min(values), max(values)))
    return low, high - low + 1


def first_box(candidate, columns, rows):
    if abs(candidate.chord.own) == LARGEST_COTANGENT:
        return Box(0, 0, columns, rows)
    v, large = candidate.v, LargeCircle.of(candidate)

    places = [v, candidate.c, candidate.a]
    for dx, dy, rounding in ((-1, 0, 15), (0, -1, 15), (1, 0, 0), (0, 1, 0)):
        extreme = large.x + dx * large.radius, large.y + dy * large.radius
        if any(large.is_beyond(extreme, side, v) for side in candidate.open_sides()):
            places.append(tuple(at + ((e + rounding) >> 4) for at, e in zip(v, extreme)))
    (x, width), (y, height) = (interval(values, n) for values, n in zip(zip(*places), (columns, rows)))
    return Box(x, y, width, height)


class Slices:
    """A side of a box cut into four."""

    def __init__(self, count):
        ends = starts(count)
        self.widths = [right - left for left, right in zip(ends, ends[1:])]
        self.unit = 16 - highest_bit(count)
        self.offsets = [left + right - count for left, right in zip(ends, ends[1:])]
        self.middles = [(offset << self.unit) >> 2 for offset in self.offsets]
        self.extent = 4 * max(1, count - 3)
        self.sizes = self.widths if count <= 64 else [1] * 4

    def distances(self, base, slope, scale):
        linear = int16(slope * scale.factor >> (scale.shift + self.unit + 7))
        bend = int16((scale.factor << 15) >> (scale.shift + 2 * self.unit))
        return [base + (m * linear >> 16) + ((m * m >> 16) * bend >> 16) for m in self.middles]


def int16(value):
    """The signed number of the low 16 bits."""
    return (value + 32768) % 65536 - 32768


class Scale:
    def __init__(self, ramp):
        self.shift = max(0, highest_bit(ramp) - 15)
        self.factor = (1 << 30) // (ramp >> self.shift)


class Grid:
    """The 4 x 4 cells of a box."""

    ALL = [(i, j) for i in range(4) for j in range(4)]

    def __init__(self, box):
        self.middle = box.doubled_middle()
        self.columns, self.rows = Slices(box.columns), Slices(box.rows)

    def scale(self, circle):
        _, x, y = circle(self.middle)
        w, h = self.columns.extent, self.rows.extent
        return Scale((4 * ((abs(x) >> 4) * w + (abs(y) >> 4) * h) + w * w + h * h) // 8 + 24)

    def distances(self, circle, scale=None):
        """How far the middles of the cells are outside a circle, which is a function of the place it is seen from."""
        scale = scale or self.scale(circle)
        power, x, y = circle(self.middle)
        power = keep_within(-(1 << 30), power >> scale.shift, 1 << 30)
        base = keep_within(-8192, power * scale.factor >> 21, 8192)
        across, along = self.columns.distances(base, x, scale), self.rows.distances(0, y, scale)
        return {(i, j): int16(across[i] + along[j]) for i, j in self.ALL}


class Chance:
    """Chance of being first."""

    CERTAIN = 511

    def __init__(self, candidate, density):
        chord = candidate.chord
        k1, k0 = chord.own, chord.behind if chord.apex else min(chord.own, 0) - 2048
        self.behind = chord.circle(k0)
        rate = exp2(log2(chord.squared_length()) + density + 135 + 4096)
        nodes = [self.at(segment(k1 + ((k0 - k1) * i >> 2)) - segment(k0), rate) for i in range(4)]
        nodes.append(self.CERTAIN)
        self.table = [
            (8 * left + (right - left) * j) >> 3 for left, right in zip(nodes, nodes[1:]) for j in range(8)
        ]

    def at(self, swept, rate):
        loss = max(0, swept) * rate >> 25
        return exp2(3840 - loss) * 511 >> 15 if loss < 3840 else 0

    def is_level(self):
        return self.table[0] >= 256

    def of_cells(self, grid, scale, distances):
        if self.is_level():
            return dict.fromkeys(grid.ALL, self.CERTAIN)
        behind = grid.distances(self.behind, scale)
        return {cell: self.between(behind[cell], -distances[cell]) for cell in grid.ALL}

    def between(self, outside_behind, inside):
        left = keep_within(0, inside, 16383)
        return self.table[32 * left // (keep_within(1, outside_behind, 16383) + left)]


def cut(weights, distances):
    return {cell: w * keep_within(0, distances[cell] + 32, 63) >> 6 for cell, w in weights.items()}


class Repulsion:
    """Of the candidate's corners, in sixteenths of the distance that counts."""

    def __init__(self, candidate, box, density, crowding):
        longer = highest_bit((box.columns - 1) | (box.rows - 1) | 1)
        self.unit = min(exp2(divide(log2(crowding) - 2048 + density, 2) + 4864), 1 << (27 - longer))
        self.corners = (candidate.v, candidate.c, candidate.a)
        self.nearest = 0

    def seen_from(self, middle):
        return [tuple((2 * at - m) * self.unit >> 16 for at, m in zip(p, middle)) for p in self.corners]

    def is_felt(self):
        return self.nearest < 512

    def scaled_middles(self, slices):
        return [m * (4 * self.unit >> slices.unit) >> 16 for m in slices.middles]

    def near_cells(self, grid):
        xs, ys = self.scaled_middles(grid.columns), self.scaled_middles(grid.rows)
        near = dict.fromkeys(grid.ALL, 512)
        corners = [
            (x, y)
            for x, y in self.seen_from(grid.middle)
            if xs[0] - 23 <= x <= xs[3] + 23 and ys[0] - 23 <= y <= ys[3] + 23
        ]
        for (i, j), (x, y) in itertools.product(grid.ALL, corners):
            dx, dy = (keep_within(-127, d, 127) for d in (xs[i] - x, ys[j] - y))
            near[i, j] = min(near[i, j], dx * dx + dy * dy)
        return near, bool(corners)

    def applied_to(self, weights, grid):
        self.near, is_any_near = self.near_cells(grid)
        if not is_any_near:
            return weights
        return {cell: w * min(self.near[cell], 255) >> 8 for cell, w in weights.items()}

    def follow(self, column, row):
        if self.is_felt():
            self.nearest = self.near[column, row]

    def crowding_after(self, crowding):
        if self.nearest < 256:
            crowding += crowding >> 4
        return keep_within(512, crowding - 12, 65536)


class Weights:
    def __init__(self, candidate, density, repulsion):
        self.circle = candidate.chord.circle(candidate.chord.own)
        self.chance = Chance(candidate, density)
        self.behind = [side.circle(side.behind) for side in candidate.sides if side.has_circle_behind()]
        self.repulsion = repulsion

    def of_cells(self, grid):
        """The weights by cell, and the distances from the circles behind."""
        scale = grid.scale(self.circle)
        own = grid.distances(self.circle, scale)
        chances = self.chance.of_cells(grid, scale, own)
        weights = {cell: keep_within(0, 32 - own[cell], 64) * chances[cell] for cell in grid.ALL}
        distances = [grid.distances(behind) for behind in self.behind]
        for outside in distances:
            weights = cut(weights, outside)
        if self.repulsion and self.repulsion.is_felt():
            weights = self.repulsion.applied_to(weights, grid)
        return weights, distances

    def forget_far_circles(self, distances, cell):
        self.behind = [behind for behind, outside in zip(self.behind, distances) if outside[cell] < 64]


def decode_half(coder, row, low, high):
    if low == 0 or high == 0:
        return int(low == 0)
    s = max(0, highest_bit(low + high) - 16)
    estimate = ((high >> s) << 15) // (((low + high) >> s) + 1)
    return decode_between(coder, row, estimate >> 12, estimate >> 4 & 255)


def decode_one_of_four(coder, rows, weights):
    upper = decode_half(coder, rows[0], sum(weights[:2]), sum(weights[2:]))
    pair = weights[2 * upper : 2 * upper + 2]
    return 2 * upper + decode_half(coder, rows[1], *pair)


def decode_cell(coder, rows, weights, box):
    grid = Grid(box)
    shares, distances = weights.of_cells(grid)
    widths, heights = grid.columns.sizes, grid.rows.sizes
    cells = [[(shares[i, j] + 32) * heights[j] for j in range(4)] for i in range(4)]
    column = decode_one_of_four(coder, rows[:2], [sum(cells[i]) * widths[i] for i in range(4)])
    row = decode_one_of_four(coder, rows[2:], cells[column])
    weights.forget_far_circles(distances, (column, row))
    if weights.repulsion:
        weights.repulsion.follow(column, row)
    return box.cell(column, row)


def decode_place_in_triangle(coder, models, candidate, density, header):
    box = first_box(candidate, header.columns, header.rows)
    repulsion = Repulsion(candidate, box, density, models.crowding) if header.heights_are_sent else None
    weights = Weights(candidate, density, repulsion)
    for _ in range(header.levels):
        if box.is_point():
            break
        box = decode_cell(coder, models.cell, weights, box)
    if repulsion:
        models.crowding = repulsion.crowding_after(models.crowding)
    x = box.x + coder.uniform(box.columns)
    return x, box.y + coder.uniform(box.rows)


class Neighbour(NamedTuple):
    place: tuple
    height: int
    residual: int


class Expectation(NamedTuple):
    """What is known of a height before it is decoded."""

    height: int
    scale: int
    tendency: int

    @classmethod
    def from_ring(cls, b, ring):
        distances = [cls.distance(minus(n.place, b)) for n in ring]
        first, base = distances[0], ring[0].height
        weights = [512 >> max(0, e + 4 - first) for e in distances]
        heights = [w * (n.height - base) for w, n in zip(weights, ring)]
        residuals = [w * n.residual for w, n in zip(weights, ring)]
        w, height = sum(weights), sum(heights)
        mean = (2 * height + w) // (2 * w)
        spread = sum(map(abs, heights))
        roughness = sum(map(abs, residuals))
        level = log2(4 * roughness + w) + 2 * log2(4 * spread + w) - 3 * log2(w)
        scale = min(11, (level + 32 * (14 + first - highest_bit(w)) + 320) // 768)
        sign = cls.expected_sign(sum(residuals), roughness)
        return cls(base + mean, scale, 2 * sign + (height > mean * w))

    @staticmethod
    def distance(d):
        return highest_bit(max(1, d[0] * d[0] // 2 + d[1] * d[1] // 2))

    @staticmethod
    def expected_sign(residual, roughness):
        size = 5 * abs(residual)
        strength = (size > roughness) + (size > 3 * roughness)
        return 2 - strength if residual < 0 else 2 + strength


def decode_difference(coder, models, expectation):
    scale = expectation.scale
    size = decode_magnitude(coder, models.height[scale], models.second, scale // 2)
    if size == 0:
        return 0
    negative = models.negative[expectation.tendency][min(size, 3) - 1].decode(coder)
    return -size if negative else size


# Sections 5 and 6: symbols and the walk


class Decoder:
    def __init__(self, header, coder):
        self.header = header
        self.coder = coder
        self.models = Models()
        self.heights = []
        self.residuals = []
        self.work = 0
        self.mesh = self.decode_seed()

    def decode_seed(self):
        seed = []
        for i in range(SEED_SIZE):
            seed.append(tuple(decode_outer_coordinate(self.coder, n) for n in (self.header.columns, self.header.rows)))
            self.decode_height(Expectation(self.heights[-1] if i > 0 else 0, 11, 5))
            self.residuals[i] = 4
        require(seed[0] < min(seed[1:]), "seed does not begin with its smallest vertex")
        require(twice_area(*seed) > 0, "seed is not counter-clockwise")
        return Mesh(seed)

    def size(self):
        return len(self.mesh.points)

    def decode_batch_size(self):
        left = self.header.vertices - self.size()
        if not self.coder.bit(16384):
            return left
        high = self.coder.uniform((left >> 16) + 1)
        batch = (high << 16) + self.coder.uniform(min(left, 65536))
        require(1 <= batch < left, "size of batch is out of bounds")
        return batch

    def decode_phase(self):
        batch = self.decode_batch_size()
        self.goal = self.size() + batch
        self.work += self.goal
        require(self.work <= 4 * self.goal + 512, "phases add too few vertices")
        self.density = Density(self.header, self.goal, batch)
        self.walk()

    def walk(self):
        self.queued = {0, INFINITY}
        self.done = set()
        queue = deque()
        chord = self.mesh.half_edge_between(0, INFINITY)
        while True:
            chord = self.take_turn(chord, queue)
            if self.size() == self.goal:
                return
            v = self.mesh.end(chord)
            self.done.add(v)
            if v == INFINITY:
                queue.appendleft(self.mesh.twin[chord])
            require(queue, "walk ends before its phase")
            chord = queue.popleft()

    def take_turn(self, chord, queue):
        began_with = self.mesh.start[chord]
        while True:
            chord = self.take_step(chord)
            w = self.mesh.start[chord]
            if self.size() == self.goal or w == began_with:
                return chord
            if w not in self.queued:
                self.queued.add(w)
                queue.append(self.mesh.twin[chord])

    def take_step(self, chord):
        place = None if self.is_certified(chord) else self.decode_hit(chord)
        if place is None:
            return self.mesh.twin[after(chord)]
        behind = self.mesh.twin[chord]
        self.decode_vertex(chord, place)
        beside_b = self.mesh.twin[behind]
        self.note_final(beside_b // 3)
        return self.mesh.twin[after(beside_b)]

    def is_certified(self, chord):
        return self.mesh.start[chord] in self.done or self.mesh.apex(chord) in self.done

    def is_final(self, triangle):
        return not self.done.isdisjoint(self.mesh.corners(triangle))

    def note_final(self, triangle):
        if not self.mesh.is_ghost(triangle):
            self.density.add(twice_area(*self.mesh.places(self.mesh.corners(triangle))))

    def decode_hit(self, chord):
        """The place of a hit, None for a miss."""
        if self.mesh.end(chord) == INFINITY:
            return self.decode_hit_around_infinity(chord)
        place = self.decode_hit_elsewhere(chord)
        if place is None:
            self.note_final(chord // 3)
        return place

    def decode_hit_around_infinity(self, chord):
        a, c = self.mesh.places((self.mesh.start[chord], self.mesh.apex(chord)))
        edge, density = HullEdge(self.header, a, c), self.density.value()
        if not edge.decode_hit(self.coder, self.models, density):
            return None
        return edge.decode_place(self.coder, self.models, density)

    def decode_hit_elsewhere(self, chord):
        candidate = Candidate(self.mesh, chord, self.is_final)
        density = self.density.value()
        position = log2(candidate.free_area()) - 2048 + density + 1536
        curve = candidate.sides[0].certified + 2 * candidate.sides[1].certified
        if self.mesh.apex(chord) not in self.queued:
            degree = self.mesh.degree(before(chord))
            curve = 4 if degree < self.header.degree + 2 else 5
            if degree <= self.header.degree:
                position = 15 * 256
        if not decode_on_curve(self.coder, self.models.hit[curve], position):
            return None
        return decode_place_in_triangle(self.coder, self.models, candidate, density, self.header)

    def decode_vertex(self, chord, place):
        cavity, boundary = self.legal_cavity(chord, place)
        self.decode_height(self.expectation(place, [self.mesh.start[e] for e in boundary]))
        self.mesh.insert(place, cavity, boundary)

    def legal_cavity(self, chord, place):
        triangle, behind = chord // 3, self.mesh.twin[chord] // 3
        corners = [vertex for vertex in self.mesh.corners(triangle) if vertex != INFINITY]
        require(place not in self.mesh.places(corners), "vertex is a corner of its triangle")
        require(place > self.mesh.points[0], "vertex is smaller than vertex 0")
        require(self.mesh.in_conflict(triangle, place), "vertex is not in conflict with its triangle")

        def may_cross(half_edge, size):
            next_triangle = self.mesh.twin[half_edge] // 3
            return (
                size < self.header.degree - 2 and next_triangle != behind and not self.is_final(next_triangle)
            )

        return self.mesh.explore_cavity(chord, place, may_cross)

    def expectation(self, place, ring):
        neighbours = [
            Neighbour(self.mesh.points[w], self.heights[w], self.residuals[w]) for w in ring if w != INFINITY
        ]
        return Expectation.from_ring(place, neighbours)

    def decode_height(self, expectation):
        height = difference = 0
        if self.header.heights_are_sent:
            difference = decode_difference(self.coder, self.models, expectation)
            height = expectation.height + difference
            require(-32768 <= height <= 32767, "height is out of bounds")
        self.heights.append(height)
        self.residuals.append(keep_within(-127, difference, 127))

    def decode_voids(self):
        """The triangles that are void."""
        voids = set()
        for triangle in self.mesh.real_triangles():
            neighbours = [e // 3 for e in self.mesh.twin[3 * triangle : 3 * triangle + 3]]
            known = [t for t in neighbours if t < triangle and not self.mesh.is_ghost(t)]
            context = 3 + sum(1 if t in voids else -1 for t in known)
            if self.models.void[context].decode(self.coder):
                voids.add(triangle)
        return voids


def decode_stream(data):
    reader = ByteReader(data)
    header = read_header(reader)
    decoder = Decoder(header, reader.section())
    while decoder.size() < header.vertices:
        decoder.decode_phase()
        if FIRST_SECTION_VERTICES <= decoder.size() < header.vertices:
            decoder.coder.finish()
            decoder.coder = reader.section()
    voids = decoder.decode_voids() if header.void_flags_are_sent else set()
    decoder.coder.finish()
    return decoder, voids


# Section 11: digest


def fnv1a(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return value


def digest(mesh, heights, voids):
    total = 0
    for triangle in mesh.real_triangles():
        corners = mesh.corners(triangle)
        smallest = corners.index(min(corners, key=lambda vertex: mesh.points[vertex]))
        words = []
        for vertex in corners[smallest:] + corners[:smallest]:
            words += [*mesh.points[vertex], heights[vertex] & 65535]
        words.append(int(triangle in voids))
        total += fnv1a(b"".join(word.to_bytes(2, "little") for word in words))
    return total % 2**64


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: reference_decoder.py FILE.mtin")
    with open(sys.argv[1], "rb") as file:
        data = file.read()
    try:
        decoder, voids = decode_stream(data)
    except Malformed as complaint:
        sys.exit(f"malformed stream: {complaint}")
    print("digest %016x" % digest(decoder.mesh, decoder.heights, voids))
    for (x, y), z in zip(decoder.mesh.points, decoder.heights):
        print(x, y, z)


if __name__ == "__main__":
    main()
