"""Tests that grid[...] equals to_numpy()[...] and decodes no more than needed, and how numpy treats a grid."""

import itertools
import pathlib
import pickle
import unittest

import numpy

import weir
from support import FolderTest, noise, ramp, same
from weir.indexing import select

ONE_AXIS = (0, 7, -1, slice(None), slice(3, 20), slice(None, None, 2), slice(25, 2, -3), slice(None, None, -1))
STRIDES = (slice(None, None, 9), slice(-1, None, -16), slice(5, 6, 100))


class Indices(FolderTest):
    def check(self, grid, values, key):
        with self.subTest(key):
            found = grid[key]
            wanted = values[key]
            self.assertEqual(type(found), type(wanted))
            self.assertTrue(same(found, wanted))

    def test_every_kind_of_index_along_every_axis(self):
        values = ramp(27, 29, 31)
        grid = self.lossless(values)
        for key in itertools.product(ONE_AXIS, repeat=3):
            if not numpy.array_equal(grid[key], values[key]):
                self.fail(repr(key))
        for key in itertools.product(STRIDES, (4, slice(1, None, 5), *STRIDES), STRIDES):
            self.check(grid, values, key)

    def test_axes_that_are_left_out_and_added(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values)
        for key in (
            5,
            numpy.int16(-3),
            (5, 6),
            (5, 6, 7),
            (5, 6, numpy.uint8(7)),
            ...,
            (),
            (..., 3),
            (2, ..., 3),
            (None, 2, None, 3),
            (..., None),
            (1, 2, 3, None),
            numpy.s_[9:2],
            numpy.s_[:: -(2**70), 5 :: 2**65],
            numpy.s_[3:3, 4],
            numpy.s_[:, 100:, ::2],
        ):
            self.check(grid, values, key)

    def test_of_a_region_and_of_every_encoding(self):
        values = noise((60, 50, 40), numpy.float32)
        for encoding in ("float", "fpn", "fp8", "packed"):
            weir.convert(
                values, self.folder / "a.nvdb", encoding=encoding, roi=((3, 5, 7), (40, 49, 58)), overwrite=True, rate=1
            )
            with weir.open(self.folder / "a.nvdb") as grid:
                whole = grid.to_numpy()
                for key in (numpy.s_[::3, 1::7, ::-1], numpy.s_[::20, ::17, ::11], numpy.s_[4, 9:12], numpy.s_[-1, -1, -1]):
                    self.check(grid, whole, key)

    def test_places_outside(self):
        grid = self.lossless(ramp(12, 20, 28))
        the_grid = "the grid has 28 x 20 x 12 voxels [z, y, x]"
        kinds = "an index of a grid is a whole number, a slice, ... or None, not "
        for key, message in (
            (28, f"index 28 is out of bounds for axis 0 (z) with size 28; {the_grid}"),
            ((0, -21), f"index -21 is out of bounds for axis 1 (y) with size 20; {the_grid}"),
            ((..., 12), f"index 12 is out of bounds for axis 2 (x) with size 12; {the_grid}"),
            ((1, 2, 3, 4), "too many indices: a grid has the 3 axes [z, y, x], but 4 were given"),
            ((..., ...), "an index can only have a single ellipsis ('...')"),
            (1.0, kinds + "1.0; for others index to_numpy()"),
            (True, kinds + "True; for others index to_numpy()"),
            (([1, 2],), kinds + "[1, 2]; for others index to_numpy()"),
            (
                numpy.zeros((28, 20, 12), bool),
                kinds + "an array of bool with the shape (28, 20, 12); for others index to_numpy()",
            ),
            (numpy.arange(3), kinds + "an array of int64 with the shape (3,); for others index to_numpy()"),
            (([*range(100)],), kinds + "a list; for others index to_numpy()"),
        ):
            self.assertEqual(self.refused(IndexError, grid.__getitem__, key), message)

    def test_only_blocks_that_are_asked_for_are_decoded(self):
        class Core:
            """Counts the voxels that are read."""

            extent, levels = (4096, 4096, 4096), 13

            def read(self, low, high, level):
                self.asked = low, high, level
                return numpy.zeros([b - a for a, b in zip(low, high)][::-1], numpy.float32)

            def read_strided(self, first, step, count):
                self.asked = first, step, count
                return numpy.zeros(count[::-1], numpy.float32)

        grid = weir.Grid.__new__(weir.Grid)
        grid._core = Core()
        grid[7:9, 4000, -1]
        self.assertEqual(grid._core.asked, ((4095, 4000, 7), (4096, 4001, 9), 0))
        self.assertEqual(grid[::512, ::-1024, 5].shape, (8, 4))
        self.assertEqual(grid._core.asked, ((5, 4095, 0), (1, -1024, 512), (1, 4, 8)))
        grid._core.asked = None
        self.assertEqual(grid[5:5].shape, (0, 4096, 4096))
        self.assertIsNone(grid._core.asked)

    def test_selection_says_its_bounds(self):
        chosen = select(numpy.s_[20:3:-5, 4, 1:], (30, 30, 30))
        self.assertEqual((chosen.low, chosen.high, chosen.shape), ((5, 4, 1), (21, 5, 30), (4, 29)))


class AsAnArray(FolderTest):
    def test_what_it_is(self):
        grid = self.lossless(ramp(12, 20, 28))
        self.assertEqual((grid.shape, grid.ndim, grid.size, len(grid)), ((28, 20, 12), 3, 6720, 28))
        self.assertIs(grid.dtype, numpy.dtype("float32"))

    def test_functions_of_numpy_take_it(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values)
        self.assertTrue(same(numpy.asarray(grid), values))
        self.assertTrue(same(numpy.asarray(grid, dtype=float), values.astype(float)))
        self.assertTrue(same(numpy.array(grid, dtype="int32"), values.astype("int32")))
        self.assertEqual(numpy.mean(grid), values.mean())
        self.assertEqual([plane[0, 0] for plane in grid], list(values[:, 0, 0]))

    def test_the_arguments_of_both_numpys(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values)
        for arguments in ({}, {"copy": None}, {"copy": True}, {"dtype": None}):
            self.assertTrue(same(grid.__array__(**arguments), values))
        self.assertTrue(same(grid.__array__("float64", copy=True), values.astype("float64")))
        self.assertEqual(
            self.refused(ValueError, grid.__array__, copy=False),
            "copy is False, but the values of a grid are decoded into an array of their own",
        )

    def test_a_pickled_grid_opens_the_file_again(self):
        values = ramp(12, 20, 28)
        with self.lossless(values) as grid:
            again = pickle.loads(pickle.dumps(grid))
        self.assertTrue(grid.closed)
        self.assertEqual(again.path, str(pathlib.Path(grid.path).resolve()))
        self.assertTrue(same(again[...], values))
        again.close()


if __name__ == "__main__":
    unittest.main()
