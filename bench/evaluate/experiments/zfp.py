"""ZFP: at equal bytes in its fixed-rate mode, and in its fixed-accuracy mode against --max-error.

The fixed rates are those that `weir sweep` measured for the tables of errors. The accuracies are by the `zfp` command
of libzfp's authors, which holds the whole volume in memory.
"""

import math
import re
import shutil
import sys

from experiment import Experiment, describe, method_options, remove_volume, size_text
from experiments.errors import SHARES
from markdown import command, decibel, percent, scientific, table
from programs import run

ENCODINGS = ("auto", "packed")
METHODS = (*ENCODINGS, "zfp")
ERROR_KEYS = ("max_abs", "psnr_db", "lossless")
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)  # of the value range
MOST_BYTES = 2 << 30  # dense; the command holds the volume three times


def zfp_statistics(arguments):
    """Returns the figures that `zfp -s` prints, by name: zfp (bytes), rmse, maxe and others."""
    printed = run(["zfp", *arguments, "-s"]).err
    return {key: float(value) for key, value in re.findall(r"(\w+)=([-+.\w]+)", printed) if value[0].isdigit()}


class Zfp(Experiment):
    name = "zfp"

    def measure(self, bench):
        if shutil.which("zfp") is None:
            print("zfp: skipped, the command zfp (Debian's package of that name) is missing", file=sys.stderr)
            return
        for volume in bench.volumes():
            if volume.dense_bytes <= MOST_BYTES:
                bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._bounds(bench, volume))

    def _bounds(self, bench, volume):
        output = bench.scratch("bound.nvdb")
        rows = []
        with bench.files.file(volume) as path, bench.files.float32_file(volume) as wide:
            value_range = self._range(bench, path, output)
            for tolerance in TOLERANCES:
                bound = tolerance * value_range
                row = {"tolerance": tolerance, "bound": bound}
                for encoding in ENCODINGS:
                    made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--max-error", repr(bound),
                                             *method_options(encoding))
                    row[f"{encoding}_bytes"] = made["file"]["bytes"]
                    row.update({f"{encoding}_{key}": made["error"][key] for key in ERROR_KEYS})
                theirs = zfp_statistics(["-i", wide, "-f", "-3", *volume.extent, "-a", repr(bound)])
                row.update(zfp_bytes=int(theirs["zfp"]), zfp_max_abs=theirs["maxe"],
                           zfp_psnr_db=psnr(value_range, theirs["rmse"]), zfp_lossless=theirs["rmse"] == 0)
                rows.append(row)
        remove_volume(output)
        return {**describe(volume), "dense_bytes": volume.dense_bytes, "value_range": value_range, "rows": rows}

    @staticmethod
    def _range(bench, path, output):
        made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--rate", "1")
        return made["value_range"][1] - made["value_range"][0]

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), **row}
                for result in measured.results(self.name) for row in result["rows"]]

    def text(self, measured):
        return self._rates_text(measured) + "\n\n" + self._bounds_text(measured)

    @staticmethod
    def _rates_text(measured):
        lines = []
        for result in measured.results("errors"):
            by = {(row["method"], row["share"]): row for row in result["rows"]}
            for encoding in ENCODINGS:
                lines.append([result["volume"] if encoding == ENCODINGS[0] else "", encoding,
                              *(_ahead(by[(encoding, share)], by[("zfp", share)]) for share in SHARES)])
        header = ["ours - ZFP, dB", "ours", *(f"{share} %" for share in SHARES)]
        return table(header, lines) + "\n\n" + command("bench/evaluate.sh --only errors")

    def _bounds_text(self, measured):
        lines = []
        for result in measured.results(self.name):
            for row in result["rows"]:
                lines.append([result["volume"] if row is result["rows"][0] else "", f"{row['tolerance']:g}",
                              *(percent(row[f"{method}_bytes"], result["dense_bytes"]) for method in METHODS),
                              *(scientific(row[f"{method}_max_abs"] / result["value_range"]) for method in METHODS),
                              *(decibel({key: row[f"{method}_{key}"] for key in ERROR_KEYS}) for method in METHODS)])
        header = ["volume", "bound / range", "bytes: auto", "packed", "ZFP", "largest error: auto", "packed", "ZFP",
                  "dB: auto", "packed", "ZFP"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only zfp",
            "weir convert VOLUME.raw --max-error BOUND --encoding packed        # one line of it",
            "zfp -i VOLUME_float32.raw -f -3 X Y Z -a BOUND -s")

    def broken_promises(self, measured):
        return [f"{row['volume']}, {encoding}: an error of {row[f'{encoding}_max_abs']} with --max-error {row['bound']}"
                for row in self.rows(measured) for encoding in ENCODINGS if row[f"{encoding}_max_abs"] > row["bound"]]


def _ahead(ours, theirs):
    """Returns the difference in dB as text. Two lossless results have no difference."""
    if not ours["bytes_got"] or not theirs["bytes_got"]:
        return "-"
    if ours["lossless"]:
        return "both lossless" if theirs["lossless"] else f"lossless / {decibel(theirs)}"
    return f"{decibel(ours)} / lossless" if theirs["lossless"] else f"{ours['psnr_db'] - theirs['psnr_db']:+.1f}"


def psnr(value_range, rmse):
    """Returns the PSNR in dB. `zfp -s` itself prints 6 dB less, because it uses half the range."""
    return 20 * math.log10(value_range / rmse) if rmse > 0 else None
