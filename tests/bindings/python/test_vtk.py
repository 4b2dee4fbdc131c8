"""Tests bindings/paraview/weir_reader.py as a source of plain VTK: values, placement, pieces, series, errors."""

import gc
import shutil
import sys
import unittest
import unittest.mock

import numpy

import weir
from support import SOURCE, FolderTest, noise, ramp, same
from weir.errors import InputNotFoundError

sys.path.insert(0, str(SOURCE / "bindings/paraview"))
sys.dont_write_bytecode = True
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkStringOutputWindow, vtkOutputWindow
    from weir_reader import WeirReader
except ImportError as error:
    raise unittest.SkipTest(f"python3-vtk9 is not installed: {error}")


def values_of(image):
    """Returns the point data as [z, y, x]."""
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])


class Reader(FolderTest):
    def read(self, path, level=0):
        reader = WeirReader()
        reader.SetFileName(str(path))
        reader.SetLevel(level)
        reader.Update()
        return reader.GetOutputDataObject(0)

    def told(self, update):
        """Returns the first line that VTK's output window gets."""
        before, window = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(window)
        self.addCleanup(vtkOutputWindow.SetInstance, before)
        update()
        return window.GetOutput().splitlines()[0].replace(f"{self.folder}/", "")

    def test_level_0_is_the_volume(self):
        values = noise((37, 50, 70))
        grid = self.lossless(values, spacing=(1, 2, 3), origin=(5, 6, 7), dataset="charge")
        image = self.read(grid.path)
        gc.collect()
        self.assertEqual(image.GetExtent(), (0, 69, 0, 49, 0, 36))
        self.assertEqual(image.GetSpacing(), (1, 2, 3))
        self.assertEqual(image.GetOrigin(), (5, 6, 7))
        self.assertEqual(image.GetPointData().GetScalars().GetName(), "charge")
        self.assertTrue(same(values_of(image), values.astype(numpy.float32)))

    def test_levels_are_means_in_the_middle_of_their_cubes(self):
        values = noise((37, 50, 70))
        grid = self.lossless(values, spacing=(1, 2, 3), origin=(5, 6, 7))
        for level in (1, 3):
            image = self.read(grid.path, level)
            self.assertTrue(same(values_of(image), grid.to_numpy(level=level)))
        mean = values[:2, :2, :2].astype(float).mean()
        self.assertEqual(values_of(self.read(grid.path, 1))[0, 0, 0], numpy.float32(mean))
        self.assertEqual(image.GetSpacing(), (8, 16, 24))
        self.assertEqual(image.GetOrigin(), (5 + 3.5, 6 + 7, 7 + 10.5))
        self.assertEqual(self.read(grid.path, 99).GetDimensions(), (1, 1, 1))

    def test_a_region_lies_where_it_was(self):
        grid = self.lossless(ramp(40, 30, 20), roi=((10, 4, 2), (30, 20, 20)), spacing=(0.5, 1, 1), origin=(1, 1, 1))
        image = self.read(grid.path)
        self.assertEqual(image.GetOrigin(), (6, 5, 3))
        self.assertEqual(image.GetDimensions(), (20, 16, 18))
        self.assertEqual(values_of(image)[0, 0, 0], 20410)

    def test_pieces_are_read_alone_and_make_the_whole(self):
        values = noise((37, 50, 70)).astype(numpy.float32)
        grid = self.lossless(values)
        reader = WeirReader()
        reader.SetFileName(grid.path)
        reader.UpdateExtent((3, 9, 4, 5, 6, 36))
        image = reader.GetOutputDataObject(0)
        self.assertEqual(image.GetExtent(), (3, 9, 4, 5, 6, 36))
        self.assertTrue(same(values_of(image), values[6:37, 4:6, 3:10]))
        reader = WeirReader()  # VTK would part the extent that was last asked for
        reader.SetFileName(grid.path)
        for level in (0, 1):
            reader.SetLevel(level)
            whole = grid.to_numpy(level=level)
            found = numpy.full_like(whole, numpy.nan)
            for piece in range(5):
                reader.UpdatePiece(piece, 5, 0)
                image = reader.GetOutputDataObject(0)
                x0, x1, y0, y1, z0, z1 = image.GetExtent()
                self.assertLess(image.GetNumberOfPoints(), whole.size)
                found[z0 : z1 + 1, y0 : y1 + 1, x0 : x1 + 1] = values_of(image)
            self.assertTrue(same(found, whole))

    def test_the_sidecar_of_another_file_is_left_out(self):
        values = ramp(20, 16, 12)
        grid = self.lossless(values)
        other = self.lossless(ramp(8, 8, 8), "b.nvdb")
        shutil.copy(f"{other.path}.json", f"{grid.path}.json")
        images = []
        told = self.told(lambda: images.append(self.read(grid.path)))
        self.assertEqual(told.partition(": is of a file of")[:2], ("a.nvdb.json", ": is of a file of"))
        self.assertEqual(images[0].GetFieldData().GetNumberOfArrays(), 0)
        self.assertTrue(same(values_of(images[0]), values.astype(numpy.float32)))

    def test_the_certificate_is_in_the_field_data(self):
        weir.convert(noise((80, 64, 96), numpy.float32), self.folder / "a.nvdb", rate=6)
        image = self.read(self.folder / "a.nvdb", 2)
        with weir.open(self.folder / "a.nvdb") as grid:
            error = grid.certificate
        for name in ("rmse", "max_abs", "psnr_db"):
            self.assertEqual(image.GetFieldData().GetArray(f"weir_{name}").GetValue(0), error[name])
        exact = self.read(self.lossless(ramp(9, 9, 9), "b.nvdb").path).GetFieldData()
        self.assertEqual(exact.GetArray("weir_max_abs").GetValue(0), 0)
        self.assertIsNone(exact.GetArray("weir_psnr_db"))
        (self.folder / "b.nvdb.json").unlink()
        self.assertEqual(self.read(self.folder / "b.nvdb").GetFieldData().GetNumberOfArrays(), 0)

    def test_a_change_is_seen(self):
        reader = WeirReader()
        for name, values in (("a.nvdb", ramp(9, 9, 9)), ("b.nvdb", ramp(12, 10, 9))):
            grid = self.lossless(values, name)
            reader.SetFileName(grid.path)
            reader.SetLevel(0)
            reader.Update()
            self.assertTrue(same(values_of(reader.GetOutputDataObject(0)), values))
            reader.SetLevel(1)
            reader.Update()
            self.assertTrue(same(values_of(reader.GetOutputDataObject(0)), grid.to_numpy(level=1)))
        self.assertEqual((reader.GetFileNames(), reader.GetLevel()), ([grid.path], 1))
        with self.assertRaisesRegex(ValueError, "^level is -1, it must be 0 or more$"):
            reader.SetLevel(-1)

    def test_a_file_that_was_replaced_is_opened_again(self):
        first, second = ramp(9, 9, 9), ramp(12, 10, 9) + 1
        reader = WeirReader()
        reader.SetFileName(self.lossless(first).path)
        reader.Update()
        self.lossless(second, overwrite=True)
        reader.Modified()
        reader.Update()
        image = reader.GetOutputDataObject(0)
        self.assertTrue(same(values_of(image), second))
        self.assertEqual(image.GetFieldData().GetArray("weir_max_abs").GetValue(0), 0)
        (self.folder / "a.nvdb").unlink()
        message = self.refused(InputNotFoundError, weir.open, self.folder / "a.nvdb")
        reader.Modified()
        self.assertEqual(self.told(reader.Update), f"WeirReader: {message}")
        self.lossless(first, overwrite=True)
        reader.Modified()
        reader.Update()
        self.assertTrue(same(values_of(reader.GetOutputDataObject(0)), first))

    def test_a_file_that_was_written_to_in_place_is_opened_again(self):
        path = self.folder / "a.nvdb"
        weir.convert(ramp(9, 9, 9), path, lossless=True)
        weir.convert(ramp(9, 9, 9) + 1, self.folder / "b.nvdb", lossless=True)
        reader = WeirReader()
        reader.SetFileName(str(path))
        reader.Update()
        path.write_bytes((self.folder / "b.nvdb").read_bytes())
        shutil.copy(self.folder / "b.nvdb.json", self.folder / "a.nvdb.json")
        reader.Modified()
        reader.Update()
        self.assertTrue(same(values_of(reader.GetOutputDataObject(0)), ramp(9, 9, 9) + 1))

    def test_a_file_as_it_was_is_not_opened_again(self):
        reader = WeirReader()
        reader.SetFileName(self.lossless(ramp(9, 9, 9)).path)
        reader.Update()
        with unittest.mock.patch.object(weir, "open", side_effect=AssertionError):
            reader.Modified()
            reader.Update()
        self.assertEqual(reader.GetOutputDataObject(0).GetDimensions(), (9, 9, 9))

    def test_a_series_is_read_by_time(self):
        steps = [ramp(9, 9, 9) + step for step in range(3)]
        reader = WeirReader()
        for step, values in enumerate(steps):
            reader.AddFileName(self.lossless(values, f"{step}.nvdb").path)
        self.assertEqual(reader.GetTimestepValues(), [0, 1, 2])
        for time, step in ((2, 2), (0, 0), (1.5, 1), (7, 2), (-1, 0)):
            reader.UpdateTimeStep(time)
            image = reader.GetOutputDataObject(0)
            self.assertTrue(same(values_of(image), steps[step]))
            self.assertEqual(image.GetInformation().Get(image.DATA_TIME_STEP()), step)
        self.lossless(ramp(10, 9, 9), "3.nvdb")
        reader.AddFileName(str(self.folder / "3.nvdb"))
        reader.UpdateTimeStep(0)
        self.assertEqual(
            self.told(lambda: reader.UpdateTimeStep(3)),
            "WeirReader: 3.nvdb: is not of the extent that the series began with; read it alone",
        )
        reader.SetFileName(str(self.folder / "3.nvdb"))
        self.assertIsNone(reader.GetTimestepValues())
        reader.Update()
        self.assertTrue(same(values_of(reader.GetOutputDataObject(0)), ramp(10, 9, 9)))

    def test_errors_are_one_line(self):
        reader = WeirReader()
        self.assertEqual(self.told(reader.Update), "WeirReader: no file is named; call SetFileName")
        message = self.refused(InputNotFoundError, weir.open, self.folder / "no.nvdb")
        reader.SetFileName(str(self.folder / "no.nvdb"))
        self.assertEqual(self.told(reader.Update), f"WeirReader: {message}")


if __name__ == "__main__":
    unittest.main()
