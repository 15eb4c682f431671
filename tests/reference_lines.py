# SPDX-License-Identifier: MIT
"""Section 15 of format-stream.md, for reference_decoder.py: the lines that a chunk marks among a mesh's edges. Written from
the page alone, for people who read along. Names are the page's."""

import re

from reference_decoder import INFINITY, Bytes
from reference_symbols import PAGE, AdaptiveBit, RangeCoder, Refusal, clamp, cross, dot, minus, require, rlog

LINES = 19                                       # the type of the chunk


def starts():
    """The rows of section 15 with their starts."""
    section = PAGE.read_text(encoding="utf-8").split("## 15. Lines")[1]
    rows = re.findall(r"^\| \*(.*)\* \| ([0-9, ]+) \|$", section, re.M)
    return {name: [AdaptiveBit(int(start)) for start in text.split(", ")] for name, text in rows}


class LineReader:
    """The marks of a mesh's edges, from the content of a chunk."""

    def __init__(self, mesh, content):
        self.mesh, self.rows = mesh, starts()
        self.marks = {}                          # the class of each half-edge that has a mark
        self.lines = []                          # class and vertices
        reader = Bytes(content, 0, "malformed")
        self.left = reader.varint(1 << 31)
        require(self.left > 0, "no edge has a mark")
        self.coder = RangeCoder(reader.take(reader.varint(1 << 31)))
        self.decode()
        self.coder.finish()

    def adaptive(self, name, number=0):
        entry = self.rows[name][number]
        one = self.coder.bit((entry.fast + entry.slow) >> 1)
        entry.learn(one)
        return one

    def ends(self, h):
        return self.mesh.origin[h], self.mesh.origin[self.mesh.following(h)]

    def decode(self):
        kind = 1
        for h, twin in enumerate(self.mesh.twin):
            if self.left == 0:
                return
            if h > twin or INFINITY in self.ends(h) or h in self.marks or not self.adaptive("begins"):
                continue
            if not self.adaptive("same class"):
                kind = 1 + self.coder.uniform(15)
            self.mark(h, kind)
            path = [*self.ends(h)]
            for start, add in ((h, path.append), (twin, lambda v: path.insert(0, v))):
                self.go_on(start, kind, add)
            self.lines.append((kind, path))
        require(self.left == 0, "edges are left")

    def mark(self, h, kind):
        self.marks[h] = self.marks[self.mesh.twin[h]] = kind
        self.left -= 1

    def go_on(self, h, kind, add):
        while self.left > 0:
            h = self.next_half_edge(h)
            if h is None:
                return
            self.mark(h, kind)
            add(self.ends(h)[1])

    def next_half_edge(self, h):
        ways, right, meets = self.ways_after(h)
        if not ways or self.adaptive("ends", meets):
            return None
        to_the_right, to_the_left = ways[:right][::-1], ways[right:]
        if to_the_right and to_the_left:
            bends = self.bend(h, to_the_right[0]) - self.bend(h, to_the_left[0])
            ways = to_the_left if self.adaptive("side", clamp(0, (bends + 1280) >> 9, 4)) else to_the_right
        else:
            ways = to_the_right or to_the_left
        i = 0
        while i < len(ways) - 1 and self.adaptive("farther", min(i, 2)):
            i += 1
        return ways[i]

    def ways_after(self, h):
        mesh = self.mesh
        u, v = (mesh.vertices[number] for number in self.ends(h))
        ways, right, meets = [], 0, 0
        back = mesh.twin[h]
        e = mesh.twin[mesh.preceding(back)]
        for _ in range(31):
            if e == back:
                break
            w = self.ends(e)[1]
            if e in self.marks:
                meets = 1
            elif w != INFINITY:
                ways.append(e)
                if cross(minus(v, u), minus(mesh.vertices[w], u)) < 0:
                    right = len(ways)
            e = mesh.twin[mesh.preceding(e)]
        return ways, right, meets

    def bend(self, h, way):
        u, v = (self.mesh.vertices[number] for number in self.ends(h))
        p, q = minus(v, u), minus(self.mesh.vertices[self.ends(way)[1]], v)
        if dot(p, q) <= 0:
            return 32768
        return 2 * rlog(abs(cross(p, q)) | 1) - rlog(dot(q, q))


def print_lines(decoder):
    if LINES not in decoder.chunks:
        raise Refusal("malformed", "the stream has no lines")
    for kind, vertices in LineReader(decoder.mesh, decoder.chunks[LINES]).lines:
        print("line", kind, *vertices)
