#!/usr/bin/env python3
"""How well `weir convert --dry-run` tells what a conversion then does.

    bench/dry_run.py [--weir WEIR] [--edge 640] [--directory DIRECTORY] [--scenes] [VOLUME...]

Of each volume, ten synthetic ones of EDGE^3 float32 voxels where none is given, it makes a dry run and the conversion, in
turn, for each of RUNS, and prints two tables in Markdown: PSNR, size and time as expected and as they came out, and how far
they were off. With --scenes each of SCENES decides what is kept, packed, and PSNR is that of what it shows. Files lie in
DIRECTORY, where there must be room for two volumes, and are in the page cache. Exit code 1 where a PSNR is off by more than
1 dB or a size by more than 5 %; times are for the reader to judge, since another program may have run meanwhile.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

VOLUMES = [("cloud", 1), ("cloud", 2), ("cloud", 3), ("turbulence", 1), ("turbulence", 2), ("background", 1), ("signed", 1),
           ("noise", 1), ("sphere", 1), ("tiny", 1)]
RUNS = [["--rate", "8"], ["--rate", "8", "--encoding", "float"], ["--rate", "20", "--encoding", "packed"],
        ["--psnr", "50"], ["--psnr", "60", "--encoding", "packed"]]


SCENE_RUNS = [["--rate", "20", "--encoding", "packed"], ["--psnr", "50", "--encoding", "packed"]]
# Scenes by name. Values are shares of the value range, lengths are shares of the volume's edge.
SCENES = {
    "upper half": lambda value, voxel: f'mode = "dvr"\n[volume]\nrange = [{value(0)}, {value(1)}]\n'
                                       'opacity = [[0, 0], [0.5, 0], [1, 1]]\n',
    "region": lambda value, voxel: f'mode = "dvr"\n[volume]\nrange = [{value(0)}, {value(1)}]\n'
                                   'opacity = [[0, 0], [0.2, 0], [1, 1]]\n'
                                   f'region = [[{voxel(0.15)}, {voxel(0.6)}], [0, {voxel(1)}], [{voxel(0.1)}, {voxel(0.5)}]]\n',
    "iso": lambda value, voxel: f'mode = "iso"\n[volume]\niso = {value(0.4)}\n',
}


def convert(weir, volume, output, options):
    """Runs the command. Returns the JSON that it prints and the seconds that it took."""
    started = time.monotonic()
    done = subprocess.run([weir, "convert", volume, "-o", output, "--json", "--quiet", *options], check=True, text=True,
                          stdout=subprocess.PIPE)
    return json.loads(done.stdout), time.monotonic() - started


class Tally:
    """The errors of the forecasts, by options."""

    def __init__(self):
        self.off = {}  # options: {"dB", "%", "time %", "in range": [...]}

    def add(self, options, expected, made, seconds):
        """Returns the cells of one line of the table."""
        off = self.off.setdefault(" ".join(options), {"dB": [], "%": [], "time %": [], "in range": []})
        error, real = expected["visible"] or expected["error"], made.get("visible") or made["error"]
        by_size = expected["file"]["exact"]
        size, bytes_made = expected["file"], made["file"]["bytes"]
        off["%"].append(abs(size["value"] / bytes_made - 1) * 100)
        off["time %"].append((expected["time"]["total_s"] / seconds - 1) * 100)
        if by_size and error["psnr_db"] and real["psnr_db"]:
            db = error["psnr_db"]
            off["dB"].append(abs(db["value"] - real["psnr_db"]))
            if db["low"] is not None:
                off["in range"].append(db["low"] <= real["psnr_db"] <= db["high"])
        elif not by_size and size["low"] is not None:
            off["in range"].append(size["low"] <= bytes_made <= size["high"])
        return [psnr_text(error["psnr_db"], by_size), psnr_text({"value": real["psnr_db"], "low": None}, False),
                size_text(size), f"{bytes_made / 1e6:.2f}", f"{expected['time']['total_s']:.2f}", f"{seconds:.2f}"]

    def print(self):
        """Returns whether the forecasts of PSNR and size are as accurate as promised."""
        print("| options | PSNR off by at most | size off by at most | in the range | time off, median | time within 20 % |")
        print("|---|---|---|---|---|---|")
        for options, off in self.off.items():
            psnr = f"{max(off['dB']):.2f} dB" if off["dB"] else "-"
            inside = f"{sum(off['in range'])} of {len(off['in range'])}" if off["in range"] else "-"
            size = "exact" if max(off["%"]) == 0 else f"{max(off['%']):.1f} %"
            near = sum(abs(time) <= 20 for time in off["time %"])
            print(f"| `{options}` | {psnr} | {size} | {inside} | {statistics.median(off['time %']):+.0f} % | "
                  f"{near} of {len(off['time %'])} |")
        return all(max(off["dB"], default=0) <= 1 and max(off["%"]) <= 5 for off in self.off.values())


def psnr_text(psnr, has_spread):
    if psnr is None or psnr["value"] is None:
        return "lossless"
    if psnr["low"] is None or not has_spread:
        return f"{psnr['value']:.2f}"
    return f"{psnr['value']:.2f} ({psnr['low']:.2f} to {psnr['high']:.2f})"


def size_text(size):
    text = f"{size['value'] / 1e6:.2f}"
    return text if size["low"] is None else f"{text} ({size['low'] / 1e6:.2f} to {size['high'] / 1e6:.2f})"


def scenes_of(weir, volume, edge, folder):
    """Writes SCENES to files. Yields each scene's name and path."""
    expected, _ = convert(weir, volume, str(folder / "out.nvdb"), ["--psnr", "50", "--dry-run"])
    low, high = expected["error"]["value_range"]
    for name, text in SCENES.items():
        path = folder / f"{name}.toml"
        path.write_text(text(lambda share: low + share * (high - low), lambda share: round(share * edge)))
        yield name, str(path)


