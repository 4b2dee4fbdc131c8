"""Compares Grid.sample with interpolation that is computed here."""

import ctypes
import itertools
import platform
import unittest
import warnings

import numpy

import weir
from support import FolderTest, noise, ramp, same


def blend(values, x, y, z):
    """Returns trilinear interpolation: the weighted sum of the eight voxels around, clamped at the ends."""
    total = 0.0
    corner = [min(max(p - 0.5, 0), n - 1) for p, n in zip((x, y, z), values.shape[::-1])]
    for upper in itertools.product((0, 1), repeat=3):
        index, share = [], 1.0
        for p, u, n in zip(corner, upper, values.shape[::-1]):
            share *= p % 1 if u else 1 - p % 1
            index.append(min(int(p) + u, n - 1))
        total += share * values[index[2], index[1], index[0]]
    return total


class Sample(FolderTest):
    def test_a_centre_is_its_voxel(self):
        values = noise((9, 17, 30))
        grid = self.lossless(values)
        z, y, x = numpy.mgrid[0:9, 0:17, 0:30]
        centres = numpy.stack([x, y, z], axis=-1) + 0.5
        for filter in ("trilinear", "nearest"):
            self.assertTrue(same(grid.sample(centres, filter), values.astype(numpy.float32)))

    def test_a_centre_is_its_voxel_beside_one_that_is_not_a_number(self):
        values = noise((9, 17, 30)).astype(numpy.float32)
        values[4, 8, 15] = numpy.nan
        grid = self.lossless(values, nonfinite="keep")
        z, y, x = numpy.mgrid[0:9, 0:17, 0:30]
        self.assertTrue(same(grid.sample(numpy.stack([x, y, z], axis=-1) + 0.5), values))
        self.assertTrue(numpy.isnan(grid.sample([[15, 8.5, 4.5]])).all())

    def test_the_values_are_the_same_where_the_caller_rounds_upwards(self):
        if platform.machine() != "x86_64":
            self.skipTest("the number of that mode is another one here")
        weir.convert(noise((64, 64, 64), numpy.float32), self.folder / "a.nvdb", rate=3, encoding="packed")
        points = numpy.random.default_rng(1).uniform(1, 63, (20000, 3)).astype(numpy.float32)
        fesetround, upwards, nearest = ctypes.CDLL("libm.so.6").fesetround, 0x800, 0
        for filter in ("nearest", "trilinear"):
            expected = weir.open(self.folder / "a.nvdb").sample(points, filter)
            grid = weir.open(self.folder / "a.nvdb")
            fesetround(upwards)
            try:
                found = grid.sample(points, filter)
            finally:
                fesetround(nearest)
            self.assertTrue(same(found, expected))

    def test_the_origin_is_the_centre_of_voxel_0(self):
        values = noise((9, 17, 30))
        grid = self.lossless(values, spacing=(2, 4, 8), origin=(10, 20, 30))
        world = numpy.array([(10, 20, 30), (12, 20, 30), (10 + 2 * 29, 20 + 4 * 16, 30 + 8 * 8)], float)
        positions = (world - grid.origin) / grid.spacing - grid.index_origin + 0.5
        expected = numpy.array([values[0, 0, 0], values[0, 0, 1], values[8, 16, 29]], numpy.float32)
        self.assertTrue(same(grid.sample(positions), expected))

    def test_a_ramp_is_exact_between_centres(self):
        grid = self.lossless(ramp(20, 30, 40))
        points = [(1, 1, 1), (7.75, 8, 8.25), (10.5, 20.25, 30.5), (19.5, 29.5, 39.5)]
        expected = [x - 0.5 + 100 * (y - 0.5) + 10000 * (z - 0.5) for x, y, z in points]
        numpy.testing.assert_array_equal(grid.sample(points), expected)

    def test_any_place_is_the_blend_of_eight(self):
        values = noise((9, 17, 30), numpy.uint8)
        grid = self.lossless(values)
        points = numpy.random.default_rng(2).uniform(-2, 32, (300, 3)).astype(numpy.float32)
        expected = [blend(values, *map(float, point)) for point in points]
        numpy.testing.assert_allclose(grid.sample(points), expected, rtol=0, atol=255 * 4e-6)

    def test_the_nearest_covers_the_place(self):
        values = ramp(20, 30, 40)
        grid = self.lossless(values)
        points = [(0, 0, 0), (0.99, 1, 1.01), (-5, 30, 40), (20, -1, 999)]
        numpy.testing.assert_array_equal(grid.sample(points, "nearest"), [0, 10100, 392900, 390019])

    def test_the_nearest_is_of_the_position_before_it_is_rounded(self):
        grid = self.lossless(numpy.broadcast_to(numpy.arange(60, dtype=numpy.float32), (3, 3, 60)).copy())
        points = [(49.999999, 0.5, 0.5), (0.99999999, 0.5, 0.5), (50, 0.5, 0.5), (-1e300, 0, 0), (1e300, 0, numpy.inf)]
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            numpy.testing.assert_array_equal(grid.sample(points, "nearest"), [49, 0, 50, 0, 59])
            self.assertEqual(grid.sample([(1e300, -1e300, 0)])[0], 59)

    def test_the_shape_is_that_of_the_points(self):
        grid = self.lossless(ramp(9, 9, 9))
        points = numpy.full((2, 5, 7, 3), 4.5)
        self.assertEqual(grid.sample(points).shape, (2, 5, 7))
        self.assertEqual(grid.sample(points).dtype, numpy.float32)
        self.assertEqual(grid.sample((4.5, 4.5, 4.5)).shape, ())
        self.assertEqual(grid.sample(numpy.zeros((0, 3))).shape, (0,))
        for wrong in (["1", "2", "3"], numpy.zeros(3, complex), [True, False, True]):
            self.assertIn("it must be numbers", self.refused(weir.UsageError, grid.sample, wrong))
        self.assertEqual(grid.sample(points[::-1, ::2, :, ::-1]).shape, (2, 3, 7))
        self.assertEqual(grid.sample([[4, 4, 4]]), 3.5 * 10101)

    def test_a_region_counts_from_its_corner(self):
        grid = self.lossless(ramp(20, 30, 40), roi=((3, 5, 7), (20, 30, 40)))
        self.assertEqual(grid.sample((0.5, 0.5, 0.5)), 70503)

    def test_what_are_no_points(self):
        grid = self.lossless(ramp(9, 9, 9))
        for message, arguments in {
            "points has the shape (2,), its last axis must be (x, y, z)": ([1, 2],),
            "points has the shape (3, 4), its last axis must be (x, y, z)": (numpy.zeros((3, 4)),),
            "points has the shape (), its last axis must be (x, y, z)": (7,),
            "points is 'a', it must be numbers, (x, y, z) along the last axis": ("a",),
            "points is [[1, 2, 'a']], it must be numbers, (x, y, z) along the last axis": ([[1, 2, "a"]],),
            "points has a position that is NaN; leave it out": ([[1, 2, numpy.nan]],),
            "filter is 'cubic', it must be 'trilinear' or 'nearest'": ([[1, 2, 3]], "cubic"),
        }.items():
            self.assertEqual(self.refused(weir.UsageError, grid.sample, *arguments), message)
        self.assertEqual(
            self.refused(weir.UsageError, grid.sample, numpy.ma.masked_array([[1, 2, 3]], [[0, 0, 1]])),
            "points is a masked array; give points.filled(VALUE), or leave the masked positions out",
        )


if __name__ == "__main__":
    unittest.main()
