#!/usr/bin/env python3
"""Rate of converting packed Zarr arrays, beside reading them by zarr-python, one core and all:

    bench/zarr_decode.py --weir build/release/weir build/zarr

Writes DIRECTORY/CODEC.zarr of version 2, in chunks of 64^3, and reads it into the page cache. The conversion does more: it
packs the values, measures the error and writes; zarr-python reads a slab of chunks at a time and drops it.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import time

import numcodecs
import numpy
import zarr

CHUNK = 64
CODECS = {"gzip": numcodecs.GZip(1), "zstd": numcodecs.Zstd(1),
          "blosc": numcodecs.Blosc("lz4", 5, numcodecs.Blosc.SHUFFLE)}


def write(path, codec, edge):
    array = zarr.open(str(path), mode="w", shape=(edge,) * 3, chunks=(CHUNK,) * 3, dtype="<f4", compressor=codec)
    random = numpy.random.default_rng(7)
    ramp = numpy.arange(edge, dtype=numpy.float32)
    for z in range(0, edge, CHUNK):
        slab = numpy.sin(0.02 * (ramp[z : z + CHUNK, None, None] + ramp[None, :, None] + 2 * ramp[None, None, :]))
        array[z : z + CHUNK] = slab + random.integers(0, 16, slab.shape, dtype=numpy.int8) * numpy.float32(2**-10)


def read_by_zarr(path):
    array = zarr.open(str(path), mode="r")
    begun = time.perf_counter()
    for z in range(0, array.shape[0], CHUNK):
        array[z : z + CHUNK]
    return time.perf_counter() - begun


def convert(weir, path, threads):
    """Returns the seconds of wall time and of CPU time of all cores."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.perf_counter()
    subprocess.run([weir, "convert", path, "--rate", "32", "--threads", str(threads), "-q", "--overwrite", "-o",
                    path.with_suffix(".nvdb")], check=True)
    seconds = time.perf_counter() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def best(measure):
    """Returns the smallest of several times, each a tuple that begins with the seconds."""
    return min(measure() for _ in range(ROUNDS))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path, help="where the arrays are written, and kept for another run")
    parser.add_argument("--weir", default="weir", help="the command; default: weir")
    parser.add_argument("--edge", type=int, default=384, help="voxels along each axis; default: 384")
    options = parser.parse_args()
    options.directory.mkdir(parents=True, exist_ok=True)
    size = 4 * options.edge**3 / 1e6
    for name, codec in CODECS.items():
        path = options.directory / f"{name}.zarr"
        if not path.exists():
            write(path, codec, options.edge)
        for chunk in path.rglob("*"):
            if chunk.is_file():
                chunk.read_bytes()
        cores = os.cpu_count()
        reading, = best(lambda path=path: (read_by_zarr(path),))
        one, _ = best(lambda path=path: convert(options.weir, path, 1))
        every, busy = best(lambda path=path: convert(options.weir, path, cores))
        print(f"{name}: zarr-python reads {size / reading:.0f} MB/s; weir converts {size / one:.0f} MB/s on one core, "
              f"{size / every:.0f} MB/s on {cores}, with {busy / every:.2f} of them busy")


if __name__ == "__main__":
    main()
