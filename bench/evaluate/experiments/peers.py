"""SPERR, SZ3 and both modes of ZFP beside weir: bytes for an error, error at equal bytes, seconds of both directions.

Errors are measured by weir on what each command decompresses to, for all in the same way. Of a peer whose command is
missing the report has what DIR holds, or else what the last published run left in bench/evaluate/kept.json.
"""

import json
import math
import sys

import volumes
from experiment import Experiment, describe, method_options, remove_volume, size_text
from experiments.speed import read_twice, threads_here
from markdown import command
from peer_tables import (OURS, SHARES, SPEED_DB, TARGETS_DB, chart, search_text, shares_table, speed_table,
                         targets_table, versions_text)
from png import write_png
from programs import BUDGET_EXIT_CODE, ProgramFailed, run
from search import smallest_that_reaches

CHART = "peers.png"
IMAGES = "images/evaluation"  # path relative to the report
ROUNDS = 3
TOLERANCE_DB = 0.1  # above the target, where the search ends
TOLERANCE_BYTES = 0.01  # below the size, as a share of it
POINT_KEYS = ("bytes", "psnr_db", "max_abs", "lossless")


class Peers(Experiment):
    name = "peers"

    def measure(self, bench):
        wanted = volumes.few_bytes_set(48)[:2] if bench.quick else [*volumes.real_set(), *volumes.few_bytes_set(256)]
        for peer in bench.peers:
            if not peer.command:
                names = {f"{volume.file_name}_{peer.name}" for volume in wanted}
                kept = [record for record in kept_records(bench.kept) if record["name"] in names]
                print(f"peers: {peer.title} skipped, the command {peer.program} is not found"
                      + ("; its figures are those that are kept" if kept else ""), file=sys.stderr)
                for record in kept:
                    bench.store.adopt(record)
        for volume in wanted:
            if bench.files.available(volume):
                for encoding in OURS:
                    self._measure(bench, volume, encoding, _Ours(bench, volume, encoding))
                for peer in bench.peers:
                    if peer.command:
                        self._measure(bench, volume, peer.name, _Theirs(bench, volume, peer))

    def _measure(self, bench, volume, method, subject):
        def measured():
            with bench.files.file(volume) as path, bench.files.float32_file(volume) as wide:
                for file in (path, wide):
                    read_twice(file, False)  # into the page cache, for all methods alike
                return {**describe(volume), "dense_bytes": volume.dense_bytes, "method": method,
                        **subject.measure(path, wide, 1 if bench.quick else ROUNDS)}
        bench.store.measure(self.name, f"{volume.file_name}_{method}", measured)

    def rows(self, measured):
        rows = []
        for result in measured.results(self.name):
            head = {"volume": result["volume"], "extent": size_text(result["extent"]), "method": result["method"],
                    "version": result["version"]}
            empty = dict.fromkeys(("target_db", "share", "parameter", *POINT_KEYS, "threads", "compress_s",
                                   "decompress_s"))
            for kind in ("targets", "shares", "speeds"):
                rows += [{**head, **empty, **row} for row in result[kind]]
        return rows

    def first_text(self, measured):
        """Returns the report's opening section."""
        return "\n\n".join((f"![PSNR against bytes]({IMAGES}/{CHART})", targets_table(measured), command(
            "bench/evaluate.sh --only peers --sperr SPERR3D --sz3 SZ3",
            "weir convert VOLUME.raw --psnr 80 --encoding packed",
            "sperr3d -c VOLUME_float32.raw --ftype 32 --dims X Y Z --omp 2 --psnr 80 --bitstream OUT",
            "sz3 -f -i VOLUME_float32.raw -z OUT -3 X Y Z -M ABS BOUND",
            "zfp -i VOLUME_float32.raw -z OUT -f -3 X Y Z -r BITS        # or -a BOUND")))

    def text(self, measured):
        return "\n\n".join((shares_table(measured), speed_table(measured), search_text(measured), versions_text(measured),
                            command("bench/evaluate.sh --only peers --sperr SPERR3D --sz3 SZ3")))

    def pictures(self, measured, directory):
        path = directory / CHART
        write_png(path, chart(measured))
        return {CHART: path}

    def broken_promises(self, measured):
        return [f"{result['volume']}, {result['method']}: {row['psnr_db']} dB with --psnr {row['target_db']}"
                for result in measured.results(self.name) if result["method"] in OURS for row in result["targets"]
                if row["bytes"] and not row["lossless"] and row["psnr_db"] < row["target_db"]]


