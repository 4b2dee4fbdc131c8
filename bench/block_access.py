#!/usr/bin/env python3
"""What parts of a converted volume cost to read: time, and bytes from the disk, out of the page cache and into it.

    PYTHONPATH=build/release/python python3 bench/block_access.py FILE.nvdb...

For each file a Markdown table: opening it, and then one block of 8^3, a region of 64^3 or a level of detail of the whole,
with the file dropped from the page cache before it is opened (cold) and just read (warm, the best of three). Bytes are
those that the kernel read from the disk for this process, its read-ahead included, which a mapped file has when it is
opened. Median and worst of positions that are spread over the parts of the volume that hold more than one value, the same at
each run.
"""

import argparse
import os
import random
import sys
import time

import numpy
import weir

READINGS = 20


def drop(path):
    """Drops a file from the page cache."""
    with open(path, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def disk_bytes():
    """Returns how many bytes this process has read from the disk so far."""
    with open("/proc/self/io", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("read_bytes"))


def timed(action):
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


def corners(grid, edge):
    """Returns low corners (z, y, x) of regions of `edge` voxels that have whole blocks and more than one value."""
    numbers = random.Random(1)
    found = []
    for _ in range(500 * READINGS):
        corner = [8 * numbers.randrange(max(1, (n - edge) // 8 + 1)) for n in grid.shape]
        values = region(grid, corner, edge)
        if values.min() < values.max():
            found.append(corner)
            if len(found) == READINGS:
                return found
    sys.exit(f"{grid.path}: too few places of {edge}^3 voxels hold more than one value")


def region(grid, corner, edge):
    z, y, x = corner
    return grid.to_numpy(numpy.s_[z:z + edge, y:y + edge, x:x + edge])


def once_cold(path, action):
    """Drops a file from the page cache. Returns seconds and bytes of opening the file, and of the action after
    that."""
    drop(path)
    before = disk_bytes()
    start = time.perf_counter()
    with weir.open(path) as grid:
        opened = time.perf_counter()
        opened_bytes = disk_bytes()
        action(grid)
        return opened - start, time.perf_counter() - opened, opened_bytes - before, disk_bytes() - opened_bytes


def warm(grid, action):
    action(grid)
    return min(timed(lambda: action(grid)) for _ in range(3))


def measure_file(path):
    with weir.open(path) as grid:
        shape, levels = grid.shape, grid.levels
        level = min(3, levels - 1)
        rows = [(name, [lambda grid, at=at, edge=edge: region(grid, at, edge) for at in corners(grid, edge)])
                for name, edge in (("a block of 8^3", 8), ("a region of 64^3", 64))]
    rows.append((f"level {level} of all", [lambda grid: grid.to_numpy(level=level)]))
    print(f"`{os.path.basename(path)}`, {' x '.join(str(n) for n in reversed(shape))}, {os.path.getsize(path)} bytes:\n")
    print("| | cold: ms | worst | cold: bytes read | worst | warm: ms | worst |\n|---|---|---|---|---|---|---|")
    opening = None
    for name, actions in rows:
        cold = numpy.array([once_cold(path, action) for action in actions])
        figures, worst = numpy.median(cold, axis=0), cold.max(axis=0)
        with weir.open(path) as grid:
            cached = [warm(grid, action) for action in actions]
            if opening is None:
                opening = timed(lambda: weir.open(path).close())
                print(f"| opening | {figures[0] * 1e3:.2f} | {worst[0] * 1e3:.2f} | {figures[2]:.0f} | {worst[2]:.0f} | "
                      f"{opening * 1e3:.3f} | |")
        print(f"| {name} | {figures[1] * 1e3:.2f} | {worst[1] * 1e3:.2f} | {figures[3]:.0f} | {worst[3]:.0f} | "
              f"{numpy.median(cached) * 1e3:.3f} | {max(cached) * 1e3:.3f} |", flush=True)
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", help="converted volumes")
    for path in parser.parse_args().files:
        measure_file(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
