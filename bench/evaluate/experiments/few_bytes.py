"""PSNR at 1 to 20 % of dense: packed blocks beside leaves and both modes of ZFP, and how often they are ahead.

ZFP's fixed accuracy has one stream for each power of two. The largest that fits into the asked bytes, and not into those
of the share before, counts against a packed file of exactly as many bytes.
"""

import math
import shutil
import statistics

from experiment import Experiment, describe, remove_volume, size_text
from experiments.sizes import FRAME_BYTES, UPPER_BYTES
from experiments.worst_case import BLIND_RECORD_BYTES, ROOT_ENTRY_BYTES
from experiments.zfp import psnr, zfp_statistics
from markdown import command, decibel, percent, table
from programs import BUDGET_EXIT_CODE, ProgramFailed

SHARES = (1, 2, 5, 10, 20)  # percent of dense float32; each divides 100
METHODS = ("auto", "packed", "zfp")
RIVALS = {"auto": "auto", "zfp": "ZFP's fixed rate", "accuracy": "ZFP's fixed accuracy"}
NOTHING = {"bytes": None, "psnr_db": None, "lossless": False}
JUDGED_SHARE = 1 / 3  # the largest share of a file that its fixed part may have, for the file to be judged
MACROCELL_BYTES = 8
ACCURACY_BITS = 40  # bounds from the range down to what float32 has nothing to gain from


def fixed_bytes(inspected):
    """Returns the bytes of a packed file's header, root, upper nodes and macrocells, as `weir inspect` tells them."""
    tree = inspected["tree"]
    return (FRAME_BYTES + ROOT_ENTRY_BYTES * tree["root_entries"] + UPPER_BYTES * tree["upper"] + 2 * BLIND_RECORD_BYTES
            + MACROCELL_BYTES * math.prod(inspected["macrocells"]["dims"]))


def gap_db(ours, theirs):
    """Returns the dB by which ours is ahead: infinite if one alone is lossless or ours is missing; None without
    theirs."""
    if theirs["bytes"] is None:
        return None
    if ours["bytes"] is None:
        return -math.inf
    if ours["lossless"] or theirs["lossless"]:
        return 0 if ours["lossless"] == theirs["lossless"] else math.inf if ours["lossless"] else -math.inf
    return ours["psnr_db"] - theirs["psnr_db"]


def gaps(row):
    """Returns, for one share, by how many dB packed is ahead of each of RIVALS that has a figure."""
    found = {name: gap_db(row["packed_there" if name == "accuracy" else "packed"], row[name]) for name in RIVALS}
    return {name: gap for name, gap in found.items() if gap is not None}


def judged(row):
    return row["fixed_bytes"] is not None and row["fixed_bytes"] <= JUDGED_SHARE * row["packed"]["bytes"]


