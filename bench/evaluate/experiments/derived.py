"""Errors of what people derive from a volume, of equal bytes: quantiles, gradient, similarity, spectrum, vorticity.

Of ZFP what its command decompresses is packed without loss first, so that `weir compare` measures all methods.
"""

import math
import shutil

from experiment import Experiment, describe, method_options, remove_volume, size_text
from experiments.zfp import zfp_statistics
from markdown import command, decibel, scientific, table
from peers import zfp_block_bits
from programs import BUDGET_EXIT_CODE, ProgramFailed

SHARES = (5, 10)  # percent of dense float32
METHODS = ("auto", "packed", "zfp")
QUANTILES = ("0.5", "0.99", "0.999")
SMALL_ERROR = 0.01  # as a share of the source's power
SEEDS = (1, 2, 3)  # one for each component of a vector field
FIELD_RATE = 20
CHARTED = "turbulence"
EQUAL = 1e-6  # relative: the certificate's gradient against that of compare


def smallest_good_wavelength(spectrum):
    """Returns the wavelength in voxels down to which the error has at most SMALL_ERROR of the source's power. None if
    that holds for all wavelengths."""
    for wave_number, source, error in zip(spectrum["wave_number"], spectrum["source"], spectrum["error"]):
        if error > SMALL_ERROR * source:
            return 1 / wave_number
    return None


def in_percent(share):
    """0.123 -> 12"""
    return f"{100 * share:.0f}" if share >= 0.1 else scientific(100 * share)


