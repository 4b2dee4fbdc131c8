"""Compressors of others, by their command lines: parameters, both directions, and what they say of their version.

SPERR's `sperr3d` and SZ3's `sz3` are built by the user, from public sources, and found by --sperr and --sz3 or on PATH;
`zfp` is Debian's package of that name. Each holds the whole volume in memory and reads float32.
"""

import dataclasses
import math
import pathlib
import re
import shutil
import subprocess

from programs import ProgramFailed, run

FLOAT_BITS = 32
CHUNK_EDGE = 256  # of SPERR's default
HEADER_BYTES = 64  # of a chunk, at most: what SPERR's files are longer than they are asked to be
ZFP_WORD_BYTES = 8  # its streams end with a whole one


def zfp_block_bits(extent, size):
    """The most whole bits for each block of 4^3 with which zfp's stream takes at most `size` bytes."""
    return 8 * (size - ZFP_WORD_BYTES) // math.prod(-(-n // 4) for n in extent)


@dataclasses.dataclass(frozen=True)
class Peer:
    """A mode of a compressor. Its parameter x grows with quality."""

    name: str
    title: str
    program: str
    command: str  # path, empty where it is not found
    commit: str = ""

    slope = 1.0  # dB for each unit of x, as a first guess
    grain = 0.05  # of x
    direct_bytes = False  # whether a size can be asked for

    def start(self, psnr_db, value_range):
        """x to begin the search for that many dB with."""
        del value_range
        return psnr_db

    def options(self, x, value_range):
        """Of its command line, for the quality x."""
        raise NotImplementedError

    def options_for_size(self, volume, size):
        """The same for at most `size` bytes, where direct_bytes."""
        raise NotImplementedError

    def encode(self, volume, source, stream, options, threads):
        """The command that compresses float32 in file `source` to file `stream`."""
        raise NotImplementedError

    def decode(self, volume, stream, output, options, threads):
        """The command that decompresses to float32 in file `output`."""
        raise NotImplementedError

    def version(self):
        """What the command says of itself, and the commit where it is known."""
        raise NotImplementedError

    def _with_commit(self, text):
        return f"{text} of {self.commit[:12]}" if self.commit else text


class Sperr(Peer):
    """x: dB that it is asked for. A chunk of its default, 256^3, is a thread's."""

    direct_bytes = True

    def options(self, x, value_range):
        del value_range
        return ["--psnr", f"{x:.4f}"]

    def options_for_size(self, volume, size):
        chunks = math.prod(-(-n // CHUNK_EDGE) for n in volume.extent)
        return ["--bpp", f"{8 * (size - HEADER_BYTES * chunks) / volume.voxels:.6f}"]

    def encode(self, volume, source, stream, options, threads):
        return [self.command, "-c", source, "--ftype", FLOAT_BITS, "--dims", *volume.extent, "--omp", threads, *options,
                "--bitstream", stream]

    def decode(self, volume, stream, output, options, threads):
        del volume, options
        return [self.command, "-d", stream, "--omp", threads, "--decomp_f", output]

    def version(self):
        teller = pathlib.Path(self.command).with_name("show_version")  # built beside it
        printed = run([teller]).out if teller.exists() else ""
        number = re.search(r"SPERR version: *(\S+)", printed)
        return self._with_commit(f"SPERR {number[1]}" if number else "SPERR, whose version is not known")


class Sz3(Peer):
    """x: the bound below the range, in dB. Several threads are an option of its configuration file, and cost bytes."""

    def start(self, psnr_db, value_range):
        return psnr_db - 6

    def options(self, x, value_range):
        return ["-M", "ABS", repr(value_range * 10 ** (-x / 20))]

    def encode(self, volume, source, stream, options, threads):
        parallel = []
        if threads > 1:
            config = pathlib.Path(stream).with_suffix(".config")
            config.write_text("[GlobalSettings]\nOpenMP = Yes\n")
            parallel = ["-c", config]
        return [self.command, "-f", "-i", source, "-z", stream, "-3", *volume.extent, *parallel, *options]

    def decode(self, volume, stream, output, options, threads):
        del options, threads  # as it was compressed
        return [self.command, "-f", "-z", stream, "-o", output, "-3", *volume.extent]

    def version(self):
        try:
            printed = run([self.command, "-v"]).out
        except ProgramFailed:
            printed = ""
        number = re.search(r"SZ3 Version: *(\S+)", printed)
        return self._with_commit(f"SZ3 {number[1]}" if number else "SZ3, whose version is not known")


class Zfp(Peer):
    """Without its header, with which zfp 1.0 crashes at some rates where it has several threads."""

    slope = 6.0

    def encode(self, volume, source, stream, options, threads):
        parallel = ["-x", f"omp={threads}"] if threads > 1 else []
        return [self.command, "-i", source, "-z", stream, "-f", "-3", *volume.extent, *options, *parallel]

    def decode(self, volume, stream, output, options, threads):
        del threads  # zfp 1.0 decompresses by one, as report.md says
        return [self.command, "-z", stream, "-f", "-3", *volume.extent, *options, "-o", output]

    def version(self):
        printed = subprocess.run([self.command], capture_output=True, text=True, check=False).stderr  # its usage
        number = re.search(r"zfp version (\S+)", printed)
        return f"zfp {number[1]}" if number else "zfp, whose version is not known"


class ZfpRate(Zfp):
    """x: bits a voxel; a block of 64 has a whole number of them."""

    grain = 1 / 64
    direct_bytes = True

    def start(self, psnr_db, value_range):
        del value_range
        return psnr_db / 12

    def options(self, x, value_range):
        del value_range
        return ["-r", repr(max(x, self.grain))]

    def options_for_size(self, volume, size):
        return ["-r", repr(max(1, zfp_block_bits(volume.extent, size)) / 64)]


class ZfpAccuracy(Zfp):
    """x: the bound is the power of two 2^-x, which is all that it tells apart."""

    grain = 1

    def start(self, psnr_db, value_range):
        return psnr_db / 6 - 3 - math.log2(value_range)

    def options(self, x, value_range):
        del value_range
        return ["-a", repr(2.0**-x)]


def find_peers(sperr=None, sz3=None, sperr_commit="", sz3_commit=""):
    """All modes; those whose `command` is empty are not to be had."""
    def found(given, name):
        return str(given) if given else shutil.which(name) or ""

    zfp = found(None, "zfp")
    return (Sperr("sperr", "SPERR", "sperr3d", found(sperr, "sperr3d"), sperr_commit),
            Sz3("sz3", "SZ3", "sz3", found(sz3, "sz3"), sz3_commit),
            ZfpRate("zfp_rate", "ZFP's rate", "zfp", zfp), ZfpAccuracy("zfp_accuracy", "ZFP's accuracy", "zfp", zfp))
