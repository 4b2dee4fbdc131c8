#!/usr/bin/env python3
"""Time and memory of converting a plotfile of AMReX of three levels, beside reading its bytes once from a cold disk:

    bench/amrex_levels.py --weir build/release/weir build/amrex

Writes DIRECTORY/plt00001, as many cells on each level, the finer ones in the middle, and converts it to one file and to
one for each level, beside it. With --wide it is DIRECTORY/plt00002, whose finest level has a quarter of the volume, and the
one before 42 %: seven times as many bytes of the same grid. The files are put out of the page cache before each is timed
(posix_fadvise).
"""
import argparse
import itertools
import os
import pathlib
import subprocess
import time

import numpy

LEVELS, BOX = 3, 128
LAYOUT = "((8, (32 8 23 0 1 9 0 127)),(4, (4 3 2 1)))"


def box_text(lo, size):
    return "((%d,%d,%d) (%d,%d,%d) (0,0,0))" % (*lo, *(i + size - 1 for i in lo))


def corners(cells, level, wide):
    """Of the boxes of a level, in the middle of its domain: `cells` along each axis, or where `wide` 3/4 of the domain's
    on level 1 and 5/8 on level 2."""
    along = cells // BOX * ((8, 12, 20)[level] if wide else 8) // 8
    first = ((cells << level) - along * BOX) // 2
    return [tuple(first + i * BOX for i in reversed(place)) for place in itertools.product(range(along), repeat=3)]


def values(lo, cells, level):
    """Shells around the middle, finer where they are nearer, as (z, y, x)."""
    x, y, z = ((numpy.arange(i, i + BOX, dtype=numpy.float32) + 0.5) / (cells << level) - 0.5 for i in lo)
    radius = numpy.sqrt(z[:, None, None] ** 2 + y[None, :, None] ** 2 + x[None, None, :] ** 2)
    wave = numpy.sin(40 * x)[None, None, :] * numpy.sin(40 * y)[None, :, None] * numpy.sin(40 * z)[:, None, None]
    return (numpy.exp(-6 * radius) * (1 + 0.5 * numpy.sin(12 / (radius + 0.05)) + 0.3 * wave)).astype("<f4")


def write(path, cells, wide):
    path.mkdir(parents=True)
    domains = " ".join(box_text((0, 0, 0), cells << level) for level in range(LEVELS))
    header = ["HyperCLaw-V1.1", 1, "density", 3, 0.5, LEVELS - 1, "0 0 0", "1 1 1", "2 2", domains, "7 7 7"]
    header += ["%r %r %r" % (3 * (1 / (cells << level),)) for level in range(LEVELS)] + [0, 0]
    for level in range(LEVELS):
        boxes = corners(cells, level, wide)
        header += ["%d %d 0.5" % (level, len(boxes)), 7]
        for lo in boxes:
            header += ["%r %r" % (i / (cells << level), (i + BOX) / (cells << level)) for i in lo]
        header.append("Level_%d/Cell" % level)
        folder = path / ("Level_%d" % level)
        folder.mkdir()
        places, least, most = [], [], []
        with open(folder / "Cell_D_00000", "wb") as fabs:
            for lo in boxes:
                places.append("FabOnDisk: Cell_D_00000 %d" % fabs.tell())
                part = values(lo, cells, level)
                fabs.write(("FAB %s%s 1\n" % (LAYOUT, box_text(lo, BOX))).encode() + part.tobytes())
                least.append("%.17e," % part.min())
                most.append("%.17e," % part.max())
        lines = [1, 1, 1, 0, "(%d 0" % len(boxes), *(box_text(lo, BOX) for lo in boxes), ")", len(places), *places, ""]
        for table in (least, most):
            lines += ["%d,1" % len(table), *table, ""]
        (folder / "Cell_H").write_text("\n".join(map(str, lines)) + "\n")
    (path / "Header").write_text("\n".join(map(str, header)) + "\n")


def drop_from_cache(files):
    for file in files:
        with open(file, "rb") as opened:
            os.fsync(opened.fileno())
            os.posix_fadvise(opened.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def read_once(files):
    buffer = bytearray(4 << 20)
    begun = time.perf_counter()
    for file in files:
        with open(file, "rb", buffering=0) as opened:
            while opened.readinto(buffer):
                pass
    return time.perf_counter() - begun


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path, help="where the plotfile is written, and kept for another run")
    parser.add_argument("--weir", default="weir", help="the command; default: weir")
    parser.add_argument("--cells", type=int, default=512, help=f"of level 0 along each axis, a multiple of {4 * BOX}; "
                        "the finest level has 4 times as many; default: 512")
    parser.add_argument("--rate", type=float, default=32, help="of each file; default: 32")
    parser.add_argument("--wide", action="store_true", help="finer levels have more of the volume")
    options = parser.parse_args()
    plotfile = options.directory / ("plt00002" if options.wide else "plt00001")
    if not plotfile.exists():
        write(plotfile, options.cells, options.wide)
    files = sorted(file for file in plotfile.rglob("*") if file.is_file())
    size = sum(file.stat().st_size for file in files)
    drop_from_cache(files)
    reading = read_once(files)
    voxels = options.cells << (LEVELS - 1)
    print(f"{size / 2**20:.0f} MiB on {LEVELS} levels, {voxels}^3 voxels as one grid: read once in {reading:.2f} s")
    for levels in ("composite", "separate"):
        drop_from_cache(files)
        begun = time.perf_counter()
        process = subprocess.Popen([options.weir, "convert", plotfile, "--dataset", "density", "--levels", levels,
                                    "--rate", str(options.rate), "--memory", "512MiB", "-q", "--overwrite", "-o",
                                    options.directory / (plotfile.name + ".nvdb")])
        _, status, usage = os.wait4(process.pid, 0)
        converting = time.perf_counter() - begun
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise SystemExit(f"weir convert --levels {levels} failed")
        print(f"--levels {levels}: converted in {converting:.2f} s, {converting / reading:.1f} times as long, "
              f"{usage.ru_utime + usage.ru_stime:.2f} s of processors, peak memory {usage.ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
