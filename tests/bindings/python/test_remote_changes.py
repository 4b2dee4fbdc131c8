"""Tests remote files over time: files that change, closed grids, and the ways in which xarray opens remote files."""

import pickle
import unittest

import numpy

import weir
from range_server import RangeServer
from support import FolderTest, same


class Remote(FolderTest):
    def setUp(self):
        super().setUp()
        z, y, x = numpy.mgrid[0:264, 0:40, 0:40].astype(numpy.float32)
        weir.convert(
            numpy.sin(x / 9) + numpy.cos(y / 7) * z, self.folder / "a.nvdb", encoding="packed", rate=8, dataset="waves"
        )
        self.files = {f"/{name}": (self.folder / name).read_bytes() for name in self.names()}
        self.here = weir.open(self.folder / "a.nvdb")
        self.addCleanup(self.here.close)

    def served(self, **keywords):
        server = RangeServer(self.files, **keywords)
        self.addCleanup(server.close)
        return server, server.url("/a.nvdb")

    def test_a_weak_tag_that_differs_is_noticed(self):
        server, url = self.served(weak=True)
        grid = weir.open(url)
        self.assertTrue(same(grid[100], self.here[100]))
        self.assertNotIn("If-Range", server.headers)
        server.changed("/a.nvdb", self.files["/a.nvdb"])
        self.assertEqual(
            self.refused(weir.InputError, lambda: grid[263]), f"{url}: changed while it was read; open it again"
        )
        self.assertTrue(same(weir.open(url)[263], self.here[263]))

    def test_a_tag_that_is_weak_in_some_answers_only_is_the_same(self):
        server, url = self.served(dated="Mon, 30 Nov 2026 07:00:00 GMT")
        grid = weir.open(url)
        self.assertEqual(server.headers["If-Range"], '"1"')
        server.weak = True
        self.assertTrue(same(grid[263], self.here[263]))

    def test_the_sidecar_of_a_closed_grid_is_refused(self):
        server, url = self.served()
        read, other = weir.open(url), weir.open(url)
        self.assertEqual(read.sidecar, self.here.sidecar)
        requests = other.requests
        for grid in (read, other):
            grid.close()
            for use in (lambda: grid.sidecar, lambda: grid.certificate, grid.to_numpy, lambda: pickle.dumps(grid)):
                self.assertEqual(
                    self.refused(weir.UsageError, use), f"{url}: is closed; open it again with weir.open"
                )
        self.assertEqual(other.requests, requests)

    def test_xarray_passes_on_what_the_server_needs(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("python3-xarray is missing")
        server, url = self.served()
        server.needs = {"Authorization": "Bearer 7"}
        options = {"headers": {"Authorization": "Bearer 7"}}
        with xarray.open_dataset(url, engine="weir", storage_options=options) as dataset:
            self.assertTrue(same(dataset["waves"][3, 4:9].values, self.here[3, 4:9]))
        with self.assertRaises(PermissionError):
            xarray.open_dataset(url, engine="weir")
        self.assertEqual(
            self.refused(weir.UsageError, xarray.open_dataset, url, engine="weir", storage_options=[1]),
            "storage_options is of type list, it must be a dictionary whose keys are texts",
        )
        path = self.folder / "a.nvdb"
        self.assertEqual(
            self.refused(weir.UsageError, xarray.open_dataset, path, engine="weir", storage_options=options),
            "storage_options are for URLs, and 'a.nvdb' is a path",
        )

    def test_xarray_passes_on_the_cache(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("python3-xarray is missing")
        sent = []
        for keywords in ({"remote_cache": 0}, {}):
            server, url = self.served()
            with xarray.open_dataset(url, engine="weir", cache=False, **keywords) as dataset:
                for z in (0, 263, 0, 263):
                    self.assertTrue(same(dataset["waves"][z].values, self.here[z]))
            sent.append(server.bytes_sent())
        self.assertGreater(sent[0], 1.5 * sent[1])
        self.assertEqual(
            self.refused(weir.UsageError, xarray.open_dataset, url, engine="weir", remote_cache="much"),
            "cache is 'much', it must be a size as 67108864 or '256MiB'",
        )


if __name__ == "__main__":
    unittest.main()
