"""The paper's three measures of what matters and ours, with both ways to fill what is dropped, as float leaves.

Packed blocks stand beside them: they are chosen by squared error alone, and none is dropped to the background.
"""

from experiment import Experiment, describe, remove_volume, size_text
from markdown import command, decibel, table
from programs import BUDGET_EXIT_CODE, ProgramFailed

METRICS = ("farthest", "closest", "median", "sse")
FILLS = ("background", "mean")
RATES = (8, 4)


class Metrics(Experiment):
    name = "metrics"

    def measure(self, bench):
        for volume in bench.volumes():
            bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._convert(bench, volume))

    def _convert(self, bench, volume):
        rows = []
        with bench.files.file(volume) as path:
            for rate in RATES:
                for metric in METRICS:
                    for fill in FILLS:
                        error = self._error(bench, path, rate, "float", "--metric", metric, "--fill", fill)
                        rows.append({"rate": rate, "encoding": "float", "metric": metric, "fill": fill, **error})
                error = self._error(bench, path, rate, "packed")
                rows.append({"rate": rate, "encoding": "packed", "metric": "sse", "fill": "mean", **error})
        return {**describe(volume), "rows": rows}

    @staticmethod
    def _error(bench, path, rate, encoding, *options):
        output = bench.scratch("metric.nvdb")
        try:
            made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--rate", rate, "--encoding",
                                     encoding, *options)
        except ProgramFailed as failure:
            if failure.code != BUDGET_EXIT_CODE:
                raise
            return {"nmse": None, "psnr_db": None, "max_abs": None, "lossless": False}
        remove_volume(output)
        return {key: made["error"][key] for key in ("nmse", "psnr_db", "max_abs", "lossless")}

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), **row}
                for result in measured.results(self.name) for row in result["rows"]]

    def text(self, measured):
        lines = []
        for result in measured.results(self.name):
            by = self._floats(result)
            packed = {row["rate"]: row for row in result["rows"] if row["encoding"] == "packed"}
            for rate in RATES:
                lines.append([f"{result['volume']}, {size_text(result['extent'])}" if rate == RATES[0] else "", f"1:{rate}",
                              *(decibel(by[(rate, metric, fill)]) for metric in METRICS for fill in FILLS),
                              decibel(packed[rate])])
        header = ["PSNR in dB", "rate", *(f"{metric}, {fill}" for metric in METRICS for fill in FILLS), "packed"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only metrics",
            "weir convert VOLUME.raw --rate 8 --encoding float --metric farthest --fill background   # one figure")

    @staticmethod
    def _floats(result):
        return {(row["rate"], row["metric"], row["fill"]): row for row in result["rows"] if row["encoding"] == "float"}

    def broken_promises(self, measured):
        broken = []
        for result in measured.results(self.name):
            by = self._floats(result)
            for (rate, metric, _), row in by.items():
                best = by[(rate, "sse", "mean")]
                if row["nmse"] is not None and best["nmse"] is not None and best["nmse"] > row["nmse"] * (1 + 1e-9):
                    broken.append(f"{result['volume']} at 1:{rate}: sse with means has an MSE of {best['nmse']}, "
                                  f"{metric} {row['nmse']}")
        return broken
