"""Tests several threads at once, Ctrl-C, and exceptions from callbacks."""

import concurrent.futures
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy

import weir
from support import FolderTest, noise, ramp, same

LARGE = (128, 256, 256)  # takes one thread about a second, which is long enough to interrupt the conversion

INTERRUPTED = """
import numpy, sys, weir
values = numpy.random.default_rng(1).random((256, 256, 256), dtype=numpy.float32)
def tell(pass_, done, total):
    if done:
        sys.stdout.write(pass_ + "\\n")
        sys.stdout.flush()
try:
    weir.convert(values, sys.argv[1], psnr=30, threads=1, progress=tell)
    print("done")
except KeyboardInterrupt:
    print("interrupted")
"""


class Threads(FolderTest):
    def test_conversions_at_once_give_the_same_bytes(self):
        values = noise((64, 64, 64), numpy.float32)
        paths = [self.folder / f"{i}.nvdb" for i in range(6)]
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            records = list(pool.map(lambda path: weir.convert(values, path, psnr=40), paths))
        self.assertEqual(len({record["file"]["digest"] for record in records}), 1)
        self.assertEqual(len({path.read_bytes() for path in paths}), 1)

    def test_reads_at_once(self):
        values = noise((40, 50, 60))
        grid = self.lossless(values)
        points = numpy.random.default_rng(3).uniform(0, 40, (20000, 3))
        expected = grid.sample(points)

        def work(i):
            if i % 2:
                return same(grid.sample(points), expected)
            return same(grid.to_numpy(), values.astype(numpy.float32)) and same(
                grid.to_numpy(level=2), self.level_2
            )

        self.level_2 = grid.to_numpy(level=2)
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            self.assertTrue(all(pool.map(work, range(40))))

    def test_a_grid_that_is_closed_while_it_is_read(self):
        values = noise((64, 64, 64))
        grid = self.lossless(values)
        started = threading.Event()

        def read():
            started.set()
            try:
                return all(same(grid.to_numpy(), values.astype(numpy.float32)) for _ in range(100))
            except weir.UsageError as error:
                return str(error).endswith("is closed; open it again with weir.open")

        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            results = [pool.submit(read) for _ in range(4)]
            started.wait()
            grid.close()
            self.assertTrue(all(result.result() for result in results))

    def test_the_interpreter_runs_meanwhile(self):
        values = noise(LARGE, numpy.float32)
        ticks = []
        done = threading.Event()

        def tick():
            while not done.wait(0.001):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        start = time.monotonic()
        weir.convert(values, self.folder / "a.nvdb", psnr=30, threads=1)
        end = time.monotonic()
        done.set()
        thread.join()
        within = [t for t in ticks if start < t < end]
        self.assertGreater(len(within), 5)
        self.assertLess(max(b - a for a, b in zip([start, *within], [*within, end])), (end - start) / 2)


    def test_a_process_forked_during_a_conversion_cannot_convert(self):
        values = noise((16, 16, 16), numpy.float32)
        states = []

        def fork(pass_, done, total):
            if states:
                return
            child = os.fork()
            if child == 0:
                try:
                    weir.convert(values, self.folder / "child.nvdb", psnr=40)
                    os._exit(1)
                except weir.UsageError as error:
                    os._exit(0 if "forked while its parent converted" in str(error) else 2)
                finally:
                    os._exit(3)
            states.append(os.waitpid(child, 0)[1])

        weir.convert(values, self.folder / "parent.nvdb", psnr=40, progress=fork)
        self.assertEqual(states, [0])
        self.assertEqual(self.names(), ["parent.nvdb", "parent.nvdb.json"])


class Interrupts(FolderTest):
    def test_ctrl_c_ends_a_conversion_and_leaves_nothing(self):
        environment = os.environ | {"PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(
            [sys.executable, "-B", "-c", INTERRUPTED, self.folder / "a.nvdb"],
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.assertEqual(process.stdout.readline(), "survey\n")
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(out.splitlines()[-1], "interrupted")
        self.assertEqual(self.names(), [])

    def test_what_progress_raises_ends_a_conversion(self):
        class Enough(Exception):
            pass

        calls = []

        def stop(pass_, done, total):
            calls.append(pass_)
            raise Enough("for today")

        with self.assertRaises(Enough):
            weir.convert(noise(LARGE, numpy.float32), self.folder / "a.nvdb", psnr=30, threads=1, progress=stop)
        self.assertEqual(calls, ["survey"])
        self.assertEqual(self.names(), [])

    def test_what_progress_raises_at_the_end_leaves_nothing_either(self):
        class Enough(Exception):
            pass

        def stop(pass_, done, total):
            if pass_ == "encode" and done == total:
                raise Enough

        for shape in ((16, 16, 16), (192, 192, 192)):
            with self.assertRaises(Enough):
                weir.convert(noise(shape, numpy.float32), self.folder / "a.nvdb", lossless=True, progress=stop)
            self.assertEqual(self.names(), [])

    def test_what_progress_raises_ends_a_picture(self):
        grid = self.lossless(ramp(32, 32, 32))

        def stop(pass_, done, total):
            raise ZeroDivisionError

        start = time.monotonic()
        with self.assertRaises(ZeroDivisionError):
            grid.render(size=(2000, 2000), spp=1000, progress=stop)
        self.assertLess(time.monotonic() - start, 30)


if __name__ == "__main__":
    unittest.main()
