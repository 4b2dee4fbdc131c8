"""Actual size against the asked one, of leaves, of packed blocks and of the paper's preset."""

from experiment import Experiment, describe, size_text
from markdown import command, percent, table, whole

RATES = (8, 4, 2, 1)
METHODS = ("auto", "packed", "paper")
LEAF_BYTES = 2144
UPPER_BYTES = 270400
LOWER_BYTES = 33856
FRAME_BYTES = 4096 + 800  # file header, GridData, TreeData, RootData


def cells(extent, edge):
    """Cubes of `edge` voxels that cover the extent."""
    count = 1
    for voxels in extent:
        count *= -(-voxels // edge)
    return count


def share_of_blocks_bytes(extent, rate):
    """Bytes of a float tree in which every `rate`-th 8^3 block is a leaf: what a rate means where it counts blocks."""
    leaves = -(-cells(extent, 8) // rate)
    return (FRAME_BYTES + (UPPER_BYTES + 32) * cells(extent, 4096) + LOWER_BYTES * cells(extent, 128)
            + LEAF_BYTES * leaves)


class Sizes(Experiment):
    name = "sizes"

    def measure(self, bench):
        for volume in bench.volumes():
            bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._sweep(bench, volume))

    def _sweep(self, bench, volume):
        rates = ",".join(str(rate) for rate in RATES)
        with bench.files.file(volume) as path:
            report = bench.weir.report("sweep", path, "-o", bench.scratch("sizes"), "--overwrite", "--rates", rates,
                                       "--methods", ",".join(METHODS))
        keys = ("method", "rate", "bytes_asked", "bytes_got", "note")
        return {**describe(volume), "rows": [{key: row.get(key) for key in keys} for row in report["rows"]]}

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), **row,
                 "bytes_share_of_blocks": share_of_blocks_bytes(result["extent"], int(row["rate"]))}
                for result in measured.results(self.name) for row in result["rows"]]

    def text(self, measured):
        lines = []
        for result in measured.results(self.name):
            by = {(row["method"], row["rate"]): row for row in result["rows"]}
            for rate in RATES:
                asked = by[("auto", rate)]["bytes_asked"]
                got = [whole(row["bytes_got"]) if row["bytes_got"] else "-"
                       for row in (by[(method, rate)] for method in METHODS)]
                counted = share_of_blocks_bytes(result["extent"], rate)
                lines.append([f"{result['volume']}, {size_text(result['extent'])}" if rate == RATES[0] else "",
                              f"1:{rate}", whole(asked), *got, percent(counted, asked)])
        header = ["volume", "rate", "bytes asked", "got, auto", "got, packed", "got, paper's preset",
                  "counted in blocks"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only sizes",
            "weir sweep VOLUME.raw -o sizes --rates 8,4,2,1 --methods auto,packed,paper       # one volume of it")

    def broken_promises(self, measured):
        return [f"{row['volume']}, {row['method']} at 1:{row['rate']:g}: {row['bytes_got']} bytes instead of "
                f"{row['bytes_asked']}"
                for row in self.rows(measured) if row["bytes_got"] not in (None, row["bytes_asked"])]
