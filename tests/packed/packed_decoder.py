#!/usr/bin/env python3
"""packed_decoder.py FILE.nvdb OUT.raw [x0,y0,z0 x1,y1,z1]: the packed data of a NanoVDB file as float32, x fastest.

The box is from the voxel x0,y0,z0 up to, and without, x1,y1,z1; left out, the index box of the grid. Prints how many
blocks of each kind the box touches. Exits with 1 and a message where the file or a stream is not as specified.

Written from format/FORMAT.md with numpy alone, apart from weir: it is what weir's own decoders are compared with.
"""

import collections
import pathlib
import struct
import sys

import numpy

import blocks
from coefficients import TABLES, SYMBOLS, Invalid, Tables

NAME = "weir_packed:1"
HEADER_BYTES = 96
REGION_BYTES = 16
GROUPS = 1548  # byte offset of the first group in a chunk
NO_STREAM = "no stream"


def unpack(layout, data, at):
    """Returns the little-endian values at an offset. A single value is returned without a tuple."""
    if at < 0 or at + struct.calcsize("<" + layout) > len(data):
        raise Invalid(f"an offset of {at} lies outside of {len(data)} bytes")
    values = struct.unpack_from("<" + layout, data, at)
    return values[0] if len(values) == 1 else values


def float32(data, at):
    """Reads a float32 bit for bit. A Python float would change the bits of a NaN."""
    unpack("I", data, at)
    return numpy.frombuffer(data, "<f4", 1, at)[0]


def text(data, at):
    return bytes(data[at:at + 256]).split(b"\0")[0].decode(errors="replace")


class Grid:
    """The first grid of a file: its index box [low, high), background and packed data."""

    def __init__(self, path):
        file = memoryview(pathlib.Path(path).read_bytes())
        if bytes(file[:8]) not in (b"NanoVDB0", b"NanoVDB2"):
            raise Invalid("not a NanoVDB file")
        at = 16
        for _ in range(unpack("H", file, 12)):
            at += 176 + unpack("I", file, at + 136)
        grid = file[at:]
        if bytes(grid[:8]) not in (b"NanoVDB0", b"NanoVDB1"):
            raise Invalid(f"no grid at byte {at}")
        root = 672 + unpack("q", grid, 672 + 24)
        box = unpack("6i", grid, root)
        self.low, self.high = box[:3], tuple(i + 1 for i in box[3:])
        self.background = float32(grid, root + 28)
        self.packed = PackedData(self.find(grid), self.low, self.high)

    @staticmethod
    def find(grid):
        first, count = unpack("qI", grid, 640)
        for record in range(first, first + 288 * count, 288):
            offset, values, size, _, kind, value_type = unpack("qQ4I", grid, record)
            if text(grid, record + 32) != NAME:
                continue
            if (size, kind, value_type) != (4, 2, 1):
                raise Invalid(f"the record {NAME} is not of floats")
            at = record + offset
            if at % 8 or not 0 <= at <= at + 4 * values <= len(grid):
                raise Invalid(f"the packed data, {4 * values} bytes at {at}, are not in the grid")
            return grid[at:at + 4 * values]
        raise Invalid(f"the grid has no blind data {NAME}")

    def read(self, low, high):
        """Returns (float32 [z, y, x] of the voxels in [low, high), number of blocks by kind)."""
        values = numpy.full([b - a for a, b in zip(low, high)], self.background, numpy.float32)
        inner = [max(a, b) for a, b in zip(low, self.low)], [min(a, b) for a, b in zip(high, self.high)]
        counts = collections.Counter()
        if all(a < b for a, b in zip(*inner)):
            cut = tuple(slice(a - o, b - o) for a, b, o in zip(*inner, low))
            values[cut] = self.packed.read(*inner, counts)
        return values.transpose(2, 1, 0), counts


