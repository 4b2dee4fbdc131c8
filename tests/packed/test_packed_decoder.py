"""Tests the independent decoder of files on a file that is built here: `python3 -m unittest` in this folder."""

import contextlib
import io
import pathlib
import random
import struct
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))

import block_encoder as encoder  # noqa: E402
import blocks  # noqa: E402
import packed_decoder  # noqa: E402
from coefficients import Invalid  # noqa: E402
from samples import F32, MEANS, UNIFORM, constants, random_numbers, values_of  # noqa: E402


class File(unittest.TestCase):
    """A file of three regions along x, built here. The kind of each block is random; some have no stream."""

    LOW, HIGH = (-5, 3, 10), (260, 20, 30)  # the index box, without HIGH
    TWO_BLOCKS = "mean 0, transform 2, lattice 0, raw 0, no stream 0\n"
    BACKGROUND, VALUE = F32(0.5), F32(4.25)

    @classmethod
    def block(cls, x, y, z):
        """Returns (stream, float32 [8, 8, 8]) of a block. The stream is None if the block has none."""
        rng = random.Random(x * 10007 + y * 101 + z)
        given = constants()
        kind = rng.randrange(5)
        if kind == 4:
            return None, numpy.full((8, 8, 8), cls.VALUE)
        stream = (lambda: encoder.mean_stream(4, 3, given, MEANS),
                  lambda: encoder.transform_stream(4, 10, random_numbers(rng, 10, 3), 3, given, MEANS),
                  lambda: encoder.lattice_stream(2, [rng.getrandbits(4) for _ in range(512)], given),
                  lambda: encoder.raw_stream([rng.gauss(0, 1) for _ in range(512)]))[kind]()
        return stream, values_of(stream).reshape(8, 8, 8)

    @classmethod
    def chunk(cls, region):
        groups, bases, masks = b"", [], []
        for group in range(256):
            bases.append(1548 + len(groups))
            streams = {}
            for bit in range(16):
                position = 16 * group + bit
                at = [16 * r + (position >> shift & 15) for r, shift in zip(region, (8, 4, 0))]
                if all(a // 8 <= b <= (h - 1) // 8 for a, b, h in zip(cls.LOW, at, cls.HIGH)):
                    stream = cls.block(*at)[0]
                    streams.update({bit: stream} if stream else {})
            masks.append(sum(1 << bit for bit in streams))
            ends = numpy.cumsum([len(s) for s in streams.values()]) + 2 * len(streams)
            groups += ends.astype("<u2").tobytes() + b"".join(streams.values())
        bases.append(1548 + len(groups))
        chunk = struct.pack("<2f257I256H", *MEANS, *bases, *masks) + groups
        return chunk + bytes(-len(chunk) % 4)

    @classmethod
    def packed(cls):
        given, table = constants(), 96 + 3840
        head = struct.pack("<2I3i3I2fi2fI2f2I2Q", 1, 0, -1, 0, 0, 4, 1, 1, given.minimum, given.maximum, given.coarsest,
                           given.lattice_minimum, given.lattice_quantum, given.lattice_bits, given.below_one,
                           given.below_more, 96, 120, table, 0)
        entries, chunks = b"", b""
        for x in range(-1, 3):
            chunk = b"" if x == 1 else cls.chunk((x, 0, 0))
            entries += struct.pack("<QfI", table + 64 + len(chunks) if chunk else 0, cls.VALUE, len(chunk))
            chunks += chunk
        data = head + numpy.array(UNIFORM, "<u2").tobytes() + entries + chunks
        return struct.pack("<Q", 8 + len(data)) + data

    @classmethod
    def setUpClass(cls):
        packed = cls.packed()
        grid = bytearray(800 + 288)
        grid[:8] = b"NanoVDB0"
        struct.pack_into("<qI", grid, 640, 800, 1)
        struct.pack_into("<q", grid, 672 + 24, 64)
        struct.pack_into("<6iIf", grid, 736, *cls.LOW, *[i - 1 for i in cls.HIGH], 0, cls.BACKGROUND)
        struct.pack_into("<qQ4I32s", grid, 800, 288, len(packed) // 4, 4, 0, 2, 1, b"weir_packed:1")
        meta = bytearray(176)
        struct.pack_into("<I", meta, 136, 8)
        cls.file = b"NanoVDB0" + struct.pack("<IHH", 0, 1, 0) + meta + b"a".ljust(8, b"\0") + grid + packed
        cls.packed_at = len(cls.file) - len(packed)

    def decoded(self, *box, change=lambda file: file):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.nvdb"
            path.write_bytes(change(self.file))
            grid = packed_decoder.Grid(path)
            return grid.read(*(box or (grid.low, grid.high)))

    def expected(self, x, y, z):
        if not all(a <= i < b for a, i, b in zip(self.LOW, (x, y, z), self.HIGH)):
            return self.BACKGROUND
        return self.VALUE if x // 128 == 1 else self.block(x // 8, y // 8, z // 8)[1][x % 8, y % 8, z % 8]

    def test_the_whole_box_has_every_block(self):
        values, counts = self.decoded()
        self.assertEqual(values.shape, (20, 17, 265))
        self.assertEqual(sum(counts.values()), 34 * 3 * 3)
        self.assertEqual(set(counts), {*blocks.KINDS, packed_decoder.NO_STREAM})
        for x, y, z in [(-5, 3, 10), (259, 19, 29), (0, 8, 16), (127, 15, 20), (128, 9, 11), (256, 7, 28)]:
            self.assertEqual(values[z - 10, y - 3, x + 5], self.expected(x, y, z))

    def test_a_box_is_cut_from_the_whole_and_has_background_around(self):
        low, high = (-9, 0, 9), (13, 18, 31)
        values, _ = self.decoded(low, high)
        for z, y, x in numpy.ndindex(values.shape):
            if (x + y + z) % 7 == 0:
                self.assertEqual(values[z, y, x], self.expected(x - 9, y, z + 9))

    def test_a_changed_header_is_refused(self):
        def put(at, layout, value):
            def change(file):
                changed = bytearray(file)
                struct.pack_into(layout, changed, self.packed_at + at, value)
                return changed
            return change
        table, chunk = 96 + 3840, 96 + 3840 + 64
        for at, layout, value, why in (
                (8, "<I", 2, "version 2"), (12, "<I", 2, "header"), (16, "<i", 0, "index box"),
                (28, "<I", 5, "index box"), (44, "<f", -2000, "constants"), (48, "<i", 251, "constants"),
                (98, "<H", 0, "table of frequencies"), (table + 12, "<I", 4, "chunk"), (chunk, "<f", 3, "means"),
                (chunk + 8, "<I", 1, "groups")):
            with self.assertRaisesRegex(Invalid, why):
                self.decoded(change=put(at, layout, value))

    def test_the_command_writes_x_fastest(self):
        with tempfile.TemporaryDirectory() as folder:
            path, out = pathlib.Path(folder) / "a.nvdb", pathlib.Path(folder) / "a.raw"
            path.write_bytes(self.file)
            self.assertEqual(self.command(path, out, "0,3,10", "9,6,12"), (0, self.TWO_BLOCKS))
            values = numpy.fromfile(out, "<f4").reshape(2, 3, 9)
            self.assertEqual(values[1, 2, 8], self.expected(8, 5, 11))
            path.write_bytes(b"nothing")
            self.assertEqual(self.command(path, out), (1, f"{path}: not a NanoVDB file\n"))

    @staticmethod
    def command(*arguments):
        """Runs the decoder. Returns (exit code, printed text)."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            code = packed_decoder.main([str(argument) for argument in arguments])
        return code, printed.getvalue()


if __name__ == "__main__":
    unittest.main()