def check(weir, volume, name, folder, tally, scene=None):
    with_scene = ["--scene", scene] if scene else []
    for options in SCENE_RUNS if scene else RUNS:
        output = str(folder / "out.nvdb")
        expected, _ = convert(weir, volume, output, [*options, *with_scene, "--dry-run"])
        made, seconds = convert(weir, volume, output, [*options, *with_scene])
        cells = tally.add(options, expected, made, seconds)
        print("|", " | ".join([name, " ".join(options), f"{100 * expected['sample']['share']:.3g} %", *cells]), "|", flush=True)
        for path in folder.glob("out.nvdb*"):
            path.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--weir", default=str(pathlib.Path(__file__).parent.parent / "build/release/weir"))
    parser.add_argument("--edge", type=int, default=640)
    parser.add_argument("--directory")
    parser.add_argument("--scenes", action="store_true")
    parser.add_argument("volumes", nargs="*", metavar="VOLUME")
    arguments = parser.parse_args()
    tally = Tally()
    print("| volume | options | sampled | PSNR expected, dB | PSNR | MB expected | MB | s expected | s |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(dir=arguments.directory) as directory:
        folder = pathlib.Path(directory)
        for volume in arguments.volumes:
            check(arguments.weir, volume, pathlib.Path(volume).name, folder, tally)
        for kind, seed in [] if arguments.volumes else VOLUMES:
            edges = "x".join([str(arguments.edge)] * 3)
            volume = folder / f"{kind}_{edges}_float32.raw"
            subprocess.run([arguments.weir, "sample", kind, "--seed", str(seed), "-o", volume, "--quiet"], check=True)
            if not arguments.scenes:
                check(arguments.weir, str(volume), f"{kind} {seed}", folder, tally)
            for scene, path in scenes_of(arguments.weir, str(volume), arguments.edge, folder) if arguments.scenes else []:
                check(arguments.weir, str(volume), f"{kind} {seed}, {scene}", folder, tally, path)
            volume.unlink()
    print()
    return 0 if tally.print() else 1


if __name__ == "__main__":
    sys.exit(main())
