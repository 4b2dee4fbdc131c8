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
CHUNK_EDGE = 256  # SPERR's default
HEADER_BYTES = 64  # the largest header of a SPERR chunk; SPERR's files exceed the requested size by their headers
ZFP_WORD_BYTES = 8  # a ZFP stream ends with a whole word


def zfp_block_bits(extent, size):
    """Returns the most whole bits per block of 4^3 voxels with which zfp's stream takes at most `size` bytes."""
    return 8 * (size - ZFP_WORD_BYTES) // math.prod(-(-n // 4) for n in extent)


@dataclasses.dataclass(frozen=True)
class Peer:
    """A mode of a compressor. The parameter x grows with the quality."""

    name: str
    title: str
    program: str
    command: str  # the program's path; empty if it is not found
    commit: str = ""

    slope = 1.0  # first guess of the dB per unit of x
    grain = 0.05  # the step of x
    direct_bytes = False  # whether the compressor can be given a size

    def start(self, psnr_db, value_range):
        """Returns the x at which the search for `psnr_db` begins."""
        del value_range
        return psnr_db

    def options(self, x, value_range):
        """Returns the options of the command line for the quality x."""
        raise NotImplementedError

    def options_for_size(self, volume, size):
        """Returns the options for at most `size` bytes. Only if direct_bytes is true."""
        raise NotImplementedError

    def encode(self, volume, source, stream, options, threads):
        """Returns the command that compresses the float32 file `source` to the file `stream`."""
        raise NotImplementedError

    def decode(self, volume, stream, output, options, threads):
        """Returns the command that decompresses to the float32 file `output`."""
        raise NotImplementedError

    def version(self):
        """Returns the version that the command prints, and the commit if it is known."""
        raise NotImplementedError

    def _with_commit(self, text):
        return f"{text} of {self.commit[:12]}" if self.commit else text


class Sperr(Peer):
    """SPERR: x is the requested PSNR in dB. A thread works on one chunk, by default of 256^3 voxels."""

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
    """SZ3: x is the error bound in dB below the range. Threads are set in its configuration file and cost bytes."""

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
    """ZFP without its header: with a header, zfp 1.0 crashes at some rates if it has several threads."""

    slope = 6.0

    def encode(self, volume, source, stream, options, threads):
        parallel = ["-x", f"omp={threads}"] if threads > 1 else []
        return [self.command, "-i", source, "-z", stream, "-f", "-3", *volume.extent, *options, *parallel]

    def decode(self, volume, stream, output, options, threads):
        del threads  # zfp 1.0 decompresses with one thread, as report.md says
        return [self.command, "-z", stream, "-f", "-3", *volume.extent, *options, "-o", output]

    def version(self):
        printed = subprocess.run([self.command], capture_output=True, text=True, check=False).stderr  # its usage
        number = re.search(r"zfp version (\S+)", printed)
        return f"zfp {number[1]}" if number else "zfp, whose version is not known"


class ZfpRate(Zfp):
    """ZFP's fixed-rate mode: x is the bits per voxel. A block of 64 voxels has a whole number of bits."""

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
    """ZFP's fixed-accuracy mode: the bound is 2^-x. ZFP distinguishes only powers of two."""

    grain = 1

    def start(self, psnr_db, value_range):
        return psnr_db / 6 - 3 - math.log2(value_range)

    def options(self, x, value_range):
        del value_range
        return ["-a", repr(2.0**-x)]


def find_peers(sperr=None, sz3=None, sperr_commit="", sz3_commit=""):
    """Returns all modes. A mode with an empty `command` is not installed."""
    def found(given, name):
        return str(given) if given else shutil.which(name) or ""

    zfp = found(None, "zfp")
    return (Sperr("sperr", "SPERR", "sperr3d", found(sperr, "sperr3d"), sperr_commit),
            Sz3("sz3", "SZ3", "sz3", found(sz3, "sz3"), sz3_commit),
            ZfpRate("zfp_rate", "ZFP's rate", "zfp", zfp), ZfpAccuracy("zfp_accuracy", "ZFP's accuracy", "zfp", zfp))
