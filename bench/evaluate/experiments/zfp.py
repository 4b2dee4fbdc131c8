"""ZFP: at equal bytes in its fixed-rate mode, and in its fixed-accuracy mode against --max-error.

The fixed rates are those that `weir sweep` measured for the tables of errors. The accuracies are by the `zfp` command
of libzfp's authors, which holds the whole volume in memory.
"""

import math
import re
import shutil
import sys

from experiment import Experiment, describe, remove_volume, size_text
from experiments.errors import SHARES
from markdown import command, decibel, percent, scientific, table
from programs import run

TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)  # of the value range
MOST_BYTES = 2 << 30  # dense; the command holds the volume three times


def zfp_statistics(arguments):
    """The figures that `zfp -s` prints, by their names: zfp (bytes), rmse, maxe and others."""
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
                made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--max-error", repr(bound))
                theirs = zfp_statistics(["-i", wide, "-f", "-3", *volume.extent, "-a", repr(bound)])
                rows.append({"tolerance": tolerance, "bound": bound,
                             "weir_bytes": made["file"]["bytes"], "weir_max_abs": made["error"]["max_abs"],
                             "weir_psnr_db": made["error"]["psnr_db"], "weir_lossless": made["error"]["lossless"],
                             "zfp_bytes": int(theirs["zfp"]), "zfp_max_abs": theirs["maxe"],
                             "zfp_psnr_db": psnr(value_range, theirs["rmse"]), "zfp_lossless": theirs["rmse"] == 0})
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
            line = [result["volume"]]
            for share in SHARES:
                ours, theirs = by[("auto", share)], by[("zfp", share)]
                if not ours["bytes_got"] or not theirs["bytes_got"]:
                    line.append("-")
                elif ours["lossless"]:
                    line.append("both lossless" if theirs["lossless"] else f"lossless / {decibel(theirs)}")
                else:
                    line.append("-" if theirs["lossless"] else f"{ours['psnr_db'] - theirs['psnr_db']:+.1f}")
            lines.append(line)
        header = ["auto - ZFP, dB", *(f"{share} %" for share in SHARES)]
        return table(header, lines) + "\n\n" + command("bench/evaluate.sh --only errors")

    def _bounds_text(self, measured):
        lines = []
        for result in measured.results(self.name):
            for row in result["rows"]:
                ours = {"lossless": row["weir_lossless"], "psnr_db": row["weir_psnr_db"]}
                theirs = {"lossless": row["zfp_lossless"], "psnr_db": row["zfp_psnr_db"]}
                lines.append([result["volume"] if row is result["rows"][0] else "", f"{row['tolerance']:g}",
                              percent(row["weir_bytes"], result["dense_bytes"]),
                              percent(row["zfp_bytes"], result["dense_bytes"]),
                              scientific(row["weir_max_abs"] / result["value_range"]),
                              scientific(row["zfp_max_abs"] / result["value_range"]), decibel(ours), decibel(theirs)])
        header = ["volume", "bound / range", "bytes: weir", "ZFP", "largest error: weir", "ZFP", "dB: weir", "ZFP"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only zfp",
            "weir convert VOLUME.raw --max-error BOUND        # one line of it",
            "zfp -i VOLUME_float32.raw -f -3 X Y Z -a BOUND -s")

    def broken_promises(self, measured):
        return [f"{row['volume']}: an error of {row['weir_max_abs']} with --max-error {row['bound']}"
                for row in self.rows(measured) if row["weir_max_abs"] > row["bound"]]


def psnr(value_range, rmse):
    """dB; `zfp -s` itself prints 6 dB less, from half the range."""
    return 20 * math.log10(value_range / rmse) if rmse > 0 else None
