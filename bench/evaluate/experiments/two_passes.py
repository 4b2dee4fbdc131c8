"""Conversions beside two passes of plain reading, the file in the page cache of a disk and in a memory file system, whose
pages are small and slower to read."""

import os
import pathlib
import shutil
import tempfile

import volumes
from experiment import Experiment
from experiments.speed import ROUNDS, threads_here, timed_file
from markdown import command, table

CASES = (("cloud", "auto", 20), ("cloud", "packed", 20), ("turbulence", "auto", 20), ("turbulence", "packed", 20),
         ("turbulence", "fpn", 8))
MEMORY = pathlib.Path("/dev/shm")
PARTS = {8: "an eighth", 20: "a twentieth"}  # by rate
PLACES = {"disk": "disk, cached", "memory": "memory"}


def holds(directory, size):
    return os.access(directory, os.W_OK) and shutil.disk_usage(directory).free > 2 * size


class TwoPasses(Experiment):
    name = "two_passes"

    def measure(self, bench):
        edge = 128 if bench.quick else 512
        for kind, encoding, rate in CASES:
            volume = volumes.cube(kind, edge)
            for place in PLACES:
                if place == "memory" and not holds(MEMORY, volume.dense_bytes):
                    continue  # the table has the disk's rows alone
                bench.store.measure(self.name, f"{kind}_{edge:04}_{encoding}_{rate}_{place}",
                                    lambda volume=volume, case=(kind, encoding, rate), place=place: {
                                        "kind": case[0], "edge": edge, "place": place, "dense_bytes": volume.dense_bytes,
                                        **self._timed(bench, volume, case[1], case[2], place)})

    @staticmethod
    def _timed(bench, volume, encoding, rate, place):
        with bench.files.file(volume) as path:
            if place == "disk":
                return timed_file(bench, path, bench.scratch("timed.nvdb"), rate, encoding, False, threads_here(), ROUNDS)
            with tempfile.TemporaryDirectory(prefix="weir_", dir=MEMORY) as directory:
                copy = pathlib.Path(directory) / path.name
                shutil.copyfile(path, copy)
                return timed_file(bench, copy, copy.with_suffix(".nvdb"), rate, encoding, False, threads_here(), ROUNDS)

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        lines = [[PLACES[row["place"]], f"{row['kind']} {row['edge']}^3, {PARTS[row['rate']]}", row["encoding"],
                  f"{row['read_twice_s']:.2f}", f"{row['seconds']:.2f}", f"{row['seconds'] / row['read_twice_s']:.2f}",
                  f"{row['survey_s']:.2f}", f"{row['encode_s']:.2f}", f"{row['cpu_s']:.2f}",
                  f"{row['dense_bytes'] / row['seconds'] / 1e9:.2f}"]
                 for row in sorted(self.rows(measured), key=lambda row: list(PLACES).index(row["place"]))]
        header = ["file in", "volume", "encoding", "reading twice: s", "conversion: s", "times reading twice", "survey: s",
                  "encode: s", "CPU s", "GB/s"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only two_passes --again      # on a machine that does nothing else",
            "weir convert turbulence_512x512x512_float32.raw --rate 20 --encoding packed   # one figure")
