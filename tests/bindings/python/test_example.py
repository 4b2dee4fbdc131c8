"""Tests what examples/python/explore.py prints and writes, with fewer voxels."""

import csv
import os
import subprocess
import sys
import unittest

import weir
from png import read_png
from support import SOURCE, FolderTest


class Explore(FolderTest):
    def test_it_runs(self):
        result = subprocess.run(
            [sys.executable, "-B", SOURCE / "examples/python/explore.py", self.folder],
            env=os.environ | {"EXPLORE_VOXELS": "96"},
            capture_output=True,
            text=True,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0].split(" of ")[0], "3,538,944 bytes")
        self.assertRegex(lines[1], r"^rate 10:   353,895 bytes,  \d\d\.\d dB, at most 0\.\d+$")
        self.assertRegex(lines[5], r"^rate  2: 1,769,472 bytes, lossless$")
        rows = list(csv.DictReader((self.folder / "rates.csv").open()))
        self.assertEqual([row["rate"] for row in rows], ["10", "8", "6", "4", "2"])
        errors = [float(row["max_abs"]) for row in rows]
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertEqual(read_png(self.folder / "slice.png").shape, (96, 288, 3))
        self.assertEqual(read_png(self.folder / "picture.png").shape, (288, 384, 3))
        with weir.open(self.folder / "stirred_8.nvdb") as grid:
            self.assertTrue(all(check.ok for check in grid.verify()))
            self.assertEqual(grid.name, "dye")


if __name__ == "__main__":
    unittest.main()
