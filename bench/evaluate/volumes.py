"""The volumes that are measured: real ones of ../shared/data, and stand-ins of the paper's by `weir sample`.

The paper is S. Zellmann, M. Jaros, J. Amstutz, I. Wald, GPU Volume Rendering with Hierarchical Compression Using VDB,
EGPGV 2025.
"""

import array
import contextlib
import dataclasses
import lzma
import os
import pathlib
import shutil
import sys

from phantom import write_phantom

_TYPE_CODES = {"uint8": "B", "int16": "h", "uint16": "H", "float32": "f"}
_LARGE_BYTES = 1 << 30  # as float32: the raw file of a larger volume is deleted after each use
PHANTOM = "phantom"  # the kind that phantom.py makes


@dataclasses.dataclass(frozen=True)
class Volume:
    name: str
    extent: tuple  # voxels x, y, z
    type: str
    kind: str = ""  # a kind of `weir sample`, or PHANTOM; empty for a real volume, which is unpacked
    note: str = ""  # the description in the report

    @property
    def file_name(self):
        return f"{self.name}_{self.size_text}_{self.type}.raw"

    @property
    def size_text(self):
        return "x".join(str(n) for n in self.extent)

    @property
    def voxels(self):
        return self.extent[0] * self.extent[1] * self.extent[2]

    @property
    def dense_bytes(self):
        """The volume's bytes as float32, to which rates refer."""
        return 4 * self.voxels


def scaled(name, extent, kind, note, scale):
    return Volume(name, tuple(max(1, round(n / scale)) for n in extent), "float32", kind, note)


def wdas_like(scale):
    note = "the WDAS cloud's place: a sparse cumulus, exact zero around it"
    return scaled("wdas-like", (1987, 1351, 2449), "cloud", note, scale)


def vorticity_like(scale):
    note = "the vorticity's place: turbulence of both signs in a part of the box, exact zero around it"
    return scaled("vorticity-like", (2450, 1162, 4000), "signed", note, scale)


def magnetic_like(edge):
    note = "the magnetic field's place: dense turbulence of magnitude 1e-16"
    return Volume("magnetic-like", (edge, edge, edge), "float32", "tiny", note)


def ct_like(edge):
    note = "a phantom of shells with a gentle texture and noise in every voxel"
    return Volume("ct-like", (edge, edge, edge), "uint16", PHANTOM, note)


def cube(kind, edge):
    return Volume(kind, (edge, edge, edge), "float32", kind)


_REAL = (
    Volume("aneurism", (256, 256, 256), "uint8", note="rotational angiography, very sparse (Philips Research)"),
    Volume("mni152_2009", (193, 229, 193), "int16", note="average of 152 heads, magnetic resonance (MNI ICBM152 2009)"),
    Volume("tooth", (103, 94, 161), "uint8", note="computed tomography, noisy background that is not zero (GE)"),
    Volume("wmag", (91, 91, 91), "float32", note="vortex tubes of a turbulent flow, smooth and dense (NCAR, SPERR)"),
)


def real_set():
    return list(_REAL)


def integer_set():
    """Whole numbers, of the table of lossless files."""
    return [*(volume for volume in _REAL if volume.type != "float32"), ct_like(256)]


def small_integer_set():
    return [ct_like(48)]


def few_bytes_set(edge):
    """What the tables of few bytes show besides the real ones: smooth, sparse, and both."""
    return [
        Volume("cloud", (edge, edge, edge), "float32", "cloud", "a sparse cumulus, exact zero around it"),
        Volume("turbulence", (edge, edge, edge), "float32", "turbulence", "dense, of both signs"),
        Volume("vorticity-like", (edge, edge, edge), "float32", "signed",
               "turbulence of both signs in a ball, exact zero around it"),
        Volume("jet-like", (edge, edge, edge), "float32", "background",
               "turbulence in a ball, a value that is not zero around it"),
    ]


def small_set():
    """Returns small volumes for the tests, each a moment's work."""
    return [wdas_like(16), magnetic_like(96)]


def report_set(scale):
    """What the tables of errors show."""
    return [
        *_REAL,
        wdas_like(scale),
        Volume("heptane-like", (302, 302, 302), "uint8", "cloud", "the heptane fire's place: a sparse plume of 8 bits"),
        vorticity_like(scale),
        magnetic_like(256),
    ]


def full_set():
    """At the paper's extents: 26 GB and 46 GB."""
    return [wdas_like(1), vorticity_like(1)]


class VolumeFiles:
    """Makes missing files of volumes in DIR/volumes. They stay, except raw files of large volumes."""

    def __init__(self, directory, data, weir):
        self.directory = pathlib.Path(directory) / "volumes"
        self._data = pathlib.Path(data)
        self._weir = weir

    def available(self, volume, copies=2.2):
        """Returns whether the volume can be made and, if it is large, the disk has room for `copies` times its size.
        Prints the reason if not."""
        if not volume.kind and not self._archive(volume).exists():
            print(f"{volume.name}: skipped, {self._archive(volume)} is missing", file=sys.stderr)
            return False
        free = shutil.disk_usage(self.directory.parent).free
        if volume.dense_bytes > _LARGE_BYTES and free < copies * volume.dense_bytes:
            needed = copies * volume.dense_bytes
            print(f"{volume.name}: skipped, {volume.size_text} needs {needed / 1e9:.0f} GB of disk, "
                  f"{free / 1e9:.0f} are free", file=sys.stderr)
            return False
        return True

    @contextlib.contextmanager
    def file(self, volume):
        """Returns the path of the raw file of `volume`."""
        path = self.directory / volume.file_name
        self._make(path, lambda partial: self._fill(volume, partial))
        try:
            yield path
        finally:
            if volume.dense_bytes > _LARGE_BYTES:
                path.unlink(missing_ok=True)

    @contextlib.contextmanager
    def float32_file(self, volume):
        """Returns the path of the same values as float32, for programs that read only float32."""
        with self.file(volume) as path:
            if volume.type == "float32":
                yield path
                return
            wide = dataclasses.replace(volume, type="float32")
            wide_path = self.directory / wide.file_name
            self._make(wide_path, lambda partial: _widen(path, volume.type, partial))
            yield wide_path

    def data_file(self, name):
        """Returns the path of another file of the real data. Prints a line and returns None if it is missing."""
        path = self._data / name
        if path.exists():
            return path
        print(f"skipped, {path} is missing", file=sys.stderr)
        return None

    def _archive(self, volume):
        return self._data / (volume.file_name + ".xz")

    def _make(self, path, fill):
        if path.exists():
            return
        self.directory.mkdir(parents=True, exist_ok=True)
        partial = path.with_name("." + path.name)
        partial.unlink(missing_ok=True)
        fill(partial)
        os.replace(partial, path)

    def _fill(self, volume, partial):
        if volume.kind == PHANTOM:
            write_phantom(partial, volume.extent, self._weir)
        elif volume.kind:
            dims = ",".join(str(n) for n in volume.extent)
            self._weir.run("sample", volume.kind, "--dims", dims, "--type", volume.type, "-o", partial)
        else:
            with lzma.open(self._archive(volume)) as packed, open(partial, "wb") as raw:
                shutil.copyfileobj(packed, raw, 1 << 20)


def _widen(path, scalar_type, partial):
    with open(path, "rb") as narrow, open(partial, "wb") as wide:
        while block := narrow.read(1 << 22):
            array.array("f", array.array(_TYPE_CODES[scalar_type], block)).tofile(wide)
