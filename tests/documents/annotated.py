# SPDX-License-Identifier: MIT
"""annotated.py [--write | FOLDER]: the annotated files of format-stream.md and format-pack.md are what the second decoder
finds in example.mtin and pair.mtp of tests/golden/1.0, byte by byte and symbol by symbol. --write writes them into the
pages. With a folder, its pages are compared instead. test-files.md lists each golden file."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import reference_decoder as decoder  # noqa: E402
from reference_pack import Pack  # noqa: E402

BEGIN = "<!-- annotated: written by tests/documents/annotated.py -->\n"
END = "<!-- end of annotated -->\n"


def hexdump(data):
    lines = []
    for at in range(0, len(data), 16):
        octets = [f"{byte:02x}" for byte in data[at:at + 16]]
        lines.append(f"    {at:08x}  {' '.join(octets[:8])}  {' '.join(octets[8:])}".rstrip())
    return "\n".join(lines) + "\n"


def table(heads, rows):
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(str(cell) for cell in line)} |\n" for line in lines)


class Fields:
    """Rows of a table of bytes: where each field lies, its bytes and its meaning."""

    def __init__(self, data, at=0):
        self.data, self.at, self.rows = data, at, []

    def add(self, size, meaning):
        octets = self.data[self.at:self.at + size]
        shown = octets.hex(" ") if size <= 8 else octets[:3].hex(" ") + " .. " + octets[-2:].hex(" ")
        self.rows.append([f"{self.at:02x}", size, f"`{shown}`", meaning(octets) if callable(meaning) else meaning])
        self.at += size

    def table(self):
        return table(["offset", "bytes", "content", "meaning"], self.rows)


def number(octets):
    return int.from_bytes(octets, "little")


def check_of(first, last):
    return lambda octets: f"check of {first:02x}..{last:02x}: {number(octets):08X}"


def properties_meaning(value):
    parts = [f"{flag}" for flag in (1, 2, 4, 2048, 4096, 8192) if value & flag]
    names = [name for flag, name in ((1, "heights"), (2, "voids"), (4, "placement"), (2048, "odd x"), (4096, "odd y"),
                                     (8192, "margins")) if value & flag]
    coding, degree = value >> 3 & 3, value >> 5 & 63
    total = " + ".join([*parts, f"8 * {coding}", f"32 * {degree}"])
    return f"properties {value} = {total}: {', '.join(names)}, {('', 'quick', 'balanced', 'dense')[coding]}, D = {degree}"


def add_varint(fields, meaning):
    reader = decoder.Bytes(fields.data, fields.at)
    value = reader.varint()
    fields.add(reader.position - fields.at, meaning(value))
    return value


def add_stream(fields):
    begin = fields.at
    fields.add(4, "`mtin`: a stream")
    fields.add(1, "version 6")
    end = add_varint(fields, lambda n: f"length: {n} bytes up to the check")
    end += fields.at
    flags = add_varint(fields, properties_meaning)
    add_varint(fields, lambda n: f"{n} vertices")
    for axis in "xy":
        add_varint(fields, lambda n: f"largest {axis}: {n}")
    if flags & 8192:
        for side in ("below", "above"):
            add_varint(fields, lambda n: f"margin {side}: {n}, that is {(n - 1) / 16:g} z steps")
    assert fields.at == end
    fields.add(4, check_of(begin, end - 1))
    section = fields.at
    size = add_varint(fields, lambda n: f"length of the section: {n} bytes of payload")
    fields.add(size, "payload of the section")
    fields.add(4, check_of(section, section + size))


class Narrator(decoder.Decoder):
    """Decodes, and notes what each symbol is for: rows of what, of what it depends on, of symbols, of the result."""

    def __init__(self, data):
        super().__init__(data)
        self.rows, self.noted, self.estimates, self.pair = [], [], [], []
        self.names = ("seed", "largest {}, {}".format(*self.header.largest))
        original = self.symbols.difference
        self.symbols.difference = lambda scale, tendency: self.noted_difference(original, scale, tendency)
        between = self.symbols.between
        self.symbols.between = lambda name, i, f: self.noted_between(between, name, i, f)

    def begin_section(self):
        super().begin_section()
        coder = self.symbols.coder
        for kind in ("bit", "uniform", "uniform_or_escape"):
            setattr(coder, kind, self.noting(getattr(coder, kind), kind))

    def noting(self, read, kind):
        def noted(of):
            value = read(of)
            if kind == "bit":
                self.noted.append(f"{of}:{value}")
            elif kind != "uniform" or of != 1:
                self.noted.append(f"{'escape' if value is None else value} of {of}{'+' if kind != 'uniform' else ''}")
            return value
        return noted

    def flush(self, what, given, gives):
        self.rows.append([what, given, ", ".join(self.noted) or "none", gives])
        self.noted.clear()
        self.estimates.clear()

    def coordinate(self, largest):
        self.pair.append(super().coordinate(largest))
        if len(self.pair) == 2:
            self.flush(*self.names, f"({self.pair[0]}, {self.pair[1]})")
            self.pair, y = [], self.pair[1]
            return y
        return self.pair[-1]

    def noted_between(self, original, name, i, f):
        self.estimates.append(256 * (i % (15 if name == "hit" else 9)) + f)
        return original(name, i, f)

    def noted_difference(self, original, scale, tendency):
        difference = original(scale, tendency)
        self.flush("height", f"scale {scale}, tendency {tendency}", f"difference {difference}")
        return difference

    def decode_height(self, b, boundary):
        height, difference = super().decode_height(b, boundary)
        ring = [str(self.mesh.origin[e]) for e in boundary if self.mesh.origin[e] != decoder.INFINITY]
        self.rows[-1][1] += f", ring {' '.join(ring)}"
        self.rows[-1][3] = f"{height - difference} {'-' if difference < 0 else '+'} {abs(difference)} = {height}"
        return height, difference

    def walk(self, end):
        self.flush("phase", f"{self.header.vertices - len(self.mesh.vertices)} left", f"{end - len(self.mesh.vertices)} vertices")
        self.names = ("position", "anywhere, as a seed's")
        super().walk(end)

    def decode_hull_hit(self, chord):
        a, c = self.mesh.origin[chord], self.mesh.far_corner(chord)
        hit = super().decode_hull_hit(chord)
        given = f"density {self.R >> 8}, curve at {self.estimates[0]}" if self.estimates else "L = 1"
        self.flush(f"infinity, c = {c}, a = {a}", given, "hit" if hit else "miss")
        return hit

    def decode_hit(self, chord):
        hit = super().decode_hit(chord)
        if not self.is_around_infinity(chord):
            t, corner = self.triangle, [self.mesh.origin[e] for e in (self.mesh.following(chord), self.mesh.preceding(chord), chord)]
            given = (f"certified {t.certified[0]}{t.certified[1]}, behind {t.behind[0] or '-'} {t.behind[2] or '-'}, S {t.S}, "
                     f"density {t.density}, expected {t.expected}, curve at {self.estimates[0]}")
            self.flush("v = {}, c = {}, a = {}".format(*corner), given, "hit" if hit else "miss")
        return hit

    def decode_tallied_position(self, place, *others):
        self.place = place
        self.found = super().decode_tallied_position(place, *others)
        return self.found

    def halves(self, lines, name, weight, formula_from):
        if name == "row":
            self.flush("column", "a number or an escape", "")
        left = super().halves(lines, name, weight, formula_from)
        given = f"lines {lines.first}..{lines.line(lines.count - 1)}, estimates {' '.join(map(str, self.estimates))}"
        given = given if name == "row" else f"t {self.place.t}, s {self.place.s}, {given}"
        self.flush(f"{name}, halves", given, f"lines {left.first}..{left.line(left.count - 1)}")
        return left

    def decode_inner_position(self):
        b, before = super().decode_inner_position(), len(self.rows)
        self.flush("row", "a number or an escape", f"line {self.found[1]}: b = ({b[0]}, {b[1]})")
        next(row for row in self.rows[before - 2:] if row[0] == "column")[3] = f"line {self.found[0]}"
        return b


def annotated_stream():
    data = (ROOT / "tests/golden/1.0/example.mtin").read_bytes()
    fields, narrator = Fields(data), Narrator(data)
    add_stream(fields)
    narrator.decode()
    symbols = table(["symbol", "depends on", "read", "result"], narrator.rows)
    x, y = zip(*narrator.mesh.vertices)
    vertices = table(["vertex", *range(len(x))], [["x", *x], ["y", *y], ["z", *narrator.mesh.heights]])
    triangles = " ".join(f"({' '.join(map(str, narrator.mesh.corners(t)))})" for t in range(len(narrator.mesh.origin) // 3)
                         if narrator.mesh.is_real(t))
    return "\n".join([hexdump(data), fields.table(), symbols, vertices,
                      f"    triangles  {triangles}\n    digest     {narrator.mesh.digest(set()):016X}\n"])


def add_pack_header(fields, pack):
    fields.add(4, "`mtpk`: a pack")
    fields.add(1, "version 5")
    fields.add(1, "no flag is set")
    placement, notes = pack.data[6], number(pack.data[8:10])
    fields.add(1, f"bytes of the placement: {placement}")
    fields.add(1, "always 0")
    for size, name in ((2, "bytes of the notes"), (2, "width of a tile"), (2, "height of a tile"), (2, "no lower z than"),
                       (2, "no higher z than"), (2, "always"), (4, "largest x"), (4, "largest y"), (4, "no tile has more vertices than"),
                       (4, "no compact tile has more bytes than"), (4, "identity"), (4, "margin below, in sixteenths and 1 more"),
                       (4, "margin above, in sixteenths and 1 more")):
        fields.add(size, lambda octets: f"{name}: {number(octets):08X}" if name == "identity" else f"{name}: {number(octets)}")
    end = fields.at + placement
    while fields.at < end:
        for name in ("offset", "numerator", "denominator"):
            add_varint(fields, lambda n: f"{'xyz'[(placement - end + fields.at) // 3]}: {name} {n}")
    return notes


NOTES = {0: "padding", 4: "accuracy", 8: "grid", 12: "true positions", 13: "surface", 16: "sums"}


def add_notes(fields, end):
    while fields.at < end:
        kind, size = fields.data[fields.at], number(fields.data[fields.at + 1:fields.at + 3])
        fields.add(3 + size, f"note {kind}, {NOTES[kind]}: {size} bytes of content")


def add_entry(fields, tile):
    fields.add(5, lambda octets: f"tile {tile}: its stream begins {number(octets)} bytes behind the index")
    fields.add(3, lambda octets: f"tile {tile}: {number(octets)} bytes")
    fields.add(4, lambda octets: f"tile {tile}: hash {number(octets):08X}")
    fields.add(2, lambda octets: f"tile {tile}: no lower z than {number(octets)}")
    fields.add(2, lambda octets: f"tile {tile}: no higher z than {number(octets)}")
    fields.add(4, lambda octets: f"tile {tile}: check {number(octets):08X}, from the identity")


def annotated_pack():
    data = (ROOT / "tests/golden/1.0/pair.mtp").read_bytes()
    pack, fields = Pack(data), Fields(data)
    notes = add_pack_header(fields, pack)
    add_notes(fields, fields.at + notes)
    fields.add(4, check_of(0, fields.at - 1))
    assert fields.at == pack.index
    for tile in range(pack.tiles):
        add_entry(fields, tile)
    assert fields.at == pack.streams
    while fields.at < len(data):
        add_stream(fields)
    tiles = []
    for tile in range(pack.tiles):
        mesh, x = pack.decode_tile(tile).mesh, tile % pack.columns * pack.size[0]
        vertices = " ".join(f"({x + p[0]} {p[1]} {z})" for p, z in zip(mesh.vertices, mesh.heights))
        tiles.append([tile, vertices, f"{mesh.digest(set()):016X}"])
    return "\n".join([hexdump(data), fields.table(), table(["tile", "vertices: x, y and z on the pack's lattice", "digest"], tiles)])


def unlisted():
    """Golden files without a row in test-files.md."""
    page = (ROOT / "shared/docs/test-files.md").read_text(encoding="utf-8")
    files = sorted((ROOT / "tests/golden").glob("*/*.mt[ip]*"))
    return [file.name for file in files if f"\n| {file.stem} | " not in page]


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1] != "--write" else ROOT / "shared/docs"
    rejected = 0
    for name, text in (("format-stream.md", annotated_stream()), ("format-pack.md", annotated_pack())):
        page = folder / name
        content = page.read_text(encoding="utf-8")
        if content.count(BEGIN) != 1 or content.count(END) != 1:
            sys.exit(f"{name} has no place for the annotated file, or several")
        before, _, rest = content.partition(BEGIN)
        old, _, after = rest.partition(END)
        if "--write" in sys.argv:
            page.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}", encoding="utf-8")
        elif old != f"\n{text}\n":
            print(f"rejected: {name} is not what the second decoder finds; annotated.py --write writes it")
            rejected += 1
    for name in unlisted():
        print(f"rejected: test-files.md does not list {name}")
        rejected += 1
    print(f"2 annotated files, {rejected} rejected")
    return 1 if rejected else 0


if __name__ == "__main__":
    sys.exit(main())
