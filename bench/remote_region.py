#!/usr/bin/env python3
"""Requests and bytes that a box of a packed file takes from a web server on loopback, as `weir.open(URL)` reads it:

    weir sample turbulence --dims 1024,1024,1024 -o t_1024x1024x1024_float32.raw
    weir convert t_1024x1024x1024_float32.raw --encoding packed --rate 16 -o t.nvdb
    PYTHONPATH=build/release/python bench/remote_region.py t.nvdb

Once inside one region of 128^3 voxels, once in its corner, once across the corner of eight. The share is the box's part of
the file, by voxels. Values are compared with those of the file itself.
"""
import argparse
import mmap
import pathlib
import sys
import time

import numpy
import weir

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/bindings/python"))
from range_server import RangeServer

REGION = 128


def measure(path, data, what, corner, edge):
    server = RangeServer({"/a.nvdb": data})
    box = tuple(slice(c, c + edge) for c in corner)
    begun = time.perf_counter()
    with weir.open(server.url("/a.nvdb")) as grid:
        values = grid.to_numpy(box)
        seconds = time.perf_counter() - begun
        share = grid.bytes * edge**3 / numpy.prod([float(n) for n in grid.shape])
    server.close()
    with weir.open(path) as here:
        if not numpy.array_equal(values, here.to_numpy(box), equal_nan=True):
            sys.exit(f"{path}: the values of {what} are not those of the file")
    sent = server.bytes_sent()
    print(f"{what}: {len(server.asked)} requests, {sent} bytes, share {share:.0f}, "
          f"(bytes - 64 KiB) / share {(sent - 65536) / share:.2f}, {seconds:.3f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="a packed file, of more than 256 voxels along each axis")
    parser.add_argument("--edge", type=int, default=64, help="voxels of the box along each axis; default: 64")
    options = parser.parse_args()
    with weir.open(options.file) as grid:
        middle = [n // (2 * REGION) * REGION for n in grid.shape]
        print(f"{options.file.name}: {' x '.join(map(str, grid.shape))}, {grid.bytes} bytes")
    with open(options.file, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        inside = (REGION - options.edge) // 2
        measure(options.file, data, "inside one region", [m + inside for m in middle], options.edge)
        measure(options.file, data, "in its corner", middle, options.edge)
        measure(options.file, data, "across eight", [m - options.edge // 2 for m in middle], options.edge)


if __name__ == "__main__":
    main()
