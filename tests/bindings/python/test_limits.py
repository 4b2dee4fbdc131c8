"""Tests calls on a machine that gives no more threads."""

import os
import subprocess
import sys
import unittest

import weir
from support import FolderTest, ramp

NO_THREADS = """
import os, resource, sys, weir
from support import ramp
values = ramp(9, 9, 9)
resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
if os.geteuid() == 0:
    os.setuid(65534)  # the user nobody, because root may start any number
grid = weir.open("a.nvdb")
for call in (lambda: weir.convert(values, "b.nvdb"), lambda: grid.render(size=(8, 8)), grid.verify):
    try:
        call()
        print("done")
    except weir.IoError as error:
        print(error)
"""

NO_MORE_THREADS = (
    "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit -v), or end some"
)


class Limits(FolderTest):
    def test_no_threads(self):
        weir.convert(ramp(9, 9, 9), self.folder / "a.nvdb", lossless=True)
        self.folder.chmod(0o777)
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(path for path in sys.path if path))
        run = subprocess.run(
            [sys.executable, "-B", "-c", NO_THREADS], cwd=self.folder, env=environment, capture_output=True, text=True
        )
        self.assertEqual((run.stderr, run.returncode), ("", 0))
        lines = run.stdout.splitlines()
        self.assertEqual(lines[0], NO_MORE_THREADS)
        self.assertEqual(set(lines[1:]) - {"done"}, {NO_MORE_THREADS})
        self.assertEqual(self.names(), ["a.nvdb", "a.nvdb.json"])


if __name__ == "__main__":
    unittest.main()
