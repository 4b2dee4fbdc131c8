"""Writes Zarr arrays of many kinds, and beside each what it holds as float32: write_arrays.py DIRECTORY

Version 2 by python3-zarr. Version 3, which that does not know, by the few lines below, with numcodecs' compressors.
cases.txt has a line for each: NAME PATH DATASET INDEX X Y Z, the index as "0,1" or "-"; NAME.f32 has the values.
"""
import itertools
import json
import os
import pathlib
import struct
import sys
import zipfile

import numcodecs
import numpy as np
import zarr

out = pathlib.Path(sys.argv[1])
random = np.random.default_rng(24)
cases = []


def values_of(dtype, shape):
    """Returns values that are smooth enough to compress but use every bit somewhere. Some floats are not finite."""
    dtype = np.dtype(dtype)
    smooth = np.cumsum(random.integers(0, 3, int(np.prod(shape)))).reshape(shape)
    if dtype.kind == "f":
        values = (smooth * 0.37 - 20).astype(dtype)
        flat = values.reshape(-1)
        flat[3::97] = [np.nan, np.inf, -np.inf][len(cases) % 3]
        flat[5::53] = random.normal(size=flat[5::53].size) * 1e-6
        return values
    info = np.iinfo(dtype)
    values = (smooth % 100).astype(dtype)
    flat = values.reshape(-1)
    flat[3::17] = random.integers(info.min, info.max, flat[3::17].size, dtype=dtype.newbyteorder("="), endpoint=True)
    return values


def note(name, path, dataset, array, index=None):
    volume = array if index is None else array[tuple(index)]
    volume.astype("<f4").tofile(out / f"{name}.f32")
    z, y, x = volume.shape
    cases.append(f"{name} {path} {dataset or '-'} {','.join(map(str, index or [])) or '-'} {x} {y} {z}")


# Version 2.
TYPES = ["|u1", "|i1"] + [f"{order}{kind}" for kind in ("u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8")
                          for order in "<>"]
COMPRESSORS = [None, numcodecs.Zlib(1), numcodecs.GZip(1), numcodecs.Zstd(1),
               numcodecs.Blosc("lz4", 5, numcodecs.Blosc.SHUFFLE), numcodecs.Blosc("zstd", 1, numcodecs.Blosc.BITSHUFFLE),
               numcodecs.Blosc("zlib", 1, numcodecs.Blosc.NOSHUFFLE), numcodecs.Blosc("blosclz", 9)]
SHAPES = [((13, 17, 19), (5, 8, 7)), ((9, 33, 40), (9, 33, 40)), ((21, 10, 12), (32, 4, 12)), ((6, 7, 50), (1, 7, 50))]
for i, dtype in enumerate(TYPES):
    for variant in range(2):
        shape, chunks = SHAPES[(i + variant) % len(SHAPES)]
        name = f"v2_{i}_{variant}"
        array = values_of(dtype, shape)
        store = zarr.DirectoryStore(str(out / f"{name}.zarr"))
        stored = zarr.create(shape, chunks=chunks, dtype=dtype, compressor=COMPRESSORS[(i + 3 * variant) % 8],
                             order="CF"[variant], store=store, fill_value=7, dimension_separator="./"[i % 2])
        stored[:] = array
        if variant == 1:  # some chunks are not stored
            files = sorted(f for f in (out / f"{name}.zarr").rglob("*") if f.is_file() and f.name[0] != ".")
            for file in files[::3]:
                file.unlink()
            array = zarr.open(store)[:]
        note(name, f"{name}.zarr", "", array)
# Arrays with filters, and arrays of bool.
for i, dtype in enumerate(["<i2", ">i4", "<u8", "|u1", "<f4", ">f4", "<f8", "|b1"]):
    for variant in range(2):
        name = f"v2_filter_{i}_{variant}"
        size = np.dtype(dtype).itemsize
        array = np.cumsum(random.integers(-3, 4, 13 * 17 * 19)).reshape(13, 17, 19)
        array = array % 3 == 0 if dtype == "|b1" else (array * (0.1 if "f" in dtype else 1)).astype(dtype)
        delta = [] if dtype == "|b1" else [numcodecs.Delta(dtype)]
        filters = [delta + [numcodecs.Shuffle(size)], delta][variant] or None
        store = zarr.DirectoryStore(str(out / f"{name}.zarr"))
        stored = zarr.create(array.shape, chunks=(5, 8, 7), dtype=dtype, compressor=COMPRESSORS[i % 8], filters=filters,
                             order="CF"[variant], store=store, fill_value=0)
        stored[:] = array
        note(name, f"{name}.zarr", "", stored[:])  # differences of floats do not sum to the values written
