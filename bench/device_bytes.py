#!/usr/bin/env python3
"""Files of volumes on each CUDA device, byte by byte beside those that the CPU makes of the same values:

    bench/device_bytes.py --library build/release/libweir.so tooth_103x94x161_uint8.raw ...

Converts each volume, as stored and as float32, whole and without some planes, by twelve budgets and three kinds of preview,
in one call and (--preview auto) as slabs. Needs numpy and CuPy; a name ends in XxYxZ_TYPE.raw, TYPE with be or le behind it
where bytes are in that order. Exit code 1 where two files, or two messages, differ.
"""
import argparse
import ctypes
import itertools
import pathlib
import re
import sys
import tempfile
import time

import cupy
import numpy

TYPES = {"uint8": 1, "int8": 2, "uint16": 3, "int16": 4, "uint32": 5, "int32": 6, "float16": 9, "float32": 10, "float64": 11}
RATE, SIZE, PSNR, MAX_ERROR, LOSSLESS = 1, 2, 3, 4, 5
PACKED, BY_CPU, BY_CUDA = 6, 1, 2
PREVIEWS = {"auto": 0, "on": 1, "off": 2}
MEMORY = 8 << 30
SLAB = 37  # planes


class Error(ctypes.Structure):
    _fields_ = [("status", ctypes.c_int32), ("message", ctypes.c_char * 2044)]


class Volume(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_size_t), ("extent", ctypes.c_int64 * 3), ("spacing", ctypes.c_double * 3),
                ("origin", ctypes.c_double * 3), ("name", ctypes.c_char_p), ("missing", ctypes.c_char_p),
                ("type", ctypes.c_int32), ("reserved", ctypes.c_int32)]


class Options(ctypes.Structure):
    _fields_ = ([("struct_size", ctypes.c_size_t), ("budget", ctypes.c_double), ("size", ctypes.c_uint64),
                 ("memory", ctypes.c_uint64), ("work_dir", ctypes.c_char_p)]
                + [(name, ctypes.c_void_p) for name in ("progress", "cancel", "notice", "user")]
                + [(name, ctypes.c_int32) for name in ("budget_kind", "encoding", "metric", "brick", "fill", "nonfinite",
                                                       "has_background")]
                + [("background", ctypes.c_float)]
                + [(name, ctypes.c_int32) for name in ("overwrite", "threads", "preview", "missing_policy", "at_most",
                                                       "backend", "certify", "reserved")])


class Weir:
    """The calls of weir.h that are needed here. Each returns its status and the bytes of the file, or a message."""

    def __init__(self, library, folder):
        self.calls = ctypes.CDLL(str(library))
        self.calls.weir_push_free.restype = None
        self.output = folder / "out.nvdb"

    def made(self, status, error):
        return status, error.message if status else self.output.read_bytes()

    def described(self, values, budget, preview, backend):
        volume, options = Volume(), Options()
        self.calls.weir_volume_init(ctypes.byref(volume), ctypes.c_size_t(ctypes.sizeof(volume)))
        self.calls.weir_convert_options_init(ctypes.byref(options), ctypes.c_size_t(ctypes.sizeof(options)))
        volume.extent[:] = values.shape[::-1]
        volume.type = TYPES[values.dtype.name]
        options.budget_kind, amount = budget
        if options.budget_kind == SIZE:
            options.size = amount
        else:
            options.budget = amount
        options.encoding, options.preview, options.backend = PACKED, PREVIEWS[preview], backend
        options.memory, options.overwrite = MEMORY, 1
        return volume, options

    def by_cpu(self, values, budget, preview):
        volume, options = self.described(values, budget, preview, BY_CPU)
        error = Error()
        status = self.calls.weir_convert(ctypes.byref(volume), values.ctypes.data_as(ctypes.c_void_p), None,
                                         ctypes.byref(options), str(self.output).encode(), ctypes.byref(error))
        return self.made(status, error)

    def by_device(self, values, budget, preview):
        volume, options = self.described(values, budget, preview, BY_CUDA)
        error = Error()
        status = self.calls.weir_convert_device(ctypes.byref(volume), ctypes.c_void_p(values.data.ptr), None, None,
                                                ctypes.byref(options), str(self.output).encode(), ctypes.byref(error))
        return self.made(status, error)

    def as_slabs(self, values, budget, preview):
        volume, options = self.described(values, budget, preview, BY_CUDA)
        error, push = Error(), ctypes.c_void_p()
        status = self.calls.weir_push_begin(ctypes.byref(volume), ctypes.byref(options), str(self.output).encode(),
                                            ctypes.byref(push), ctypes.byref(error))
        if status:
            return self.made(status, error)
        status = self.calls.weir_push_device_memory(push, ctypes.c_uint64(values.nbytes + (64 << 20)), ctypes.byref(error))
        for z in range(0, values.shape[0], SLAB):
            planes = values[z : z + SLAB]
            status = status or self.calls.weir_push_slab_device(push, ctypes.c_int64(z), ctypes.c_int64(len(planes)),
                                                                ctypes.c_void_p(planes.data.ptr), None, None,
                                                                ctypes.byref(error))
        status = status or self.calls.weir_push_end(push, ctypes.byref(error))
        made = self.made(status, error)
        self.calls.weir_push_free(push)
        return made


