"""Tests that weir reads packed files like the decoder of tests/packed, which was written from FORMAT.md alone."""

import struct
import sys
import unittest
from unittest import mock

import numpy
import weir
from support import SOURCE, FolderTest

sys.path.insert(0, str(SOURCE / "tests/packed"))
import blocks  # noqa: E402
import packed_decoder  # noqa: E402


def waves(extent):
    """Smooth, with a part that is zero; numpy's order, x last or first does not matter."""
    z, y, x = numpy.meshgrid(*(numpy.arange(n, dtype=numpy.float64) for n in reversed(extent)), indexing="ij")
    values = numpy.sin(x * 0.11) * numpy.cos(y * 0.07 + z * 0.05) + 0.3 * numpy.sin(z * 0.21)
    return numpy.where(x < 20, 0, values).astype(numpy.float32)


class Packed(FolderTest):
    def same_by_both(self, values, **options):
        path = self.folder / "packed.nvdb"
        weir.convert(values, path, encoding="packed", overwrite=True, **options)
        theirs, counts = packed_decoder.Grid(str(path)).read(*self.box(path))
        ours = weir.open(path).to_numpy()
        self.assertEqual(ours.astype("<f4").tobytes(), numpy.asarray(theirs, dtype="<f4").tobytes())
        return counts

    @staticmethod
    def box(path):
        grid = packed_decoder.Grid(str(path))
        return grid.low, grid.high

    def test_transformed_blocks(self):
        counts = self.same_by_both(waves((45, 38, 131)), rate=20)
        self.assertGreater(counts["transform"], 100)

    def test_blocks_of_whole_numbers(self):
        counts = self.same_by_both(numpy.round(waves((30, 20, 33)) * 100).astype(numpy.int16), lossless=True)
        self.assertGreater(counts["lattice"], 10)

    def test_values_outside_of_the_range_are_clamped_by_both(self):
        path = self.folder / "changed.nvdb"
        integers = numpy.round(waves((30, 20, 33)) * 100).astype(numpy.int16)
        for name, values, options, places in (
            ("the file's lattice", integers, {"lossless": True}, self.quantum_of_the_file),
            ("a lattice of each block", waves((30, 20, 33)), {"max_error": 1e-5}, self.quanta_of_streams),
        ):
            weir.convert(values, path, encoding="packed", overwrite=True, **options)
            content = bytearray(path.read_bytes())
            for at in places(path, content):
                struct.pack_into("<f", content, at, 1.75 * struct.unpack_from("<f", content, at)[0])
            path.write_bytes(content)
            grid = packed_decoder.Grid(path)
            with mock.patch.object(blocks, "clamped", lambda found, _: found):
                unclamped, _ = grid.read(grid.low, grid.high)
            theirs, counts = grid.read(grid.low, grid.high)
            with self.subTest(name), weir.open(path) as ours:
                self.assertEqual(set(+counts), {"lattice", packed_decoder.NO_STREAM})
                self.assertEqual(ours.to_numpy().tobytes(), theirs.tobytes())
                self.assertEqual(theirs.max(), grid.packed.constants.maximum)
                self.assertGreater(unclamped.max(), theirs.max())

    @staticmethod
    def packed_at(content):
        """Returns the offset at which the packed data of a file begin."""
        record = content.index(packed_decoder.NAME.encode()) - 32
        return record + struct.unpack_from("<q", content, record)[0]

    def quantum_of_the_file(self, _, content):
        return [self.packed_at(content) + 56]

    def quanta_of_streams(self, path, content):
        """Of all streams with a lattice of their own."""
        begin = self.packed_at(content)
        with mock.patch.object(blocks, "parse", side_effect=blocks.parse) as parse:
            grid = packed_decoder.Grid(path)
            grid.read(grid.low, grid.high)
        streams = {call.args[0] for call in parse.call_args_list}
        own = [s for s in streams if s[0] & 3 == blocks.LATTICE and s[0] >> 4 == blocks.OWN_LATTICE]
        return [content.index(stream, begin) + 5 for stream in own]

    def test_floats_kept_bit_by_bit(self):
        rng = numpy.random.default_rng(3)
        noise = rng.standard_normal((19, 17, 23)).astype(numpy.float32)
        counts = self.same_by_both(noise, lossless=True, preview="off")
        self.assertGreater(counts["raw"] + counts["lattice"], 10)

    def test_errors_within_a_bound(self):
        counts = self.same_by_both(waves((40, 40, 40)), max_error=1e-3, preview="on")
        self.assertGreater(counts["transform"] + counts["lattice"], 50)

    def test_a_region_reads_its_own_blocks_alone(self):
        path = self.folder / "region.nvdb"
        weir.convert(waves((64, 64, 64)), path, encoding="packed", rate=10)
        grid = weir.open(path)
        whole = grid.to_numpy()
        part = grid.to_numpy(((9, 20, 31), (40, 41, 62)))
        self.assertEqual(part.tobytes(), whole[31:62, 20:41, 9:40].tobytes())

    def test_a_picture_in_less_memory_than_the_blocks_take(self):
        path = self.folder / "picture.nvdb"
        weir.convert(waves((80, 96, 96)), path, encoding="packed", rate=20)
        grid = weir.open(path)
        options = {"size": (40, 30), "spp": 2, "mode": "dvr", "backend": "cpu"}
        picture = grid.render(memory="1MiB", **options)
        self.assertGreater(picture.std(), 5)
        numpy.testing.assert_array_equal(picture, grid.render(**options))
        message = self.refused(weir.UsageError, grid.render, memory=100000, **options)
        self.assertRegex(message, "^memory .* is too small to render this grid, which takes .*; give memory .* or more$")


if __name__ == "__main__":
    unittest.main()
