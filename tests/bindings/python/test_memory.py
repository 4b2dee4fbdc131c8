"""Tests which memory is held and which is released."""

import resource
import subprocess
import sys
import unittest
import weakref

import numpy

import weir
from support import FolderTest, noise

LEVEL = """
import resource, sys, weir
grid = weir.open(sys.argv[1])
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
assert (grid.to_numpy(level=2) == 7).all()
print(1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before))
"""


class Memory(FolderTest):
    def test_no_reference_is_kept(self):
        class Array(numpy.ndarray):
            pass

        values = noise((9, 9, 9)).view(Array)
        calls = []
        before = sys.getrefcount(values), sys.getrefcount(calls)
        for i in range(20):
            weir.convert(values, self.folder / f"{i}.nvdb", lossless=True, progress=lambda *call: calls.append(call))
            with self.assertRaises(weir.UsageError):
                weir.convert(values, self.folder / f"{i}.nvdb")
        self.assertEqual((sys.getrefcount(values), sys.getrefcount(calls)), before)
        gone = weakref.ref(values)
        del values
        self.assertIsNone(gone())

    def test_results_are_freed(self):
        grid = self.lossless(noise((64, 64, 64)))
        points = numpy.zeros((100000, 3), numpy.float32)

        def use():
            grid.to_numpy()
            grid.to_numpy(level=1)
            grid.sample(points)
            grid.macrocells()
            grid.render(size=(100, 100), mode="mip", spp=1)
            with weir.open(grid.path) as other:
                other.to_numpy()

        for _ in range(10):
            use()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(40):
            use()
        grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
        self.assertLess(grown, 16 << 20)  # if the arrays were kept, they would take 40 times 3.6 MiB

    def test_an_array_is_not_copied(self):
        values = numpy.zeros((256, 256, 128), numpy.float64).transpose()  # 64 MiB
        values[:] = 1
        values[5] = 2
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        weir.convert(values, self.folder / "a.nvdb", memory="100MB", threads=1)
        grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
        self.assertLess(grown, values.nbytes)

    def test_a_level_does_not_hold_the_volume(self):
        weir.convert(numpy.broadcast_to(numpy.uint8(7), (512, 512, 512)), self.folder / "a.nvdb")
        command = [sys.executable, "-B", "-c", LEVEL, self.folder / "a.nvdb"]
        grown = int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        self.assertLess(grown, 64 << 20)  # the level takes 8 MiB, the volume 512 MiB


if __name__ == "__main__":
    unittest.main()
