#!/usr/bin/env python3
"""Writes the inputs of docs/zarr.md to the current folder: run.zarr (version 3, two fields at two times),
run.zarr.zip (the same in a zip file) and image.ome.zarr (version 2, an image of two scales)."""

import array
import gzip
import itertools
import json
import math
import os
import zipfile
import zlib

CHUNK = 16


def chunk_bytes(corner, scale, shift):
    values = array.array("f")
    for k, j, i in itertools.product(range(CHUNK), repeat=3):
        at = [(c + d) * scale / 32 - 1 for c, d in zip(corner, (k, j, i))]
        values.append(math.exp(-sum(a * a for a in at)) + shift)
    return values.tobytes()


def corners(cells):
    return itertools.product(range(0, cells, CHUNK), repeat=3)


def write(path, data):
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else json.dumps(data, indent=1).encode())


def write_run(root):
    write(f"{root}/zarr.json", {"zarr_format": 3, "node_type": "group", "attributes": {}})
    for name, shift in (("density", 0), ("temperature", 300)):
        write(f"{root}/{name}/zarr.json", {
            "zarr_format": 3, "node_type": "array", "shape": [2, 64, 64, 64], "data_type": "float32",
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [1, CHUNK, CHUNK, CHUNK]}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
            "codecs": [{"name": "bytes", "configuration": {"endian": "little"}},
                       {"name": "gzip", "configuration": {"level": 1}}],
            "fill_value": 0, "dimension_names": ["time", "z", "y", "x"], "attributes": {"units": "kg m-3"}})
        for time, corner in itertools.product(range(2), corners(64)):
            if name == "density" and corner == (0, 0, 0):
                continue  # not stored
            key = "/".join(str(c // CHUNK) for c in corner)
            write(f"{root}/{name}/c/{time}/{key}", gzip.compress(chunk_bytes(corner, 1, shift + time), 1))


def write_image(root):
    axes = [{"name": "c", "type": "channel"}] + [{"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"]
    levels = [{"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": [1] + [0.5 * 2**level] * 3}]}
              for level in range(2)]
    write(f"{root}/.zgroup", {"zarr_format": 2})
    write(f"{root}/.zattrs", {"multiscales": [{"version": "0.4", "axes": axes, "datasets": levels}]})
    for level, cells in enumerate((64, 32)):
        write(f"{root}/{level}/.zarray", {
            "zarr_format": 2, "shape": [2] + [cells] * 3, "chunks": [1] + [CHUNK] * 3, "dtype": "<f4", "order": "C",
            "compressor": {"id": "zlib", "level": 1}, "filters": None, "fill_value": 0.0, "dimension_separator": "/"})
        for channel, corner in itertools.product(range(2), corners(cells)):
            key = "/".join(str(c // CHUNK) for c in corner)
            write(f"{root}/{level}/{channel}/{key}", zlib.compress(chunk_bytes(corner, 2**level, channel), 1))


write_run("run.zarr")
with zipfile.ZipFile("run.zarr.zip", "w") as packed:
    for folder, _, files in os.walk("run.zarr"):
        for file in files:
            packed.write(os.path.join(folder, file), os.path.relpath(os.path.join(folder, file), "run.zarr"))
write_image("image.ome.zarr")
