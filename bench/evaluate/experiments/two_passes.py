"""Leaves and packed blocks to a twentieth, beside two passes of plain reading, the file in the page cache."""

import volumes
from experiment import Experiment
from experiments.speed import threads_here, timed_conversion
from markdown import command, table

KINDS = ("cloud", "turbulence")
ENCODINGS = ("auto", "packed")
RATE = 20


class TwoPasses(Experiment):
    name = "two_passes"

    def measure(self, bench):
        edge = 128 if bench.quick else 512
        for kind in KINDS:
            for encoding in ENCODINGS:
                bench.store.measure(self.name, f"{kind}_{edge:04}_{encoding}", lambda kind=kind, encoding=encoding: {
                    "kind": kind, "edge": edge,
                    **timed_conversion(bench, volumes.cube(kind, edge), RATE, encoding, False, threads_here())})

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        lines = [[f"{row['kind']} {row['edge']}^3", row["encoding"], f"{row['read_twice_s']:.2f}",
                  f"{row['seconds']:.2f}", f"{row['seconds'] / row['read_twice_s']:.2f}", f"{row['survey_s']:.2f}",
                  f"{row['encode_s']:.2f}", f"{row['cpu_s']:.2f}", f"{row['dense_bytes'] / row['seconds'] / 1e9:.2f}"]
                 for row in self.rows(measured)]
        header = ["volume", "encoding", "reading twice: s", "conversion: s", "of reading twice", "survey: s", "encode: s",
                  "CPU s", "GB/s"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only two_passes --again      # on a machine that does nothing else",
            f"weir convert turbulence_512x512x512_float32.raw --rate {RATE} --encoding packed   # one figure")
