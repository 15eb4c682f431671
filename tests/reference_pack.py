# SPDX-License-Identifier: MIT
"""The pack of format-pack.md, for reference_decoder.py: which tiles there are, and the stream of each. Written from the page
alone, for people who read along. Comments name its sections."""

import zlib

from reference_decoder import Bytes, Decoder, print_terrain, read_placement
from reference_symbols import Refusal, require


def fnv32(data):
    value = 0x811C9DC5
    for byte in data:
        value = (value ^ byte) * 0x01000193 & 0xFFFFFFFF
    return value


class Pack:
    def __init__(self, data):
        self.data = data
        reader = Bytes(data)
        self.read_header(reader)
        self.index = reader.position
        self.streams = self.index + 20 * self.tiles

    def read_header(self, reader):
        """Section 2, Fixed header."""
        if reader.take(4) != b"mtpk":
            raise Refusal("foreign", "this is not a microtin pack")
        if reader.take(1) != b"\x05":
            raise Refusal("unsupported", "this version of packs is not known")
        flags = reader.number(1)
        if flags >= 16:
            raise Refusal("unsupported", "a flag of the pack is not known")
        placement, zero, notes = reader.number(1), reader.number(1), reader.number(2)
        fields = reader.take(38)
        content = Bytes(reader.take(placement), 0, "malformed")
        reader.take(notes)
        reader.check(0, "the header")
        if flags:
            raise Refusal("unsupported", "a flag of the pack is not known")
        require(zero == 0, "a byte of the header is not 0")
        require(placement <= 66, "the placement is too long")
        self.read_fields(Bytes(fields))
        if placement:
            read_placement(content)
            require(content.at_end(), "the placement has more bytes than its numbers")

    def read_fields(self, reader):
        self.size = reader.number(2), reader.number(2)
        reader.take(4)                                   # bounds of heights, which decoding does not need
        zero = reader.number(2)
        self.largest = reader.number(4), reader.number(4)
        self.most_vertices, _, self.identity = reader.number(4), reader.number(4), reader.number(4)
        margins = reader.number(4), reader.number(4)
        require(zero == 0, "a number of the header is not 0")
        require(min(self.size) >= 1, "a tile has no width or no height")
        require(1 <= min(self.largest) and max(self.largest) < 1 << 31, "the lattice is out of range")
        require(self.most_vertices <= 1 << 24, "the number of vertices is out of range")
        require(max(margins) <= (1 << 20) + 1, "a margin is out of range")
        self.columns = (self.largest[0] - 1) // self.size[0] + 1
        self.rows = (self.largest[1] - 1) // self.size[1] + 1
        self.tiles = self.columns * self.rows
        require(self.tiles < 1 << 32, "the pack has too many tiles")

    def stream(self, tile):
        """Section 2, Index entry: the bytes of a tile's stream; None if the tile has no terrain."""
        reader = Bytes(self.data, self.index + 20 * tile)
        entry = reader.take(16)
        if reader.number(4) != zlib.crc32(tile.to_bytes(4, "little") + entry, self.identity):
            raise Refusal("damaged", "the check of the index entry fails")
        reader = Bytes(entry)
        offset, size, expected = reader.number(5), reader.number(3), reader.number(4)
        if size == 0:
            require(entry == bytes(16), "a tile without terrain has numbers")
            return None
        stream = Bytes(self.data, self.streams + offset).take(size)
        if fnv32(stream) != expected:
            raise Refusal("damaged", "the hash of the tile's stream is wrong")
        return stream

    def decode_tile(self, tile):
        """Section 2, Streams of tiles: the decoder of a tile, None if the tile has no terrain."""
        stream = self.stream(tile)
        if stream is None:
            return None
        try:
            decoder = Decoder(stream)
            self.check_tile(decoder.header, tile)
            return decoder.decode()
        except Refusal as refusal:
            if refusal.status == "unsupported":
                raise
            raise Refusal("malformed", str(refusal)) from refusal    # the hash is right, so nothing is damaged or missing

    def check_tile(self, header, tile):
        require(not header.placement and not header.notes, "the stream of a tile has a placement or notes")
        require(header.vertices <= self.most_vertices, "a tile has more vertices than the header states")
        for axis, number in enumerate((tile % self.columns, tile // self.columns)):
            left = self.largest[axis] - number * self.size[axis]
            require(header.largest[axis] <= min(self.size[axis], left), "the stream reaches beyond its tile")


def print_pack(data):
    """Decodes all tiles that can be decoded. The first refusal is raised at the end."""
    pack, first = Pack(data), None
    for tile in range(pack.tiles):
        print("tile", tile)
        try:
            decoder = pack.decode_tile(tile)
            if decoder is None:
                print("no terrain")
            else:
                print_terrain(decoder)
        except Refusal as refusal:
            print(refusal)
            first = first or refusal
    if first:
        raise first
