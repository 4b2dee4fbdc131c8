"""Tests weir.open: a grid's properties, all values and parts of them, levels, bounds, lifetime."""

import copy
import gc
import json
import os
import pickle
import shutil
import unittest

import numpy

import weir
from support import FolderTest, noise, ramp, run_weir, same


class Properties(FolderTest):
    def test_of_a_converted_array(self):
        values = ramp(12, 20, 28)
        values[:, :8, :8] = 7
        grid = self.lossless(values, background=7, spacing=(0.5, 1, 2))
        self.assertEqual(grid.path, str(self.folder / "a.nvdb"))
        self.assertEqual(grid.extent, (12, 20, 28))
        self.assertEqual(grid.index_origin, (0, 0, 0))
        self.assertEqual(grid.background, 7)
        self.assertEqual(grid.range, (7, values.max()))
        self.assertEqual(grid.type, "float32")
        self.assertEqual(grid.bytes, (self.folder / "a.nvdb").stat().st_size)
        self.assertEqual(repr(grid), f"<weir.Grid '{self.folder}/a.nvdb', 12 x 20 x 28, float32>")
        self.assertEqual(grid.certificate, grid.sidecar["error"])
        self.assertTrue(grid.certificate["lossless"])

    def test_a_path_of_bytes_is_a_text_in_path(self):
        self.lossless(ramp(9, 9, 9), name="\udcff.nvdb")
        name = os.fsencode(self.folder / "\udcff.nvdb")
        with weir.open(name) as grid:
            self.assertEqual(grid.path, os.fsdecode(name))
            self.assertEqual(repr(grid), f"<weir.Grid {os.fsdecode(name)!r}, 9 x 9 x 9, float32>")

    def test_packed_says_how_blocks_are_stored(self):
        self.assertFalse(self.lossless(ramp(9, 9, 9)).packed)
        weir.convert(ramp(9, 9, 9), self.folder / "p.nvdb", encoding="packed")
        with weir.open(self.folder / "p.nvdb") as grid:
            self.assertTrue(grid.packed)
            self.assertEqual(grid.type, "float32")

    def test_without_a_sidecar(self):
        grid = self.lossless(ramp(9, 9, 9))
        (self.folder / "a.nvdb.json").unlink()
        self.assertIsNone(grid.sidecar)
        self.assertIsNone(grid.certificate)

    def test_verify_has_the_checks_of_the_command(self):
        grid = self.lossless(noise((20, 30, 40)))
        checks = grid.verify()
        self.assertTrue(all(check.ok for check in checks))
        self.assertEqual(run_weir("verify", grid.path), f"{grid.path}: all {len(checks)} checks hold\n")

    def test_another_working_directory_changes_nothing(self):
        values = noise((20, 30, 40))
        here = self.lossless(values)
        (self.folder / "other").mkdir()
        weir.convert(values[:9], self.folder / "other/a.nvdb", lossless=True)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        with weir.open("a.nvdb") as grid:
            os.chdir("other")
            self.assertEqual(grid.sidecar, here.sidecar)
            self.assertEqual(grid.verify(), here.verify())
            self.assertEqual(repr(grid), "<weir.Grid 'a.nvdb', 40 x 30 x 20, fpn>")

    def test_verify_finds_a_changed_byte(self):
        self.lossless(noise((20, 30, 40)))
        content = bytearray((self.folder / "a.nvdb").read_bytes())
        content[-1] ^= 1
        (self.folder / "a.nvdb").write_bytes(content)
        with weir.open(self.folder / "a.nvdb") as grid:
            self.assertEqual([check.name for check in grid.verify() if not check.ok], ["sidecar file.digest"])


