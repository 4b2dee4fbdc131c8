"""Runs the Python blocks of docs/python.md as a reader would: one after the other, in one folder."""

import contextlib
import importlib.util
import io
import os
import re
import unittest

import numpy

import weir
from range_server import RangeServer
from support import SOURCE, FolderTest

_BLOCK = re.compile(r"(<!-- not run:[^>]*-->\n)?```python\n(?P<code>.*?)```", re.DOTALL)


class Document(FolderTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        (self.folder / "share/weir").mkdir(parents=True)
        (self.folder / "share/weir/paraview").symlink_to(SOURCE / "bindings/paraview")
        self.write_cloud_model()
        self.remote = self.serve_step()

    def serve_step(self):
        """Returns the URL of the packed file that the section on remote files opens."""
        z, y, x = numpy.mgrid[0:128, 0:128, 0:128].astype(numpy.float32)
        weir.convert(numpy.sin(x / 9) + numpy.cos(y / 7) * z, "step_0042.nvdb", rate=20, encoding="packed")
        files = {f"/{path.name}": path.read_bytes() for path in self.folder.glob("step_0042.nvdb*")}
        server = RangeServer(files)
        self.addCleanup(server.close)
        return server.url("/step_0042.nvdb")

    def write_cloud_model(self):
        """Writes two steps of the cloud model that the section on xarray opens."""
        netcdf = importlib.import_module("netCDF4")
        with netcdf.Dataset("model.nc", "w") as model:
            for name, size, spacing in (("time", 2, 600), ("height", 24, 100), ("lat", 32, 0.01), ("lon", 40, 0.01)):
                model.createDimension(name, None if name == "time" else size)
                model.createVariable(name, "f8", (name,))[:] = spacing * numpy.arange(size)
            model["time"].units = "seconds since 2026-01-01"
            values = model.createVariable("qc", "f4", ("time", "height", "lat", "lon"))
            values[:] = numpy.arange(2 * 24 * 32 * 40).reshape(2, 24, 32, 40)
        for index, name in enumerate(("qc_0042.nvdb", "qc_0043.nvdb")):
            weir.convert("model.nc", name, dataset="/qc", index=[index], lossless=True)

    @unittest.skipUnless(importlib.util.find_spec("dask"), "python3-dask is missing")
    def test_its_code_runs(self):
        text = (SOURCE / "docs/python.md").read_text()
        out, names, left_out = io.StringIO(), {}, ""
        for block in _BLOCK.finditer(text):
            line = text.count("\n", 0, block.start("code")) + 1
            if block[1]:
                continue
            if "weir_reader" in block["code"] and importlib.util.find_spec("vtkmodules") is None:
                left_out = f"line {line} and what follows needs python3-vtk9"
                break
            # The block is padded with empty lines, so that a traceback shows the document's line numbers.
            text_here = block["code"].replace("https://host.example/run/step_0042.nvdb", self.remote)
            code = compile("\n" * (line - 1) + text_here, "docs/python.md", "exec")
            with contextlib.redirect_stdout(out):
                exec(code, names)
        printed = out.getvalue()
        self.assertTrue(printed.startswith("838861 "), printed)
        self.assertIn("<weir.Grid 'density.nvdb', 128 x 128 x 128, fpn>\n", printed)
        self.assertIn("density.nvdb: exists; choose another output or pass overwrite\n", printed)
        self.assertEqual(names["part"].shape, (10, 128, 4))
        self.assertTrue((names["part"] == names["same"]).all())
        self.assertEqual(names["region"].shape, (64, 64, 64))
        self.assertEqual(names["coarse"].shape, (16, 16, 16))
        self.assertEqual(names["picture"].shape, (240, 320, 3))
        self.assertEqual(float(names["largest"]), 16 * 32 * 40 - 1)
        self.assertEqual(dict(names["series"]["qc"].sizes), {"time": 2, "height": 24, "lat": 32, "lon": 40})
        self.assertEqual(names["eighth"].shape, (3, 4, 5))
        self.assertEqual(float(names["series"]["qc"][1, 0, 0, 1]), 24 * 32 * 40 + 1)
        if left_out:
            self.skipTest(left_out)
        self.assertIn("(64, 64, 64) (1.0, 1.0, 1.0) density\n", printed)


if __name__ == "__main__":
    unittest.main()
