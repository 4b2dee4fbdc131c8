"""Tests bindings/paraview/weir_reader.py as a plugin of ParaView, in batch mode."""

import importlib.util
import os
import shutil
import subprocess
import unittest

from support import SOURCE, FolderTest, ramp

if not shutil.which("pvbatch") or importlib.util.find_spec("paraview") is None:
    raise unittest.SkipTest("it needs paraview and python3-paraview")

PARAVIEW = """
import inspect, sys
if not hasattr(inspect, "getargspec"):  # see docs/python.md
    inspect.getargspec = inspect.getfullargspec
from paraview.simple import *
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
LoadPlugin(sys.argv[1], remote=False, ns=globals())
reader = OpenDataFile(sys.argv[2])
reader.Level = 1
reader.UpdatePipeline()
image = servermanager.Fetch(reader)
print(type(reader).__name__, image.GetDimensions(), image.GetSpacing(), image.GetOrigin())
print(vtk_to_numpy(image.GetPointData().GetScalars()).sum())
series = OpenDataFile([sys.argv[2], sys.argv[3]])
print(list(series.TimestepValues), list(series.FileNames) == sys.argv[2:])
series.UpdatePipeline(1)
print(servermanager.Fetch(series).GetPointData().GetScalars().GetRange())
"""


class ParaView(FolderTest):
    def test_the_plugin_loads_and_reads(self):
        values = ramp(20, 16, 12)
        grid = self.lossless(values, spacing=(1, 2, 3))
        later = self.lossless(values + 1, "b.nvdb")
        (self.folder / "script.py").write_text(PARAVIEW)
        result = subprocess.run(
            ["pvbatch", self.folder / "script.py", SOURCE / "bindings/paraview/weir_reader.py", grid.path, later.path],
            env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            text=True,
            timeout=300,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(
            result.stdout.splitlines(),
            [
                "WeirReader (10, 8, 6) (2.0, 4.0, 6.0) (0.5, 1.0, 1.5)",
                str(grid.to_numpy(level=1).sum()),
                "[0.0, 1.0] True",
                str(later.range),
            ],
        )


if __name__ == "__main__":
    unittest.main()