class ToNumpy(FolderTest):
    def test_lossless_is_lossless(self):
        for shape in ((1, 1, 1), (1, 1, 300), (300, 1, 1), (8, 8, 8), (9, 130, 17)):
            with self.subTest(shape):
                values = noise(shape, numpy.float32)
                grid = self.lossless(values, overwrite=True)
                self.assertTrue(same(grid.to_numpy(), values))

    def test_what_was_lost_is_what_the_certificate_says(self):
        values = noise((80, 64, 96), numpy.float32)
        record = weir.convert(values, self.folder / "a.nvdb", rate=6)
        with weir.open(self.folder / "a.nvdb") as grid:
            difference = grid.to_numpy().astype(float) - values
        self.assertEqual(numpy.abs(difference).max(), record["error"]["max_abs"])
        self.assertAlmostEqual((difference**2).mean(), record["error"]["mse"], delta=1e-12 * record["error"]["mse"])

    def test_the_values_are_those_of_the_command(self):
        values = noise((80, 64, 96), numpy.float32)
        weir.convert(values, self.folder / "a.nvdb", rate=6)
        with weir.open(self.folder / "a.nvdb") as grid:
            again = grid.to_numpy()
        again.tofile(self.folder / "a_96x64x80_float32.raw")
        report = run_weir("compare", self.folder / "a_96x64x80_float32.raw", self.folder / "a.nvdb", "--json")
        self.assertTrue(json.loads(report)["lossless"])

    def test_parts(self):
        values = ramp(12, 20, 28)
        grid = self.lossless(values)
        for roi in (numpy.s_[3:20, 5:6, 0:12], numpy.s_[-4:, :, 1:-1], numpy.s_[:, :9], numpy.s_[9:12]):
            with self.subTest(roi):
                self.assertTrue(same(grid.to_numpy(roi), values[roi]))
        self.assertTrue(same(grid.to_numpy(((1, 2, 3), (4, 9, 28))), values[3:28, 2:9, 1:4]))
        self.assertTrue(same(grid.to_numpy(numpy.array([[1, 2, 3], [4, 9, 28]])), values[3:28, 2:9, 1:4]))

    def test_parts_that_are_none(self):
        grid = self.lossless(ramp(12, 20, 28))
        inside = "it must hold a voxel and lie in the 12 x 20 x 28 (x, y, z) there are"
        form = (
            "it must be three slices [z0:z1, y0:y1, x0:x1] without steps, or ((x0, y0, z0), (x1, y1, z1))"
        )
        for roi, why in (
            (((0, 0, 0), (13, 1, 1)), inside),
            (((-1, 0, 0), (1, 1, 1)), inside),
            (((3, 0, 0), (3, 1, 1)), inside),
            (numpy.s_[5:5], inside),
            (numpy.s_[::2], form),
            (numpy.s_[::-1, :, :], form),
            (((0, 0), (1, 1)), form),
            (((0, 0, 0.5), (1, 1, 1)), form),
            (((0, 0, 0), (float("inf"), 1, 1)), form),
            (((0, 0, 0), (1, float("nan"), 1)), form),
            (7, form),
            ((1, 2, 3), form),
        ):
            with self.subTest(roi):
                self.assertEqual(self.refused(weir.UsageError, grid.to_numpy, roi), f"roi is {roi!r}, {why}")

    def test_a_part_that_is_an_array_is_named_by_type_and_shape(self):
        grid = self.lossless(ramp(12, 20, 28))
        message = self.refused(weir.UsageError, grid.to_numpy, numpy.ones((28, 20, 12), bool))
        self.assertEqual(
            message,
            "roi is an array of bool with the shape (28, 20, 12), it must be three slices [z0:z1, y0:y1, x0:x1] without "
            "steps, or ((x0, y0, z0), (x1, y1, z1))",
        )

    def test_arrays_are_the_callers_own(self):
        values = ramp(12, 20, 28)
        with weir.open(self.lossless(values).path) as grid:
            first = grid.to_numpy()
            first[:] = 0
            second = grid.to_numpy()
        del grid
        gc.collect()
        self.assertTrue(same(second, values))
        self.assertTrue(second.flags.owndata and second.flags.writeable and second.flags.c_contiguous)


