"""Tests remote files: the same values as from a local file, in few requests, and one-line errors otherwise."""

import base64
import os
import pathlib
import pickle
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import unittest
import unittest.mock

import numpy
import weir
from range_server import RangeServer
from support import FolderTest, same
from weir.remote_file import sidecar_url


def bumps(edge):
    """Returns a smooth volume that differs everywhere."""
    z, y, x = (numpy.arange(edge, dtype=numpy.float32) for _ in range(3))
    wave = numpy.sin(z[:, None, None] * 0.05) * numpy.cos(y[None, :, None] * 0.04) + numpy.sin(x[None, None, :] * 0.06)
    return (wave + 0.002 * numpy.random.default_rng(2).standard_normal((edge, edge, edge))).astype(numpy.float32)


class Remote(FolderTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = pathlib.Path(folder.name) / "a.nvdb"
        cls.values = bumps(264)
        weir.convert(cls.values, cls.path, encoding="packed", rate=16, dataset="bumps")
        cls.files = {"/run/a.nvdb": cls.path.read_bytes(), "/run/a.nvdb.json": cls.path.with_suffix(".nvdb.json").read_bytes()}
        cls.here = weir.open(cls.path)

    def served(self, path="/run/a.nvdb", files=None, **keywords):
        server = RangeServer(self.files if files is None else files, **keywords)
        self.addCleanup(server.close)
        return server, server.url(path)

    def test_has_the_values_of_the_file(self):
        server, url = self.served()
        with weir.open(url) as grid:
            self.assertIsInstance(grid, weir.RemoteGrid)
            self.assertEqual(repr(grid), f"<weir.Grid '{url}', 264 x 264 x 264, packed>")
            self.assertEqual((grid.range, grid.spacing, grid.name), (self.here.range, self.here.spacing, "bumps"))
            for roi in (numpy.s_[0:9, 100:140, 3:264], numpy.s_[120:136, 120:136, 120:136], numpy.s_[263:264, 0:1, 5:6]):
                self.assertTrue(same(grid.to_numpy(roi), self.here.to_numpy(roi)), roi)
            self.assertTrue(same(grid[::50, 7, ::-20], self.here[::50, 7, ::-20]))
            for level in (1, 4, 9):
                self.assertTrue(same(grid.to_numpy(level=level), self.here.to_numpy(level=level)), level)
            self.assertTrue(same(grid.to_numpy(), self.here.to_numpy()))
        with weir.open(url) as grid:
            grid.to_numpy()
            self.assertLess(grid.bytes_read, 1.01 * grid.bytes)

    def test_samples_are_those_of_the_file(self):
        _, url = self.served()
        points = numpy.random.default_rng(4).uniform(-3, 268, (5000, 3))
        edges = [[0, 0, 0], [264, 264, 264], [127.5, 128.5, 7.5], [128, 8, 263.9]]
        for chosen in (points, edges, points[:1]):
            for filter in ("trilinear", "nearest"):
                with weir.open(url) as grid:
                    self.assertTrue(same(grid.sample(chosen, filter), self.here.sample(chosen, filter)), filter)

    def test_a_region_takes_six_requests_and_few_bytes(self):
        server, url = self.served()
        grid = weir.open(url)
        self.assertEqual(grid.requests, 2)
        part = grid.to_numpy(numpy.s_[64:128, 64:128, 64:128])
        self.assertTrue(same(part, self.here[64:128, 64:128, 64:128]))
        self.assertLessEqual(len(server.asked), 6)
        self.assertEqual(grid.requests, len(server.asked))
        self.assertEqual(grid.bytes_read, server.bytes_sent())
        blocks = self.here.bytes / 264**3 * 64**3
        self.assertLess(server.bytes_sent(), 3 * blocks + 65536)
        again = grid.to_numpy(numpy.s_[70:100, 64:128, 65:66])
        self.assertTrue(same(again, self.here[70:100, 64:128, 65:66]))
        self.assertLessEqual(len(server.asked), 6)

    def test_certificate_macrocells_and_metadata(self):
        server, url = self.served("/run/a.nvdb?key=1")
        grid = weir.open(url)
        self.assertEqual(grid.certificate, self.here.certificate)
        self.assertEqual(grid.requests, 3)
        self.assertEqual(grid.sidecar, self.here.sidecar)
        self.assertEqual(grid.requests, 3)
        self.assertTrue(same(grid.macrocells().max, self.here.macrocells().max))
        del server.files["/run/a.nvdb.json"]
        self.assertIsNone(weir.open(url).certificate)
        server.forbidden.add("/run/a.nvdb.json")  # like stores that do not tell which files are missing
        self.assertIsNone(weir.open(url).sidecar)
        server.forbidden.clear()
        server.files["/run/a.nvdb.json"] = self.files["/run/a.nvdb.json"].replace(b'"bytes"', b'"bites"')
        self.assertIn("a.nvdb.json?...: ", self.refused(weir.InputError, lambda: weir.open(url).sidecar))

    def test_what_was_read_is_forgotten_above_the_cache(self):
        server, url = self.served()
        small = weir.open(url, cache="100KiB")
        large = weir.open(url)
        for grid in (small, large):
            for z in (0, 130, 0, 130):
                self.assertTrue(same(grid[z : z + 8, 0:100, 0:100], self.here[z : z + 8, 0:100, 0:100]))
        self.assertGreater(small.bytes_read, 1.5 * large.bytes_read)
        message = self.refused(weir.UsageError, weir.open, url, cache="much")
        self.assertEqual(message, "cache is 'much', it must be a size as 67108864 or '256MiB'")

    def test_more_than_the_cache_is_read_in_parts(self):
        _, url = self.served()
        small = weir.open(url, cache="100KiB")
        whole = weir.open(url)
        self.assertTrue(same(small.to_numpy(level=3), whole.to_numpy(level=3)))
        self.assertTrue(same(small[::-40, ::40, ::40], self.here[::-40, ::40, ::40]))
        self.assertTrue(same(small.to_numpy(), self.here.to_numpy()))
        self.assertTrue(same(small.to_numpy(numpy.s_[5:260, 3:9]), self.here.to_numpy(numpy.s_[5:260, 3:9])))

    def test_threads_share_a_grid(self):
        _, url = self.served()
        grid = weir.open(url, cache=50000)
        wrong = []

        def look(first):
            for z in range(first, 264, 60):
                if not same(grid[z], self.here[z]):
                    wrong.append(z)

        threads = [threading.Thread(target=look, args=(first,)) for first in (0, 20, 40)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_another_process_opens_it_again(self):
        _, url = self.served()
        copy = pickle.loads(pickle.dumps(weir.open(url, cache="1MiB")))
        self.assertTrue(same(copy[5], self.here[5]))

    def test_a_forked_process_has_connections_of_its_own(self):
        _, url = self.served()
        grid = weir.open(url)
        children = []
        for first in (0, 60, 120, 180):
            child = os.fork()
            if child == 0:
                good = all(same(grid[z], self.here[z]) for z in range(first, first + 60, 9))
                os._exit(0 if good else 1)
            children.append(child)
        self.assertEqual([os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children], [0, 0, 0, 0])
        self.assertTrue(same(grid[200], self.here[200]))

    def test_a_server_that_is_not_there(self):
        server, url = self.served()
        server.close()
        message = self.refused(weir.IoError, weir.open, url)
        self.assertIn("cannot be read: Failed to establish a new connection: ", message)
        self.assertNotIn("<", message)

    def test_convert_reads_no_url(self):
        message = self.refused(weir.UsageError, weir.convert, "http://127.0.0.1/a.raw", self.folder / "a.nvdb")
        self.assertEqual(
            message,
            "source is 'http://127.0.0.1/a.raw': weir.convert reads files of this machine; copy it here first",
        )

    def test_what_needs_all_of_the_file_says_so(self):
        _, url = self.served()
        grid = weir.open(url)
        message = self.refused(weir.UsageError, grid.render)
        self.assertEqual(message, f"{url}: render reads all of the file; copy it to this machine")
        message = self.refused(weir.UsageError, grid.verify)
        self.assertEqual(message, f"{url}: verify reads all of the file; copy it to this machine")
        grid.close()
        self.assertIn("is closed", self.refused(weir.UsageError, grid.to_numpy))

    def test_only_packed_files(self):
        weir.convert(self.values[:64, :64, :64], self.folder / "b.nvdb", encoding="float", rate=2)
        _, url = self.served("/b.nvdb", {"/b.nvdb": (self.folder / "b.nvdb").read_bytes()})
        message = self.refused(weir.InputError, weir.open, url)
        self.assertEqual(
            message,
            f"{url}: is not packed (--encoding packed), and only packed files are read block by block; copy the file to "
            "this machine to read it",
        )

    def test_servers_that_cannot(self):
        server, url = self.served(ranges=False)
        message = self.refused(weir.InputError, weir.open, url)
        self.assertEqual(
            message, f"{url}: its server sends whole files only (status 200); copy the file to this machine"
        )
        missing = server.url("/b.nvdb")
        with self.assertRaises(FileNotFoundError) as raised:
            weir.open(missing)
        self.assertIsInstance(raised.exception, weir.InputError)
        self.assertEqual(str(raised.exception), f"{missing}: its server says 404 Not Found; there is no such file")
        server.close()
        self.assertIn("cannot be read", self.refused(weir.IoError, weir.open, url))

    def test_ctrl_c_ends_waiting_for_a_server_and_the_grid_reads_on(self):
        server, url = self.served()
        grid = weir.open(url)
        server.stalled.set()
        for call in (lambda: weir.open(url), lambda: grid[9], lambda: grid.sample([[9, 9, 9]]), grid.macrocells):
            start = time.monotonic()
            timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                call()
            self.assertLess(time.monotonic() - start, 2)
            timer.join()
        server.stalled.clear()
        self.assertTrue(same(grid[9], self.here[9]))

    def test_ctrl_c_ends_a_program_that_waits_for_a_server(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            url = f"http://127.0.0.1:{silent.getsockname()[1]}/a.nvdb"
            command = [sys.executable, "-c", f"import weir; print('ready', flush=True); weir.open({url!r})"]
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                self.assertEqual(process.stdout.readline(), "ready\n")
                connection, _ = silent.accept()
                with connection:
                    process.send_signal(signal.SIGINT)
                    start = time.monotonic()
                    _, errors = process.communicate(timeout=60)
                    self.assertLess(time.monotonic() - start, 2)
        self.assertEqual(errors.splitlines()[-1], "KeyboardInterrupt")
        self.assertEqual(process.returncode, -signal.SIGINT)

    def test_reads_where_no_thread_can_be_started(self):
        _, url = self.served()
        grid = weir.open(url)
        with unittest.mock.patch.object(threading.Thread, "start", side_effect=RuntimeError("can't start new thread")):
            found = grid[9]
        self.assertTrue(same(found, self.here[9]))

    def test_a_few_failures_are_tried_again(self):
        server, url = self.served()
        server.failures = 2
        grid = weir.open(url)
        server.failures = 2
        self.assertTrue(same(grid[9], self.here[9]))
        server.cut = 3
        self.assertTrue(same(grid[150], self.here[150]))
        server.failures = 1000
        self.assertIn("503", self.refused(weir.IoError, lambda: grid[263]))
        self.assertLessEqual(1000 - server.failures, 4 * 8, "each of them four times at most, eight at once")

    def test_bodies_that_always_break(self):
        server, url = self.served()
        grid = weir.open(url)
        server.cut = 1000
        with self.assertRaisesRegex(
            weir.IoError, "^http://.*/run/a.nvdb: the connection broke: .*; try again, or copy the file to this machine$"
        ) as caught:
            grid[9]
        self.assertIs(caught.exception.__class__, weir.IoError)

    def test_a_sidecar_that_breaks_is_asked_for_again(self):
        server, url = self.served()
        mended = weir.open(url)
        server.cut = 3
        self.assertEqual(mended.sidecar, self.here.sidecar)
        broken = weir.open(url)
        server.cut = 1000
        with self.assertRaisesRegex(
            weir.IoError,
            "^http://.*/run/a.nvdb.json: the connection broke: .*; try again, or copy the file to this machine$",
        ) as caught:
            _ = broken.sidecar
        self.assertIs(caught.exception.__class__, weir.IoError)
        self.assertEqual(1000 - server.cut, 4)

    def test_compressed_bodies_are_refused(self):
        server, url = self.served()
        grid = weir.open(url)
        server.coding = "gzip, gzip"
        message = self.refused(weir.InputError, lambda: grid[9])
        self.assertEqual(
            message, f"{url}: its server sends compressed bytes (gzip, gzip); copy the file to this machine"
        )
        self.assertIn("(gzip, gzip)", self.refused(weir.InputError, lambda: grid.sidecar))
        server.coding = "identity"
        self.assertTrue(same(grid[9], self.here[9]))

    def test_redirects_are_followed_and_their_bodies_not_read(self):
        server, _ = self.served()
        places = {"/there": "/run/a.nvdb", "/loop": "/loop", "/file": "file:///etc/passwd?key=7", "/bad": "http://["}
        server.moved = places
        grid = weir.open(server.url("/there"))
        self.assertTrue(same(grid[9], self.here[9]))
        url = server.url("/loop")
        self.assertEqual(self.refused(weir.IoError, weir.open, url), f"{url}: cannot be read: too many redirects")
        for path, place in (("/file", "file:///etc/passwd?..."), ("/bad", "http://[")):
            self.assertEqual(
                self.refused(weir.IoError, weir.open, server.url(path)),
                f"{server.url(path)}: its server redirects to '{place}', which is no URL of http or https",
            )
        self.assertLess(server.wasted, 128 << 20, "of some thirteen bodies of 64 MiB")

    def test_messages_show_no_passwords_and_signatures(self):
        server, url = self.served("/run/a.nvdb?X-Signature=secret7")
        asked = url.replace("://", "://me:pass%3Aword@")
        shown = server.url("/run/a.nvdb?...").replace("://", "://***@")
        server.needs = {"Authorization": "Basic " + base64.b64encode(b"me:pass:word").decode()}
        grid = weir.open(asked)
        self.assertEqual(repr(grid), f"<weir.Grid '{shown}', 264 x 264 x 264, packed>")
        self.assertEqual(grid.path, shown)
        self.assertEqual(grid.certificate, self.here.certificate)
        copy = pickle.loads(pickle.dumps(grid))
        self.assertTrue(same(copy[5], self.here[5]))
        self.assertEqual(
            self.refused(weir.UsageError, grid.verify),
            f"{shown}: verify reads all of the file; copy it to this machine",
        )
        server.needs = {"Authorization": "none"}
        with self.assertRaises(PermissionError) as raised:
            weir.open(asked)
        self.assertEqual(raised.exception.filename, shown)
        self.assertEqual(
            str(raised.exception), f"{shown}: its server says 401 Unauthorized; it may not be read without other rights"
        )
        server.needs = {}
        server.coding = "gzip"
        with self.assertRaises(weir.InputError) as raised:
            weir.open(asked)
        server.close()
        with self.assertRaises(weir.IoError) as broken:
            weir.open(asked)
        for error in (raised.exception, broken.exception):
            text = "".join(traceback.format_exception(error))
            self.assertIn(shown, text)
            self.assertNotRegex(text, "secret7|pass%3Aword")
        self.assertIn(repr(shown), self.refused(weir.UsageError, weir.convert, asked, self.folder / "a.nvdb"))
        self.assertEqual(
            self.refused(weir.UsageError, weir.open, "https://me:pass%3Aword@[/a.nvdb?key=secret7"),
            "https://***@[/a.nvdb?...: is no URL of http or https; correct it",
        )

    def test_headers_go_to_the_server_that_they_are_for(self):
        other, url = self.served()
        server, _ = self.served()
        server.moved = {"/here": "/run/a.nvdb", "/elsewhere": url}
        headers = {"authorization": "Bearer 7", "X-Team": "a", "range": "bytes=0-9"}
        for options in ({"headers": headers}, {"client_kwargs": {"headers": headers}}):
            grid = weir.open(server.url("/here"), storage_options=options)
            self.assertTrue(same(grid[9], self.here[9]))
            self.assertEqual((server.headers["authorization"], server.headers["X-Team"]), ("Bearer 7", "a"))
            weir.open(server.url("/elsewhere"), storage_options=options)
            self.assertEqual((other.headers.get("authorization"), other.headers["X-Team"]), (None, "a"))
        whole, url = self.served(ranges=False)
        self.assertEqual(
            self.refused(weir.InputError, weir.open, url, storage_options={"headers": headers}),
            f"{url}: its server sends whole files only (status 200); copy the file to this machine",
        )

    def test_reads_that_were_given_up_make_no_more_requests(self):
        server, url = self.served()
        grid = weir.open(url)
        server.cut = 1000
        failed = []
        reader = threading.Thread(target=lambda: failed.append(self.refused(weir.IoError, lambda: grid[9])))
        reader.start()
        while server.cut == 1000:
            time.sleep(0.01)
        grid._file.interrupt()
        reader.join()
        self.assertIn("reading was interrupted", failed[0])
        time.sleep(0.1)
        left = server.cut
        time.sleep(1)
        self.assertEqual(server.cut, left)
        server.cut = 0
        self.assertTrue(same(grid[9], self.here[9]))

    def test_answers_longer_than_what_was_asked_for(self):
        server, url = self.served()
        server.beyond = True
        last = len(self.files["/run/a.nvdb"]) - 1
        self.assertEqual(
            self.refused(weir.IoError, weir.open, url),
            f"{url}: its server answers bytes 0 to 8191 with status 206 and "
            f'Content-Range "bytes 0-{last}/{last + 1}"; copy the file to this machine',
        )

    def test_a_file_that_changes_is_noticed(self):
        server, url = self.served()
        grid = weir.open(url)
        server.changed("/run/a.nvdb", bytes(len(self.files["/run/a.nvdb"])))
        message = self.refused(weir.InputError, grid.to_numpy)
        self.assertEqual(message, f"{url}: changed while it was read; open it again")

    def test_a_file_of_another_length_is_noticed_where_the_server_tells_no_versions(self):
        server, url = self.served(tags=False)
        grid = weir.open(url)
        server.changed("/run/a.nvdb", self.files["/run/a.nvdb"] + bytes(8))
        message = self.refused(weir.InputError, grid.to_numpy)
        self.assertEqual(message, f"{url}: changed while it was read; open it again")

    def test_damaged_and_cut_files(self):
        data = self.files["/run/a.nvdb"]
        _, url = self.served("/a.nvdb", {"/a.nvdb": data[: len(data) // 2]})
        with self.assertRaises(weir.InputError) as raised:
            weir.open(url).to_numpy()
        self.assertRegex(str(raised.exception), "is it complete")
        _, url = self.served("/a.nvdb", {"/a.nvdb": b"no such format" * 2000})
        self.assertRegex(self.refused(weir.InputError, weir.open, url), "not a NanoVDB file")
        many = bytearray(data)
        many[4096 + 648 : 4096 + 652] = (1 << 31).to_bytes(4, "little")
        _, url = self.served("/a.nvdb", {"/a.nvdb": bytes(many)})
        self.assertIn("has 2147483648 records of blind data", self.refused(weir.InputError, weir.open, url))
        random = numpy.random.default_rng(8)
        opened = 0
        for _ in range(12):
            damaged = bytearray(data)
            for at in random.integers(0, 20000, 3).tolist() + random.integers(0, len(data), 300).tolist():
                damaged[at] = random.integers(256)
            server, url = self.served("/a.nvdb", {"/a.nvdb": bytes(damaged)})
            try:
                weir.open(url).to_numpy(numpy.s_[60:200, 60:200, 60:200])
                opened += 1
            except (weir.InputError, weir.IoError) as error:
                self.assertNotIn("\n", str(error))
        self.assertLess(opened, 12)

    def test_damage_on_the_way_is_forgotten(self):
        data = bytearray(self.files["/run/a.nvdb"])
        head = 65536  # bytes of the grid's head, which weir.open reads
        data[head:] = bytes(byte ^ 0xFF for byte in data[head:])
        for cache in ("256MiB", 0):
            with self.subTest(cache):
                server, url = self.served()
                grid = weir.open(url, cache=cache)
                server.files["/run/a.nvdb"] = bytes(data)  # the same version, as the server says
                for use in (grid.to_numpy, lambda: grid.sample([[200, 200, 200]]), lambda: grid[200, ::50, ::50]):
                    with self.assertRaises(weir.InputError):
                        use()
                server.files["/run/a.nvdb"] = self.files["/run/a.nvdb"]
                self.assertTrue(same(grid[200, ::50, ::50], self.here[200, ::50, ::50]))
                self.assertEqual(grid.sample([[200, 200, 200]]), self.here.sample([[200, 200, 200]]))
                self.assertTrue(same(grid.to_numpy(), self.here.to_numpy()))

    def test_a_fragment_is_no_part_of_what_is_asked_for(self):
        for url in ("/run/a.nvdb#v1", "/run/a.nvdb?key=1#v1"):
            server, url = self.served(url)
            grid = weir.open(url)
            self.assertEqual(grid.certificate, self.here.certificate)
            self.assertLess(grid.bytes_read, self.here.bytes / 2)
        self.assertEqual(sidecar_url("https://host/a.nvdb?key=1#v1"), "https://host/a.nvdb.json?key=1")
        self.assertEqual(sidecar_url("s3://bucket/a#1.nvdb"), "s3://bucket/a#1.nvdb.json")

    def test_storage_options_of_wrong_types(self):
        for options, message in (
            ([1], "storage_options is of type list, it must be a dictionary whose keys are texts"),
            ({1: 2}, "storage_options is of type dict, it must be a dictionary whose keys are texts"),
            ({"headers": 3}, "storage_options['headers'] is of type int, it must be a dictionary whose keys are texts"),
            (
                {"client_kwargs": 3},
                "storage_options['client_kwargs'] is of type int, it must be a dictionary whose keys are texts",
            ),
            (
                {"client_kwargs": {"headers": {"A": 1}}},
                "storage_options['client_kwargs']['headers']['A'] is of type int, it must be a text",
            ),
            (
                {"headers": {"Authorization": "Bearer secret\n"}},
                "storage_options['headers']['Authorization'] has a character that no header has, a line break for instance; "
                "remove it",
            ),
        ):
            with self.subTest(message):
                found = self.refused(weir.UsageError, weir.open, "https://host/a.nvdb", storage_options=options)
                self.assertEqual(found, message)

    def test_file_systems_of_fsspec(self):
        try:
            import fsspec
        except ImportError:
            self.skipTest("python3-fsspec is not installed")
        memory = fsspec.filesystem("memory")
        for path, data in self.files.items():
            memory.pipe(path, data)
        grid = weir.open("memory://run/a.nvdb")
        self.assertTrue(same(grid[100:120, 5], self.here[100:120, 5]))
        self.assertEqual(grid.certificate, self.here.certificate)
        local = weir.open(f"file://{self.path}", storage_options={"auto_mkdir": False})
        self.assertTrue(same(local[7], self.here[7]))
        with self.assertRaises(FileNotFoundError) as raised:
            weir.open("memory://run/b.nvdb")
        self.assertEqual(str(raised.exception), "memory://run/b.nvdb: there is no such file")
        for status in (401, 403, 404, 410, 500):  # as aiohttp says it
            answer = OSError(f"{status}, url=URL('https://me:pass@host/a.nvdb.json?key=secret7')")
            answer.status = status
            beside = weir.open("memory://run/a.nvdb")
            beside._file._path = "https://host/a.nvdb?key=secret7"
            with unittest.mock.patch.object(type(memory), "cat_file", side_effect=answer) as asked:
                if status < 500:
                    self.assertIsNone(beside.sidecar)
                else:
                    self.assertEqual(
                        self.refused(weir.IoError, lambda: beside.sidecar),
                        "memory://run/a.nvdb.json: cannot be read: 500, url=URL('https://***@host/a.nvdb.json?...",
                    )
            self.assertEqual(asked.call_args.args[-1], "https://host/a.nvdb.json?key=secret7")
        memory.pipe("/run/a.nvdb", bytes(len(self.files["/run/a.nvdb"])))
        message = self.refused(weir.InputError, grid.to_numpy)
        self.assertEqual(message, "memory://run/a.nvdb: changed while it was read; open it again")
        self.assertIn("cannot be opened", self.refused(weir.UsageError, weir.open, "nonsense://a/b.nvdb"))
        message = self.refused(weir.UsageError, weir.open, self.path, storage_options={"a": 1})
        self.assertEqual(message, f"storage_options are for URLs, and '{self.path}' is a path")
        message = self.refused(weir.UsageError, weir.open, self.path, cache="1MiB")
        self.assertEqual(message, f"cache is for URLs, and '{self.path}' is a path")

    def test_xarray_opens_a_url(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("python3-xarray is not installed")
        server, url = self.served()
        dataset = xarray.open_dataset(url, engine="weir")
        self.assertTrue(same(dataset["bumps"][3, 4:9].values, self.here[3, 4:9]))
        self.assertLess(server.bytes_sent(), self.here.bytes / 2)


if __name__ == "__main__":
    unittest.main()
