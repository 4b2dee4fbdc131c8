"""Compares the smallest lossless files: leaves, packed blocks, and the whole raw file compressed by xz."""

import lzma

import volumes
from experiment import Experiment, describe, method_options, remove_volume, size_text
from markdown import command, percent, table, whole

ENCODINGS = ("auto", "packed")
XZ_PRESET = 9
READ_BYTES = 8 << 20


def xz_bytes(path):
    """Returns the bytes that `xz -9` makes of a file."""
    compressor = lzma.LZMACompressor(preset=XZ_PRESET)
    total = 0
    with open(path, "rb") as file:
        while block := file.read(READ_BYTES):
            total += len(compressor.compress(block))
    return total + len(compressor.flush())


class Lossless(Experiment):
    name = "lossless"

    def measure(self, bench):
        for volume in volumes.small_integer_set() if bench.quick else volumes.integer_set():
            if bench.files.available(volume):
                bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._convert(bench, volume))

    @staticmethod
    def _convert(bench, volume):
        output = bench.scratch("lossless.nvdb")
        result = {**describe(volume), "dense_bytes": volume.dense_bytes}
        with bench.files.file(volume) as path:
            for encoding in ENCODINGS:
                made = bench.weir.report("convert", path, "-o", output, "--lossless", "--overwrite",
                                         *method_options(encoding))
                result[f"{encoding}_bytes"] = made["file"]["bytes"]
                result[f"{encoding}_lossless"] = made["error"]["lossless"]
            result["xz_bytes"] = xz_bytes(path)
        remove_volume(output)
        return result

    def rows(self, measured):
        return [{**result, "extent": size_text(result["extent"])} for result in measured.results(self.name)]

    def text(self, measured):
        lines = [[f"{row['volume']}, {row['extent']}, {row['type']}", whole(row["dense_bytes"]),
                  *(percent(row[f"{method}_bytes"], row["dense_bytes"], 2) for method in (*ENCODINGS, "xz"))]
                 for row in self.rows(measured)]
        return table(["volume", "dense bytes", "auto", "packed", "xz -9"], lines) + "\n\n" + command(
            "bench/evaluate.sh --only lossless",
            "weir convert VOLUME.raw --lossless --encoding packed        # one figure",
            "xz -9 --stdout VOLUME.raw | wc --bytes                      # the last column")

    def broken_promises(self, measured):
        return [f"{row['volume']}: {encoding} is not lossless" for row in self.rows(measured) for encoding in ENCODINGS
                if not row[f"{encoding}_lossless"]]
