"""Keeps white noise to the last bit. Measures the largest overhead of a file beyond the values themselves."""

import volumes
from experiment import Experiment, method_options, remove_volume
from experiments.sizes import FRAME_BYTES, LEAF_BYTES, LOWER_BYTES, UPPER_BYTES, cells
from markdown import command, table, whole

BOUNDS = {"auto": 1.055, "packed": 1.01}  # limits as multiples of the dense bytes, without the fixed part
ROOT_ENTRY_BYTES = 32
BLIND_RECORD_BYTES = 288
PACKED_HEAD_BYTES = 96 + 32 * 120  # header and tables
REGION_BYTES = 16 + 1548  # a region's entry in the table, and its directory


def fixed_bytes(edge):
    """Returns the bytes that do not grow with the voxels: header, root, upper nodes, one lower node, macrocell
    record."""
    return FRAME_BYTES + (UPPER_BYTES + ROOT_ENTRY_BYTES) * cells((edge,) * 3, 4096) + LOWER_BYTES + BLIND_RECORD_BYTES


def packed_fixed_bytes(edge, preview):
    """Returns the same for a packed file: also its tables and one region's directory; with a preview, nodes and two
    leaves."""
    tree = UPPER_BYTES * cells((edge,) * 3, 4096) + LOWER_BYTES + 2 * LEAF_BYTES if preview else 0
    return (FRAME_BYTES + ROOT_ENTRY_BYTES * cells((edge,) * 3, 4096) + tree + 2 * BLIND_RECORD_BYTES
            + PACKED_HEAD_BYTES + REGION_BYTES)


def expected_bytes(edge):
    """Returns the bytes by the format's formula if all leaves of the cube are kept as float32."""
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
            for encoding in BOUNDS:
                bench.store.measure(self.name, f"noise_{edge:04}_{encoding}",
                                    lambda edge=edge, encoding=encoding: self._convert(bench, edge, encoding))

    @staticmethod
    def _convert(bench, edge, encoding):
        volume = volumes.cube("noise", edge)
        output = bench.scratch("noise.nvdb")
        with bench.files.file(volume) as path:
            made = bench.weir.report("convert", path, "-o", output, "--lossless", "--overwrite",
                                     *method_options(encoding))
        remove_volume(output)
        packed = encoding == "packed"
        fixed = packed_fixed_bytes(edge, made["packed"]["preview"]) if packed else fixed_bytes(edge)
        return {"edge": edge, "encoding": encoding, "dense_bytes": volume.dense_bytes, "bytes": made["file"]["bytes"],
                "lossless": made["error"]["lossless"], "fixed_bytes": fixed,
                "expected_bytes": None if packed else expected_bytes(edge),
                "bound_bytes": int(BOUNDS[encoding] * volume.dense_bytes) + fixed}

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        def more(bytes_, dense):
            return f"{100 * (bytes_ / dense - 1):+.2f} %"

        lines = [[f"{row['edge']}^3", row["encoding"], whole(row["dense_bytes"]), whole(row["bytes"]),
                  more(row["bytes"], row["dense_bytes"]), more(row["bytes"] - row["fixed_bytes"], row["dense_bytes"]),
                  whole(row["bound_bytes"])] for row in self.rows(measured)]
        header = ["noise", "encoding", "dense bytes", "lossless file", "against dense", "without the fixed part", "bound"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only worst_case",
            "weir sample noise -o noise_256x256x256_float32.raw",
            "weir convert noise_256x256x256_float32.raw --lossless --encoding packed")

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            name = f"{row['encoding']}, noise of {row['edge']}^3"
            if not row["lossless"]:
                broken.append(f"{name} is not lossless")
            if row["expected_bytes"] and row["bytes"] != row["expected_bytes"]:
                broken.append(f"{name} takes {row['bytes']} bytes, the format says {row['expected_bytes']}")
            if row["bytes"] > row["bound_bytes"]:
                broken.append(f"{name} takes {row['bytes']} bytes, the bound is {row['bound_bytes']}")
        return broken