class _Ours:
    """weir itself. Decompresses with `weir export`, because no other command writes all values."""

    def __init__(self, bench, volume, encoding):
        self._bench, self._volume, self._encoding = bench, volume, encoding
        self._output = bench.scratch("peers.nvdb")

    def measure(self, path, wide, rounds):
        del wide
        targets = [{"target_db": target, **self._convert(path, "--psnr", target)} for target in TARGETS_DB]
        shares = [{"share": share, **self._convert(path, "--size", share * self._volume.dense_bytes // 100)}
                  for share in SHARES]
        speeds = []
        size = next(row["bytes"] for row in targets if row["target_db"] == SPEED_DB)
        exported = self._bench.scratch("peers.vdb")
        for threads in thread_counts():
            there, back = [], []
            for _ in range(rounds):
                there.append(self._bench.weir.run("convert", path, "-o", self._output, "--overwrite", "--size", size,
                                                  "--threads", threads, *method_options(self._encoding)).seconds)
                back.append(self._bench.weir.run("export", self._output, "-o", exported, "--overwrite", "--threads",
                                                 threads, "--compression", "none").seconds)
            speeds.append({"threads": threads, "compress_s": min(there), "decompress_s": min(back)})
        exported.unlink()
        remove_volume(self._output)
        return {"version": self._bench.weir.version(), "targets": targets, "shares": shares, "speeds": speeds}

    def _convert(self, path, *budget):
        try:
            made = self._bench.weir.report("convert", path, "-o", self._output, "--overwrite", *budget,
                                           *method_options(self._encoding))
        except ProgramFailed as failure:
            if failure.code != BUDGET_EXIT_CODE:
                raise
            return nothing()
        return {"bytes": made["file"]["bytes"], **{key: made["error"][key] for key in POINT_KEYS[1:]}}


class _Theirs:
    """A peer whose parameter is searched. Each point is measured once and kept."""

    def __init__(self, bench, volume, peer):
        self._bench, self._volume, self._peer = bench, volume, peer
        self._stream = bench.scratch("peers.stream")
        self._decoded = bench.scratch(f"peers_{volume.size_text}_float32.raw")
        self._known = {}  # x -> its point

    def measure(self, path, wide, rounds):
        del path
        self._wide = wide
        low, high = self._range()
        self._value_range = high - low
        targets = [{"target_db": target, **self._for_psnr(target)} for target in TARGETS_DB]
        shares = [{"share": share, **self._for_bytes(share * self._volume.dense_bytes // 100)} for share in SHARES]
        at = next(row for row in targets if row["target_db"] == SPEED_DB)
        speeds = [self._speed(at["parameter"], threads, rounds) for threads in thread_counts()] if at["bytes"] else []
        for scratch in (self._stream, self._decoded):
            scratch.unlink(missing_ok=True)
        return {"version": self._peer.version(), "targets": targets, "shares": shares, "speeds": speeds}

    def _range(self):
        output = self._bench.scratch("peers.nvdb")
        made = self._bench.weir.report("convert", self._wide, "-o", output, "--overwrite", "--psnr", 20)
        remove_volume(output)
        return made["value_range"]

    def _for_psnr(self, target):
        peer = self._peer
        found = smallest_that_reaches(lambda x: self._keyed(x, quality), target,
                                      peer.start(target, self._value_range), peer.slope, peer.grain, TOLERANCE_DB)
        return found or nothing()

    def _for_bytes(self, size):
        """Returns the point of the highest quality that fits."""
        if self._peer.direct_bytes:
            point = self._point(self._peer.options_for_size(self._volume, size))
            return point if point["bytes"] <= size else nothing()
        # Starts at the point nearest in bytes. 6 dB take about one bit per voxel, less if most voxels are empty.
        nearest = min(self._known, key=lambda x: abs(math.log(self._known[x]["bytes"] / size)))
        found = smallest_that_reaches(lambda x: self._keyed(-x, lambda point: -math.log2(point["bytes"])),
                                      -math.log2(size), -nearest, self._peer.slope / 20, self._peer.grain,
                                      math.log2(1 + TOLERANCE_BYTES))
        return found or nothing()

    def _keyed(self, x, value):
        if x not in self._known:
            self._known[x] = {"parameter": x, **self._point(self._peer.options(x, self._value_range))}
        return value(self._known[x]), self._known[x]

    def _point(self, options):
        """Compresses with one thread. Returns the bytes, and the error of the decompressed values by weir."""
        run(self._peer.encode(self._volume, self._wide, self._stream, options, 1))
        run(self._peer.decode(self._volume, self._stream, self._decoded, options, threads_here()))
        output = self._bench.scratch("peers.nvdb")
        self._bench.weir.report("convert", self._decoded, "-o", output, "--overwrite", "--lossless", "--encoding", "float")
        error = self._bench.weir.report("compare", self._wide, output)
        remove_volume(output)
        return {"bytes": self._stream.stat().st_size, **{key: error[key] for key in POINT_KEYS[1:]}}

    def _speed(self, x, threads, rounds):
        options = self._peer.options(x, self._value_range)
        there = [run(self._peer.encode(self._volume, self._wide, self._stream, options, threads)).seconds
                 for _ in range(rounds)]
        back = [run(self._peer.decode(self._volume, self._stream, self._decoded, options, threads)).seconds
                for _ in range(rounds)]
        return {"threads": threads, "compress_s": min(there), "decompress_s": min(back)}


def kept_records(path):
    """Returns the records of methods other than weir's from a file that keep_records() wrote."""
    return json.loads(path.read_text()) if path.exists() else []


def keep_records(measured, path):
    """Keeps the peers' figures for runs without the peers. Leaves out seconds: weir's would be of another day."""
    records = {record["name"]: record for record in kept_records(path)}
    records.update((record["name"], {**record, "result": {**record["result"], "speeds": []}})
                   for record in measured.records(Peers.name) if record["result"]["method"] not in OURS)
    path.write_text(json.dumps([records[name] for name in sorted(records)], indent=1) + "\n")


def quality(point):
    return math.inf if point["lossless"] else point["psnr_db"]


def nothing():
    return {"bytes": None, "psnr_db": None, "max_abs": None, "lossless": False}


def thread_counts():
    return sorted({1, threads_here()})
