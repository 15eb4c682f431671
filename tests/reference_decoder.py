#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A slow second decoder, written from format-stream.md and format-pack.md alone, for people who learn the formats.

Usage: reference_decoder.py [--lines] FILE

Prints the digest of a stream's mesh, then x, y and z of each vertex in decoded order; for a pack, the digest and vertices of
each tile. With --lines prints class and vertices of each line of a stream instead. Refuses what breaks a rule: prints one line, which begins with the status, and exits with 1. Functions have the
names that the page uses. Comments name its sections.
"""

import sys
import zlib
from collections import deque

sys.dont_write_bytecode = True
from reference_symbols import (Lines, RangeCoder, Refusal, Symbols, Tally, bit, clamp, cot, cross, dot, incircle,  # noqa: E402
                               log2, minus, quotient, require, rexp, rlog, rroot, scaled, segment, turn)

INFINITY = -1                                    # the number of the vertex at infinity
QUICK, BALANCED, DENSE = 1, 2, 3                 # codings (section 4)


# Bytes and headers (section 4)


class Bytes:
    """Reads a file, or a part of it, from front to back."""

    def __init__(self, data, position=0, shortage="truncated"):
        self.data, self.position, self.shortage = data, position, shortage

    def at_end(self):
        return self.position >= len(self.data)

    def take(self, count):
        if self.position + count > len(self.data):
            raise Refusal(self.shortage, "the bytes end too early")
        self.position += count
        return self.data[self.position - count:self.position]

    def number(self, count):
        return int.from_bytes(self.take(count), "little")

    def varint(self, limit=1 << 64):
        """Seven bits in each byte, high bits first; in its shortest form and below the limit."""
        value, first = 0, True
        while True:
            byte = self.take(1)[0]
            require(not (first and byte == 0x80), "a varint is not in its shortest form")
            value = value << 7 | byte & 127
            require(value < limit, "a varint is too large")
            first = False
            if byte < 128:
                return value

    def zigzag(self):
        value = self.varint()
        return value >> 1 if value % 2 == 0 else -(value >> 1) - 1

    def length_and_content(self):
        """A length and as many bytes. A length that breaks a rule counts as 0; the second result then is False."""
        try:
            length = self.varint(1 << 31)
        except Refusal as refusal:
            if refusal.status == "truncated":
                raise
            return b"", False
        return self.take(length), True

    def check(self, begin, what):
        """The CRC-32 of all bytes from begin up to here."""
        crc = zlib.crc32(self.data[begin:self.position])
        if self.number(4) != crc:
            raise Refusal("damaged", "the check of " + what + " fails")


def read_chunks(data):
    """Section 4, Chunks: what follows the last section must be chunks, or the file is damaged. The first of each type."""
    reader, chunks = Bytes(data, 0, "damaged"), {}
    while not reader.at_end():
        begin = reader.position
        try:
            kind = reader.varint(1 << 31)
            content = reader.take(reader.varint(1 << 31))
        except Refusal as refusal:
            raise Refusal("damaged", "no chunk follows the last section") from refusal
        reader.check(begin, "a chunk")
        chunks.setdefault(kind, content)
    return chunks


class Header:
    """Section 4: identity, numbers, placement, notes."""

    def __init__(self, reader):
        begin = reader.position
        if reader.take(4) != b"mtin":
            raise Refusal("foreign", "this is not a microtin stream")
        if reader.take(1) != b"\x06":
            raise Refusal("unsupported", "this version of streams is not known")
        content, length_is_right = reader.length_and_content()
        reader.check(begin, "the header")
        require(length_is_right, "the header's length is malformed")
        self.numbers(Bytes(content, 0, "malformed"))

    def numbers(self, reader):
        properties = reader.varint()
        if properties >= 16384:
            raise Refusal("unsupported", "a property of the stream is not known")
        self.vertices = reader.varint()
        self.largest = (reader.varint(), reader.varint())
        self.coding = properties >> 3 & 3
        if self.coding == 0:
            raise Refusal("unsupported", "the coding of the stream is not known")
        self.heights = properties & 1
        self.voids = properties & 2
        self.placement = properties & 4
        self.degree = properties >> 5 & 63                       # D
        self.odd = (properties >> 11 & 1, properties >> 12 & 1)
        margins = [reader.varint() for _ in range(2)] if properties & 8192 else [0]
        if self.placement:
            read_placement(reader)
        self.notes = reader.data[reader.position:]               # a decoder skips them unread
        require(max(margins) <= (1 << 20) + 1, "a margin is out of range")
        require(6 <= self.degree <= 32, "the largest degree is out of range")
        require(3 <= self.vertices <= 1 << 24, "the number of vertices is out of range")
        require(max(self.largest) <= 65535, "the lattice is too large")


def read_placement(reader):
    """Offset, numerator and denominator of x, y, and z."""
    for _ in range(3):
        reader.zigzag()
        require(1 <= reader.varint() < 1 << 40, "a numerator is out of range")
        require(1 <= reader.varint() < 1 << 40, "a denominator is out of range")


# The mesh (sections 2, 5, 7 and 11)


class Mesh:
    """Triangle t has the half-edges 3t, 3t + 1, 3t + 2, each with its origin and its twin."""

    def __init__(self):
        self.vertices = []                                       # (x, y)
        self.heights = []
        self.residuals = []
        self.origin = []
        self.twin = []

    @staticmethod
    def following(e):
        return e - 2 if e % 3 == 2 else e + 1

    @staticmethod
    def preceding(e):
        return e + 2 if e % 3 == 0 else e - 1

    def corners(self, t):
        return self.origin[3 * t:3 * t + 3]

    def is_real(self, t):
        return INFINITY not in self.corners(t)

    def far_corner(self, e):
        """The corner opposite to e in the triangle of e."""
        return self.origin[self.preceding(e)]

    def join(self, e, f):
        self.twin[e], self.twin[f] = f, e

    def seed(self):
        """Section 7: triangle 0 and the ghosts 1 + i of the half-edges (i + 1 mod 3) -> i -> infinity."""
        self.origin = [0, 1, 2, 1, 0, INFINITY, 2, 1, INFINITY, 0, 2, INFINITY]
        self.twin = [3, 6, 9, 0, 11, 7, 1, 5, 10, 2, 8, 4]

    def half_edge_to_infinity(self, vertex):
        """The half-edge vertex -> infinity."""
        for e in range(len(self.origin)):
            if self.origin[e] == vertex and self.origin[self.following(e)] == INFINITY:
                return e
        raise AssertionError("the vertex is not on the hull")

    def degree(self, e):
        """The number of triangles around the origin of e, ghosts included."""
        count, f = 1, self.twin[self.preceding(e)]
        while f != e:
            count, f = count + 1, self.twin[self.preceding(f)]
        return count

    def in_conflict(self, t, p):
        """Section 2, Ties: is the position p in conflict with the triangle t?"""
        numbers = self.corners(t)
        if INFINITY in numbers:
            i = numbers.index(INFINITY)
            u, w = self.vertices[numbers[i - 2]], self.vertices[numbers[i - 1]]
            side = turn(u, w, p)
            return side > 0 or side == 0 and min(u, w) < p < max(u, w)
        corners = [self.vertices[number] for number in numbers]
        d = incircle(*corners, p)
        if d != 0:
            return d > 0
        largest = max(corners)
        if p > largest:
            return False
        corners[corners.index(largest)] = p
        return turn(*corners) > 0

    def find_cavity(self, chord, b):
        """Section 7: the triangles of the cavity, and the half-edges of its boundary."""
        cavity, boundary = [chord // 3], []
        stack = [self.preceding(chord), self.following(chord), chord]
        while stack:
            e = stack.pop()
            t = self.twin[e] // 3
            if not self.in_conflict(t, b):
                boundary.append(e)
            else:
                cavity.append(t)
                stack += [self.preceding(self.twin[e]), self.following(self.twin[e])]
        return cavity, boundary

    def insert(self, b, cavity, boundary):
        """Section 7: fills the cavity with a fan around b. Returns the half-edge from b to the chord's end."""
        number = len(self.vertices)
        self.vertices.append(b)
        edges = [(self.origin[e], self.origin[self.following(e)], self.twin[e]) for e in boundary]
        new = len(self.origin) // 3
        self.origin += [None] * 6
        self.twin += [None] * 6
        numbers = cavity + [new, new + 1]
        for t, (p, q, outer) in zip(numbers, edges):
            self.origin[3 * t:3 * t + 3] = [p, q, number]
            self.join(3 * t, outer)
        for t, following in zip(numbers, numbers[1:] + numbers[:1]):
            self.join(3 * t + 1, 3 * following + 2)
        return self.twin[3 * numbers[0] + 1]

    def digest(self, void):
        """Section 11."""
        total = 0
        for t in range(len(self.origin) // 3):
            if not self.is_real(t):
                continue
            numbers = self.corners(t)
            first = min(range(3), key=lambda i: self.vertices[numbers[i]])
            data = b""
            for number in numbers[first:] + numbers[:first]:
                for value in self.vertices[number] + (self.heights[number],):
                    data += (value & 65535).to_bytes(2, "little")
            value = 0xCBF29CE484222325
            for byte in data + (1 if t in void else 0).to_bytes(2, "little"):
                value = (value ^ byte) * 0x100000001B3 & (1 << 64) - 1
            total += value
        return total & (1 << 64) - 1

    def height_at(self, p, void):
        """Section 12: the height at p in substeps, with 16 fractional bits; without one, outside or void."""
        result = "outside"
        for t in range(len(self.origin) // 3):
            if not self.is_real(t):
                continue
            a, b, c = ((256 * x, 256 * y) for x, y in (self.vertices[number] for number in self.corners(t)))
            parts = turn(b, c, p), turn(c, a, p), turn(a, b, p)
            if min(parts) < 0:
                continue
            if t not in void:
                weighted = sum(part * self.heights[number] for part, number in zip(parts, self.corners(t)))
                return (2 * 65536 * weighted + sum(parts)) // (2 * sum(parts))
            result = "void"
        return result


# The triangle of a hit, and positions in it (section 10)


class Triangle:
    """Section 10, Elsewhere: the triangle of the chord as seen from v, in grains."""

    def __init__(self, decoder, chord):
        mesh = decoder.mesh
        self.mesh, self.done, self.chord = mesh, decoder.done, chord
        self.density = decoder.R >> 8
        before, after = mesh.preceding(chord), mesh.following(chord)
        self.sides = (after, before, chord)                      # v-c, c-a, a-v
        self.v = mesh.vertices[mesh.origin[after]]
        self.c = minus(mesh.vertices[mesh.origin[before]], self.v)
        self.a = minus(mesh.vertices[mesh.origin[chord]], self.v)
        self.twice_area = cross(self.c, self.a)
        self.S = 10 - bit(max(abs(k) for k in self.c + self.a))
        self.C = (scaled(self.c[0], self.S), scaled(self.c[1], self.S))
        self.A = (scaled(self.a[0], self.S), scaled(self.a[1], self.S))
        self.cc, self.aa, self.ca = dot(self.C, self.C), dot(self.A, self.A), dot(self.C, self.A)
        self.T = max(1, cross(self.C, self.A))
        self.certified = (self.is_certified(0), self.is_certified(1), 1)
        self.behind = (self.circle_behind(0, self.C), None, self.circle_behind(2, self.A))
        self.expected = rlog(self.free_area()) - 256 * (2 * self.S + 1) + self.density

    def is_certified(self, side):
        t = self.mesh.twin[self.sides[side]] // 3
        return int(any(vertex in self.done for vertex in self.mesh.corners(t)))

    def circle_behind(self, side, E):
        """The cotangent of the circle behind side 0 or 2; None if there is none."""
        apex = self.mesh.far_corner(self.mesh.twin[self.sides[side]])
        if not self.certified[side] or apex == INFINITY:
            return None
        d = minus(self.mesh.vertices[apex], self.v)
        m = max(0, bit(abs(d[0]) | abs(d[1])) + self.S - 10)
        D = (scaled(d[0], self.S - m), scaled(d[1], self.S - m))
        E = (E[0] >> m, E[1] >> m)
        h = cross(D, E) if side == 0 else cross(E, D)
        return cot(dot(D, minus(E, D)), max(1, h), 16)

    def free_area(self):
        """Twice the area in which a vertex may lie, in grains."""
        free = self.T
        if not self.certified[0]:
            free += segment(self.cc, cot(self.ca - self.aa, self.T, 4))
        if not self.certified[1]:
            free += segment(self.cc + self.aa - 2 * self.ca, cot(-self.ca, self.T, 4))
        if self.behind[0] is not None:
            free -= segment(self.cc, self.behind[0])
        if self.behind[2] is not None:
            free -= segment(self.aa, self.behind[2])
        return max(free, (self.T >> 4) + 1)

    def decode_hit(self, symbols, queued, D):
        c = self.mesh.origin[self.sides[1]]
        if c in queued:
            return symbols.hit(self.certified[0] + 2 * self.certified[1], self.expected + 1536)
        degree = self.mesh.degree(self.sides[1])
        if degree <= D:
            return symbols.hit(4, 3840)
        return symbols.hit(4 if degree == D + 1 else 5, self.expected + 1536)


def turned(p, t):
    """p, turned by t quarters counter-clockwise."""
    x, y = p
    return ((x, y), (-y, x), (-x, -y), (y, -x))[t]


class Circle:
    """A circle through v: it reaches from y - r to y + r in a column x, r being the root of square(x)."""

    def __init__(self, E, k, f):
        self.x2 = (E[0] + (k * E[1] >> 12)) >> f
        self.y = (E[1] - (k * E[0] >> 12)) >> (1 + f)

    def square(self, x):
        return x * (self.x2 - x) + self.y * self.y

    def centre(self):
        return (self.x2 >> 1, self.y)


class Place:
    """Section 10, Elsewhere, the position: the turned triangle, circles, and weights."""

    def __init__(self, triangle, decoder):
        self.triangle = triangle
        self.heights, self.crowding = decoder.header.heights, decoder.crowding
        x, y = triangle.a
        if abs(x) >= abs(y):
            self.t = 0 if x < 0 else 2
        else:
            self.t = 1 if y > 0 else 3
        v, largest = triangle.v, decoder.header.largest
        ends = turned(minus((0, 0), v), self.t), turned(minus(largest, v), self.t)
        self.lattice = [sorted(pair) for pair in zip(*ends)]     # first and last column, first and last row
        self.make_circles(turned(triangle.C, self.t), turned(triangle.A, self.t))
        self.make_chances()
        self.make_reach()

    def make_circles(self, C, A):
        triangle, behind = self.triangle, self.triangle.behind
        self.k1 = cot(triangle.cc - triangle.ca, triangle.T, 64)
        self.k0 = min(self.k1, -16384 if behind[2] is None else behind[2])
        x, y = Circle(A, self.k1, 0).centre()
        f = max(0, bit(abs(x) | abs(y) | 1) - 12)
        self.own = Circle(A, self.k1, f)
        self.cutting = []
        if behind[2] is not None and behind[2] > -16 * 4096:
            self.cutting.append(Circle(A, self.k0, f))
        if behind[0] is not None and behind[0] > -16 * 4096:
            self.cutting.append(Circle(C, -behind[0], f))
        difference = self.k1 - self.k0
        self.across = (difference * A[1] >> (12 + f), -difference * A[0] >> (12 + f))
        self.C, self.A = (C[0] >> f, C[1] >> f), (A[0] >> f, A[1] >> f)
        self.s = triangle.S - f

    def grain(self, w):
        return scaled(w, self.s - 1)

    def lines(self, low, high):
        """The first and the last line from low to high, in grains."""
        if self.s >= 0:
            return (low + (1 << self.s) - 1) >> self.s, high >> self.s
        return low << -self.s, ((high + 1) << -self.s) - 1

    # Columns and rows

    def open_ends(self):
        """The western and the eastern end of the own circle; None if an end is not open."""
        centre = self.own.centre()
        radius = rroot(dot(centre, centre) | 1) + 1
        edges = [(self.A, (0, 0))]
        if self.triangle.certified[0]:
            edges.append(((0, 0), self.C))
        if self.triangle.certified[1]:
            edges.append((self.C, self.A))
        ends = []
        for end in ((centre[0] - radius, centre[1]), (centre[0] + radius, centre[1])):
            is_open = all(turn(p, q, end) >= 0 for p, q in edges)
            ends.append(end[0] if is_open else None)
        return ends

    def columns(self):
        """The possible columns, and the context of quick coding."""
        west_end, east_end = self.open_ends()
        west, east = min(self.C[0], self.A[0]), max(self.C[0], 0)
        if west_end is not None:
            west = min(west, west_end)
        if east_end is not None:
            east = max(east, east_end)
        first, last = self.lines(west, east)
        first, last = max(first, self.lattice[0][0]), min(last, self.lattice[0][1])
        context = (east_end is None) + 2 * (west_end is None) + 4 * self.triangle.certified[0]
        return Lines(first, last - first + 1), context

    def spans(self, x, exact=False):
        """The own span and the span in column x; exact: with the roots as they are."""
        square = self.own.square(x)
        r = (rroot(square) if square > 0 else 0) + (0 if exact else 1)
        own = low, high = self.own.y - r, self.own.y + r
        for circle in self.cutting:
            square = circle.square(x)
            if square <= 0:
                continue
            r = rroot(square)
            if not exact:
                r -= (r >> 11) + 1
            begin, end = circle.y - r, circle.y + r
            if begin <= low:
                low = max(low, end)
            elif end >= high and begin < high:
                high = begin
        return own, (low, high)

    def rows(self, x):
        """The possible rows in column x, in grains."""
        first, last = self.lines(*self.spans(x)[1])
        first = clamp(self.lattice[1][0], first, self.lattice[1][1])
        last = max(first, min(last, self.lattice[1][1]))
        return Lines(first, last - first + 1)

    # Weights

    def make_chances(self):
        triangle = self.triangle
        rate = triangle.density - 256 * (2 * triangle.S + 1) + 2134

        def swept(k):
            return segment(triangle.aa, k) - segment(triangle.aa, self.k0)

        def left(u):
            if u <= 0:
                return 511
            if rlog(u) + rate >= 3072:
                return 0
            return rexp(2303 - rexp(rlog(u) + rate))
        step = quotient(self.k1 - self.k0, 3)
        self.chances = [left(swept(self.k1 - i * step)) for i in range(3)] + [511]

    def chance(self, x, y, own):
        """The chance of being first, 0..511."""
        low, high = own
        everything = dot(self.across, (x, y)) % (1 << 32)
        left = (high - y) * (y - low) % (1 << 32)
        w = left // ((everything >> 8) + 1)
        if w >= 256:
            return 511
        i = 3 * w >> 8
        return self.chances[i] + ((self.chances[i + 1] - self.chances[i]) * (3 * w & 255) >> 8)

    def make_reach(self):
        e = clamp(512, 512 * self.s + 2048 - rlog(self.crowding) - self.triangle.density, 7168)
        self.reach = rexp(e)
        self.z = max(0, (e >> 8) - 14)
        self.factor = 255 * 65536 // (self.reach >> self.z)

    def apart(self, x, y):
        """How far a position is from v, C and A, 0..255."""
        d = self.reach
        for corner in ((0, 0), self.C, self.A):
            offset = minus((x, y), corner)
            d = min(d, dot(offset, offset))
        return ((d >> self.z) * self.factor) >> 16

    def position_weight(self, x, y, own):
        chance = self.chance(x, y, own)
        if not self.heights:
            return chance + 4
        return (chance * (self.apart(x, y) + 4) >> 8) + 4

    def column_weight(self, x):
        own, (low, high) = self.spans(x, exact=True)
        length = high - low
        if length <= 0:
            return 4
        e = length >> 3
        w = self.position_weight(x, low + e, own) + self.position_weight(x, high - e, own)
        return (length * w >> 10) + 4


# The decoder


class Decoder:
    """Decodes one stream."""

    def __init__(self, data):
        self.reader = Bytes(data)
        self.header = Header(self.reader)
        self.symbols = Symbols()
        self.mesh = Mesh()
        self.tallies = [[Tally() for _ in range(3)] for _ in range(2)]     # of x, of y: first, second after even, odd
        self.crowding = 2048                                               # K
        self.void = set()
        self.work = self.R = 0
        self.done, self.queued = set(), set()

    # Sections (section 4)

    def begin_section(self):
        begin = self.reader.position
        payload, length_is_right = self.reader.length_and_content()
        self.reader.check(begin, "a section")
        require(length_is_right, "a section's length is malformed")
        self.symbols.coder = RangeCoder(payload)

    def end_section(self):
        self.symbols.coder.finish()

    def decode(self):
        n = self.header.vertices
        self.begin_section()
        self.decode_seed()
        while len(self.mesh.vertices) < n:
            if len(self.mesh.vertices) >= 256:
                self.end_section()
                self.begin_section()
            self.decode_phase(n - len(self.mesh.vertices))
        if self.header.voids:
            self.decode_void_flags()
        self.end_section()
        self.chunks = read_chunks(self.reader.data[self.reader.position:])
        return self

    # Symbols outside the walk (section 5)

    def coordinate(self, largest):
        coder = self.symbols.coder
        if coder.bit(24576):
            return largest if coder.bit(16384) else 0
        return coder.uniform(largest + 1)

    def decode_seed(self):
        height = 0
        for _ in range(3):
            x = self.coordinate(self.header.largest[0])
            y = self.coordinate(self.header.largest[1])
            if self.header.heights:
                height += self.symbols.difference(11, 5)
                require(-32768 <= height <= 32767, "a height is outside 16 bits")
            self.mesh.vertices.append((x, y))
            self.mesh.heights.append(height)
            self.mesh.residuals.append(4 if self.header.heights else 0)
        first, second, third = self.mesh.vertices
        require(first < min(second, third) and turn(first, second, third) > 0, "the seed is not in order")
        self.mesh.seed()

    def decode_phase(self, left):
        coder, batch = self.symbols.coder, left
        if coder.bit(16384):
            batch = coder.uniform((left >> 16) + 1) << 16
            batch |= coder.uniform(min(left, 65536))
            require(1 <= batch < left, "the size of a phase is out of range")
        end = len(self.mesh.vertices) + batch
        self.work += end
        require(self.work <= 3 * end + 512, "the phases add too few vertices")                 # section 3, Work
        self.R = 256 * (log2(batch) - log2((self.header.largest[0] + 1) * (self.header.largest[1] + 1)))
        self.share = log2(batch) - log2(end) - 220
        self.walk(end)

    def decode_void_flags(self):
        for t in range(len(self.mesh.origin) // 3):
            if not self.mesh.is_real(t):
                continue
            context = 3
            for e in range(3 * t, 3 * t + 3):
                neighbour = self.mesh.twin[e] // 3
                if neighbour < t and self.mesh.is_real(neighbour):
                    context += 1 if neighbour in self.void else -1
            if self.symbols.adaptive("void", context):
                self.void.add(t)

    # The walk (section 6)

    def walk(self, end):
        """A phase, up to the given number of vertices."""
        mesh = self.mesh
        self.done, self.queued = set(), {INFINITY, 0}
        queue = deque()
        chord = mesh.half_edge_to_infinity(0)
        v, began_with = INFINITY, 0
        while True:
            if not self.is_certified(chord) and self.decode_hit(chord):
                b = self.decode_position(chord)
                chord = self.insert(chord, b)                            # b -> v
            else:
                chord = mesh.twin[mesh.following(chord)]                 # c -> v
            if len(mesh.vertices) == end:
                return
            w = mesh.origin[chord]
            if w == began_with:
                self.done.add(v)
                if v == INFINITY:
                    queue.appendleft(mesh.twin[chord])                   # infinity -> 0
                require(queue, "the walk ends too early")
                chord = queue.popleft()
                began_with, v = mesh.origin[chord], mesh.origin[mesh.following(chord)]
            elif w not in self.queued:
                self.queued.add(w)
                queue.append(mesh.twin[chord])                           # v -> w

    def is_certified(self, chord):
        """The triangle of the chord is final for this phase if a or c is done."""
        return self.mesh.origin[chord] in self.done or self.mesh.far_corner(chord) in self.done

    def is_around_infinity(self, chord):
        return self.mesh.origin[self.mesh.following(chord)] == INFINITY

    def decode_hit(self, chord):
        if self.is_around_infinity(chord):
            return self.decode_hull_hit(chord)
        self.triangle = Triangle(self, chord)
        hit = self.triangle.decode_hit(self.symbols, self.queued, self.header.degree)
        if not hit:
            self.learn_density(self.triangle.twice_area)
        return hit

    def decode_position(self, chord):
        if self.is_around_infinity(chord):
            return self.decode_hull_position(chord)
        return self.decode_inner_position()

    def learn_density(self, twice_area):
        self.R += (256 * (self.share - rlog(twice_area)) - self.R) >> 4

    # Insertion (section 7)

    def insert(self, chord, b):
        mesh = self.mesh
        v, a = mesh.origin[mesh.following(chord)], mesh.origin[chord]
        corners = [mesh.vertices[vertex] for vertex in mesh.corners(chord // 3) if vertex != INFINITY]
        require(b not in corners and b > mesh.vertices[0], "a vertex is not legal")
        require(mesh.in_conflict(chord // 3, b), "a vertex is not in conflict with its triangle")
        cavity, boundary = mesh.find_cavity(chord, b)
        require(len(cavity) <= self.header.degree - 2, "a cavity has too many triangles")
        require(boundary[0] == chord, "a cavity contains the triangle behind the chord")
        require(not any(vertex in self.done for t in cavity for vertex in mesh.corners(t)),
                "a cavity contains a triangle that is final")
        difference = height = 0
        if self.header.heights:
            height, difference = self.decode_height(b, boundary)
        mesh.heights.append(height)
        mesh.residuals.append(clamp(-127, difference, 127))
        if v != INFINITY:
            self.learn_density(turn(mesh.vertices[a], mesh.vertices[v], b))
        return mesh.insert(b, cavity, boundary)

    # Hits around infinity (section 10)

    def hull_edge(self, chord):
        """a, the difference d to c, the length L, and the axis if the edge is at the border, else None."""
        mesh, largest = self.mesh, self.header.largest
        a, c = mesh.vertices[mesh.origin[chord]], mesh.vertices[mesh.far_corner(chord)]
        d = minus(c, a)
        axis = None
        if d[0] == 0 and a[0] in (0, largest[0]):
            axis = 1
        if d[1] == 0 and a[1] in (0, largest[1]):
            axis = 0
        return a, d, abs(d[0]) | abs(d[1]), axis

    def decode_hull_hit(self, chord):
        _, _, L, axis = self.hull_edge(chord)
        if axis is not None and L == 1:
            return 0
        return self.symbols.hit(6, 2 * log2(L) + (self.R >> 8) + 1536)

    def decode_hull_position(self, chord):
        a, d, L, axis = self.hull_edge(chord)
        if axis is None:
            return (self.coordinate(self.header.largest[0]), self.coordinate(self.header.largest[1]))
        tally, parity_of_a = self.tallies[axis][0], a[axis] + self.header.odd[axis]
        lines = Lines(1, L - 1).sieve(self.symbols.coder, tally, parity_of_a)
        t = max(0, -(self.R >> 8)) // 512
        if lines.gauge == 2 and t > 0:
            t -= 1
        number = self.symbols.magnitude("gap", 0, t)
        require(number < lines.count, "a vertex lies beyond the edge at the border")
        k = lines.line(number)
        tally.learn((k + parity_of_a) & 1)
        return (a[0] + quotient(k * d[0], L), a[1] + quotient(k * d[1], L))

    # Positions elsewhere (section 10)

    def decode_inner_position(self):
        place = Place(self.triangle, self)
        v, t = self.triangle.v, place.t
        axes = (t % 2, 1 - t % 2)                                # the axes of columns and rows
        parities = [v[axis] + self.header.odd[axis] for axis in axes]
        tally = self.tallies[axes[0]][0]
        p = self.decode_tallied_position(place, tally, self.tallies[axes[1]], parities)
        if p is None:                                            # an escape
            p = [first + self.symbols.coder.uniform(last - first + 1) for first, last in place.lattice]
        elif self.header.heights and self.header.coding != QUICK:
            if place.apart(place.grain(2 * p[0]), place.grain(2 * p[1])) < 254:
                self.crowding += self.crowding >> 4
            self.crowding = clamp(512, self.crowding - 12, 65536)
        x, y = turned(p, -t % 4)
        return (v[0] + x, v[1] + y)

    def decode_tallied_position(self, place, tally, tallies, parities):
        """Column and row as seen from v, turned; None is the escape."""
        coder, coding, triangle = self.symbols.coder, self.header.coding, place.triangle
        columns, context = place.columns()
        columns = columns.sieve(coder, tally, parities[0])
        m = clamp(0, (triangle.expected + 256) >> 8, 3)
        if coding == QUICK:
            columns = self.quarter(columns, "quick column", context + 8 * (m > 1))
        else:
            columns = self.halves(columns, "column", lambda w: place.column_weight(place.grain(w)),
                                         4 if coding == DENSE else 3)
        number = coder.uniform_or_escape(columns.count)
        if number is None:
            return None
        column = columns.line(number)
        column_parity = (column + parities[0]) & 1
        x = place.grain(2 * column)

        tally_of_row = tallies[1 + column_parity]
        rows = place.rows(x).sieve(coder, tally_of_row, parities[1])
        if coding == QUICK:
            where = 4 if x < place.A[0] else 8 if x > 0 else 0
            rows = self.quarter(rows, "quick row", m + where)
        else:
            own = place.spans(x)[0]
            rows = self.halves(rows, "row", lambda w: place.position_weight(x, place.grain(w), own),
                                      4 if coding == DENSE else 2)
        number = coder.uniform_or_escape(rows.count)
        if number is None:
            return None
        row = rows.line(number)
        tally.learn(column_parity)
        tally_of_row.learn((row + parities[1]) & 1)
        return column, row

    def quarter(self, lines, name, row):
        if lines.count < 4:
            return lines
        first = self.symbols.adaptive(name, 3 * row)
        second = self.symbols.adaptive(name, 3 * row + 1 + first)
        return lines.half(first).half(second)

    def halves(self, lines, name, weight, formula_from):
        """Up to four halvings. From the time formula_from on, the outer weight is estimated by a formula."""
        taken, upper = [], 0                                     # the weights of the halves taken; the last decision
        for time in range(4):
            i, h = lines.count, lines.count >> 1
            if i < 2:
                break
            low_line = 2 * lines.first + lines.gauge * (h - 1)
            high_line = low_line + lines.gauge * i
            if time < 2:
                low, high = weight(low_line), weight(high_line)
            else:
                w, inner = taken[-1], (taken[-1] + taken[-2]) >> 1
                if time < formula_from:
                    outer = weight(high_line if upper else low_line)
                else:
                    outer = max(2 * w - inner, (w >> 2) + 1)
                low, high = (inner, outer) if upper else (outer, inner)
            low_all, high_all = (low * h, high * (i - h)) if i < 32 else (low, high)
            estimate = (high_all << 11) // (low_all + high_all + 1)
            upper = self.symbols.between(name, 9 * time + (estimate >> 8), estimate & 255)
            taken.append(high if upper else low)
            lines = lines.half(upper)
        return lines

    # Heights (section 10)

    def decode_height(self, b, boundary):
        """The height and its difference from the prediction."""
        mesh = self.mesh
        ring = [mesh.origin[e] for e in boundary if mesh.origin[e] != INFINITY]
        base, N = mesh.heights[ring[0]], None
        W = H = P = Q = G = 0
        for vertex in ring:
            dx, dy = minus(mesh.vertices[vertex], b)
            e = bit(max(1, dx * dx // 2 + dy * dy // 2))
            N = e if N is None else N
            weight = 512 >> max(0, e + 4 - N)
            W += weight
            H += weight * (mesh.heights[vertex] - base)
            P += weight * abs(mesh.heights[vertex] - base)
            Q += weight * mesh.residuals[vertex]
            G += weight * abs(mesh.residuals[vertex])
        mean = (2 * H + W) // (2 * W)
        below = 1 if H > mean * W else 0
        scale = min(11, quotient(rlog(4 * G + W) + 2 * rlog(4 * P + W) - 3 * rlog(W)
                                 + 32 * (14 + N - bit(W)) + 320, 768))
        strength = 2 if 5 * abs(Q) > 3 * G else 1 if 5 * abs(Q) > G else 0
        tendency = 2 * (2 - strength if Q < 0 else 2 + strength) + below
        difference = self.symbols.difference(scale, tendency)
        height = base + mean + difference
        require(-32768 <= height <= 32767, "a height is outside 16 bits")
        return height, difference


def print_terrain(decoder):
    print("digest %016x" % decoder.mesh.digest(decoder.void))
    for (x, y), z in zip(decoder.mesh.vertices, decoder.mesh.heights):
        print(x, y, z)


def main():
    lines = sys.argv[1:2] == ["--lines"]
    if len(sys.argv) != (3 if lines else 2):
        print("usage: reference_decoder.py [--lines] FILE", file=sys.stderr)
        return 2
    with open(sys.argv[-1], "rb") as file:
        data = file.read()
    try:
        if lines:
            from reference_lines import print_lines
            print_lines(Decoder(data).decode())
        elif data[:4] == b"mtpk":
            from reference_pack import print_pack
            print_pack(data)
        else:
            print_terrain(Decoder(data).decode())
    except Refusal as refusal:
        print(refusal, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
