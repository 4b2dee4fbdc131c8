"""Runs and times the measured programs, and reads their reports."""

import dataclasses
import json
import os
import platform
import signal
import subprocess
import tempfile
import time


BUDGET_EXIT_CODE = 4  # weir's exit code if no file of the size or error is possible, e.g. the smallest tree is larger


class ProgramFailed(Exception):
    """A program ended with another exit code than 0; the text is its last line on stderr."""

    def __init__(self, command, code, message):
        super().__init__(f"{' '.join(command)}: exit code {code}: {message}")
        self.code = code


@dataclasses.dataclass(frozen=True)
class Run:
    out: str
    err: str
    seconds: float  # wall clock
    cpu_s: float  # of all its threads, in the program and in the kernel
    peak_rss_bytes: int


def run(command):
    """Runs `command` to its end. Raises ProgramFailed."""
    command = [str(part) for part in command]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        start = time.monotonic()
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:  # an interrupt also reaches the program, which cleans up
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
        seconds = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        result = Run(out.read(), err.read(), seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024)
    if process.returncode != 0:
        raise ProgramFailed(command, process.returncode, (result.err.strip().splitlines() or [""])[-1])
    return result


class Weir:
    """The `weir` command."""

    def __init__(self, path):
        self.path = str(path)

    def version(self):
        """Returns weir's version and the commit that it was built from, as weir writes them into every sidecar."""
        with tempfile.TemporaryDirectory() as directory:
            volume, output = f"{directory}/volume_8x8x8_uint8.raw", f"{directory}/volume.nvdb"
            self.run("sample", "cloud", "-o", volume)
            made = self.report("convert", volume, "-o", output, "--lossless")["weir"]
        return " of ".join(["weir " + made["version"], *([made["commit"]] if made["commit"] else [])])

    def run(self, *arguments):
        return run([self.path, *arguments, "--progress", "never", "--log-level", "error"])

    def report(self, *arguments):
        """Returns what `weir ARGUMENTS --json` prints. NaN and infinity do not occur, because JSON has neither."""
        return json.loads(self.run(*arguments, "--json").out)

    def inspect(self, path):
        """Returns the output of `weir inspect`, which has no progress to silence."""
        return json.loads(run([self.path, "inspect", path, "--json"]).out)

    def flip(self, reference, test, *arguments):
        """Returns the output of `weir flip`, which has no progress to silence."""
        return json.loads(run([self.path, "flip", reference, test, *arguments, "--json"]).out)


def machine():
    """Describes the machine: processor, threads, memory, system. Names no host or user."""
    model = platform.machine()
    memory_kib = 0
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), model)
        with open("/proc/meminfo", encoding="utf-8") as file:
            memory_kib = int(file.readline().split()[1])
    except OSError:
        pass
    threads = len(os.sched_getaffinity(0))
    system = f"{platform.system()} {'.'.join(platform.release().split('.')[:2])}"
    return f"{model}, {threads} threads, {memory_kib / 2**20:.0f} GiB, {system}"