class Levels(FolderTest):
    @staticmethod
    def means(values, level):
        """Returns the level as numpy computes it in double precision."""
        edge = 1 << level
        padded = numpy.pad(values.astype(float), [(0, -n % edge) for n in values.shape], constant_values=numpy.nan)
        z, y, x = (n // edge for n in padded.shape)
        return numpy.nanmean(padded.reshape(z, edge, y, edge, x, edge), axis=(1, 3, 5)).astype(numpy.float32)

    def test_each_level_is_the_means_of_its_cubes(self):
        values = noise((37, 70, 50))  # integers, so that sums are exact in any order
        grid = self.lossless(values)
        self.assertEqual(grid.levels, 8)
        for level in range(grid.levels):
            with self.subTest(level=level):
                found = grid.to_numpy(level=level)
                self.assertEqual(found.shape, grid.level_shape(level))
                self.assertTrue(same(found, self.means(values, level)))
        self.assertEqual(grid.level_shape(7), (1, 1, 1))

    def test_a_part_of_a_level_is_the_part_of_it(self):
        grid = self.lossless(noise((37, 70, 50)))
        for level, part in ((1, numpy.s_[3:11, 1:35, 5:20]), (2, numpy.s_[1:, 7:8, 2:5]), (4, numpy.s_[1:3, :, 3:])):
            self.assertTrue(same(grid.to_numpy(part, level), grid.to_numpy(level=level)[part]))

    def test_a_region_that_does_not_begin_at_a_leaf(self):
        values = noise((37, 70, 50))
        grid = self.lossless(values, roi=((3, 5, 7), (50, 70, 37)))
        for level in (1, 2, 3, 4):
            self.assertTrue(same(grid.to_numpy(level=level), self.means(values[7:, 5:, 3:], level)))

    def test_nan_stays(self):
        values = ramp(16, 16, 16)
        values[5, 9, 2] = numpy.nan
        found = self.lossless(values, nonfinite="keep").to_numpy(level=1)
        self.assertTrue(numpy.isnan(found[2, 4, 1]))
        self.assertEqual(numpy.isnan(found).sum(), 1)

    def test_levels_that_there_are_not(self):
        grid = self.lossless(ramp(12, 20, 28))
        for level in (-1, 6, 1.0, None, True, False):
            message = self.refused(weir.UsageError, grid.to_numpy, None, level)
            self.assertEqual(message, f"level is {level!r}, it must be a whole number from 0 to 5")


class Bounds(FolderTest):
    def test_macrocells_bound_the_values_and_their_neighbours(self):
        values = noise((37, 70, 50))
        grid = self.lossless(values)
        cells = grid.macrocells()
        self.assertEqual(cells.cell, 16)
        self.assertEqual(cells.origin, (0, 0, 0))
        self.assertEqual(cells.min.shape, (3, 5, 4))
        around = numpy.pad(values.astype(numpy.float32), 1, constant_values=grid.background)
        for z, y, x in numpy.ndindex(cells.min.shape):
            part = around[16 * z : 16 * z + 18, 16 * y : 16 * y + 18, 16 * x : 16 * x + 18]
            low, high = part.min(), part.max()
            if z == 2 or y == 4 or x == 3:  # cells that overhang hold the background too
                low, high = min(low, grid.background), max(high, grid.background)
            self.assertEqual((cells.min[z, y, x], cells.max[z, y, x]), (low, high))

    def test_the_first_cell_of_a_region_begins_before_it(self):
        grid = self.lossless(noise((37, 70, 50)), roi=((3, 5, 17), (50, 70, 37)))
        self.assertEqual(grid.macrocells().origin, (-3, -5, -1))


class ChangedFiles(FolderTest):
    """Tests files that are written to in place while they are open."""

    def opened(self, encoding):
        weir.convert(ramp(40, 50, 60), self.folder / "a.nvdb", encoding=encoding, rate=1.2, overwrite=True)
        grid = weir.open(self.folder / "a.nvdb")
        self.addCleanup(grid.close)
        return grid

    def refuses_to_read(self, grid):
        for use in (
            grid.to_numpy,
            lambda: grid[3],
            lambda: grid[::7, ::-9, 3],
            lambda: grid.to_numpy(level=1),
            lambda: grid.sample([[30, 30, 30]]),
            grid.macrocells,
            lambda: grid.render(mode="mip", size=(16, 16), backend="cpu"),
            grid.verify,
        ):
            message = self.refused(weir.InputError, use)
            self.assertEqual(message, "a.nvdb: changed since it was opened; open it again")
        self.assertEqual(grid.extent, (40, 50, 60))

    def test_a_file_that_was_cut(self):
        for encoding in ("fpn", "packed"):
            with self.subTest(encoding):
                grid = self.opened(encoding)
                os.truncate(grid.path, 20000)
                self.refuses_to_read(grid)

    def test_a_file_that_was_overwritten(self):
        for encoding in ("fpn", "packed"):
            with self.subTest(encoding):
                grid = self.opened(encoding)
                grid.sample([[1, 1, 1]])
                weir.convert(-ramp(40, 50, 60), self.folder / "b.nvdb", encoding=encoding, rate=1.2, overwrite=True)
                shutil.copyfile(self.folder / "b.nvdb", grid.path)
                os.utime(grid.path, ns=(1, 1))  # whatever the clock's steps are
                self.refuses_to_read(grid)

    def test_a_file_that_was_replaced_is_read_on(self):
        values = ramp(40, 50, 60)
        grid = self.lossless(values)
        weir.convert(-values, grid.path, lossless=True, overwrite=True)
        self.assertTrue(same(grid.to_numpy(), values))
        self.assertTrue(same(grid[::7, ::-9, 3], values[::7, ::-9, 3]))
        self.assertEqual(grid.sample([[0.5, 0.5, 0.5]]), values[0, 0, 0])
        self.assertEqual(grid.render(mode="mip", size=(16, 16), backend="cpu").shape, (16, 16, 3))

    def test_what_is_read_by_the_name_of_a_file_that_was_replaced_is_refused(self):
        grid = self.lossless(ramp(40, 50, 60))
        self.assertTrue(all(check.ok for check in grid.verify()))
        weir.convert(-ramp(40, 50, 60), grid.path, lossless=True, overwrite=True)
        for use in (grid.verify, lambda: grid.sidecar, lambda: grid.certificate):
            self.assertEqual(
                self.refused(weir.InputError, use), "a.nvdb: was replaced or removed since it was opened; open it again"
            )
        with weir.open(grid.path) as again:
            self.assertTrue(all(check.ok for check in again.verify()))


class Lifetime(FolderTest):
    def test_a_closed_grid(self):
        grid = self.lossless(ramp(9, 9, 9))
        with grid as same_grid:
            self.assertIs(grid, same_grid)
            self.assertFalse(grid.closed)
        self.assertTrue(grid.closed)
        grid.close()
        self.assertEqual(repr(grid), f"<weir.Grid '{self.folder}/a.nvdb', closed>")
        for use in (
            lambda: grid.extent,
            lambda: grid.sidecar,
            grid.to_numpy,
            grid.macrocells,
            grid.verify,
            grid.render,
            lambda: grid.sample([[1, 1, 1]]),
            grid.__enter__,
            lambda: pickle.dumps(grid),
            lambda: copy.copy(grid),
        ):
            self.assertEqual(
                self.refused(weir.UsageError, use), "a.nvdb: is closed; open it again with weir.open"
            )


if __name__ == "__main__":
    unittest.main()
