"""The Python that docs/python.md shows, run as a reader would: its blocks one after the other, in one folder."""

import contextlib
import importlib.util
import io
import os
import re
import unittest

from support import SOURCE, FolderTest

_BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)


class Document(FolderTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        (self.folder / "share/weir").mkdir(parents=True)
        (self.folder / "share/weir/paraview").symlink_to(SOURCE / "bindings/paraview")

    def test_its_code_runs(self):
        text = (SOURCE / "docs/python.md").read_text()
        out, names, left_out = io.StringIO(), {}, ""
        for block in _BLOCK.finditer(text):
            line = text.count("\n", 0, block.start(1)) + 1
            if "weir_reader" in block[1] and importlib.util.find_spec("vtkmodules") is None:
                left_out = f"line {line} and what follows needs python3-vtk9"
                break
            # Padded so that a traceback has the document's lines.
            code = compile("\n" * (line - 1) + block[1], "docs/python.md", "exec")
            with contextlib.redirect_stdout(out):
                exec(code, names)
        printed = out.getvalue()
        self.assertTrue(printed.startswith("838861 "), printed)
        self.assertIn("<weir.Grid 'density.nvdb', 128 x 128 x 128, fpn>\n", printed)
        self.assertIn("density.nvdb: exists; choose another output or pass overwrite\n", printed)
        self.assertEqual(names["part"].shape, (10, 128, 4))
        self.assertTrue((names["part"] == names["same"]).all())
        self.assertEqual(names["coarse"].shape, (16, 16, 16))
        self.assertEqual(names["picture"].shape, (240, 320, 3))
        if left_out:
            self.skipTest(left_out)
        self.assertIn("(64, 64, 64) (1.0, 1.0, 1.0) density\n", printed)


if __name__ == "__main__":
    unittest.main()