def read(path):
    found = re.fullmatch(r".*_(\d+)x(\d+)x(\d+)_([a-z]+\d+)(be|le)?\.raw", path.name)
    if not found or found[4] not in TYPES:
        raise SystemExit(f"{path}: a name ends in XxYxZ_TYPE.raw")
    stored = numpy.dtype(found[4]).newbyteorder(">" if found[5] == "be" else "<")
    values = numpy.fromfile(path, stored).reshape([int(found[i]) for i in (3, 2, 1)])
    return values.astype(values.dtype.newbyteorder("="))


def forms(values):
    """Returns the values unchanged, as float32, and as float32 with an odd extent."""
    single = values.astype(numpy.float32)
    whole = [single] if values.dtype == numpy.float32 else [values, single]
    return whole + [numpy.ascontiguousarray(single[1:, :-3, 5:])]


def budgets(values):
    width = float(values.max()) - float(values.min())
    rates = [(RATE, rate) for rate in (3, 8, 20, 60)]
    levels = [(PSNR, level) for level in (35, 60, 110)]
    return [(0, 0), *rates, (SIZE, values.size * 4 // 7 + 13), *levels, (MAX_ERROR, 0.02 * width),
            (MAX_ERROR, 1e-4 * width), (LOSSLESS, 0)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("volumes", nargs="+", type=pathlib.Path, metavar="FILE", help="NAME_XxYxZ_TYPE.raw")
    parser.add_argument("--library", type=pathlib.Path, default="libweir.so", help="default: libweir.so")
    options = parser.parse_args()
    devices = cupy.cuda.runtime.getDeviceCount()
    begun = time.perf_counter()
    compared = refused = different = 0
    with tempfile.TemporaryDirectory() as folder:
        weir = Weir(options.library.resolve(), pathlib.Path(folder))
        for path in options.volumes:
            for values in forms(read(path)):
                on_devices = []
                for device in range(devices):
                    with cupy.cuda.Device(device):
                        on_devices.append(cupy.asarray(values))
                for budget, preview in itertools.product(budgets(values), PREVIEWS):
                    expected = weir.by_cpu(values, budget, preview)
                    ways = [weir.by_device] + ([weir.as_slabs] if preview == "auto" else [])
                    for way, (device, array) in itertools.product(ways, enumerate(on_devices)):
                        with cupy.cuda.Device(device):
                            cupy.cuda.Device(device).synchronize()
                            found = way(array, budget, preview)
                        compared += 1
                        refused += found[0] != 0
                        if found != expected:
                            different += 1
                            print(f"{path}, {values.dtype}, {values.shape}: budget {budget}, preview {preview}, "
                                  f"{way.__name__}, device {device}: differs")
                print(f"{path.name}, {values.dtype}, {'x'.join(map(str, values.shape[::-1]))}: "
                      f"{compared} files compared, {different} differ, {time.perf_counter() - begun:.0f} s", flush=True)
    print(f"{devices} devices: {compared} files compared, {refused} of them refused, {different} differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