class Derived(Experiment):
    name = "derived"

    def measure(self, bench):
        for volume in bench.few_bytes_volumes():
            bench.store.measure(self.name, volume.file_name, lambda volume=volume: self._rows(bench, volume))
        edge = 64 if bench.quick else 256
        bench.store.measure(self.name, f"field {edge}", lambda: self._field(bench, edge))

    def _rows(self, bench, volume):
        rows = []
        with bench.files.file(volume) as path:
            for share in SHARES:
                for method in METHODS:
                    if method == "zfp" and shutil.which("zfp") is None:
                        continue
                    output = bench.scratch(f"{volume.name}.nvdb")
                    made = self._convert(bench, volume, path, method, share, output)
                    if made is None:
                        continue
                    size, certified = made
                    rows.append({"share": share, "method": method, "bytes_asked": share * volume.dense_bytes // 100,
                                 "bytes": size, **self._errors(bench, path, output, certified)})
                    if volume.name == CHARTED and share == SHARES[0] and method == "packed":
                        chart = bench.directory / "derived" / f"{volume.name}_spectrum.png"
                        chart.parent.mkdir(parents=True, exist_ok=True)
                        bench.weir.run("compare", path, output, "--spectrum", chart)
                    remove_volume(output)
        return {**describe(volume), "rows": rows}

    def _convert(self, bench, volume, path, method, share, output):
        """Returns the bytes of `output` and the certificate of its gradient, {} if it has none. None if no file has
        that size."""
        size = share * volume.dense_bytes // 100
        if method == "zfp":
            decoded = bench.scratch(f"decoded_{volume.size_text}_float32.raw")
            block_bits = zfp_block_bits(volume.extent, size)
            with bench.files.float32_file(volume) as wide:
                theirs = zfp_statistics(["-i", wide, "-f", "-3", *volume.extent, "-r", repr(block_bits / 64), "-o", decoded])
            bench.weir.run("convert", decoded, "-o", output, "--overwrite", "--encoding", "packed", "--lossless")
            decoded.unlink()
            return int(theirs["zfp"]), {}
        try:
            made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--size", size, "--certify", "gradient",
                                     *method_options(method))
        except ProgramFailed as failure:
            if failure.code != BUDGET_EXIT_CODE:
                raise
            return None
        return made["file"]["bytes"], made["error"].get("gradient", {})

    @staticmethod
    def _errors(bench, path, output, certified):
        spacing = ("--spacing", "1,1,1")  # in voxels
        found = bench.weir.report("compare", path, output, "--derived", "--spectrum", bench.scratch("derived.csv"), *spacing)
        derived = found["derived"]
        low, high = found["value_range"]
        return {"psnr_db": found["psnr_db"], "lossless": found["lossless"], "max_abs": found["max_abs"] / (high - low),
                **{f"quantile_{q}": derived["quantiles"][q] / (high - low) for q in QUANTILES},
                "gradient_relative_rms": derived["gradient"]["relative_rms"], "gradient_max_abs": derived["gradient"]["max_abs"],
                "gradient_rms": derived["gradient"]["rms"], "gradient_rms_certified": certified.get("rms"),
                "ssim": derived["ssim"], "wavelength": smallest_good_wavelength(found["spectrum"])}

    @staticmethod
    def _field(bench, edge):
        """Measures vorticity and divergence of three components that are packed separately."""
        rows = []
        for method in ("auto", "packed"):
            files = []
            for seed in SEEDS:
                source = bench.scratch(f"u{seed}_{edge}x{edge}x{edge}_float32.raw")
                output = bench.scratch(f"u{seed}.nvdb")
                bench.weir.run("sample", "turbulence", "--seed", seed, "-o", source, "--overwrite")
                made = bench.weir.report("convert", source, "-o", output, "--overwrite", *method_options(method),
                                         *(("--lossless",) if bench.quick and method == "auto" else ("--rate", FIELD_RATE)))
                files += [source, output]
            found = bench.weir.report("compare", *files[:2], "--vector", *files[2:])["vector"]
            rows.append({"method": method, "psnr_db": made["error"]["psnr_db"], "lossless": made["error"]["lossless"],
                         **{f"{what}_relative_rms": found[what]["relative_rms"] for what in ("vorticity", "divergence")}})
            for source, output in zip(files[::2], files[1::2]):
                source.unlink()
                remove_volume(output)
        return {"edge": edge, "field": rows}

    def rows(self, measured):
        return [{"volume": result["volume"], "extent": size_text(result["extent"]), **row}
                for result in measured.results(self.name) if "rows" in result for row in result["rows"]]

    def text(self, measured):
        lines = []
        for result in measured.results(self.name):
            for row in result.get("rows", []):
                named = row is result["rows"][0]
                lines.append([f"{result['volume']}, {size_text(result['extent'])}" if named else "", f"{row['share']} %",
                              {"zfp": "ZFP"}.get(row["method"], row["method"]), decibel(row),
                              *(in_percent(row[f"quantile_{q}"]) for q in QUANTILES), in_percent(row["max_abs"]),
                              in_percent(row["gradient_relative_rms"]), f"{row['ssim']:.5f}",
                              "all" if row["wavelength"] is None else f"{row['wavelength']:.1f}"])
        header = ["volume", "of dense", "method", "PSNR, dB", "median", "99 %", "99.9 %", "largest", "gradient", "SSIM",
                  "wavelengths above"]
        parts = [table(header, lines), self._field_text(measured)]
        return "\n\n".join(part for part in parts if part) + "\n\n" + command(
            "bench/evaluate.sh --only derived",
            "weir compare VOLUME.raw VOLUME.nvdb --derived --spectrum SPECTRUM.png --spacing 1,1,1      # one line")

    def _field_text(self, measured):
        for result in measured.results(self.name):
            if "field" in result:
                lines = [[row["method"], decibel(row), *(f"{in_percent(row[f'{what}_relative_rms'])} %"
                                                         for what in ("vorticity", "divergence"))] for row in result["field"]]
                edge = result["edge"]
                return (f"The next table is for a vector field of {edge}^3: three components of turbulence, each converted\n"
                        f"at rate {FIELD_RATE}. It has the relative RMS error of what is derived from all three:\n\n"
                        + table(["method", "PSNR of a component, dB", "vorticity", "divergence"], lines))
        return ""

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            if row.get("bytes", 0) > row.get("bytes_asked", 0):
                broken.append(f"{row['volume']} at {row['share']} %, {row['method']}: {row['bytes']} bytes, "
                              f"{row['bytes_asked']} were asked for")
            certified = row["gradient_rms_certified"]
            if certified is not None and not math.isclose(certified, row["gradient_rms"], rel_tol=EQUAL, abs_tol=0):
                broken.append(f"{row['volume']} at {row['share']} %, {row['method']}: the certificate has a gradient's error of "
                              f"{certified}, compare {row['gradient_rms']}")
        return broken

    def pictures(self, measured, directory):
        chart = directory / "derived" / f"{CHARTED}_spectrum.png"
        return {chart.name: chart} if chart.exists() else {}
