#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A slow second decoder of microtin streams, written from shared/docs/format-stream.md and not from the C++ code.

Usage: reference_decoder.py FILE.mtin

Prints the digest of the mesh, then x, y and z of each vertex in decoded order. Section numbers in this file
are those of shared/docs/format-stream.md; names are its names wherever it has any.
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


def rlog(v):
    """Straight between powers of two."""
    return 256 * highest_bit(v) + ((v << 8 >> highest_bit(v)) & 255)


def rexp(exponent):
    return (256 + (exponent & 255)) << 23 >> (31 - (exponent >> 8)) if exponent >= 0 else 0


def rough_root(v):
    half = highest_bit(v | 1) >> 1
    guess = (11 * ((2 << half) + (v >> half)) >> 5) + 1
    return (guess + v // guess) >> 1


ONE = 4096  # a cotangent of 1


def cotangent(q, h, most):
    s = max(0, highest_bit(h) - 11)
    h >>= s
    return divide(ONE * keep_within(-most * h, q >> s, most * h), h)


def segment(square, k):
    """Twice its area."""
    j = k >> 4
    size = abs(j)
    minor = ((square >> 4) * ((size + 188) * 174763 // (size * (size + 188) + 20643))) >> 7
    if j <= 0:
        return minor
    i = min(size, 2048)
    return (square >> 8) * ((65536 + i * i) * 201 >> 15) - minor


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
        number = self.part(self.range, count)
        require(number is not None, "uniform number is too large")
        return number

    def uniform_or_escape(self, count):
        """None is an escape."""
        return self.part(self.range - (self.range >> 10), count)

    def part(self, width, count):
        size = width // count
        number = self.code // size
        if number < count:
            self.code -= number * size
            self.range = size
        else:
            self.code -= count * size
            self.range -= count * size
            number = None
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
    decoding: int
    vertices: int
    columns: int
    rows: int
    odd_origin: tuple


def read_header(reader):
    require(reader.take(4) == b"mtin", "not a microtin stream")
    require(reader.number(1) == 6, "unknown version")
    payload = ByteReader(reader.take(reader.length()))
    reader.expect_check(0)
    properties = payload.varint()
    require(properties < 1 << 14, "unknown properties")
    vertices = payload.varint()
    columns, rows = payload.varint() + 1, payload.varint() + 1
    decoding, degree = properties >> 3 & 3, properties >> 5 & 63
    require(6 <= degree <= 32, "degree is out of bounds")
    require(decoding != 0, "decoding is none of the three")
    require(3 <= vertices <= 1 << 24, "number of vertices is out of bounds")
    require(max(columns, rows) <= 1 << 16, "a side is out of bounds")
    if properties & 8192:
        for _ in ("below", "above"):
            require(payload.varint() <= (1 << 20) + 1, "margin")
    if properties & 4:
        check_placement(payload)
    odd_origin = properties >> 11 & 1, properties >> 12 & 1
    return Header(bool(properties & 1), bool(properties & 2), degree, decoding, vertices, columns, rows, odd_origin)


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
    """The numbers at the end of format-stream.md."""
    text = (Path(__file__).parent.parent / "shared" / "docs" / "format-stream.md").read_text(encoding="utf-8")
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
        self.column, self.row = bits(4, 9), bits(4, 9)
        self.quick_column, self.quick_row = bits(16, 3), bits(12, 3)
        self.height = bits(12, 7)
        self.second = bits(10)
        self.negative = bits(10, 3)
        self.gap = bits(7)
        self.void = bits(7)
        self.crowding = 2048
        self.tallies = [Tally(), Tally()]
        self.next_tallies = [[Tally(), Tally()], [Tally(), Tally()]]


class Tally:
    """Of lines, even and odd ones."""

    def __init__(self):
        self.met = [1, 1]

    def prefers_one(self):
        return max(self.met) > 2 * min(self.met)

    def learn(self, odd):
        self.met[odd] += 1
        if sum(self.met) > 512:
            self.met = [(count + 1) >> 1 for count in self.met]

    def decode_odd(self, coder, lines):
        """Of lines that count from an even one."""
        even, odd = self.met
        n = lines.count()
        if n % 2 == 1 and n < 32:
            even *= lines.count_of_parity(0)
            odd *= lines.count_of_parity(1)
        return coder.bit(keep_within(64, (odd << 15) // (even + odd), 32704))


class Ruling:
    """What is left of lines once a parity may have been decoded: number i is line step * i + base."""

    def __init__(self, coder, tally, lines, odd_origin):
        self.numbers, self.step, self.base = lines, 1, 0
        if lines.count() > 1 and tally.prefers_one():
            odd = tally.decode_odd(coder, lines.moved(odd_origin))
            self.step, self.base = 2, odd - odd_origin
            self.numbers = Lines(-((self.base - lines.first) // 2), (lines.last - self.base) // 2)

    def line(self, number):
        return self.step * number + self.base


class Density:
    def __init__(self, header, vertices, batch):
        self.share = log2(batch) - log2(vertices) - 220
        self.mean = 256 * (log2(batch) - log2(header.columns * header.rows))

    def value(self):
        return self.mean >> 8

    def add(self, area):
        self.mean += (256 * (self.share - rlog(area)) - self.mean) >> 4


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
        axis = 0 if self.d[1] == 0 else 1
        odd = (self.a[axis] + self.header.odd_origin[axis]) % 2
        tally = models.tallies[axis]
        ruling = Ruling(coder, tally, Lines(1, self.length() - 1), odd)
        typical = max(0, max(0, -density) // 512 - (ruling.step - 1))
        number = ruling.numbers.first + decode_magnitude(coder, models.gap, models.second, typical)
        require(number <= ruling.numbers.last, "vertex is beyond its hull edge")
        k = ruling.line(number)
        tally.learn((k + odd) % 2)
        return tuple(at + k * (d // self.length()) for at, d in zip(self.a, self.d))


def decode_outer_coordinate(coder, count):
    """Likely to be the smallest or the largest."""
    if coder.bit(24576):
        return (count - 1) * coder.bit(16384)
    return coder.uniform(count)


def shifted(p, by):
    """Coordinates times a power of two, rounded down."""
    return tuple(at << by if by >= 0 else at >> -by for at in p)


class Side(NamedTuple):
    certified: bool
    apex: tuple  # as seen from v; None behind a hull edge


class Candidate:
    """The triangle of a chord that is not certified, in grains as seen from v."""

    def __init__(self, mesh, chord, is_final):
        half_edges = [after(chord), before(chord), chord]
        self.v, c, a = mesh.places([mesh.start[e] for e in half_edges])
        self.a = minus(a, self.v)
        offsets = minus(c, self.v), self.a
        self.sides = [self.side(mesh, e, e == chord or is_final(mesh.twin[e] // 3)) for e in half_edges]
        self.shift = 10 - highest_bit(max(abs(at) for p in offsets for at in p))
        self.C, self.A = (shifted(p, self.shift) for p in offsets)
        self.cc, self.aa, self.ca = dot(self.C, self.C), dot(self.A, self.A), dot(self.C, self.A)
        self.T = max(1, cross(self.C, self.A))
        self.behind = {0: self.cotangent_behind(0, self.C, -1), 2: self.cotangent_behind(2, self.A, 1)}

    def side(self, mesh, half_edge, certified):
        apex = mesh.apex(mesh.twin[half_edge])
        return Side(certified, None if apex == INFINITY else minus(mesh.points[apex], self.v))

    def cotangent_behind(self, number, end, sign):
        """None where no circle is known."""
        side = self.sides[number]
        if not side.certified or side.apex is None:
            return None
        m = max(0, highest_bit(abs(side.apex[0]) | abs(side.apex[1])) + self.shift - 10)
        d, e = shifted(side.apex, self.shift - m), shifted(end, -m)
        return cotangent(dot(d, minus(e, d)), max(1, sign * cross(e, d) >> m), 16)

    def expected_points(self, density):
        """A logarithm."""
        free = self.T
        if not self.sides[0].certified:
            free += segment(self.cc, cotangent(self.ca - self.aa, self.T, 4))
        if not self.sides[1].certified:
            free += segment(self.cc + self.aa - 2 * self.ca, cotangent(-self.ca, self.T, 4))
        for number, square in ((0, self.cc), (2, self.aa)):
            if self.behind[number] is not None:
                free -= segment(square, self.behind[number])
        return rlog(max(free, (self.T >> 4) + 1)) - 256 * (2 * self.shift + 1) + density


class Turn:
    """By quarters, such that a place lies in the west."""

    def __init__(self, a):
        if abs(a[0]) >= abs(a[1]):
            self.quarters = 0 if a[0] < 0 else 2
        else:
            self.quarters = 1 if a[1] > 0 else 3

    def __call__(self, p, quarters=None):
        for _ in range(self.quarters if quarters is None else quarters):
            p = (-p[1], p[0])
        return p

    def back(self, p):
        return self(p, (4 - self.quarters) % 4)


class Circle:
    """Through v."""

    def __init__(self, end, k, f):
        self.x2 = (end[0] + (k * end[1] >> 12)) >> f
        self.y = (end[1] - (k * end[0] >> 12)) >> (1 + f)

    def square(self, x):
        return x * (self.x2 - x) + self.y * self.y

    def centre(self):
        return self.x2 >> 1, self.y


class Lines(NamedTuple):
    first: int
    last: int

    def count(self):
        return self.last - self.first + 1

    def moved(self, by):
        return Lines(self.first + by, self.last + by)

    def count_of_parity(self, odd):
        return (self.last - odd) // 2 - (self.first - odd - 1) // 2

    def half(self, upper):
        middle = self.first + self.count() // 2
        return Lines(middle, self.last) if upper else Lines(self.first, middle - 1)

    def kept_within(self, first, last):
        """At least one line of first .. last."""
        low = keep_within(first, self.first, last)
        return Lines(low, max(low, min(self.last, last)))


class Sweep:
    """Chance of being first."""

    def __init__(self, candidate, a, f, k1, k0, density):
        def swept(k):
            return segment(candidate.aa, k) - segment(candidate.aa, k0)

        self.rate = density - 256 * (2 * candidate.shift + 1) + 2134
        third = divide(k1 - k0, 3)
        self.nodes = [self.left(swept(k1 - i * third)) for i in range(3)] + [511]
        self.across = ((k1 - k0) * a[1] >> (12 + f), (k0 - k1) * a[0] >> (12 + f))

    def left(self, u):
        if u <= 0:
            return 511
        loss = rlog(u) + self.rate
        return 0 if loss >= 3072 else rexp(2303 - rexp(loss))

    def chance(self, x, y, own):
        whole = dot(self.across, (x, y))
        low, high = own
        w = (high - y) * (y - low) % 2**32 // ((whole % 2**32 >> 8) + 1)
        if w >= 256:
            return 511
        i, way = divmod(3 * w, 256)
        return self.nodes[i] + ((self.nodes[i + 1] - self.nodes[i]) * way >> 8)


class Repulsion:
    def __init__(self, corners, s, density, crowding):
        self.corners = corners
        exponent = keep_within(512, 512 * s + 2048 - rlog(crowding) - density, 7168)
        self.reach = rexp(exponent)
        self.z = max(0, (exponent >> 8) - 14)
        self.factor = 255 * 65536 // (self.reach >> self.z)

    def apart(self, x, y):
        d = min([self.reach] + [dot(p, p) for p in (minus((x, y), corner) for corner in self.corners)])
        return ((d >> self.z) * self.factor) >> 16


class PlaceDecoder:
    QUICK, DENSE = 1, 3

    def __init__(self, coder, models, candidate, density, header):
        self.coder, self.models, self.candidate, self.header = coder, models, candidate, header
        self.turn = Turn(candidate.a)
        c, a = self.turn(candidate.C), self.turn(candidate.A)
        behind, self.next_behind = candidate.behind[2], candidate.behind[0]
        k1 = cotangent(candidate.cc - candidate.ca, candidate.T, 64)
        k0 = min(k1, -4 * ONE if behind is None else behind)
        whole = Circle(a, k1, 0)
        f = max(0, highest_bit(abs(whole.x2 >> 1) | abs(whole.y) | 1) - 12)
        self.s = candidate.shift - f
        self.own = Circle(a, k1, f)
        self.cutting = []
        if behind is not None and behind > -16 * ONE:
            self.cutting.append(Circle(a, k0, f))
        if self.next_behind is not None and self.next_behind > -16 * ONE:
            self.cutting.append(Circle(c, -self.next_behind, f))
        self.c, self.a = shifted(c, -f), shifted(a, -f)
        first = self.turn(minus((0, 0), candidate.v))
        last = self.turn(minus((header.columns - 1, header.rows - 1), candidate.v))
        self.columns, self.rows = (Lines(*sorted(ends)) for ends in zip(first, last))
        axis = self.turn.quarters % 2
        odd = [(at + odd) % 2 for at, odd in zip(candidate.v, header.odd_origin)]
        self.odd = odd[axis], odd[1 - axis]
        self.tally, self.next_tallies = models.tallies[axis], models.next_tallies[axis]
        self.repulsion = None
        if header.decoding != self.QUICK:
            self.sweep = Sweep(candidate, a, f, k1, k0, density)
            if header.heights_are_sent:
                self.repulsion = Repulsion([(0, 0), self.c, self.a], self.s, density, models.crowding)

    def grain(self, doubled):
        return shifted((doubled,), self.s - 1)[0]

    def lines(self, low, high):
        if self.s >= 0:
            return Lines((low + (1 << self.s) - 1) >> self.s, high >> self.s)
        return Lines(low << -self.s, ((high + 1) << -self.s) - 1)

    def is_open(self, end):
        def is_beyond(p, q):
            return cross(minus(q, p), minus(end, p)) < 0

        v, sides = (0, 0), self.candidate.sides
        return not (
            is_beyond(self.a, v)
            or (sides[0].certified and is_beyond(v, self.c))
            or (sides[1].certified and is_beyond(self.c, self.a))
        )

    def legal_columns(self):
        """And whether they are open in the west and in the east."""
        x, y = self.own.centre()
        radius = rough_root(x * x + y * y | 1) + 1
        west, east = [self.c[0], self.a[0]], [self.c[0], 0]
        is_open = [self.is_open((end, y)) for end in (x - radius, x + radius)]
        if is_open[0]:
            west.append(x - radius)
        if is_open[1]:
            east.append(x + radius)
        lines = self.lines(min(west), max(east))
        return Lines(max(lines.first, self.columns.first), min(lines.last, self.columns.last)), *is_open

    def spans(self, x, wider):
        """What the own circle covers, and what is legal of it."""
        r = (rough_root(self.own.square(x)) if self.own.square(x) > 0 else 0) + wider
        own = low, high = self.own.y - r, self.own.y + r
        for circle in self.cutting:
            if circle.square(x) <= 0:
                continue
            r = rough_root(circle.square(x))
            if wider:
                r -= (r >> 11) + 1
            begin, end = circle.y - r, circle.y + r
            if begin <= low:
                low = max(low, end)
            elif end >= high and begin < high:
                high = begin
        return own, (low, high)

    def place_weight(self, x, y, own):
        chance = self.sweep.chance(x, y, own)
        if self.repulsion:
            chance = chance * (self.repulsion.apart(x, y) + 4) >> 8
        return chance + 4

    def column_weight(self, x):
        own, (low, high) = self.spans(x, 0)
        length = high - low
        if length <= 0:
            return 4
        eighth = length >> 3
        both = self.place_weight(x, low + eighth, own) + self.place_weight(x, high - eighth, own)
        return (length * both >> 10) + 4

    def decode_quarter(self, bits, lines):
        if lines.count() < 4:
            return lines
        upper = bits[0].decode(self.coder)
        lines = lines.half(upper)
        return lines.half(bits[2 if upper else 1].decode(self.coder))

    def decode_halves(self, calibrations, ruling, weigh):
        lines = ruling.numbers
        weighed = (5 if self.header.decoding == self.DENSE else 3) - (calibrations is self.models.row)
        before = kept = 0
        for time, row in enumerate(calibrations):
            if lines.count() < 2:
                break
            n, half = lines.count(), lines.count() >> 1
            middle = 2 * lines.first + half - 1
            grains = [self.grain(ruling.line(at) + ruling.base) for at in (middle, middle + n)]
            if time < 2:
                low, high = (weigh(at) for at in grains)
            else:
                inner = (kept + before) >> 1
                if time < weighed:
                    outer = weigh(grains[upper])
                else:
                    outer = max(2 * kept - inner, (kept >> 2) + 1)
                low, high = (inner, outer) if upper else (outer, inner)
            below, above = (low * half, high * (n - half)) if n < 32 else (low, high)
            estimate = (above << 11) // (below + above + 1)
            upper = decode_between(self.coder, row, estimate >> 8, estimate & 255)
            lines = lines.half(upper)
            before, kept = kept, high if upper else low
        return lines

    def decode_any(self, lines):
        return lines.first + self.coder.uniform(lines.count())

    def decode_line(self, ruling, left):
        """None if it is none of these."""
        number = self.coder.uniform_or_escape(left.count())
        return None if number is None else ruling.line(left.first + number)

    def decode_column(self, n):
        lines, west, east = self.legal_columns()
        ruling = Ruling(self.coder, self.tally, lines, self.odd[0])
        if self.header.decoding == self.QUICK:
            row = (not east) + 2 * (not west) + 4 * self.candidate.sides[0].certified + 8 * (n > 1)
            left = self.decode_quarter(self.models.quick_column[row], ruling.numbers)
        else:
            left = self.decode_halves(self.models.column, ruling, self.column_weight)
        return self.decode_line(ruling, left)

    def decode_row(self, n, column, lines, own):
        x = self.grain(2 * column)
        tally = self.next_tallies[(column + self.odd[0]) % 2]
        ruling = Ruling(self.coder, tally, lines, self.odd[1])
        if self.header.decoding == self.QUICK:
            zone = 4 if x < self.a[0] else 8 if x > 0 else 0
            left = self.decode_quarter(self.models.quick_row[n + zone], ruling.numbers)
        else:
            left = self.decode_halves(self.models.row, ruling, lambda y: self.place_weight(x, y, own))
        row = self.decode_line(ruling, left)
        if row is None:
            return None
        self.tally.learn((column + self.odd[0]) % 2)
        tally.learn((row + self.odd[1]) % 2)
        return row

    def decode(self, expected):
        n = keep_within(0, (expected + 256) >> 8, 3)
        row, column = None, self.decode_column(n)
        if column is not None:
            own, span = self.spans(self.grain(2 * column), 1)
            row = self.decode_row(n, column, self.lines(*span).kept_within(*self.rows), own)
        if row is None:
            place = self.decode_any(self.columns), self.decode_any(self.rows)
        else:
            place = column, row
            self.learn_crowding(place)
        x, y = self.turn.back(place)
        return self.candidate.v[0] + x, self.candidate.v[1] + y

    def learn_crowding(self, place):
        if not self.repulsion:
            return
        crowding = self.models.crowding
        if self.repulsion.apart(*(self.grain(2 * at) for at in place)) < 254:
            crowding += crowding >> 4
        self.models.crowding = keep_within(512, crowding - 12, 65536)


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
        level = rlog(4 * roughness + w) + 2 * rlog(4 * spread + w) - 3 * rlog(w)
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
        require(self.work <= 3 * self.goal + 512, "phases add too few vertices")
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
        expected = candidate.expected_points(density)
        position = expected + 1536
        curve = candidate.sides[0].certified + 2 * candidate.sides[1].certified
        if self.mesh.apex(chord) not in self.queued:
            degree = self.mesh.degree(before(chord))
            curve = 4 if degree < self.header.degree + 2 else 5
            if degree <= self.header.degree:
                position = 15 * 256
        if not decode_on_curve(self.coder, self.models.hit[curve], position):
            return None
        return PlaceDecoder(self.coder, self.models, candidate, density, self.header).decode(expected)

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
