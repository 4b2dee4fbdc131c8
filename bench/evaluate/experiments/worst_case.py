"""White noise kept to the last bit: the most that a file takes besides the values themselves."""

import volumes
from experiment import Experiment, remove_volume
from experiments.sizes import FRAME_BYTES, LEAF_BYTES, LOWER_BYTES, UPPER_BYTES, cells
from markdown import command, table, whole

BOUND = 1.055  # of the dense bytes, besides the fixed part
BLIND_RECORD_BYTES = 288


def fixed_bytes(edge):
    """What does not grow with the voxels: header, root, upper nodes, one lower node, the macrocells' record."""
    return FRAME_BYTES + (UPPER_BYTES + 32) * cells((edge,) * 3, 4096) + LOWER_BYTES + BLIND_RECORD_BYTES


def expected_bytes(edge):
    """By the format's formula, all of the cube's leaves kept as float32."""
    extent = (edge, edge, edge)
    macrocells = -(-8 * cells(extent, 16) // 32) * 32
    return (fixed_bytes(edge) + LOWER_BYTES * (cells(extent, 128) - 1) + LEAF_BYTES * cells(extent, 8) + macrocells)


class WorstCase(Experiment):
    name = "worst_case"

    def measure(self, bench):
        edges = (32, 64) if bench.quick else (32, 64, 128, 256, 512, 1024)
        for edge in edges:
            if not bench.files.available(volumes.cube("noise", edge)):
                continue
            bench.store.measure(self.name, f"noise_{edge:04}", lambda edge=edge: self._convert(bench, edge))

    def _convert(self, bench, edge):
        volume = volumes.cube("noise", edge)
        output = bench.scratch("noise.nvdb")
        with bench.files.file(volume) as path:
            made = bench.weir.report("convert", path, "-o", output, "--lossless", "--overwrite")
        remove_volume(output)
        bound = int(BOUND * volume.dense_bytes) + fixed_bytes(edge)
        return {"edge": edge, "dense_bytes": volume.dense_bytes, "bytes": made["file"]["bytes"],
                "lossless": made["error"]["lossless"], "fixed_bytes": fixed_bytes(edge),
                "expected_bytes": expected_bytes(edge), "bound_bytes": bound}

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        def more(bytes_, dense):
            return f"+{100 * (bytes_ / dense - 1):.2f} %"

        lines = [[f"{row['edge']}^3", whole(row["dense_bytes"]), whole(row["bytes"]),
                  more(row["bytes"], row["dense_bytes"]), more(row["bytes"] - row["fixed_bytes"], row["dense_bytes"]),
                  whole(row["bound_bytes"])] for row in self.rows(measured)]
        header = ["noise", "dense bytes", "lossless file", "against dense", "without the fixed part", "bound"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only worst_case",
            "weir sample noise -o noise_256x256x256_float32.raw",
            "weir convert noise_256x256x256_float32.raw --lossless")

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            if not row["lossless"]:
                broken.append(f"noise of {row['edge']}^3 is not lossless")
            if row["bytes"] != row["expected_bytes"]:
                broken.append(f"noise of {row['edge']}^3 takes {row['bytes']} bytes, the format says "
                              f"{row['expected_bytes']}")
            if row["bytes"] > row["bound_bytes"]:
                broken.append(f"noise of {row['edge']}^3 takes {row['bytes']} bytes, the bound is {row['bound_bytes']}")
        return broken
