"""A large conversion with each encoding from a cold disk, with the steps after it; also killed and continued."""

import json
import mmap
import os
import signal
import subprocess
import time

import volumes
from experiment import Experiment, remove_volume, size_text
from experiments.speed import forget
from markdown import command, table

RATE = 8
SMALL_RATE = 50  # the rate of another conversion, of which only the time is measured
ENCODINGS = ("auto", "packed")
MEMORY = "512MiB"
CEILING_BYTES = 512 << 20
# Conversions by SMALL_RATE, by what their results are called: their memory, and that in bytes. In the larger one values
# stay between the passes.
SMALL_RUNS = {"small": (MEMORY, CEILING_BYTES), "large_memory": ("8GiB", 8 << 30)}
READ_BYTES = 8 << 20
PICTURE = "headline.png"  # the picture of the first encoding's file


def read_cold(path):
    """Returns the seconds to read an uncached file once, past the page cache: the disk's speed for one reader."""
    forget(path)
    buffer = mmap.mmap(-1, READ_BYTES)  # aligned, as direct reads want it
    start = time.monotonic()
    file = os.open(path, os.O_RDONLY | os.O_DIRECT)
    try:
        while os.readv(file, [buffer]) == READ_BYTES:
            pass
    finally:
        os.close(file)
    return time.monotonic() - start


