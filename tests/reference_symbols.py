# SPDX-License-Identifier: MIT
"""Sections 2, 8 and 9 of format-stream.md, for reference_decoder.py: integer functions, the range coder, and the symbols
that are made of its bits. Written from the page alone, for people who read along. Names are the page's."""

import re
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "shared" / "docs" / "format-stream.md"

# The rows of section 14 and the numbers of their adaptive bits.
ROWS = {"hit": 105, "column": 36, "row": 36, "quick column": 48, "quick row": 36, "height": 84, "second": 10,
        "negative": 30, "gap": 7, "void": 7}


class Refusal(Exception):
    """A file that is not decoded. The status is one of malformed, damaged, unsupported, truncated."""

    def __init__(self, status, reason):
        super().__init__(status + ": " + reason)
        self.status = status


def require(holds, rule):
    """A rule of the format that bytes break although their checks pass."""
    if not holds:
        raise Refusal("malformed", rule)


# Integer functions (sections 2 and 9)


def clamp(low, value, high):
    return low if value < low else high if value > high else value


def quotient(a, b):
    """a / b of the page: rounded towards zero."""
    return a // b if (a >= 0) == (b > 0) else -(-a // b)


def scaled(value, exponent):
    """value * 2^exponent, rounded down."""
    return value << exponent if exponent >= 0 else value >> -exponent


def cross(p, q):
    return p[0] * q[1] - p[1] * q[0]


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1]


def minus(p, q):
    return (p[0] - q[0], p[1] - q[1])


def bit(v):
    return v.bit_length() - 1


def log2(v):
    b = bit(v)
    m = scaled(v, 16 - b) & 65535
    e = ((m * (65536 - m) >> 16) * (27800 - (10600 * m >> 16))) >> 16
    return 256 * b + ((m + e + 128) >> 8)


def rlog(v):
    return 256 * bit(v) + (scaled(v, 8 - bit(v)) & 255)


def rexp(l):
    return 0 if l < 0 else (256 + (l & 255)) * (1 << 23) >> (31 - (l >> 8))