class PackedData:
    """The regions, chunks and streams of packed data. [low, high): the index box of the grid."""

    def __init__(self, data, low, high):
        self.data = data
        size, version, flags = unpack("QII", data, 0)
        if version != 1:
            raise Invalid(f"packed data of version {version}")
        if size != len(data) or flags & ~1 or unpack("I", data, 76) != TABLES:
            raise Invalid("the header of the packed data is not that of version 1")
        self.first = unpack("3i", data, 16)
        self.count = unpack("3I", data, 28)
        if self.first != tuple(i // 128 for i in low) or self.count != tuple(
                (b - 1) // 128 - a // 128 + 1 for a, b in zip(low, high)):
            raise Invalid("the regions are not those of the index box")
        self.constants = self.read_constants()
        self.table = unpack("Q", data, 80)

    def read_constants(self):
        minimum, maximum, coarsest, *lattice, bits, one, more, tables = unpack("2fi2fI2fI", self.data, 40)
        if not numpy.isfinite([minimum, maximum, *lattice, one, more]).all() or minimum > maximum or bits > 24 or (
                abs(coarsest) > blocks.MOST_STEP):
            raise Invalid("the constants of the packed data are out of range")
        if tables % 4 or not HEADER_BYTES <= tables <= len(self.data) - 2 * TABLES * SYMBOLS:
            raise Invalid(f"tables at {tables}")
        table = numpy.frombuffer(self.data, "<u2", TABLES * SYMBOLS, tables)
        numbers = [numpy.float32(v) for v in (minimum, maximum, *lattice, one, more)]
        return blocks.Constants(*numbers[:2], coarsest, *numbers[2:4], bits, *numbers[4:], Tables(table))

    def read(self, low, high, counts):
        """Returns float32 [x, y, z] of a box inside the index box. Adds the box's blocks to `counts`."""
        first, last = [a // 8 for a in low], [(b - 1) // 8 for b in high]
        size = [b - a + 1 for a, b in zip(first, last)]
        values = numpy.empty((size[0], 8, size[1], 8, size[2], 8), numpy.float32)
        for region in numpy.ndindex(*[b // 16 - a // 16 + 1 for a, b in zip(first, last)]):
            origin = [(a // 16 + r) * 16 for a, r in zip(first, region)]  # the region's lowest block
            ranges = [range(max(a, o), min(b, o + 15) + 1) for a, b, o in zip(first, last, origin)]
            places = [(x, y, z) for x in ranges[0] for y in ranges[1] for z in ranges[2]]
            positions = [(x & 15) << 8 | (y & 15) << 4 | z & 15 for x, y, z in places]
            found = self.decode([o // 16 for o in origin], positions, counts)
            cut = [slice(r.start - a, r.stop - a) for r, a in zip(ranges, first)]
            found = found.reshape(*map(len, ranges), 8, 8, 8).transpose(0, 3, 1, 4, 2, 5)
            values[cut[0], :, cut[1], :, cut[2]] = found
        whole = values.reshape([8 * n for n in size])
        return whole[tuple(slice(a - 8 * f, b - 8 * f) for a, b, f in zip(low, high, first))]

    def decode(self, region, positions, counts):
        """Returns float32 [block, x, y, z] of blocks, by their position in the region (in units of 128 voxels)."""
        x, y, z = (r - f for r, f in zip(region, self.first))
        entry = self.table + REGION_BYTES * (x + self.count[0] * (y + self.count[1] * z))
        at, _, size = unpack("Q2I", self.data, entry)
        values = numpy.full((len(positions), 8, 8, 8), float32(self.data, entry + 8))
        if at == 0:
            counts[NO_STREAM] += len(positions)
            return values
        if at % 4 or size < GROUPS or at + size > len(self.data):
            raise Invalid(f"region {tuple(region)} has a chunk of {size} bytes at {at}")
        chunk = Chunk(self.data[at:at + size])
        parsed = {}
        for n, position in enumerate(positions):
            stream = chunk.stream(position)
            try:
                if stream is not None:
                    parsed[n] = blocks.parse(stream, self.constants, chunk.means)
            except Invalid as error:
                raise Invalid(f"region {tuple(region)}, block {position:#05x}: {error}") from error
            counts[NO_STREAM if stream is None else blocks.KINDS[parsed[n].kind]] += 1
        if parsed:
            values[list(parsed)] = blocks.values_of(list(parsed.values()), self.constants)
        return values


class Chunk:
    """The streams of a region's blocks and the range of the blocks' means."""

    def __init__(self, data):
        self.data = data
        self.means = tuple(map(numpy.float32, unpack("2f", data, 0)))
        self.bases = unpack("257I", data, 8)
        self.masks = unpack("256H", data, 1036)
        rises = all(a <= b for a, b in zip(self.bases, self.bases[1:]))
        if not numpy.isfinite(self.means).all() or not self.means[0] <= self.means[1]:
            raise Invalid("the range of means of a chunk is not one")
        if self.bases[0] != GROUPS or not rises or self.bases[256] > len(data):
            raise Invalid("the groups of a chunk do not follow each other")

    def stream(self, position):
        """Returns the bytes of a block's stream; None if the block has no stream."""
        group, bit = divmod(position, 16)
        mask = self.masks[group]
        if not mask >> bit & 1:
            return None
        data = self.data[self.bases[group]:self.bases[group + 1]]
        number, directory = (mask & ((1 << bit) - 1)).bit_count(), 2 * mask.bit_count()
        begin = unpack("H", data, 2 * number - 2) if number else directory
        end = unpack("H", data, 2 * number)
        if not directory <= begin < end <= len(data):
            raise Invalid(f"block {position:#05x} has no stream in bytes {begin} to {end} of its group")
        return bytes(data[begin:end])


def main(arguments):
    if len(arguments) not in (2, 4):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        grid = Grid(arguments[0])
        box = [tuple(map(int, corner.split(","))) for corner in arguments[2:]] or [grid.low, grid.high]
        values, counts = grid.read(*box)
    except (OSError, Invalid) as error:
        print(f"{arguments[0]}: {error}", file=sys.stderr)
        return 1
    values.astype("<f4").tofile(arguments[1])
    print(", ".join(f"{kind} {counts[kind]}" for kind in (*blocks.KINDS, NO_STREAM)))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