class Headline(Experiment):
    name = "headline"

    def measure(self, bench):
        volume = volumes.wdas_like(1 if bench.full else 8 if bench.quick else bench.scale)
        if bench.files.available(volume, 1 + 3 / RATE):
            for encoding in ENCODINGS:
                bench.store.measure(self.name, f"{volume.name}_{volume.size_text}_{encoding}",
                                    lambda encoding=encoding: self._run(bench, volume, encoding))

    def _run(self, bench, volume, encoding):
        whole, again = bench.scratch("headline.nvdb"), bench.scratch("headline_again.nvdb")
        picture = bench.directory / PICTURE if encoding == ENCODINGS[0] else bench.scratch(PICTURE)
        for output in (whole, again):
            remove_volume(output)
        with bench.files.file(volume) as path:
            result = {"encoding": encoding, "extent": list(volume.extent), "dense_bytes": volume.dense_bytes,
                      "read_cold_s": read_cold(path)}
            forget(path)
            arguments = ["convert", path, "--rate", RATE, "--encoding", encoding, "--memory", MEMORY, "--resume", "on",
                         "--json", "-o"]
            run = bench.weir.run(*arguments, whole)
            sidecar = json.loads(run.out)
            result.update(seconds=run.seconds, cpu_s=run.cpu_s, peak_rss_bytes=run.peak_rss_bytes,
                          bytes_read=sidecar["timing"]["bytes_read"], survey_s=sidecar["timing"]["survey_s"],
                          file_bytes=sidecar["budget"]["file_bytes"], psnr_db=sidecar["error"]["psnr_db"],
                          lossless=sidecar["error"]["lossless"])
            for name, more in (("verify", [whole]), ("compare", [path, whole]),
                               ("render", [whole, "-o", picture, "--overwrite", "--spp", 8, "--size", "320x240"])):
                result[f"{name}_s"] = bench.weir.run(name, *more).seconds
            for key, (memory, _) in SMALL_RUNS.items():
                forget(path)
                run_small = bench.weir.run("convert", path, "--rate", SMALL_RATE, "--encoding", encoding, "--memory",
                                           memory, "--resume", "on", "--json", "-o", again)
                result.update({f"{key}_s": run_small.seconds, f"{key}_peak_bytes": run_small.peak_rss_bytes,
                               f"{key}_bytes_read": json.loads(run_small.out)["timing"]["bytes_read"]})
                remove_volume(again)
            forget(path)
            result["killed_after_s"] = self._kill(bench, [*arguments, again], run.seconds / 2)
            forget(path)
            rest = bench.weir.run(*arguments, again)
            second = json.loads(rest.out)
            result.update(rest_s=rest.seconds, rest_bytes_read=second["timing"]["bytes_read"],
                          same_bytes=second["file"]["digest"] == sidecar["file"]["digest"])
        for output in (whole, again):
            remove_volume(output)
        return result

    @staticmethod
    def _kill(bench, arguments, seconds):
        """Kills a conversion after `seconds` without warning. Returns the seconds that it ran."""
        command_line = [bench.weir.path, *(str(a) for a in arguments), "--progress", "never", "--log-level", "error"]
        start = time.monotonic()
        process = subprocess.Popen(command_line, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        process.wait()
        return time.monotonic() - start

    def rows(self, measured):
        return [{**r, "extent": "x".join(map(str, r["extent"]))} for r in measured.results(self.name)]

    def text(self, measured):
        results = measured.results(self.name)
        largest = max(result["dense_bytes"] for result in results)
        largest_results = [result for result in results if result["dense_bytes"] == largest]
        heads = [self._head(result) for result in largest_results]
        columns = [self._lines(result) for result in largest_results]
        lines = [[parts[0][0], *(field for _, *fields in parts for field in fields)] for parts in zip(*columns)]
        header = ["", *(field for result in largest_results for field in (f"{result['encoding']}: seconds", ""))]
        first = largest_results[0]
        volume = f"The volume has {size_text(first['extent'])} voxels ({largest / 1e9:.2f} GB), none of them in the page cache."
        return "\n\n".join((" ".join((volume, *heads)), table(header, lines),
                            command("bench/evaluate.sh --only headline --again --full"),
                            f"![The picture that weir render makes](images/evaluation/{PICTURE})"))

    @staticmethod
    def _head(r):
        quality = "no error" if r["lossless"] else f"{r['psnr_db']:.1f} dB"
        return (f"*{r['encoding']}*: the file has {r['file_bytes']:,} bytes and {quality}; peak memory was "
                f"{r['peak_rss_bytes'] / 2**20:.0f} MiB.")

    @staticmethod
    def _lines(r):
        rate = r["dense_bytes"] / 1e9
        of_disk = r["bytes_read"] / r["dense_bytes"] * r["read_cold_s"]
        return [
            ["the file read once, 8 MiB at a time, past the page cache", f"{r['read_cold_s']:.1f}",
             f"{rate / r['read_cold_s']:.2f} GB/s"],
            [f"`weir convert --rate {RATE} --memory {MEMORY}`", f"{r['seconds']:.1f}",
             f"{rate / r['seconds']:.2f} GB/s; {r['bytes_read'] / r['dense_bytes']:.2f} times read, in "
             f"{r['seconds'] / of_disk:.2f} of the time that reading as much takes plainly"],
            ["of that, the survey", f"{r['survey_s']:.1f}", f"{rate / r['survey_s']:.2f} GB/s"],
            *(Headline._small_line(r, key, memory) for key, (memory, _) in SMALL_RUNS.items()),
            ["`weir verify`", f"{r['verify_s']:.1f}", ""],
            ["`weir compare`", f"{r['compare_s']:.1f}", "the certificate's PSNR, measured again"],
            ["`weir render`, 320 x 240, 8 samples", f"{r['render_s']:.1f}", ""],
            ["killed by SIGKILL", f"{r['killed_after_s']:.1f}", "the same conversion again, to another file"],
            ["continued by the same command", f"{r['rest_s']:.1f}",
             f"{r['rest_bytes_read'] / r['dense_bytes']:.2f} times read; "
             + ("the same bytes" if r["same_bytes"] else "**other bytes**")],
        ]

    @staticmethod
    def _small_line(r, key, memory):
        seconds = r[f"{key}_s"]
        return [f"`weir convert --rate {SMALL_RATE} --memory {memory}`", f"{seconds:.1f}",
                f"{r['dense_bytes'] / 1e9 / seconds:.2f} GB/s; {r[f'{key}_bytes_read'] / r['dense_bytes']:.2f} times read, "
                f"{seconds / r['read_cold_s']:.2f} of the time to read it once; peak {r[f'{key}_peak_bytes'] / 2**20:.0f} MiB"]

    def pictures(self, measured, directory):
        return {PICTURE: directory / PICTURE}

    def broken_promises(self, measured):
        broken = []
        for row in self.rows(measured):
            name = f"{row['extent']}, {row['encoding']}"
            if not row["same_bytes"]:
                broken.append(f"{name}: continued to other bytes")
            ceilings = {"peak_rss_bytes": CEILING_BYTES}
            ceilings.update((f"{key}_peak_bytes", ceiling) for key, (_, ceiling) in SMALL_RUNS.items())
            for key, ceiling in ceilings.items():
                if row[key] > ceiling:
                    broken.append(f"{name}: {row[key]} bytes resident, the ceiling is {ceiling}")
        return broken