class FewBytes(Experiment):
    name = "few_bytes"

    def measure(self, bench):
        for volume in bench.few_bytes_volumes():
            bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._rows(bench, volume))

    def _rows(self, bench, volume):
        with bench.files.file(volume) as path:
            value_range, rows = self._sweep(bench, path)
            if shutil.which("zfp") is not None:
                with bench.files.float32_file(volume) as wide:
                    streams = self._accuracy_streams(wide, volume, value_range, rows[-1]["bytes_asked"])
                least = 0
                for row in rows:
                    fitting = [stream for stream in streams if least < stream["bytes"] <= row["bytes_asked"]]
                    if fitting:
                        row["accuracy"] = max(fitting, key=lambda stream: stream["bytes"])
                        row["packed_there"] = self._packed(bench, path, row["accuracy"]["bytes"])
                    least = row["bytes_asked"]
        return {**describe(volume), "dense_bytes": volume.dense_bytes, "rows": rows}

    @staticmethod
    def _sweep(bench, path):
        """The range of values, and a row for each share."""
        directory = bench.scratch("few_bytes")
        report = bench.weir.report("sweep", path, "-o", directory, "--overwrite", "--keep", "--methods",
                                   ",".join(METHODS), "--rates", ",".join(str(100 // share) for share in SHARES))
        by = {(row["method"], row["rate"]): row for row in report["rows"]}
        rows = []
        for share in SHARES:
            rate = 100 // share
            row = {"share": share, "bytes_asked": by[("packed", rate)]["bytes_asked"], "fixed_bytes": None,
                   "accuracy": NOTHING, "packed_there": NOTHING}
            for method in METHODS:
                got = by[(method, rate)]
                row[method] = {"bytes": got["bytes_got"], "psnr_db": got["psnr_db"], "lossless": got["lossless"]}
            if row["packed"]["bytes"]:
                inspected = bench.weir.inspect(directory / f"packed_rate{rate}.nvdb")
                row["fixed_bytes"] = fixed_bytes(inspected)
                lowest, highest = inspected["sidecar"]["value_range"]
            rows.append(row)
        shutil.rmtree(directory)
        return highest - lowest, rows

    @staticmethod
    def _accuracy_streams(path, volume, value_range, most_bytes):
        """Those of every power of two from the range down, until one has more bytes or no error."""
        streams = []
        highest = math.floor(math.log2(value_range))
        for exponent in range(highest, highest - ACCURACY_BITS, -1):
            bound = 2.0**exponent
            made = zfp_statistics(["-i", path, "-f", "-3", *volume.extent, "-a", repr(bound)])
            streams.append({"bytes": int(made["zfp"]), "psnr_db": psnr(value_range, made["rmse"]),
                            "lossless": made["rmse"] == 0, "bound": bound})
            if streams[-1]["bytes"] > most_bytes or streams[-1]["lossless"]:
                break
        return streams

    @staticmethod
    def _packed(bench, path, size):
        output = bench.scratch("few_bytes.nvdb")
        try:
            made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--size", size, "--encoding", "packed")
        except ProgramFailed as failure:
            if failure.code != BUDGET_EXIT_CODE:
                raise
            return NOTHING
        remove_volume(output)
        return {"bytes": made["file"]["bytes"], "psnr_db": made["error"]["psnr_db"],
                "lossless": made["error"]["lossless"]}

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), "share": row["share"],
                 "bytes_asked": row["bytes_asked"], "fixed_bytes": row["fixed_bytes"],
                 **{f"{name}_{key}": row[name][key] for name in (*METHODS, "accuracy", "packed_there")
                    for key in NOTHING}}
                for result in measured.results(self.name) for row in result["rows"]]

    def text(self, measured):
        results = measured.results(self.name)
        return "\n\n".join((self._ahead_table(results), self._left_out(results), self._table(results), command(
            "bench/evaluate.sh --only few_bytes",
            "weir sweep VOLUME.raw -o few --rates 100,50,20,10,5 --methods auto,packed,zfp      # one volume",
            "zfp -i VOLUME_float32.raw -f -3 X Y Z -a BOUND -s                                  # its fixed accuracy",
            "weir convert VOLUME.raw --size BYTES --encoding packed                             # packed there")))

    @staticmethod
    def _ahead_table(results):
        found = [(gaps(row), f"{result['volume']} at {row['share']} %")
                 for result in results for row in result["rows"] if judged(row)]
        points = {title: [(g[name], where) for g, where in found if name in g] for name, title in RIVALS.items()}
        both = [(min(g[name] for name in ("auto", "accuracy") if name in g), where) for g, where in found
                if "auto" in g or "accuracy" in g]
        points["the better of auto and ZFP's fixed accuracy"] = both
        lines = []
        for title, pairs in points.items():
            if pairs:
                least, where = min(pairs)
                lines.append([title, f"{sum(gap >= 0 for gap, _ in pairs)} of {len(pairs)}",
                              _gap_text(statistics.median(gap for gap, _ in pairs)), _gap_text(least), where])
        return table(["packed against", "at or above", "median, dB", "least, dB", "where"], lines)

    @staticmethod
    def _left_out(results):
        names = [f"{result['volume']} at {row['share']} %" for result in results for row in result["rows"]
                 if not judged(row)]
        return "The table above leaves out, because of their fixed part: " + (", ".join(names) or "none") + "."

    @staticmethod
    def _table(results):
        lines = []
        for result in results:
            for row in result["rows"]:
                fixed, there = row["fixed_bytes"], row["accuracy"]["bytes"]
                lines.append([f"{result['volume']}, {size_text(result['extent'])}" if row is result["rows"][0] else "",
                              f"{row['share']} %", percent(fixed, row["packed"]["bytes"]) if fixed else "-",
                              *(decibel(row[method]) for method in METHODS),
                              percent(there, result["dense_bytes"], 2) if there else "-",
                              decibel(row["accuracy"]), decibel(row["packed_there"])])
        header = ["PSNR in dB", "of dense", "fixed part of packed", "auto", "packed", "ZFP's rate",
                  "ZFP's accuracy, of dense", "dB", "packed there"]
        return table(header, lines)

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            for got, asked in (("packed_bytes", "bytes_asked"), ("packed_there_bytes", "accuracy_bytes")):
                if row[got] not in (None, row[asked]):
                    broken.append(f"{row['volume']} at {row['share']} %: {row[got]} bytes packed instead of {row[asked]}")
        return broken


def _gap_text(gap):
    if math.isfinite(gap):
        return f"{gap:+.1f}"
    return "lossless" if gap > 0 else "the other is lossless, or there is no file"
