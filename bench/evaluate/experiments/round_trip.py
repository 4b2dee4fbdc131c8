"""The WDAS cloud there and back: OpenVDB to NanoVDB at several rates, and that file read as a source again."""

import filecmp
import shutil

from experiment import Experiment, remove_volume
from markdown import command, decibel, percent, scientific, table, whole
from programs import run

CLOUD = "wdas_cloud_sixteenth.vdb"
BUDGETS = (("--lossless",), ("--lossless", "--encoding", "float"), ("--rate", "2"), ("--rate", "4"), ("--rate", "8"),
           ("--rate", "4", "--preset", "paper"),
           *((*budget, "--encoding", "packed") for budget in (("--lossless",), ("--rate", "8"), ("--rate", "20"))))


class RoundTrip(Experiment):
    name = "round_trip"

    def measure(self, bench):
        source = bench.files.data_file(CLOUD)
        if source is None:
            return
        for budget in BUDGETS:
            bench.store.measure(self.name, f"weir {' '.join(budget)}",
                                lambda budget=budget: self._weir(bench, source, budget))
        if shutil.which("nanovdb_convert"):
            bench.store.measure(self.name, "stock", lambda: self._stock(bench, source))

    @staticmethod
    def _weir(bench, source, budget):
        there, back = bench.scratch("there.nvdb"), bench.scratch("back.nvdb")
        made = bench.weir.report("convert", source, "-o", there, "--overwrite", *budget)
        error = bench.weir.report("compare", source, there)
        # What was made, as a source: the same values in the same bytes, or something was lost on the way.
        bench.weir.run("convert", there, "-o", back, "--overwrite", "--lossless")
        again = bench.weir.report("compare", there, back)
        same = bench.weir.report("compare", source, back)
        result = {"converter": f"weir convert {' '.join(budget)}", "source_bytes": source.stat().st_size,
                  "dense_bytes": made["budget"]["dense_float32_bytes"], "bytes": there.stat().st_size,
                  "extent": made["grid"]["extent"], "index_bbox": made["grid"]["index_bbox"],
                  "psnr_db": error["psnr_db"], "max_abs": error["max_abs"], "lossless": error["lossless"],
                  "second_lossless": again["lossless"], "second_mse_same": same["mse"] == error["mse"],
                  "second_file_same": filecmp.cmp(there, back, shallow=False)}
        remove_volume(there)
        remove_volume(back)
        return result

    @staticmethod
    def _stock(bench, source):
        there = bench.scratch("stock.nvdb")
        run(["nanovdb_convert", "-f", source, there])
        error = bench.weir.report("compare", source, there)
        result = {"converter": "nanovdb_convert", "source_bytes": source.stat().st_size, "dense_bytes": None,
                  "bytes": there.stat().st_size, "extent": None, "index_bbox": None, "psnr_db": error["psnr_db"],
                  "max_abs": error["max_abs"], "lossless": error["lossless"], "second_lossless": None,
                  "second_mse_same": None, "second_file_same": None}
        remove_volume(there)
        return result

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        rows = self.rows(measured)
        dense = next((row["dense_bytes"] for row in rows if row["dense_bytes"]), None)
        lines = [[row["converter"], whole(row["bytes"]), percent(row["bytes"], dense) if dense else "-", decibel(row),
                  scientific(row["max_abs"]),
                  {True: "the same values", False: "other values", None: ""}[row["second_mse_same"]]]
                 for row in sorted(rows, key=lambda row: -row["bytes"])]
        header = ["wdas_cloud_sixteenth.vdb by", "bytes", "of dense", "dB", "largest error", "converted again"]
        return table(header, lines) + "\n\n" + command(
            "bench/evaluate.sh --only round_trip",
            f"weir convert {CLOUD} -o there.nvdb --rate 8 && weir compare {CLOUD} there.nvdb",
            "weir convert there.nvdb -o back.nvdb --lossless && weir compare there.nvdb back.nvdb")

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            if "--lossless" in row["converter"] and not row["lossless"]:
                broken.append(f"{row['converter']} is not lossless")
            if row["second_lossless"] is False:
                broken.append(f"{row['converter']}: its file converted with --lossless has other values")
        return broken
