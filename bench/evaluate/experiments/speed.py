"""Time and memory of conversions, beside the time to read the file twice."""

import json
import os
import time

import volumes
from experiment import Experiment, remove_volume
from markdown import command, table

RATE = 8
ENCODINGS = ("float", "fpn", "packed")
ROUNDS = 3
SINGLE_ROUND_EDGE = 1024  # from there on a round is long enough to be believed
READ_BYTES = 8 << 20
CEILING_BYTES = 512 << 20  # the default of --memory


def threads_here():
    return len(os.sched_getaffinity(0))


def forget(path):
    """Drops a file that is on the disk from the page cache."""
    with open(path, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def read_twice(path, cold):
    """Seconds to read all of a file two times into the same 8 MiB."""
    buffer = memoryview(bytearray(READ_BYTES))
    total = 0.0
    for _ in range(2):
        if cold:
            forget(path)
        start = time.monotonic()
        with open(path, "rb", buffering=0) as file:
            while file.readinto(buffer):
                pass
        total += time.monotonic() - start
    return total


def timed_conversion(bench, volume, rate, encoding, cold, threads):
    """The fastest of some conversions, with the time to read the file twice right before each."""
    rounds = 1 if volume.extent[0] >= SINGLE_ROUND_EDGE else ROUNDS
    with bench.files.file(volume) as path:
        timed = timed_file(bench, path, bench.scratch("timed.nvdb"), rate, encoding, cold, threads, rounds)
    return {**timed, "dense_bytes": volume.dense_bytes}


def timed_file(bench, path, output, rate, encoding, cold, threads, count):
    """The same of a file and where its output goes."""
    rounds = []
    for _ in range(count):
        if not cold:
            read_twice(path, False)  # now it is there, where memory allows
        twice_s = read_twice(path, cold)
        if cold:
            forget(path)
        remove_volume(output)
        run = bench.weir.run("convert", path, "-o", output, "--rate", rate, "--encoding", encoding,
                             "--threads", threads, "--json")
        timing = json.loads(run.out)["timing"]
        rounds.append({"seconds": run.seconds, "cpu_s": run.cpu_s, "read_twice_s": twice_s,
                       "peak_rss_bytes": run.peak_rss_bytes, "bytes_read": timing["bytes_read"],
                       "survey_s": timing["survey_s"], "encode_s": timing["encode_s"]})
    best = min(rounds, key=lambda r: r["seconds"])
    remove_volume(output)
    return {"encoding": encoding, "threads": threads, "rate": rate,
            "seconds": best["seconds"], "cpu_s": best["cpu_s"], "survey_s": best["survey_s"],
            "encode_s": best["encode_s"], "bytes_read": best["bytes_read"],
            "slowest_s": max(r["seconds"] for r in rounds), "read_twice_s": min(r["read_twice_s"] for r in rounds),
            "peak_rss_bytes": max(r["peak_rss_bytes"] for r in rounds), "rounds": len(rounds)}


class Speed(Experiment):
    name = "speed"

    def measure(self, bench):
        for edge in self._edges(bench):
            for encoding in ENCODINGS:
                for cache in ("cold", "warm"):
                    self._one(bench, edge, encoding, cache, threads_here())
        threads = 1
        while threads < threads_here():
            for encoding in ENCODINGS:
                self._one(bench, 128 if bench.quick else 512, encoding, "warm", threads)
            threads *= 2

    @staticmethod
    def _edges(bench):
        if bench.quick:
            return (128,)
        return (128, 256, 512, 1024, 2048) if bench.full else (128, 256, 512, 1024)

    def _one(self, bench, edge, encoding, cache, threads):
        name = f"cloud_{edge:04}_{encoding}_{cache}_{threads:03}"
        volume = volumes.cube("cloud", edge)
        if bench.files.available(volume, 1 + 2 / RATE):
            bench.store.measure(self.name, name, lambda: {
                "edge": edge, "cache": cache,
                **timed_conversion(bench, volume, RATE, encoding, cache == "cold", threads)})

    def rows(self, measured):
        return measured.results(self.name)

    def text(self, measured):
        by = {(r["edge"], r["encoding"], r["cache"], r["threads"]): r for r in self.rows(measured)}
        most = max(threads for *_, threads in by)
        loads = [record["load"] for record in measured.records(self.name)]
        load = f"Load average of the machine before each measurement: {min(loads):.1f} to {max(loads):.1f}."
        return "\n\n".join((load, self._size_table(by, most), self._thread_table(by), command(
            "bench/evaluate.sh --only speed --again           # on a machine that does nothing else",
            "weir convert cloud_512x512x512_float32.raw --rate 8 --encoding packed --threads 2   # one figure")))

    @staticmethod
    def _size_table(by, most):
        lines = []
        for edge in sorted({edge for edge, *_ in by}):
            for encoding in ENCODINGS:
                line = [f"{edge}^3" if encoding == ENCODINGS[0] else "", encoding]
                found = [by.get((edge, encoding, cache, most)) for cache in ("cold", "warm")]
                for row in found:
                    line += (["-"] * 6 if row is None else [
                        f"{row['seconds']:.2f}", f"{row['dense_bytes'] / row['seconds'] / 1e9:.2f}",
                        f"{row['seconds'] / row['read_twice_s']:.2f}", f"{row['cpu_s']:.2f}",
                        f"{row['bytes_read'] / row['dense_bytes']:.2f}", f"{row['peak_rss_bytes'] / 2**20:.0f}"])
                lines.append(line)
        columns = ["GB/s", "times reading twice", "CPU s", "times read", "peak MiB"]
        header = ["cloud", "encoding", "cold: s", *columns, "warm: s", *columns]
        return table(header, lines)

    @staticmethod
    def _thread_table(by):
        lines = []
        for edge in sorted({edge for edge, *_ in by}):
            for encoding in ENCODINGS:
                rows = [by[key] for key in sorted(by) if key[:3] == (edge, encoding, "warm")]
                if len(rows) > 1:
                    lines += [[f"{edge}^3", encoding, row["threads"], f"{row['seconds']:.2f}",
                               f"{rows[0]['seconds'] / row['seconds']:.2f}"] for row in rows]
        return table(["cloud", "encoding", "threads", "warm: s", "times as fast as one"], lines)

    def broken_promises(self, measured):
        return [f"{row['edge']}^3, {row['encoding']}: {row['peak_rss_bytes']} bytes resident, the ceiling is "
                f"{CEILING_BYTES}" for row in self.rows(measured) if row["peak_rss_bytes"] > CEILING_BYTES]
