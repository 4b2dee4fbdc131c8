"""The Python that docs/python.md shows, run as a reader would: its blocks one after the other, in one folder."""

import contextlib
import io
import os
import re
import unittest

from support import SOURCE, FolderTest

_BLOCK = re.compile(r"(?:<!-- needs (\w+) -->\n)?```python\n(.*?)```", re.DOTALL)


class Document(FolderTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        (self.folder / "share/weir").mkdir(parents=True)
        (self.folder / "share/weir/paraview").symlink_to(SOURCE / "bindings/paraview")

    def test_its_code_runs(self):
        text = (SOURCE / "docs/python.md").read_text()
        out, names, left_out = io.StringIO(), {}, []
        for block in _BLOCK.finditer(text):
            line = text.count("\n", 0, block.start(2)) + 1
            if block[1] and not self.importable(block[1]):
                left_out.append(f"line {line} needs {block[1]}")
                continue
            # Padded so that a traceback has the document's lines.
            code = compile("\n" * (line - 1) + block[2], "docs/python.md", "exec")
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
            self.skipTest("; ".join(left_out))
        self.assertIn("(64, 64, 64) (1.0, 1.0, 1.0) density\n", printed)

    @staticmethod
    def importable(module):
        try:
            __import__(module)
        except ImportError:
            return False
        return True


if __name__ == "__main__":
    unittest.main()
