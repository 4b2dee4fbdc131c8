"""Compares pictures of weir's, the paper's and ZFP's volumes of equal bytes with pictures of the source."""

import dataclasses
import pathlib
import shutil
import sys

import png
import volumes
from experiment import Experiment, method_options, remove_volume
from experiments.sizes import cells
from experiments.zfp import zfp_statistics
from markdown import command, table
from programs import BUDGET_EXIT_CODE, ProgramFailed

RATES = (20, 10, 6, 5, 4)
SHEET_RATES = (20, 10, 5)
METHODS = ("auto", "packed", "paper", "zfp")
LEAST_ZFP_BITS = 9  # per block of 4^3 voxels
SIZE = "256x192"
SCENES = pathlib.Path(__file__).resolve().parents[1] / "scenes"
GAP = 4  # pixels between the pictures of a sheet


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    volume: volumes.Volume
    samples: int  # per pixel


class Pictures(Experiment):
    name = "pictures"

    @staticmethod
    def _scenes(bench):
        if bench.quick:
            return [Scene("cloud_path", volumes.wdas_like(16), 2)], (10, 5)
        by_name = {volume.name: volume for volume in bench.volumes()}
        wanted = (("cloud_path", "wdas-like", 32), ("vessels_path", "aneurism", 32), ("brain_iso", "mni152_2009", 4),
                  ("tooth_iso", "tooth", 4), ("vortices_iso", "wmag", 4))
        return [Scene(name, by_name[volume], samples) for name, volume, samples in wanted if volume in by_name], RATES

    def measure(self, bench):
        scenes, rates = self._scenes(bench)
        for scene in scenes:
            self._directory(bench, scene).mkdir(parents=True, exist_ok=True)
            bench.store.measure(self.name, f"{scene.name} noise", lambda scene=scene: self._noise(bench, scene))
            for method in METHODS:
                if method == "zfp" and shutil.which("zfp") is None:
                    print("pictures: ZFP's are skipped, the command zfp is missing", file=sys.stderr)
                    continue
                for rate in rates:
                    bench.store.measure(self.name, f"{scene.name} {method} {rate:02}",
                                        lambda scene=scene, method=method, rate=rate:
                                        self._picture(bench, scene, method, rate))

    @staticmethod
    def _directory(bench, scene):
        return bench.directory / "pictures" / scene.name

    @staticmethod
    def _render(bench, scene, source, picture, *options):
        bench.weir.run("render", source, "-o", picture, "--overwrite", "--scene", SCENES / f"{scene.name}.toml", "--size",
                       "64x48" if bench.quick else SIZE, "--spp", scene.samples, "--backend", "cpu", *options)

    def _noise(self, bench, scene):
        """Renders the source and measures how far a picture with another seed differs from it."""
        directory = self._directory(bench, scene)
        with bench.files.file(scene.volume) as path:
            self._render(bench, scene, path, directory / "source.png", "--volume", "dense")
            self._render(bench, scene, path, directory / "seed.png", "--volume", "dense", "--seed", "1")
        return self._judged(bench, scene, "seed", {"method": "source, another seed", "rate": None, "psnr_db": None,
                                                   "lossless": True, "bytes": scene.volume.dense_bytes})

    def _judged(self, bench, scene, name, result):
        directory = self._directory(bench, scene)
        flip = bench.weir.flip(directory / "source.png", directory / f"{name}.png", "-o",
                               directory / f"{name}_flip.png", "--overwrite")
        return {"scene": scene.name, "volume": scene.volume.name, "samples": scene.samples, **result,
                "flip_mean": flip["mean"], "flip_third_quartile": flip["third_weighted_quartile"],
                "flip_max": flip["max"]}

    def _picture(self, bench, scene, method, rate):
        make = self._by_zfp if method == "zfp" else self._by_weir
        try:
            result = make(bench, scene, method, rate)
        except ProgramFailed as failure:
            if failure.code != BUDGET_EXIT_CODE:
                raise
            result = None
        if result is None:
            return {"scene": scene.name, "volume": scene.volume.name, "samples": scene.samples, "method": method,
                    "rate": rate, "psnr_db": None, "lossless": False, "bytes": None, "flip_mean": None,
                    "flip_third_quartile": None, "flip_max": None}
        return self._judged(bench, scene, f"{method}_{rate:02}", result)

    def _by_weir(self, bench, scene, method, rate):
        output = bench.scratch("picture.nvdb")
        with bench.files.file(scene.volume) as path:
            made = bench.weir.report("convert", path, "-o", output, "--overwrite", "--rate", rate,
                                     *method_options(method))
        self._render(bench, scene, output, self._directory(bench, scene) / f"{method}_{rate:02}.png")
        remove_volume(output)
        return {"method": method, "rate": rate, "psnr_db": made["error"]["psnr_db"],
                "lossless": made["error"]["lossless"], "bytes": made["file"]["bytes"]}

    def _by_zfp(self, bench, scene, method, rate):
        """Compresses with the most whole bits per block that fit into the requested bytes. Renders the decoded volume
        as a dense one."""
        block_bits = 8 * -(-scene.volume.dense_bytes // rate) // cells(scene.volume.extent, 4)
        if block_bits < LEAST_ZFP_BITS:
            return None
        decoded = bench.scratch(dataclasses.replace(scene.volume, type="float32").file_name)
        with bench.files.float32_file(scene.volume) as path:
            theirs = zfp_statistics(["-i", path, "-f", "-3", *scene.volume.extent, "-r", repr(block_bits / 64),
                                     "-o", decoded])
            # weir compares the source with a lossless file of the decoded values.
            lossless = bench.scratch("decoded.nvdb")
            bench.weir.run("convert", decoded, "-o", lossless, "--overwrite", "--lossless")
            error = bench.weir.report("compare", path, lossless)
        remove_volume(lossless)
        picture = self._directory(bench, scene) / f"{method}_{rate:02}.png"
        self._render(bench, scene, decoded, picture, "--volume", "dense")
        decoded.unlink()
        return {"method": method, "rate": rate, "psnr_db": error["psnr_db"], "lossless": error["lossless"],
                "bytes": int(theirs["zfp"])}

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        rows = self.rows(measured)
        rates = sorted({row["rate"] for row in rows if row["rate"]}, reverse=True)
        parts = [self._table(rows, rates) + "\n\n" + command(
            "bench/evaluate.sh --only pictures",
            "weir render VOLUME.raw --volume dense -o source.png --scene bench/evaluate/scenes/cloud_path.toml",
            "weir convert VOLUME.raw -o auto.nvdb --rate 10 && weir render auto.nvdb -o auto.png --scene ...",
            "weir flip source.png auto.png -o auto_flip.png                       # one figure, and its map")]
        for scene in dict.fromkeys(row["scene"] for row in rows):
            name = self._sheet_name(scene)
            parts.append(f"**{scene.replace('_', ', ')}**\n\n![{scene}](images/evaluation/{name})")
        return "\n\n".join(parts)

    @staticmethod
    def _sheet_name(scene):
        return f"{scene}.png"

    @staticmethod
    def _table(rows, rates):
        by = {(row["scene"], row["method"], row["rate"]): row for row in rows}
        lines = []
        for scene in dict.fromkeys(row["scene"] for row in rows):
            noise = by.get((scene, "source, another seed", None))
            for method in METHODS:
                line = [f"{scene}, {noise['volume']}" if method == METHODS[0] and noise else "",
                        f"{noise['flip_mean']:.4f}" if method == METHODS[0] and noise else "", method]
                for rate in rates:
                    row = by.get((scene, method, rate))
                    line.append("-" if row is None or row["flip_mean"] is None else f"{row['flip_mean']:.4f}")
                lines.append(line)
        return table(["mean FLIP of", "noise", "by", *(f"1:{rate}" for rate in rates)], lines)

    def pictures(self, measured, directory):
        """A sheet for each scene; the single pictures stay where they are, in pictures/."""
        sheets = {}
        for scene in dict.fromkeys(row["scene"] for row in self.rows(measured)):
            folder = directory / "pictures" / scene
            if (folder / "source.png").exists():
                png.write_png(folder / "sheet.png", self._sheet(folder))
                sheets[self._sheet_name(scene)] = folder / "sheet.png"
        return sheets

    @staticmethod
    def _sheet(folder):
        """The source's picture, one by another seed and its map; then for each method a row of pictures and one of
        maps, whose columns are rates."""
        source = png.read_png(folder / "source.png")
        step_x, step_y = source.width + GAP, source.height + GAP
        sheet = png.blank(len(SHEET_RATES) * step_x - GAP, (1 + 2 * len(METHODS)) * step_y - GAP)
        for column, name in enumerate(("source.png", "seed.png", "seed_flip.png")):
            png.paste(sheet, png.read_png(folder / name), column * step_x, 0)
        for row, method in enumerate(METHODS):
            for column, rate in enumerate(SHEET_RATES):
                for below, name in enumerate((f"{method}_{rate:02}.png", f"{method}_{rate:02}_flip.png")):
                    if (folder / name).exists():
                        png.paste(sheet, png.read_png(folder / name), column * step_x, (1 + 2 * row + below) * step_y)
        return sheet

    def broken_promises(self, measured):
        """A lossless file shows the source's picture; constant blocks of other values may differ in the last bit."""
        return [f"{row['scene']} at 1:{row['rate']}: lossless, and FLIP is {row['flip_mean']}"
                for row in self.rows(measured)
                if row["method"] in ("auto", "packed", "paper") and row["lossless"] and row["flip_mean"] > 1e-3]
