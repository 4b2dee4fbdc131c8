"""Tests the picture that VTK draws from bindings/paraview/weir_reader.py, on a separate display."""

import importlib.util
import shutil
import subprocess
import sys
import unittest

import numpy

from png import read_png
from support import SOURCE, FolderTest

if not shutil.which("xvfb-run") or importlib.util.find_spec("vtkmodules") is None:
    raise unittest.SkipTest("it needs xvfb, xauth and python3-vtk9")

PICTURE = """
import sys
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import *
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
import vtkmodules.vtkRenderingOpenGL2, vtkmodules.vtkRenderingVolumeOpenGL2
sys.path.insert(0, sys.argv[1])
from weir_reader import WeirReader
reader = WeirReader()
reader.SetFileName(sys.argv[2])
reader.SetLevel(int(sys.argv[3]))
mapper = vtkFixedPointVolumeRayCastMapper()
mapper.SetInputConnection(reader.GetOutputPort())
opacity = vtkPiecewiseFunction()
opacity.AddPoint(0, 0)
opacity.AddPoint(1, 1)
colour = vtkColorTransferFunction()
colour.AddRGBPoint(0, 0, 0, 1)
colour.AddRGBPoint(1, 1, 0, 0)
look = vtkVolumeProperty()
look.SetScalarOpacity(opacity)
look.SetColor(colour)
volume = vtkVolume()
volume.SetMapper(mapper)
volume.SetProperty(look)
renderer = vtkRenderer()
renderer.AddVolume(volume)
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(120, 120)
window.AddRenderer(renderer)
camera = renderer.GetActiveCamera()
camera.SetFocalPoint(0, 0, 0)
camera.SetPosition(0, -150, 0)
camera.SetViewUp(0, 0, 1)
renderer.ResetCameraClippingRange()
window.Render()
grab = vtkWindowToImageFilter()
grab.SetInput(window)
writer = vtkPNGWriter()
writer.SetFileName(sys.argv[4])
writer.SetInputConnection(grab.GetOutputPort())
writer.Write()
"""


class Pictures(FolderTest):
    def picture(self, path, level):
        target = self.folder / f"{level}.png"
        command = [sys.executable, "-B", "-c", PICTURE, SOURCE / "bindings/paraview", path, str(level), target]
        result = subprocess.run(["xvfb-run", "-a", *command], capture_output=True, text=True, timeout=300)
        self.assertTrue(target.exists(), result.stderr)
        return read_png(target).astype(int)

    def test_a_ball_is_round_and_in_the_middle(self):
        n = 32
        z, y, x = numpy.mgrid[0:n, 0:n, 0:n] - (n - 1) / 2
        ball = (x * x + y * y + z * z < 10**2).astype(numpy.float32)
        grid = self.lossless(ball, origin=(-(n - 1) / 2,) * 3)
        fine, coarse = (self.picture(grid.path, level)[:, :, 0] for level in (0, 1))
        rows, columns = numpy.nonzero(fine > 128)
        self.assertAlmostEqual(rows.mean(), 59.5, delta=1)
        self.assertAlmostEqual(columns.mean(), 59.5, delta=1)
        # Seen from 150 away in a picture of 120 pixels that is 30 degrees high.
        radius = 60 * 10 / (150 * numpy.tan(numpy.pi / 12))
        self.assertAlmostEqual(numpy.sqrt(rows.size / numpy.pi), radius, delta=1)
        self.assertLess(numpy.abs(fine - coarse).mean(), 12)


if __name__ == "__main__":
    unittest.main()