def rroot(v):
    h = bit(v | 1) >> 1
    g = (11 * ((1 << (h + 1)) + (v >> h)) >> 5) + 1
    return (g + v // g) >> 1


def cot(q, h, most):
    s = max(0, bit(h) - 11)
    h >>= s
    return quotient(4096 * clamp(-most * h, q >> s, most * h), h)


def segment(s, k):
    j = k >> 4
    i = abs(j)
    minor = ((s >> 4) * ((i + 188) * 174763 // (i * (i + 188) + 20643))) >> 7
    if j <= 0:
        return minor
    i = min(i, 2048)
    return (s >> 8) * ((65536 + i * i) * 201 >> 15) - minor


def incircle(a, b, c, p):
    """Section 2: positive if p lies inside the circle through a, b, c."""
    def h(p):
        return cross(minus(a, p), minus(b, p))

    def q(p):
        return dot(minus(a, p), minus(b, p))
    return q(c) * h(p) - q(p) * h(c)


def turn(a, b, c):
    """Positive if a, b, c turn counter-clockwise."""
    return cross(minus(b, a), minus(c, a))


# Range coder (section 8)


class RangeCoder:
    def __init__(self, payload):
        self.payload, self.position = payload, 0
        self.range = (1 << 32) - 1
        self.code = 0
        for _ in range(4):
            self.code = self.code << 8 | self.next_byte()
        require(self.code != self.range, "the first code equals the range")

    def next_byte(self):
        position = self.position
        self.position += 1
        require(position < len(self.payload) + 4, "a section needs more than its payload")
        return self.payload[position] if position < len(self.payload) else 0

    def finish(self):
        require(self.position >= len(self.payload), "payload is left")

    def after_symbol(self):
        while self.range < 1 << 24:
            self.range = self.range << 8
            self.code = self.code << 8 | self.next_byte()

    def bit(self, p):
        bound = (self.range >> 15) * p
        one = self.code < bound
        if one:
            self.range = bound
        else:
            self.range -= bound
            self.code -= bound
        self.after_symbol()
        return int(one)

    def uniform(self, count):
        if count == 1:
            return 0
        self.range //= count
        number = self.code // self.range
        require(number < count, "a uniform number is too large")
        self.code -= number * self.range
        self.after_symbol()
        return number

    def uniform_or_escape(self, count):
        """None is the escape."""
        part = (self.range - (self.range >> 10)) // count
        number = self.code // part
        if number < count:
            self.code -= number * part
            self.range = part
        else:
            self.code -= count * part
            self.range -= count * part
            number = None
        self.after_symbol()
        return number


class AdaptiveBit:
    def __init__(self, start):
        self.fast = self.slow = 128 * start + 64

    def learn(self, one):
        t = 32704 if one else 64
        self.fast += (t - self.fast) >> 5
        self.slow += (t - self.slow) >> 8


def start_table():
    """Section 14."""
    table = PAGE.read_text(encoding="utf-8").split("## 14. Start table")[1].split("\n## ")[0]
    return [int(word) for line in re.findall(r"^    (.*)$", table, re.M) for word in line.split()]


class Symbols:
    """The adaptive bits of a stream, and the symbols that are made of them."""

    def __init__(self):
        starts = iter(start_table())
        self.rows = {name: [AdaptiveBit(next(starts)) for _ in range(size)] for name, size in ROWS.items()}
        self.coder = None                                        # that of the section

    def adaptive(self, name, number):
        entry = self.rows[name][number]
        one = self.coder.bit((entry.fast + entry.slow) >> 1)
        entry.learn(one)
        return one

    def between(self, name, i, f):
        """A bit between the adaptive bits i and i + 1, at f / 256 of the way."""
        here, there = self.rows[name][i], self.rows[name][i + 1]
        s, s_there = here.fast + here.slow, there.fast + there.slow
        one = self.coder.bit((s + ((s_there - s) * f >> 8)) >> 1)
        (here if f < 128 else there).learn(one)
        return one

    def hit(self, curve, position):
        """A curve of 15 entries, read at a position."""
        position = clamp(0, position, 256 * 14 - 1)
        return self.between("hit", 15 * curve + (position >> 8), position & 255)

    def length(self, name, first, t):
        """A length of 0..17 bits, from the typical length t; the row of seven bits begins at first."""
        def longer(k):
            return self.adaptive(name, first + clamp(0, k - t + 3, 6))
        if longer(t):
            length = t + 1
            while length < 17 and longer(length):
                length += 1
        else:
            length = t
            while length > 0 and not longer(length - 1):
                length -= 1
        return length

    def magnitude(self, name, first, t):
        length = self.length(name, first, t)
        if length < 2:
            return length
        second = self.adaptive("second", min(length, 9))
        return (2 + second) << (length - 2) | self.coder.uniform(1 << (length - 2))

    def difference(self, scale, tendency):
        """Section 10, Height: a difference in height."""
        size = self.magnitude("height", 7 * scale, scale // 2)
        if size and self.adaptive("negative", 3 * tendency + min(size, 3) - 1):
            return -size
        return size


class Tally:
    """Section 8, Parities: counts of even and odd lines."""

    def __init__(self):
        self.counts = [1, 1]

    def learn(self, parity):
        self.counts[parity] += 1
        if sum(self.counts) > 512:
            self.counts = [(count + 1) >> 1 for count in self.counts]

    def is_one_sided(self):
        return self.counts[0] > 2 * self.counts[1] or self.counts[1] > 2 * self.counts[0]


class Lines:
    """Lines first, first + gauge, ... of the lattice, count of them."""

    def __init__(self, first, count, gauge=1):
        self.first, self.count, self.gauge = first, count, gauge

    def sieve(self, coder, tally, parity_of_zero):
        """The lines that are left; parity_of_zero is the parity of line 0."""
        if self.count < 2 or not tally.is_one_sided():
            return self
        even, odd = tally.counts
        first_parity = (self.first + parity_of_zero) & 1
        if self.count % 2 == 1 and self.count < 32:
            more, fewer = (self.count + 1) // 2, self.count // 2
            even *= fewer if first_parity else more
            odd *= more if first_parity else fewer
        parity = coder.bit(clamp(64, (odd << 15) // (even + odd), 32704))
        if parity == first_parity:
            return Lines(self.first, (self.count + 1) // 2, 2)
        return Lines(self.first + 1, self.count // 2, 2)

    def half(self, upper):
        h = self.count >> 1
        if upper:
            return Lines(self.first + self.gauge * h, self.count - h, self.gauge)
        return Lines(self.first, h, self.gauge)

    def line(self, number):
        return self.first + self.gauge * number
