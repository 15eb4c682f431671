#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""vectors.py [--write]: test vectors for each section of format-stream.md, computed by the second decoder.

vectors.json must contain them; --write writes it. tests/stream/vectors_test.cpp compares the library with it.
"""

import json
import sys
import zlib
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import reference_decoder as decoder  # noqa: E402
import reference_lines as lines  # noqa: E402
import reference_symbols as symbols  # noqa: E402
from reference_pack import fnv32  # noqa: E402

FILE = Path(__file__).with_name("vectors.json")
NUMBERS = [1, 2, 3, 5, 13, 127, 128, 1000, 65535, 65536, 1234567, 123456789, (1 << 31) - 1]


class Dice:
    """Numbers that look random and are equal on every machine."""

    def __init__(self, seed):
        self.state = seed

    def below(self, count):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 33) % count


def varint(value):
    groups = [value & 127]
    while value := value >> 7:
        groups.append(value & 127 | 128)
    return bytes(reversed(groups))


def varint_vectors():
    taken = [0, 1, 127, 128, 16383, 16384, (1 << 31) - 1, (1 << 64) - 1]
    for value in taken:
        assert decoder.Bytes(varint(value)).varint() == value
    return [[varint(value).hex(), value] for value in taken]


def is_refused(data):
    try:
        decoder.Bytes(data).varint()
    except symbols.Refusal:
        return True
    return False


def zigzag_vectors():
    return [[code, decoder.Bytes(varint(code)).zigzag()] for code in (0, 1, 2, 3, 254, 255, (1 << 64) - 2, (1 << 64) - 1)]


def points(*numbers):
    return list(zip(numbers[::2], numbers[1::2]))


# Three corners and a point: inside, outside, on the circle, each of four as the largest, and the largest determinant.
CIRCLES = [points(0, 0, 4, 0, 0, 4, 1, 1), points(0, 0, 4, 0, 0, 4, 9, 9), points(0, 0, 4, 0, 4, 4, 0, 4),
           points(4, 0, 4, 4, 0, 4, 0, 0), points(4, 4, 0, 4, 0, 0, 4, 0), points(0, 4, 0, 0, 4, 0, 4, 4),
           points(5, 0, 8, 1, 9, 8, 1, 2), points(5, 0, 10, 5, 5, 10, 2, 9), points(0, 0, 65534, 0, 0, 65534, 32767, 32767),
           points(0, 0, 65535, 0, 0, 65535, 32768, 32767)]
# A hull edge and a point: left, right, between, beyond each end, at an end.
EDGES = [points(0, 0, 4, 0, 2, 1), points(0, 0, 4, 0, 2, 0), points(4, 0, 0, 0, 2, 1), points(0, 0, 4, 0, 5, 0),
         points(0, 0, 4, 2, 2, 1), points(0, 0, 4, 0, 4, 0), points(9, 3, 1, 3, 5, 3), points(9, 3, 1, 3, 0, 3)]


# Three positions: straight on, a little to the left and to the right, a right angle, back, large areas and squares.
BENDS = [points(0, 0, 10, 0, 20, 0), points(0, 0, 10, 0, 20, 1), points(0, 9, 10, 9, 20, 8),
         points(0, 0, 10, 0, 10, 7), points(0, 0, 10, 0, 3, 2), points(5, 5, 6, 8, 9, 30), points(0, 0, 65535, 0, 65535, 65535),
         points(0, 0, 40000, 3, 65535, 65535), points(65535, 0, 1000, 1000, 0, 65535),
         points(1, 0, 1, 1, 65535, 65535)]


def inserted(mesh, a, v, b):
    """Inserts b behind the edge from a to v. Returns the cavity and its ring."""
    chord = next(e for e in range(len(mesh.origin)) if mesh.origin[e] == a and mesh.origin[mesh.following(e)] == v)
    assert mesh.in_conflict(chord // 3, b)
    cavity, boundary = mesh.find_cavity(chord, b)
    assert boundary[0] == chord
    ring = [mesh.origin[e] for e in boundary]
    mesh.insert(b, cavity, boundary)
    return cavity, ring


def conflict(corners, p):
    mesh = decoder.Mesh()
    mesh.vertices, mesh.origin = corners, [0, 1, 2 if len(corners) == 3 else decoder.INFINITY]
    return int(mesh.in_conflict(0, p))


def adaptive_vector(start, bits):
    bit, ps = symbols.AdaptiveBit(start), []
    for one in bits:
        ps.append((bit.fast + bit.slow) >> 1)
        bit.learn(one)
    return {"start": start, "bits": bits, "probabilities": ps, "fast": bit.fast, "slow": bit.slow}


def coder_vector(payload, wanted):
    """What a payload decodes to; wanted has probabilities of bits, and counts of numbers that may escape or not."""
    coder = symbols.RangeCoder(payload)
    read = {"bit": coder.bit, "number": coder.uniform, "number or escape": coder.uniform_or_escape}
    return {"payload": payload.hex(), "symbols": [[kind, of, read[kind](of)] for kind, of in wanted]}


class Script:
    """A range coder whose symbols are thrown. It notes probability or count, and what was thrown."""

    def __init__(self, dice, escapes=False):
        self.dice, self.escapes, self.noted = dice, escapes, []

    def note(self, of, value):
        self.noted.append([of, value])
        return value

    def bit(self, p):
        return self.note(p, self.dice.below(2))

    def uniform(self, count):
        return 0 if count == 1 else self.note(count, self.dice.below(count))

    def uniform_or_escape(self, count):
        value = self.note(count, count if self.escapes else self.dice.below(count))
        return None if value == count else value


def scripted(script):
    result = symbols.Symbols()
    result.coder = script
    return result


def tally_vector(even, odd, first, count, parity_of_zero, dice):
    tally, script = symbols.Tally(), Script(dice)
    tally.counts = [even, odd]
    lines = symbols.Lines(first, count).sieve(script, tally, parity_of_zero)
    tally.learn(1)
    return {"even": even, "odd": odd, "first": first, "lines": count, "odd origin": parity_of_zero, "symbols": script.noted,
            "left": [lines.first, lines.count, lines.gauge], "learnt": tally.counts}


def magnitude_vector(typical, dice):
    script = Script(dice)
    value = scripted(script).magnitude("gap", 0, typical)
    return {"typical": typical, "symbols": script.noted, "magnitude": value}


SEED = points(0, 0, 40, 30, 0, 30)
# The ends of a chord and the vertex that is inserted there: outside the hull, on it, inside, and on a circle.
INSERTIONS = [[0, -1, (40, 0)], [0, 3, (16, 12)], [1, -1, (20, 30)], [3, 1, (24, 12)], [1, -1, (39, 36)]]


def seeded_mesh():
    mesh = decoder.Mesh()
    mesh.vertices = list(SEED)
    mesh.seed()
    return mesh


def insertion_vector():
    mesh, steps = seeded_mesh(), []
    for a, v, b in INSERTIONS:
        cavity, ring = inserted(mesh, a, v, b)
        steps.append({"chord": [a, v], "vertex": b, "cavity": cavity, "ring": ring,
                      "triangles": [mesh.corners(t) for t in range(len(mesh.origin) // 3)]})
    mesh.heights = [7 * x - y - 100 for x, y in mesh.vertices]
    void = next(t for t in range(len(mesh.origin) // 3) if mesh.is_real(t))
    return {"seed": SEED, "insertions": steps, "heights": mesh.heights, "void": void, "digest": "%016x" % mesh.digest({void})}


def bend_vector(u, v, w):
    stub = lines.LineReader.__new__(lines.LineReader)
    stub.mesh = decoder.Mesh()
    stub.mesh.vertices, stub.mesh.origin = [u, v, w], [0, 1, 2]
    return [u, v, w, stub.bend(0, 1)]


def marks_vector(edges, dice):
    """Lines among the edges of the mesh of the insertions, with as many marks, and the script that makes them."""
    mesh = seeded_mesh()
    for step in INSERTIONS:
        inserted(mesh, *step)
    while True:
        stub, script = lines.LineReader.__new__(lines.LineReader), Script(dice)
        stub.mesh, stub.rows, stub.marks, stub.lines = mesh, lines.starts(), {}, []
        stub.left, stub.coder = edges, script
        try:
            stub.decode()
        except symbols.Refusal:
            continue
        return {"vertices": mesh.vertices, "triangles": [mesh.corners(t) for t in range(len(mesh.origin) // 3)],
                "edges": edges, "symbols": script.noted, "lines": stub.lines}


def height_vector(size, spread, dice):
    """Of a ring around (500, 500), its first vertex at a distance that differs from the others'."""
    stub = decoder.Decoder.__new__(decoder.Decoder)
    stub.mesh, script = decoder.Mesh(), Script(dice)
    stub.symbols, mesh = scripted(script), stub.mesh
    mesh.vertices = [(dice.below(1001), dice.below(1001)) for _ in range(size)]
    mesh.heights = [dice.below(2 * spread + 1) - spread for _ in range(size)]
    mesh.residuals = [clamped(dice.below(2 * spread + 1) - spread // 2) for _ in range(size)]
    mesh.origin = list(range(size))
    height, difference = stub.decode_height((500, 500), range(size))
    return {"ring": [[*p, z, r] for p, z, r in zip(mesh.vertices, mesh.heights, mesh.residuals)],
            "prediction": height - difference, "symbols": script.noted, "height": height}


def clamped(residual):
    return symbols.clamp(-127, residual, 127)


class Place:
    """A triangle (v, c, a), and the apexes behind its sides; None: the side is open; infinity is outside the hull."""

    def __init__(self, largest, corners, apexes, density, crowding, tallies, header):
        self.given = {"largest": largest, "corners": corners, "apexes": apexes, "density": density, "crowding": crowding,
                      "tallies": tallies, **header}

    def decoder(self, script):
        given, stub = self.given, decoder.Decoder.__new__(decoder.Decoder)
        stub.symbols, stub.header = scripted(script), decoder.Header.__new__(decoder.Header)
        stub.header.largest, stub.header.odd = given["largest"], given["odd"]
        stub.header.coding, stub.header.heights = given["coding"], given["heights"]
        stub.R, stub.crowding = given["density"] << 8, given["crowding"]
        stub.tallies = [[symbols.Tally() for _ in range(3)] for _ in range(2)]
        for tally, counts in zip(stub.tallies[0] + stub.tallies[1], given["tallies"]):
            tally.counts = list(counts)
        stub.mesh, stub.done = self.mesh()
        return stub

    def mesh(self):
        """Triangle 0, and those behind its sides, of which each has its apex first."""
        mesh, done = decoder.Mesh(), set()
        mesh.vertices = list(self.given["corners"])
        mesh.origin, mesh.twin = [0, 1, 2], [4, 7, 10] + [None] * 9
        for side, apex in enumerate(self.given["apexes"]):
            number = decoder.INFINITY
            if apex != "infinity":
                number = len(mesh.vertices)
                mesh.vertices.append(apex or (0, 0))
            if apex:
                done.add(number)
            mesh.origin += [number, (side + 1) % 3, side]
        return mesh, done

    def vector(self, script):
        stub = self.decoder(script)
        stub.triangle = decoder.Triangle(stub, 2)
        x, y = stub.decode_inner_position()
        return {**self.given, "behind": [stub.triangle.behind[side] for side in (0, 2)], "expected": stub.triangle.expected,
                "symbols": script.noted, "position": [x, y], "crowding afterwards": stub.crowding}


def far_side(dice, size, p, q):
    """An apex to the right of p -> q; infinity if none is found."""
    apexes = [(dice.below(size), dice.below(size)) for _ in range(20)]
    return next((apex for apex in apexes if symbols.turn(q, p, apex) > 0), "infinity")


def random_place(dice, number):
    size = (6, 20, 100, 3000, 65536)[number % 5]
    while True:
        v, c, a = corners = [(dice.below(size), dice.below(size)) for _ in range(3)]
        if symbols.turn(*corners) > 0:
            break
    apexes = [far_side(dice, size, p, q) if dice.below(2) else None for p, q in ((v, c), (c, a))]
    apexes.append("infinity" if dice.below(4) == 0 else far_side(dice, size, a, v))
    mean = -2 * symbols.log2(size)
    header = {"coding": 1 + number % 3, "heights": int(number % 4 != 1), "odd": [dice.below(2), dice.below(2)]}
    tallies = [[1 + dice.below(250), 1 + dice.below(250)] for _ in range(6)]
    place = Place([size - 1, size - 1], corners, apexes, mean + dice.below(2048), 512 + dice.below(8192), tallies, header)
    return place.vector(Script(dice, escapes=number % 8 == 7))


def place_vectors(dice):
    return [random_place(dice, number) for number in range(30)]


def hull_vector(largest, a, c, density, tallies, odd, dice):
    """A decision around infinity, and the position of a hit. None if what was thrown is malformed."""
    given = {"largest": largest, "corners": [a, c], "density": density, "tallies": tallies, "odd": odd}
    script = Script(dice)
    stub = Place(largest, [a, c], [], density, 2048, tallies, {"odd": odd, "coding": 2, "heights": 1}).decoder(script)
    stub.mesh.origin = [0, decoder.INFINITY, 1]
    try:
        hit = stub.decode_hull_hit(0)
        position = stub.decode_hull_position(0) if hit else None
    except symbols.Refusal:
        return None
    return {**given, "symbols": script.noted, "position": position, "tallies afterwards": [t.counts for t in stub.tallies[0] + stub.tallies[1]]}


def hull_vectors(dice):
    """Edges at each border in both directions, of which one is a step long, and elsewhere."""
    found = []
    for number, (a, c) in enumerate([((0, 0), (40, 0)), ((40, 60), (40, 0)), ((0, 60), (40, 60)), ((0, 3), (0, 60)), ((7, 0), (8, 0)),
                                     ((9, 9), (5, 3)), ((12, 60), (29, 60)), ((5, 5), (30, 5))]):
        for _ in range(20):
            tallies = [[1 + dice.below(250), 1 + dice.below(80)] for _ in range(6)]
            vector = hull_vector([40, 60], a, c, -800 - 300 * number, tallies, [number % 2, number // 2 % 2], dice)
            if vector and (vector["position"] or not vector["symbols"]):
                found.append(vector)
                break
    return found


def coder_vectors(dice):
    payload = bytes(dice.below(256) for _ in range(24))
    wanted = [("bit", 16384), ("bit", 64), ("bit", 32704), ("number", 1), ("number", 2), ("number", 3000), ("number", 65536),
              ("number or escape", 1), ("number or escape", 7), ("number or escape", 16384), ("bit", 24576)]
    return [coder_vector(payload, wanted), coder_vector(bytes([255, 255, 255, 254]), [("number or escape", 5), ("bit", 9000)]),
            coder_vector(b"\x80", [("bit", 16384), ("number", 256)])]


def vectors():
    dice = Dice(1)
    squares = [1, 2, 3, 4, 8, 15, 16, 17, 1000, 999999, 1000000, (1 << 31) - 1]
    cots = [[0, 1, 16], [5, 3, 64], [-5, 3, 64], [1000, 1, 16], [-1000, 1, 16], [123456, 7890, 4], [-16777215, 33554431, 4]]
    segments = [[4, 0], [1000, 4096], [1000, -4096], [100000, 65536], [8000000, -65536], [8000000, 262144], [33554431, 16384]]
    return {
        "crc32": [[data.hex(), zlib.crc32(data)] for data in (b"", b"mtin", b"123456789", bytes(range(240, 256)))],
        "fnv32": [[data.hex(), fnv32(data)] for data in (b"", b"mtin", b"123456789", bytes(range(240, 256)))],
        "varint": varint_vectors(),
        "varint refused": [[data.hex(), 1] for data in (b"\x80", b"\x80\x01", b"\x82" + b"\x80" * 8 + b"\x00") if is_refused(data)],
        "zigzag": zigzag_vectors(),
        "log2": [[v, symbols.log2(v)] for v in NUMBERS],
        "rlog": [[v, symbols.rlog(v)] for v in NUMBERS],
        "rexp": [[l, symbols.rexp(l)] for l in (-1, 0, 1, 255, 256, 300, 2047, 2048, 5000, 7168, 8191)],
        "rroot": [[v, symbols.rroot(v)] for v in squares],
        "cot": [[*c, symbols.cot(*c)] for c in cots],
        "segment": [[*s, symbols.segment(*s)] for s in segments],
        "incircle": [[*four, symbols.incircle(*four)] for four in CIRCLES],
        "conflict with a triangle": [[*four, conflict(four[:3], four[3])] for four in CIRCLES],
        "conflict with a ghost": [[*three, conflict(three[:2], three[2])] for three in EDGES],
        "adaptive bit": [adaptive_vector(start, [dice.below(2) for _ in range(12)]) for start in (0, 128, 255)],
        "range coder": coder_vectors(dice),
        "tally": [tally_vector(*t, dice) for t in ((1, 1, 0, 9, 0), (3, 1, -4, 9, 0), (1, 9, -4, 9, 1), (9, 2, 5, 40, 1),
                                                   (400, 112, 3, 7, 0), (2, 5, 3, 1, 0))],
        "magnitude": [magnitude_vector(typical, dice) for typical in (0, 0, 1, 3, 5, 8, 16)],
        "insertion": [insertion_vector()],
        "height": [height_vector(*h, dice) for h in ((3, 3), (5, 40), (8, 300), (12, 3000), (32, 20000))],
        "position": place_vectors(dice),
        "position around infinity": hull_vectors(dice),
        "bend": [bend_vector(*three) for three in BENDS],
        "marks": [marks_vector(edges, Dice(edges)) for edges in (1, 2, 5, 8, 11, 14)],
    }


def text_of(all_vectors):
    """One vector a line."""
    parts = []
    for name, cases in all_vectors.items():
        lines = ",\n  ".join(json.dumps(case) for case in cases)
        parts.append(f'"{name}": [\n  {lines}\n]')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def main():
    text = text_of(vectors())
    if "--write" in sys.argv:
        FILE.write_text(text, encoding="utf-8")
    if FILE.read_text(encoding="utf-8") != text:
        print("rejected: vectors.json is not what the second decoder computes; vectors.py --write writes it")
        return 1
    print(text.count("\n  "), "vectors")
    return 0


if __name__ == "__main__":
    sys.exit(main())
