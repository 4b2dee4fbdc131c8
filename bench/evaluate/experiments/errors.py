"""Error at 10 to 100 % of the dense size: the paper's preset, float leaves by squared error, auto, packed, ZFP."""

import pathlib

from experiment import Experiment, describe, remove_volume, size_text
from markdown import command, decibel, percent, scientific, table

SHARES = (10, 20, 30, 40, 50, 60, 70, 80, 90, 100)  # percent of dense float32
METHODS = ("paper", "float", "auto", "packed", "zfp")
ENCODINGS = ("float", "auto", "packed")  # weir's encodings that select by squared error
PREVIEW_STEPS = {"packed": 1}  # how often more bytes may give more error: once, at the size that adds the preview
ERROR_KEYS = ("mse", "nmse", "psnr_db", "max_abs", "lossless")


class Errors(Experiment):
    name = "errors"

    def measure(self, bench):
        for volume in bench.volumes():
            bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._sweep(bench, volume))

    def _sweep(self, bench, volume):
        sweep = pathlib.Path(volume.file_name).stem
        directory = bench.directory / "sweeps" / sweep
        directory.parent.mkdir(parents=True, exist_ok=True)
        with bench.files.file(volume) as path:
            report = bench.weir.report("sweep", path, "-o", directory, "--overwrite", "--methods", ",".join(METHODS),
                                       "--rates", ",".join(repr(100 / share) for share in SHARES))
            lossless = {encoding: self._lossless(bench, path, encoding) for encoding in ENCODINGS}
        shares = {repr(100 / share): share for share in SHARES}
        keys = ("method", "bytes_asked", "bytes_got", "encoding", "seconds", "note", *ERROR_KEYS)
        rows = [{"share": shares[repr(row["rate"])], **{key: row.get(key) for key in keys}} for row in report["rows"]]
        return {**describe(volume), "dense_bytes": volume.dense_bytes, "rows": rows, "lossless_bytes": lossless,
                "sweep": sweep}

    def _lossless(self, bench, path, encoding):
        output = bench.scratch("lossless.nvdb")
        made = bench.weir.report("convert", path, "-o", output, "--lossless", "--encoding", encoding, "--overwrite")
        remove_volume(output)
        return made["file"]["bytes"]

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), **row}
                for result in measured.results(self.name) for row in result["rows"]]

    def text(self, measured):
        parts = [self._volume_text(result) for result in measured.results(self.name)]
        return "\n\n".join(parts) + "\n\n" + command(
            "bench/evaluate.sh --only errors",
            "weir sweep VOLUME.raw -o sweep --rates 10,5,2.5,2,1.25,1 --methods paper,float,auto,packed,zfp",
            "weir convert VOLUME.raw --lossless --encoding packed        # last row")

    def _volume_text(self, result):
        by = {(row["method"], row["share"]): row for row in result["rows"]}

        def fields(row):
            return [scientific(row["nmse"]), decibel(row)] if row["bytes_got"] else ["-", "-"]

        lines = [[f"{share} %", *(field for method in METHODS for field in fields(by[(method, share)]))]
                 for share in SHARES]
        sizes = {name: percent(bytes_, result["dense_bytes"]) for name, bytes_ in result["lossless_bytes"].items()}
        lines.append(["lossless from", "", sizes["float"], "", sizes["float"], "", sizes["auto"], "", sizes["packed"],
                      "", ""])
        title = f"**{result['volume']}**, {size_text(result['extent'])}, {result['type']}: {result['note']}"
        header = ["of dense", "paper's: MSE", "dB", "float: MSE", "dB", "auto: MSE", "dB", "packed: MSE", "dB",
                  "ZFP: MSE", "dB"]
        plot = f"![PSNR against bits per voxel](images/evaluation/{self._image(result)})"
        return f"{title}\n\n{table(header, lines)}\n\n{plot}"

    @staticmethod
    def _image(result):
        return f"{result['volume']}_{'x'.join(str(n) for n in result['extent'])}_psnr.png"

    def pictures(self, measured, directory):
        return {self._image(result): directory / "sweeps" / result["sweep"] / "psnr_bits.png"
                for result in measured.results(self.name)}

    def broken_promises(self, measured):
        broken = []
        for result in measured.results(self.name):
            by = {(row["method"], row["share"]): row for row in result["rows"]}
            for share in SHARES:
                paper = by[("paper", share)]
                for method in ENCODINGS:
                    ours = by[(method, share)]
                    if ours["bytes_got"] and paper["bytes_got"] and ours["mse"] > paper["mse"]:
                        broken.append(f"{result['volume']} at {share} %: {method} has an MSE of {ours['mse']}, the "
                                      f"paper's preset {paper['mse']}")
            for method in ENCODINGS:
                rows = [by[(method, share)] for share in SHARES if by[(method, share)]["bytes_got"]]
                rises = [(before, after) for before, after in zip(rows, rows[1:]) if after["mse"] > before["mse"]]
                broken += [f"{result['volume']}: {method} has more error at {after['share']} % than at "
                           f"{before['share']} %" for before, after in rises[PREVIEW_STEPS.get(method, 0):]]
            if any(by[("auto", share)]["mse"] > by[("float", share)]["mse"] for share in SHARES
                   if by[("auto", share)]["bytes_got"]):
                broken.append(f"{result['volume']}: auto has more error than float")
        return broken