for variant, (order, method) in enumerate([("C", zipfile.ZIP_STORED), ("F", zipfile.ZIP_DEFLATED)]):
    name = f"v2_zip_{variant}"
    array = values_of(">i2", (2, 3, 11, 12, 13))
    with zarr.ZipStore(str(out / f"{name}.zip"), compression=method, mode="w") as store:
        group = zarr.group(store=store)
        group.create_dataset("a/b", data=array, chunks=(2, 2, 4, 5, 6), order=order)
        group.create_dataset("flat", data=array[0, 0, 0])
    note(name, f"{name}.zip", "a/b", array, (1, 2))
    note(f"{name}_first", f"{name}.zip", "a/b", array, (0, 0))


# Version 3.
def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 & -(crc & 1))
    return struct.pack("<I", crc ^ 0xFFFFFFFF)


def encode(chunk, codecs):
    data = chunk
    for codec in codecs:
        configuration = codec.get("configuration", {})
        if codec["name"] == "transpose":
            data = data.transpose(configuration["order"])
        elif codec["name"] == "bytes":
            order = ">" if configuration.get("endian") == "big" else "<"
            data = np.ascontiguousarray(data).astype(data.dtype.newbyteorder(order)).tobytes()
        elif codec["name"] == "gzip":
            data = bytes(numcodecs.GZip(configuration["level"]).encode(data))
        elif codec["name"] == "zstd":
            data = bytes(numcodecs.Zstd(configuration["level"]).encode(data))
        elif codec["name"] == "blosc":
            shuffle = ["noshuffle", "shuffle", "bitshuffle"].index(configuration["shuffle"])
            typed = np.frombuffer(data, dtype=f"V{configuration['typesize']}") if shuffle else data
            data = bytes(numcodecs.Blosc(configuration["cname"], configuration["clevel"], shuffle).encode(typed))
        elif codec["name"] == "crc32c":
            data = data + crc32c(data)
        elif codec["name"] == "sharding_indexed":
            data = encode_shard(data, configuration)
    return data


