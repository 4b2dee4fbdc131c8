"""Tests programs that end while a daemon thread calls weir: exit status kept, no half-written files."""

import subprocess
import sys
import unittest

import numpy

import weir
from range_server import RangeServer
from support import FolderTest, noise

# The thread runs `work`, which sets `begun`. The program ends soon after.
PROGRAM = """
import atexit, sys, threading, time
import numpy, weir
begun = threading.Event()
{work}
threading.Thread(target=work, daemon=True).start()
begun.wait(60)
time.sleep({pause})
sys.exit(7)
"""

CONVERSION = """
values = numpy.random.default_rng(1).random((256, 256, 256), dtype=numpy.float32)
def tell(pass_, done, total):
    if pass_ == {pass_!r}:
        begun.set()
        {then}
def work():
    weir.convert(values, {output!r}, psnr=30, threads=1, progress=tell)
"""

CALLS = """
def work():
    with weir.open({path!r}) as grid:
        points = numpy.random.default_rng(1).random((100000, 3))
        while True:
            {call}
            begun.set()
"""

REMOTE = """
def work():
    begun.set()
    weir.open({url!r}).to_numpy()
"""

# Registered before weir's own handler, and therefore called after weir's.
LATE = """
import atexit, sys
def late():
    import numpy
    weir.convert(numpy.ones((8, 8, 8), numpy.float32), sys.argv[1], lossless=True)
    print(weir.open(sys.argv[1]).to_numpy().sum())
atexit.register(late)
import weir
sys.exit(7)
"""


class InterpreterEnd(FolderTest):
    def ends(self, work, pause=0.1):
        """Runs a program that ends with status 7."""
        program = PROGRAM.format(work=work, pause=pause)
        ended = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, timeout=60)
        self.assertEqual((ended.returncode, ended.stderr, ended.stdout), (7, "", ""))

    def test_while_an_array_is_converted(self):
        for pass_ in ("survey", "encode"):
            self.ends(CONVERSION.format(pass_=pass_, then="pass", output=str(self.folder / "a.nvdb")))
            self.assertEqual(self.names(), [])

    def test_while_progress_is_told(self):
        for then in ("time.sleep(60)", "while True: pass"):
            self.ends(CONVERSION.format(pass_="encode", then=then, output=str(self.folder / "a.nvdb")))
            self.assertEqual(self.names(), [])

    def test_while_values_of_a_file_are_read(self):
        path = self.folder / "a.nvdb"
        weir.convert(noise((64, 64, 64), numpy.float32), path, psnr=40)
        for call in ("grid.to_numpy()", "grid[::3]", "grid.sample(points)", "weir.open(grid.path)", "grid.verify()"):
            for pause in (0, 0.03):
                with self.subTest(call=call, pause=pause):
                    self.ends(CALLS.format(path=str(path), call=call), pause)

    def test_while_a_server_does_not_answer(self):
        path = self.folder / "a.nvdb"
        weir.convert(noise((64, 64, 64), numpy.float32), path, psnr=40, encoding="packed")
        server = RangeServer({"/a.nvdb": path.read_bytes()})
        self.addCleanup(server.close)
        self.ends(REMOTE.format(url=server.url("/a.nvdb")), 0.01)
        server.stalled.set()
        self.ends(REMOTE.format(url=server.url("/a.nvdb")), 1)

    def test_calls_of_the_thread_that_ends_it_work(self):
        path = self.folder / "a.nvdb"
        ended = subprocess.run([sys.executable, "-B", "-c", LATE, path], capture_output=True, text=True, timeout=60)
        self.assertEqual((ended.returncode, ended.stderr, ended.stdout), (7, "", "512.0\n"))
        self.assertEqual(self.names(), ["a.nvdb", "a.nvdb.json"])


@unittest.skipIf(sys.version_info >= (3, 13), "Python initialises modules in the main interpreter from 3.13 on")
class Subinterpreter(unittest.TestCase):
    def test_is_refused(self):
        program = (
            "import _xxsubinterpreters, sys\n"
            "sub = _xxsubinterpreters.create()\n"
            "_xxsubinterpreters.run_string(sub, f'import sys; sys.path[:] = {sys.path!r}; import weir')\n"
        )
        ended = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, timeout=60)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(
            "ImportError'>: weir cannot be imported in a subinterpreter; use the main interpreter, or another process",
            ended.stderr,
        )


if __name__ == "__main__":
    unittest.main()
