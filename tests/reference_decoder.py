#!/usr/bin/env python3
"""A slow second decoder of microtin streams, written from shared/FORMAT.md and not from the C++ code.

Usage: reference_decoder.py FILE.mtin

Prints the digest of the mesh, then x, y and z of each vertex in decoded order. Section numbers in this file
are those of shared/FORMAT.md; names are its names wherever it has any.
"""

import math
import sys
import zlib
from collections import deque
from typing import NamedTuple

INFINITY = -1
SEED_SIZE = 3
PLACEMENT = 1
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


def half_disc_above(i):
    if i == 32:
        return 0
    k = i / (32 - i)
    return (1 + k * k) * math.atan2(1, k) - k


LOG_TABLE = [round(4096 * math.log2(1 + i / 32)) for i in range(33)]
EXP_TABLE = [round(32768 * (2 ** (i / 32) - 1)) for i in range(33)]
SEGMENT_TABLE = [round(32768 * half_disc_above(i)) for i in range(33)]


def log2(v):
    if v == 0:
        return 0
    b = highest_bit(v)
    m = ((v << 13) >> b) & 8191
    i = m >> 8
    fraction = LOG_TABLE[i] + (((LOG_TABLE[i + 1] - LOG_TABLE[i]) * (m & 255)) >> 8)
    return 256 * b + ((fraction + 8) >> 4)


def exp2(exponent):
    if exponent <= 0:
        return 1
    if exponent >= 62 * 256:
        return 1 << 62
    i, f = (exponent & 255) >> 3, exponent & 7
    mantissa = 32768 + EXP_TABLE[i] + (((EXP_TABLE[i + 1] - EXP_TABLE[i]) * f) >> 3)
    return (mantissa << (exponent >> 8)) >> 15


def disc(c, q, h):
    k = 256 * q // h
    if k >= 32768:
        return 1 << 50
    return min(1 << 50, ((c * ((65536 + k * k) >> 8)) >> 8) * 201)


def segment(c, q, h):
    t = abs(q) * 8192 // (abs(q) + h)
    i = t >> 8
    s = SEGMENT_TABLE[i] - (((SEGMENT_TABLE[i] - SEGMENT_TABLE[i + 1]) * (t & 255)) >> 8)
    small = (c * s) >> 9
    return small if q <= 0 else disc(c, q, h) - small