def chunks_of(array, shape, fill):
    """Yields each chunk, filled up beyond the array's edge, with its position."""
    for position in itertools.product(*(range(-(-n // c)) for n, c in zip(array.shape, shape))):
        part = array[tuple(slice(p * c, (p + 1) * c) for p, c in zip(position, shape))]
        chunk = np.full(shape, fill, dtype=array.dtype)
        chunk[tuple(slice(0, n) for n in part.shape)] = part
        yield position, chunk


def encode_shard(shard, configuration):
    index_first = configuration.get("index_location") == "start"
    count = int(np.prod([n // c for n, c in zip(shard.shape, configuration["chunk_shape"])]))
    checked = len(configuration["index_codecs"]) > 1
    offset = count * 16 + 4 * checked if index_first else 0
    places, body = [], b""
    for _, chunk in chunks_of(shard, configuration["chunk_shape"], 0):
        if (chunk == FILL).all():
            places.append((2**64 - 1, 2**64 - 1))
            continue
        data = encode(chunk, configuration["codecs"])
        places.append((offset + len(body), len(data)))
        body += data
    order = ">" if configuration["index_codecs"][0]["configuration"]["endian"] == "big" else "<"
    index = np.array(places, dtype=order + "u8").tobytes()
    index += crc32c(index) if checked else b""
    return index + body if index_first else body + index


def write_v3(path, array, chunk, codecs, fill, keys=None, names=None, attributes=None, leave_out=lambda position: False):
    os.makedirs(path, exist_ok=True)
    keys = keys or {"name": "default", "configuration": {"separator": "/"}}
    metadata = {"zarr_format": 3, "node_type": "array", "shape": array.shape, "data_type": array.dtype.name,
                "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}},
                "chunk_key_encoding": keys, "codecs": codecs, "fill_value": fill, "attributes": attributes or {}}
    if names:
        metadata["dimension_names"] = names
    (path / "zarr.json").write_text(json.dumps(metadata))
    separator = keys.get("configuration", {}).get("separator", "/" if keys["name"] == "default" else ".")
    for position, part in chunks_of(array, chunk, FILL):
        if leave_out(position) or (part == FILL).all():
            array[tuple(slice(p * c, (p + 1) * c) for p, c in zip(position, chunk))] = FILL
            continue
        parts = (["c"] if keys["name"] == "default" else []) + [str(p) for p in position]
        file = path / separator.join(parts)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(encode(part, codecs))


FILL = 5
BYTES = [{"name": "bytes", "configuration": {"endian": order}} for order in ("little", "big")]
GZIP, ZSTD = [{"name": "gzip", "configuration": {"level": 1}}], [{"name": "zstd", "configuration": {"level": 1, "checksum": False}}]
CRC = [{"name": "crc32c"}]


def blosc(cname, shuffle, size):
    return [{"name": "blosc", "configuration": {"cname": cname, "clevel": 5, "shuffle": shuffle, "typesize": size,
                                                "blocksize": 0}}]


def transpose(*order):
    return [{"name": "transpose", "configuration": {"order": order}}]


KEYS = [None, {"name": "default", "configuration": {"separator": "."}}, {"name": "v2"},
        {"name": "v2", "configuration": {"separator": "/"}}]
V3_TYPES = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float16", "float32", "float64"]
for i, dtype in enumerate(V3_TYPES):
    size = np.dtype(dtype).itemsize
    packers = [[], GZIP, ZSTD, blosc("lz4", "shuffle", size), blosc("zstd", "bitshuffle", size), GZIP + CRC, CRC,
               CRC + ZSTD + CRC]
    for variant in range(2):
        name = f"v3_{i}_{variant}"
        array = values_of(dtype, (13, 17, 19))
        front = [[], transpose(2, 1, 0), transpose(1, 2, 0), transpose(0, 2, 1)][(i + variant) % 4]
        codecs = front + [BYTES[(i + variant) % 2]] + packers[(i + 4 * variant) % 8]
        write_v3(out / f"{name}.zarr", array, (5, 8, 7), codecs, FILL, KEYS[i % 4],
                 leave_out=lambda position: variant == 1 and sum(position) % 3 == 0)
        note(name, f"{name}.zarr", "", array)
for i, dtype in enumerate(["uint16", "float32", "float64", "int32", "uint8", "float16"]):
    name = f"v3_shard_{i}"
    array = values_of(dtype, (2, 13, 17, 19))
    array[:, 4:8, :8, :] = FILL  # some inner chunks are not stored
    inner = [[], transpose(3, 2, 1, 0)][i % 2] + [BYTES[i // 2 % 2]] + [[], GZIP, ZSTD, CRC][i % 4]
    index = [BYTES[i % 2]] + (CRC if i != 2 else [])
    sharding = {"name": "sharding_indexed",
                "configuration": {"chunk_shape": (1, 4, 4, 8), "codecs": inner, "index_codecs": index,
                                  "index_location": ["end", "start"][i // 2 % 2]}}
    write_v3(out / f"{name}.zarr", array, (2, 8, 12, 16), [sharding], FILL,
             leave_out=lambda position: i == 3 and position == (0, 1, 1, 1))
    note(name, f"{name}.zarr", "", array, (1,))
# Shards within shards, with the index at the start or the end.
for i, dtype in enumerate(["uint16", "float32", "float64", "int32"]):
    name = f"v3_nested_{i}"
    array = values_of(dtype, (13, 17, 39))
    array[4:8, :8, :] = FILL
    array[8:, 8:, 24:] = FILL  # whole inner shards
    codecs = [[], transpose(2, 1, 0)][i % 2] + [BYTES[i // 2 % 2]] + [GZIP, [], ZSTD, CRC][i]
    shapes = [(2, 4, 4), (4, 4, 12), (8, 8, 24)][:2 + i % 2]
    for level, shape in enumerate(shapes):
        codecs = [{"name": "sharding_indexed",
                   "configuration": {"chunk_shape": shape, "codecs": codecs,
                                     "index_codecs": [BYTES[(i + level) % 2]] + (CRC if (i + level) % 3 else []),
                                     "index_location": ["end", "start"][i // 2 * ((i + level) % 2)]}}]
    write_v3(out / f"{name}.zarr", array, (8, 16, 24), codecs, FILL,
             leave_out=lambda position: i == 3 and position == (1, 0, 1))
    note(name, f"{name}.zarr", "", array)
# Arrays in a zip file, stored and deflated, with names of axes and inside a group.
for variant, method in enumerate([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED]):
    name = f"v3_zip_{variant}"
    array = values_of("float32", (3, 9, 10, 11))
    root = out / f"{name}.zarr"
    write_v3(root / "fields" / "rho", array, (2, 4, 5, 6), [BYTES[0]] + GZIP, FILL, names=("t", "z", "y", "x"))
    for group in (root, root / "fields"):
        (group / "zarr.json").write_text('{"zarr_format": 3, "node_type": "group", "attributes": {"a": NaN}}')
    with zipfile.ZipFile(out / f"{name}.zip", "w", method) as packed:
        for file in sorted(root.rglob("*")):
            packed.write(file, file.relative_to(root))
    note(name, f"{name}.zip", "", array, (2,))
(out / "cases.txt").write_text("\n".join(cases) + "\n")
