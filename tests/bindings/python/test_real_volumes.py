"""Tests real volumes as arrays: the same bytes as from their files, and the errors that numpy finds."""

import lzma
import unittest

import numpy

import weir
from support import SOURCE, FolderTest

DATA = SOURCE.parent / "shared/data"
if not DATA.is_dir():
    raise unittest.SkipTest("shared/data, the real volumes, is not there")


class RealVolumes(FolderTest):
    def check(self, name, shape, dtype, **budget):
        raw = self.folder / f"{name}.raw"
        raw.write_bytes(lzma.decompress((DATA / f"{name}.raw.xz").read_bytes()))
        values = numpy.memmap(raw, dtype, "r", shape=shape)
        record = weir.convert(values, self.folder / "array.nvdb", **budget)
        weir.convert(raw, self.folder / "file.nvdb", **budget)
        self.assertEqual((self.folder / "array.nvdb").read_bytes(), (self.folder / "file.nvdb").read_bytes())
        with weir.open(self.folder / "array.nvdb") as grid:
            difference = grid.to_numpy().astype(float) - values
            self.assertTrue(all(check.ok for check in grid.verify()))
        self.assertEqual(numpy.abs(difference).max(), record["error"]["max_abs"])
        self.assertAlmostEqual((difference**2).mean(), record["error"]["mse"], delta=1e-9 * record["error"]["mse"])
        return record

    def test_aneurism(self):
        self.assertTrue(self.check("aneurism_256x256x256_uint8", (256,) * 3, "u1", rate=10)["error"]["lossless"])

    def test_mni152(self):
        self.check("mni152_2009_193x229x193_int16", (193, 229, 193), "<i2", rate=10)

    def test_tooth(self):
        record = self.check("tooth_103x94x161_uint8", (161, 94, 103), "u1", max_error=3)
        self.assertLessEqual(record["error"]["max_abs"], 3)

    def test_wmag(self):
        record = self.check("wmag_91x91x91_float32", (91, 91, 91), "<f4", psnr=40)
        self.assertGreaterEqual(record["error"]["psnr_db"], 40)


if __name__ == "__main__":
    unittest.main()