def rounded_root(u):
    if u == 0:
        return 0
    e = exp2(log2(u) // 2) + 1
    return (e + u // e) // 2 + 1


class Circle:
    """A circle through the point `origin`, by its power X, Y there."""

    LIMIT = 1 << 40

    def __init__(self, origin, x, y):
        self.origin = origin
        self.x = keep_within(-self.LIMIT, x, self.LIMIT)
        self.y = keep_within(-self.LIMIT, y, self.LIMIT)
        shorter, longer = sorted((abs(self.x), abs(self.y)))
        self.steepness = longer + 3 * shorter // 8 + 1

    @classmethod
    def through(cls, p, q, r):
        s, t = minus(q, p), minus(r, p)
        h = cross(s, t)
        return cls(
            p,
            divide(256 * (s[1] * dot(t, t) - t[1] * dot(s, s)), h),
            divide(256 * (t[0] * dot(s, s) - s[0] * dot(t, t)), h),
        )

    def seen_from(self, place):
        """C, X and Y after the origin has moved to place."""
        i, j = minus(place, self.origin)
        power = i * (256 * i + self.x) + j * (256 * j + self.y)
        return power, self.x + 512 * i, self.y + 512 * j


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


def usable(p):
    return keep_within(64, p, 32768 - 64)


class AdaptiveBit:
    def __init__(self, p):
        self.probability = 2 * p
        self.count = 6

    def decode(self, coder):
        bit = coder.bit(usable(self.probability // 2))
        self.learn(bit)
        return bit

    def learn(self, bit):
        s = highest_bit(self.count + 2)
        if bit:
            self.probability += (65535 - self.probability) >> s
        else:
            self.probability -= self.probability >> s
        self.count = min(self.count + 1, 254)


def probability_at(odds):
    p = 32768 * 256 // (exp2(abs(odds) + 2048) + 256)
    return p if odds < 0 else 32768 - p


class Curve:
    def __init__(self, size, odds, step):
        self.row = [AdaptiveBit(probability_at(odds + step * i)) for i in range(size)]

    def decode(self, coder, position):
        last = len(self.row) - 1
        position = keep_within(0, position, 256 * last)
        i = min(position >> 8, last - 1)
        f = position - 256 * i
        left, right = self.row[i], self.row[i + 1]
        bit = coder.bit(usable((left.probability * (256 - f) + right.probability * f) >> 9))
        (left if f < 128 else right).learn(bit)
        return bit


def unary_bits(typical):
    return [AdaptiveBit(24000 if i < typical else 16384 if i == typical else 8000) for i in range(10)]


def second_bits():
    return [AdaptiveBit(14000) for _ in range(10)]


def decode_magnitude(coder, unary, second, limit):
    bits = 0
    while bits < limit and unary[min(bits, 9)].decode(coder):
        bits += 1
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
        value = shift = 0
        while True:
            byte = self.number(1)
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                require(byte > 0 or shift == 7, "varint is not in its shortest form")
                return value

    def expect_check(self, start):
        checked = self.data[start : self.position]
        require(self.number(4) == zlib.crc32(checked), "CRC-32 is wrong")

    def section(self):
        start = self.position
        payload = self.take(self.varint())
        self.expect_check(start)
        return RangeDecoder(payload)


class Header(NamedTuple):
    heights_are_sent: bool
    void_flags_are_sent: bool
    degree: int
    vertices: int
    columns: int
    rows: int


def read_header(reader):
    require(reader.take(4) == b"mtin", "not a microtin stream")
    require(reader.number(1) == 1, "unknown version")
    flags = reader.number(1)
    require(flags < 4, "unknown flags")
    degree = reader.number(1)
    require(6 <= degree <= 32, "degree is out of bounds")
    require(reader.number(1) == 0, "byte 7 is not 0")
    vertices = reader.number(4)
    require(3 <= vertices <= 1 << 24, "number of vertices is out of bounds")
    columns, rows = reader.number(2) + 1, reader.number(2) + 1
    check_blocks(ByteReader(reader.take(reader.number(2))))
    reader.expect_check(0)
    return Header(bool(flags & 1), bool(flags & 2), degree, vertices, columns, rows)


def check_blocks(reader):
    while not reader.is_at_end():
        block_type = reader.number(1)
        content = reader.take(reader.number(2))
        require(block_type < 128, "unknown block that must be known")
        if block_type == PLACEMENT:
            check_placement(ByteReader(content))


def check_placement(reader):
    for _ in range(3):
        require(reader.varint() < 1 << 64, "offset is out of bounds")
        for _ in ("numerator", "denominator"):
            require(1 <= reader.varint() < 1 << 40, "step is out of bounds")
    require(reader.is_at_end(), "placement block is too long")


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


class Models:
    """What the adaptive bits have learnt. It outlives phases and sections."""

    def __init__(self):
        self.hull_hit = AdaptiveBit(16384)
        self.on_edge = AdaptiveBit(16384)
        self.edge_unary, self.edge_second = unary_bits(6), second_bits()
        self.hit = [Curve(29, -1920, 160) for _ in range(4)]
        self.cell = [[Curve(17, -2048, 256) for _ in range(4)] for _ in range(3)]
        self.height_unary = [unary_bits(context // 2) for context in range(12)]
        self.height_second = second_bits()
        self.height_sign = AdaptiveBit(16384)
        self.void = [AdaptiveBit(3000 + 6500 * context) for context in range(5)]


class Density:
    def __init__(self, lattice_points, vertices, batch):
        self.mean_area = 256 * lattice_points // vertices + 1
        self.odds = log2(batch) - log2(vertices)

    def value(self):
        return self.odds - (log2(self.mean_area) - 2048)

    def add(self, area):
        self.mean_area = max(1, self.mean_area + divide(256 * area - self.mean_area, 32))


class Side(NamedTuple):
    start: tuple
    end: tuple
    opposite: tuple
    certified: bool
    apex: tuple  # None behind a hull edge

    def squared_length(self):
        s = minus(self.end, self.start)
        return dot(s, s)

    def segment_inside(self, h):
        return segment(self.squared_length(), -angle_at(self.opposite, self.start, self.end), h)

    def segment_behind(self):
        h = twice_area(self.end, self.start, self.apex)
        return segment(self.squared_length(), -angle_at(self.apex, self.start, self.end), h)

    def circle_behind(self):
        return Circle.through(self.start, self.apex, self.end)

    def is_open_towards(self, place):
        s = minus(self.end, self.start)
        beyond = cross(s, minus(place, self.start)) < 4 * (abs(s[0]) + abs(s[1]))
        return beyond and not self.certified


class Candidate:
    """The triangle of a chord that is not certified, seen from the chord."""

    def __init__(self, mesh, chord, is_final):
        half_edges = [after(chord), before(chord), chord]
        self.v, self.c, self.a = mesh.places([mesh.start[e] for e in half_edges])
        self.h = twice_area(self.v, self.c, self.a)
        self.sides = [self.side(mesh, e, e == chord or is_final(mesh.twin[e] // 3)) for e in half_edges]
        self.chord = self.sides[2]
        self.circle = Circle.through(self.v, self.c, self.a)

    @staticmethod
    def side(mesh, half_edge, certified):
        ends_and_opposite = mesh.start[half_edge], mesh.end(half_edge), mesh.apex(half_edge)
        apex = mesh.apex(mesh.twin[half_edge])
        return Side(*mesh.places(ends_and_opposite), certified, None if apex == INFINITY else mesh.points[apex])

    def certified_sides(self):
        return [side for side in self.sides if side.certified]

    def free_area(self):
        whole = disc(self.chord.squared_length(), abs(angle_at(self.c, self.a, self.v)), self.h)
        free = whole
        for side in self.certified_sides():
            free -= side.segment_inside(self.h)
            if side.apex:
                free -= side.segment_behind()
        return max(free, whole // 256 + 1)

    def is_open_towards(self, place):
        return any(side.is_open_towards(place) for side in self.sides)

    def hit_curve(self):
        return self.sides[0].certified + 2 * self.sides[1].certified


class Box(NamedTuple):
    x: int
    y: int
    columns: int
    rows: int

    def cell(self, column, row):
        left, right = slices(self.columns)[column : column + 2]
        bottom, top = slices(self.rows)[row : row + 2]
        return Box(self.x + left, self.y + bottom, right - left, top - bottom)

    def is_point(self):
        return self.columns == 1 and self.rows == 1


def slices(count):
    return [count * i // 4 for i in range(5)]


def extremes(candidate):
    """The leftmost, rightmost, lowest and highest place of the circle, None if it is too large."""
    x, y = divide(-candidate.circle.x, 512), divide(-candidate.circle.y, 512)
    if max(abs(x), abs(y)) > 131072:
        return None
    radius = rounded_root(x * x + y * y) + 2
    x, y = x + candidate.v[0], y + candidate.v[1]
    return [(x - radius, y), (x + radius, y), (x, y - radius), (x, y + radius)]


def interval(values, count):
    """The first value and the number of values, within a lattice of count values."""
    low, high = (keep_within(0, extreme, count - 1) for extreme in (min(values), max(values)))
    return low, high - low + 1


def first_box(candidate, columns, rows):
    around = extremes(candidate)
    if around is None:
        return Box(0, 0, columns, rows)
    corners = [candidate.v, candidate.c, candidate.a]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    xs += [e[0] for e in around[:2] if candidate.is_open_towards(e)]
    ys += [e[1] for e in around[2:] if candidate.is_open_towards(e)]
    (x, width), (y, height) = interval(xs, columns), interval(ys, rows)
    return Box(x, y, width, height)


def cell_distances(circle, box):
    """Distances of the 4 x 4 cells from the circle, by column and row."""
    power, x, y = circle.seen_from((box.x, box.y))
    ramp = circle.steepness * 5 * (max(box.columns - 4, 0) + max(box.rows - 4, 0)) // 32 + 64
    shift = max(0, highest_bit(ramp) - 15)
    scale = (1 << 29) // (ramp >> shift)

    def along(count, power, slope):
        starts = slices(count)
        for start, end in zip(starts, starts[1:]):
            m = start + end - 1
            here = (power + divide((128 * m + slope) * m, 2)) >> shift
            yield (keep_within(-(1 << 29), here, 1 << 29) * scale) >> 23

    distances_x, distances_y = along(box.columns, power, x), list(along(box.rows, 0, y))
    return [[dx + dy for dy in distances_y] for dx in distances_x]


def share(distance):
    return keep_within(0, distance + 32, 64)


class Chance:
    """Chance of being first."""

    CERTAIN = 4096

    def __init__(self, candidate, density):
        chord = candidate.chord
        k1 = self.cotangent(angle_at(candidate.c, candidate.a, candidate.v), candidate.h)
        if chord.apex:
            h = twice_area(candidate.a, candidate.v, chord.apex)
            k0 = self.cotangent(angle_at(chord.apex, candidate.a, candidate.v), h)
            self.behind = chord.circle_behind()
        else:
            k0 = min(k1, 0) - 2048
            self.behind = self.circle_behind_hull_edge(candidate, k1 - k0)
        self.table = self.chances(chord.squared_length(), k0, k1, density)
        self.scale = min(65535, 256 * candidate.circle.steepness // self.behind.steepness)

    @staticmethod
    def cotangent(q, h):
        return keep_within(-32767, divide(256 * q, h), 32767)

    @staticmethod
    def circle_behind_hull_edge(candidate, k):
        v, a, circle = candidate.v, candidate.a, candidate.circle
        return Circle(v, circle.x + k * (a[1] - v[1]), circle.y + k * (v[0] - a[0]))

    @staticmethod
    def chances(c, k0, k1, density):
        behind = segment(c, k0, 256)
        table = []
        for i in range(9):
            s = segment(c, k0 + divide((k1 - k0) * i, 8), 256) - behind
            loss = exp2(log2(s) + density + 135) if s > 0 else 0
            table.append(exp2(3072 - loss))
        return table

    def is_level(self):
        return self.table[8] >= self.table[0] - self.table[0] // 8

    def of_cells(self, box, level, distances):
        if level == 2 or self.is_level():
            return [[self.CERTAIN] * 4] * 4
        behind = cell_distances(self.behind, box)
        return [[self.at(behind[i][j], -distances[i][j]) for j in range(4)] for i in range(4)]

    def at(self, outside_behind, inside):
        g, rest = (keep_within(0, d, 1 << 14) for d in (outside_behind, inside))
        u = 256 * g // (g + (rest * self.scale >> 8) + 1)
        i, f = u >> 5, u & 31
        return (self.table[i] * (32 - f) + self.table[i + 1] * f) >> 5


class Weights:
    def __init__(self, candidate, density):
        self.circle = candidate.circle
        self.chance = Chance(candidate, density)
        self.circles_behind = [side.circle_behind() for side in candidate.certified_sides() if side.apex]

    def of_cells(self, box, level):
        distances = cell_distances(self.circle, box)
        chances = self.chance.of_cells(box, level, distances)
        weights = [
            [self.first_weight(box, box.cell(i, j), -distances[i][j], chances[i][j]) for j in range(4)]
            for i in range(4)
        ]
        self.circles_behind = [c for c in self.circles_behind if self.take_away(c, box, weights)]
        return weights

    @staticmethod
    def first_weight(box, cell, depth, chance):
        if cell.columns == 0 or cell.rows == 0:
            return 0
        width = cell.columns if box.columns <= 64 else 1
        height = cell.rows if box.rows <= 64 else 1
        return share(depth) * chance * width * height + 1

    @staticmethod
    def take_away(circle, box, weights):
        """Takes what lies in the circle from the weights. Whether later levels have to look at it."""
        distances = cell_distances(circle, box)
        for i in range(4):
            for j in range(4):
                kept = share(distances[i][j])
                if weights[i][j] and kept < 64:
                    weights[i][j] = (weights[i][j] >> 6) * kept + 1
        return any(share(d) < 64 for column in distances for d in column)


def decode_choice(coder, curve, zero, one):
    if zero == 0 or one == 0:
        return int(zero == 0)
    return curve.decode(coder, log2(one) - log2(zero) + 2048)


def decode_one_of_four(coder, curves, weights):
    upper = decode_choice(coder, curves[0], sum(weights[:2]), sum(weights[2:]))
    pair = weights[2 * upper : 2 * upper + 2]
    return 2 * upper + decode_choice(coder, curves[1], *pair)


def decode_place_in_triangle(coder, models, candidate, density, columns, rows):
    box = first_box(candidate, columns, rows)
    weights = Weights(candidate, density)
    for level, curves in enumerate(models.cell):
        if box.is_point():
            break
        cells = weights.of_cells(box, level)
        column = decode_one_of_four(coder, curves[:2], [sum(cells[i]) for i in range(4)])
        row = decode_one_of_four(coder, curves[2:], cells[column])
        box = box.cell(column, row)
    x = box.x + coder.uniform(box.columns)
    return x, box.y + coder.uniform(box.rows)


def decode_place_on_edge(coder, models, a, c, g):
    k = 1 + decode_magnitude(coder, models.edge_unary, models.edge_second, g.bit_length())
    require(k < g, "vertex is beyond its hull edge")
    return (a[0] + k * ((c[0] - a[0]) // g), a[1] + k * ((c[1] - a[1]) // g))


class Ring(NamedTuple):
    """What the vertices around b say of its height."""

    prediction: int
    context: int

    @classmethod
    def around(cls, b, neighbours):
        squared = [dot(s, s) for s in (minus(point, b) for point, _, _ in neighbours)]
        weights = [4096 * min(squared) // d for d in squared]
        total = sum(weights)

        def weighted(values):
            return sum(w * value for w, value in zip(weights, values))

        heights = [height for _, height, _ in neighbours]
        first = next(height for w, height in zip(weights, heights) if w > 0)
        prediction = (2 * weighted(heights) + total) // (2 * total)
        around = weighted([roughness for _, _, roughness in neighbours]) // total
        spread = 4 * weighted([abs(height - first) for height in heights]) // total
        return cls(prediction, min(11, (3 * around + log2(spread + 1) // 64) // 4 // 3))


def decode_difference(coder, models, context):
    difference = decode_magnitude(coder, models.height_unary[context], models.height_second, 17)
    negative = difference and models.height_sign.decode(coder)
    return -difference if negative else difference


def roughness_of(difference):
    return log2(4 * abs(difference) + 1) // 64


# Sections 5 and 6: symbols and the walk


class Decoder:
    def __init__(self, header, coder):
        self.header = header
        self.coder = coder
        self.models = Models()
        self.heights = []
        self.roughness = [16] * SEED_SIZE
        self.work = 0
        self.mesh = self.decode_seed()

    def decode_place_in_lattice(self):
        x = self.coder.uniform(self.header.columns)
        return x, self.coder.uniform(self.header.rows)

    def decode_seed(self):
        seed = []
        for _ in range(SEED_SIZE):
            seed.append(self.decode_place_in_lattice())
            self.heights.append(self.coder.uniform(65536) - 32768 if self.header.heights_are_sent else 0)
        require(seed[0] < min(seed[1:]), "seed does not begin with its smallest vertex")
        require(twice_area(*seed) > 0, "seed is not counter-clockwise")
        return Mesh(seed)

    def size(self):
        return len(self.mesh.points)

    def decode_batch_size(self):
        left = self.header.vertices - self.size()
        if not self.coder.bit(16384):
            return left
        batch = self.coder.uniform((left >> 12) + 1) << 12
        batch += self.coder.uniform(4096)
        require(1 <= batch < left, "size of batch is out of bounds")
        return batch

    def decode_phase(self):
        batch = self.decode_batch_size()
        self.goal = self.size() + batch
        self.work += self.goal
        require(self.work <= 4 * self.header.vertices + 256, "phases add too few vertices")
        self.density = Density(self.header.columns * self.header.rows, self.goal, batch)
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
            self.note_final(chord // 3)
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
        return self.decode_hit_elsewhere(chord)

    def decode_hit_around_infinity(self, chord):
        if not self.models.hull_hit.decode(self.coder):
            return None
        a, c = self.mesh.places((self.mesh.start[chord], self.mesh.apex(chord)))
        g = math.gcd(*minus(c, a))
        if g > 1 and self.models.on_edge.decode(self.coder):
            return decode_place_on_edge(self.coder, self.models, a, c, g)
        return self.decode_place_in_lattice()

    def decode_hit_elsewhere(self, chord):
        candidate = Candidate(self.mesh, chord, self.is_final)
        density = self.density.value()
        position = 2 * (log2(candidate.free_area()) - 2048 + density) + 3072
        if not self.models.hit[candidate.hit_curve()].decode(self.coder, position):
            return None
        size = self.header.columns, self.header.rows
        return decode_place_in_triangle(self.coder, self.models, candidate, density, *size)

    def decode_vertex(self, chord, place):
        cavity, boundary = self.legal_cavity(chord, place)
        self.decode_height(place, [self.mesh.start[e] for e in boundary])
        self.mesh.insert(place, cavity, boundary)

    def legal_cavity(self, chord, place):
        triangle, behind = chord // 3, self.mesh.twin[chord] // 3
        corners = [vertex for vertex in self.mesh.corners(triangle) if vertex != INFINITY]
        require(place not in self.mesh.places(corners), "vertex is a corner of its triangle")
        require(place > self.mesh.points[0], "vertex is smaller than vertex 0")
        require(self.mesh.in_conflict(triangle, place), "vertex is not in conflict with its triangle")
        around_infinity = self.mesh.end(chord) == INFINITY

        def may_cross(half_edge, size):
            next_triangle = self.mesh.twin[half_edge] // 3
            ends = {self.mesh.start[half_edge], self.mesh.end(half_edge)}
            return (
                size < self.header.degree - 2
                and next_triangle != behind
                and not self.is_final(next_triangle)
                and not (around_infinity and ends == {0, INFINITY})
            )

        return self.mesh.explore_cavity(chord, place, may_cross)

    def decode_height(self, place, ring):
        difference = height = 0
        if self.header.heights_are_sent:
            neighbours = [
                (self.mesh.points[w], self.heights[w], self.roughness[w]) for w in ring if w != INFINITY
            ]
            prediction, context = Ring.around(place, neighbours)
            difference = decode_difference(self.coder, self.models, context)
            height = prediction + difference
            require(-32768 <= height <= 32767, "height is out of bounds")
        self.heights.append(height)
        self.roughness.append(roughness_of(difference))

    def decode_voids(self):
        """The triangles that are void."""
        voids = set()
        for triangle in self.mesh.real_triangles():
            neighbours = [e // 3 for e in self.mesh.twin[3 * triangle : 3 * triangle + 3]]
            known = [t for t in neighbours if t < triangle and not self.mesh.is_ghost(t)]
            context = 2 + sum(1 if t in voids else -1 for t in known)
            if self.models.void[keep_within(0, context, 4)].decode(self.coder):
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
