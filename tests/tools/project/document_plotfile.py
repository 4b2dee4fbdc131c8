#!/usr/bin/env python3
"""Writes small AMReX plotfiles with two components on two levels to the given paths."""

import array
import itertools
import math
import os
import sys

CELLS, BOX, LEVELS = 64, 32, 2
NAMES = ("density", "Temp")
LAYOUT = "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))"


def box_text(lo, size):
    hi = tuple(i + size - 1 for i in lo)
    return "((%d,%d,%d) (%d,%d,%d) (0,0,0))" % (*lo, *hi)


def boxes(level):
    cells = CELLS << level
    places = [lo[::-1] for lo in itertools.product(range(0, cells, BOX), repeat=3)]
    return [lo for lo in places if level == 0 or all(cells // 4 <= i < cells * 3 // 4 for i in lo)]


def values(component, lo, level):
    cells = CELLS << level
    found = array.array("d")
    for z, y, x in itertools.product(*(range(i, i + BOX) for i in reversed(lo))):
        radius = math.dist(((x + 0.5) / cells, (y + 0.5) / cells, (z + 0.5) / cells), (0.5, 0.5, 0.5))
        found.append(math.exp(-8 * radius) * (100 if component else 1))
    if sys.byteorder == "big":
        found.byteswap()
    return found


def write(path):
    with open(os.path.join(path, "Header"), "w") as header:
        domains = " ".join(box_text((0, 0, 0), CELLS << level) for level in range(LEVELS))
        lines = ["HyperCLaw-V1.1", len(NAMES), *NAMES, 3, 0.5, LEVELS - 1, "0 0 0", "1 1 1", 2, domains, "7 7"]
        lines += ["%r %r %r" % (3 * (1 / (CELLS << level),)) for level in range(LEVELS)] + [0, 0]
        for level in range(LEVELS):
            lines += ["%d %d 0.5" % (level, len(boxes(level))), 7]
            for lo in boxes(level):
                lines += ["%r %r" % (i / (CELLS << level), (i + BOX) / (CELLS << level)) for i in lo]
            lines.append("Level_%d/Cell" % level)
        header.write("\n".join(map(str, lines)) + "\n")
    for level in range(LEVELS):
        folder = os.path.join(path, "Level_%d" % level)
        os.makedirs(folder)
        places, tables = [], ([], [])
        with open(os.path.join(folder, "Cell_D_00000"), "wb") as fabs:
            for lo in boxes(level):
                places.append("FabOnDisk: Cell_D_00000 %d" % fabs.tell())
                fabs.write(("FAB %s%s %d\n" % (LAYOUT, box_text(lo, BOX), len(NAMES))).encode())
                parts = [values(component, lo, level) for component in range(len(NAMES))]
                for part in parts:
                    fabs.write(part.tobytes())
                for table, end in zip(tables, (min, max)):
                    table.append("".join("%.17e," % end(part) for part in parts))
        with open(os.path.join(folder, "Cell_H"), "w") as cells:
            lines = [1, 1, len(NAMES), 0, "(%d 0" % len(places), *(box_text(lo, BOX) for lo in boxes(level)), ")"]
            lines += [len(places), *places, ""]
            for table in tables:
                lines += ["%d,%d" % (len(table), len(NAMES)), *table, ""]
            cells.write("\n".join(map(str, lines)) + "\n")


for name in sys.argv[1:]:
    os.makedirs(name)
    write(name)
