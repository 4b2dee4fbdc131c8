"""Helpers of the tests: a folder for each test, the command to compare with, fields with known values."""

import logging
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy

import weir

logging.getLogger("weir").addHandler(logging.NullHandler())  # notices are not the tests' output

SOURCE = pathlib.Path(os.environ["WEIR_SOURCE"])


class FolderTest(unittest.TestCase):
    """A test that has its own empty folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def names(self):
        """Returns all names in the folder, hidden ones too."""
        return sorted(path.name for path in self.folder.iterdir())

    def lossless(self, values, name="a.nvdb", **keywords):
        """Returns an open grid of exactly `values` [z, y, x]."""
        weir.convert(values, self.folder / name, lossless=True, **keywords)
        grid = weir.open(self.folder / name)
        self.addCleanup(grid.close)
        return grid

    def refused(self, kind, call, *arguments, **keywords):
        """Returns the whole message of the exception `kind` that the call raises, without the test folder's path."""
        with self.assertRaises(kind) as raised:
            call(*arguments, **keywords)
        self.assertIs(raised.exception.__class__, kind)
        return str(raised.exception).replace(f"{self.folder}/", "")


def run_weir(*arguments):
    """Runs the weir command that was built with this module. Returns its stdout."""
    command = [os.environ["WEIR_COMMAND"], *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def noise(shape, dtype=numpy.int16, seed=1):
    """Returns values over the type's whole range, without repeating runs. Floats are in [-1, 1)."""
    random = numpy.random.default_rng(seed)
    dtype = numpy.dtype(dtype)
    if dtype.kind == "b":
        return random.integers(0, 2, shape).astype(bool)
    if dtype.kind in "iu":
        limits = numpy.iinfo(dtype)
        return random.integers(limits.min, limits.max, shape, dtype=dtype, endpoint=True)
    return random.uniform(-1, 1, shape).astype(dtype)


def ramp(nx, ny, nz):
    """Returns x + 100 y + 10000 z as float32 [z, y, x], so that each value tells its position."""
    z, y, x = numpy.mgrid[0:nz, 0:ny, 0:nx]
    return (x + 100 * y + 10000 * z).astype(numpy.float32)


def same(a, b):
    """Returns whether the arrays have the same shape and the same bits."""
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()
