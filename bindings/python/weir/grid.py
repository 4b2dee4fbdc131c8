"""weir.open and what it returns."""

from __future__ import annotations

import json
import os
from types import TracebackType
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Type, Union

import numpy
from numpy.typing import NDArray

from . import _core
from .conversion import Numbers, Path, Progress
from .errors import UsageError
from .indexing import select
from .options import LONGEST_BOX, described, given_options, input_bytes, is_url, size_text

if TYPE_CHECKING:
    import xarray

#: Positions beyond are outside any grid.
_FARTHEST = 2.0**31


class Macrocells(NamedTuple):
    """Bounds of the values that a filtered look-up in a cell of the grid can have."""

    cell: int  #: voxels along an edge
    origin: tuple[int, int, int]  #: (x, y, z) of the first cell's corner in voxels from the grid's; 0 or below
    min: NDArray[numpy.float32]  #: float32 [z, y, x], one for each cell
    max: NDArray[numpy.float32]  #: the same of the largest values


class Check(NamedTuple):
    """One thing that must hold of a file."""

    name: str
    found: str
    expected: str
    ok: bool


class Grid:
    """A NanoVDB file, mapped and checked; values are decoded where they are asked for. Made by weir.open.

    A grid is indexed like the array of its values: grid[60:70, :, -1], grid[::16, ::16, ::16], grid[5] and so on are
    float32 arrays, for which only the blocks of 8^3 voxels that hold them are decoded; numpy.asarray(grid) has all.
    Coordinates (x, y, z) are voxels from the grid's lowest corner; arrays are indexed [z, y, x]. All methods may be
    called from several threads. Arrays are the caller's own and outlive the grid. A grid is a context manager; once
    closed, it raises UsageError.
    """

    #: Else the first one of a packed file decodes all of it.
    _samples_decode_their_blocks = False

    def __init__(self, path: Path) -> None:
        name = input_bytes(path)
        self._path = os.fsdecode(name)
        self._absolute = os.path.abspath(self._path)
        self._core = _core.Grid(name)

    def __enter__(self) -> Grid:
        return self

    def __exit__(
        self,
        kind: Optional[Type[BaseException]],
        error: Optional[BaseException],
        traceback: Optional[TracebackType],
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return f"<weir.Grid {self._path!r}, closed>"
        stored = "packed" if self.packed else self.type
        return f"<weir.Grid {self._path!r}, {' x '.join(map(str, self.extent))}, {stored}>"

    def close(self) -> None:
        """Lets go of the file. Twice does no harm."""
        self._core.close()

    @property
    def closed(self) -> bool:
        """Whether close was called."""
        return self._core.closed

    @property
    def path(self) -> str:
        """As it was given, bytes as text; of a URL without the user, password and query."""
        return self._path

    @property
    def name(self) -> str:
        """Of the quantity, "density" for instance; may be empty."""
        return self._core.name

    @property
    def type(self) -> str:
        """How leaves are stored: "float32", "fpn", "fp4", "fp8" or "fp16"; where `packed`, the "float32" of the tree that
        other programs read."""
        return self._core.type

    @property
    def packed(self) -> bool:
        """Whether each 8^3 block is coded as a whole, by encoding="packed"."""
        return self._core.packed

    @property
    def extent(self) -> tuple[int, int, int]:
        """Voxels (x, y, z)."""
        return self._core.extent

    @property
    def shape(self) -> tuple[int, int, int]:
        """Of to_numpy(): voxels (z, y, x)."""
        x, y, z = self.extent
        return z, y, x

    @property
    def dtype(self) -> numpy.dtype[numpy.float32]:
        """Of to_numpy(): float32, whatever `type` is."""
        return numpy.dtype(numpy.float32)

    @property
    def ndim(self) -> int:
        """3."""
        return 3

    @property
    def size(self) -> int:
        """How many voxels there are."""
        x, y, z = self.extent
        return x * y * z

    def __len__(self) -> int:
        """Planes of constant z."""
        return self.shape[0]

    def __getitem__(self, key: Any) -> Any:
        """What to_numpy()[key] is, decoding only the blocks that hold it: a float32 array of the caller's own, or one
        numpy.float32 where `key` is (z, y, x).

        key
            Whole numbers, below 0 from the end, slices with any step, `...` and None, for the axes [z, y, x].

        Raises IndexError for a place outside of the grid, and for arrays as indices.
        """
        return self._read(key, 0)

    def _read(self, key: Any, level: int) -> Any:
        """What to_numpy(level=level)[key] is, as grid[key] of level 0."""
        chosen = select(key, self.level_shape(level))
        if 0 in chosen.count:
            return numpy.empty(chosen.shape, self.dtype)
        first, step, count, low, high = (part[::-1] for part in (*chosen[:3], chosen.low, chosen.high))
        if all(by == 1 for by in step):
            values = self._core.read(low, high, level)
        elif level == 0:
            values = self._core.read_strided(first, step, count)
        else:
            values = self._core.read(low, high, level)
            values = numpy.ascontiguousarray(values[tuple(slice(None, None, by) for by in chosen.step)])
        if values.shape == chosen.shape:
            return values
        return values.reshape(chosen.shape) if chosen.shape else values[0, 0, 0]

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        """to_numpy(), for numpy.asarray(grid) and functions of numpy. Raises ValueError for copy=False."""
        if copy is False:
            raise ValueError("copy is False, but the values of a grid are decoded into an array of their own")
        values = self.to_numpy()
        return values if dtype is None else values.astype(dtype, copy=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy in another process opens the file there."""
        return Grid, (self._absolute,)

    @property
    def index_origin(self) -> tuple[int, int, int]:
        """Index (x, y, z) of the lowest voxel in the file; not 0 where a region was converted."""
        return self._core.index_origin

    @property
    def spacing(self) -> tuple[float, float, float]:
        """World units per voxel (x, y, z)."""
        return self._core.spacing

    @property
    def origin(self) -> tuple[float, float, float]:
        """World position (x, y, z) of the centre of the voxel with index (0, 0, 0)."""
        return self._core.origin

    @property
    def background(self) -> float:
        """What lies outside; in files that weir made, the most frequent value of the histogram's fullest bin."""
        return self._core.background

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest value there is, as the file says; NaN where it says none."""
        return self._core.range

    @property
    def bytes(self) -> int:
        """Length of the file."""
        return self._core.bytes

    @property
    def sidecar(self) -> Optional[dict[str, Any]]:
        """What weir.convert returned, from the file beside this one; None where there is none.

        Raises InputError where it is damaged, or of another file.
        """
        text = self._core.sidecar()
        return None if text is None else json.loads(text)

    @property
    def certificate(self) -> Optional[dict[str, Any]]:
        """The sidecar's "error": mse, rmse, nmse, psnr_db (None: lossless), max_abs, lossless; None without a sidecar."""
        sidecar = self.sidecar
        return None if sidecar is None else sidecar["error"]

    @property
    def levels(self) -> int:
        """How many levels of detail to_numpy offers: 0 ... levels - 1."""
        return self._core.levels

    def level_shape(self, level: int) -> tuple[int, int, int]:
        """Shape of to_numpy(level=level): voxels (z, y, x) halved `level` times, rounded up."""
        is_number = isinstance(level, (int, numpy.integer)) and not isinstance(level, bool)
        if not is_number or not 0 <= level < self.levels:
            raise UsageError(f"level is {described(level)}, it must be a whole number from 0 to {self.levels - 1}")
        z, y, x = (-(-voxels >> int(level)) for voxels in self.shape)
        return z, y, x

    def to_numpy(self, roi: Any = None, level: int = 0) -> NDArray[numpy.float32]:
        """The values as float32 [z, y, x]: what a reader of the file decodes.

        roi
            Slices as of an array, numpy.s_[z0:z1, y0:y1, x0:x1], without steps, or corners ((x0, y0, z0),
            (x1, y1, z1)), x1 exclusive; to_numpy(s, k) is to_numpy(level=k)[s], and decodes only that.
        level
            Each value is the mean of the voxels in a cube of 2^level voxels along an edge (of those that are there, at
            the upper ends), NaN where one of them is. No more than some rows of the volume are held meanwhile.

        Raises UsageError for a roi outside of the grid and a level that it does not have, InputError where the file was
        written to since it was opened, as all that reads values.
        """
        low, high = _box_of(roi, self.level_shape(level))
        return self._core.read(low, high, level)

    def to_xarray(self, level: int = 0) -> xarray.DataArray:
        """The values as an xarray.DataArray [z, y, x], which decodes what is asked of it, when it is asked.

        Coordinates are world positions of the voxels' centres, or the source's own where these are not equally spaced;
        with name, units, long_name, time and names of the axes as the sidecar keeps them. level, as of to_numpy. Wants
        python3-xarray; the grid must stay open. xarray.open_dataset("a.nvdb", engine="weir") opens a file like this.
        """
        from .xarray_backend import data_array

        return data_array(self, level)

    def sample(self, points: Any, filter: str = "trilinear") -> NDArray[numpy.float32]:
        """Values at positions in voxels: float32, one for each (x, y, z) along the last axis of `points`.

        Voxel i covers [i, i + 1), its centre is at i + 0.5; positions outside are clamped to the grid. "trilinear"
        blends the 8 voxels around a position, which it rounds to float32; "nearest" takes the one that covers it.
        Beyond 2^23 voxels along an axis float32 has no position of each voxel: to_numpy(roi) reads it. Raises UsageError
        for positions that are no numbers, or NaN.
        """
        if filter not in ("trilinear", "nearest"):
            raise UsageError(f"filter is {filter!r}, it must be 'trilinear' or 'nearest'")
        if isinstance(points, numpy.ma.MaskedArray):
            raise UsageError("points is a masked array; give points.filled(VALUE), or leave the masked positions out")
        try:
            given = numpy.asarray(points)
            if given.dtype.kind not in "iuf":
                raise TypeError
            if given.dtype != numpy.float32:
                given = given.astype(numpy.float64).clip(-_FARTHEST, _FARTHEST)
                # The centre of the voxel that covers a position: rounded first, it could be the next voxel's.
                given = given if filter == "trilinear" else numpy.floor(given) + 0.5
            positions = numpy.asarray(given, dtype=numpy.float32, order="C")
        except (TypeError, ValueError):
            raise UsageError(f"points is {described(points)}, it must be numbers, (x, y, z) along the last axis") from None
        if positions.ndim == 0 or positions.shape[-1] != 3:
            raise UsageError(f"points has the shape {positions.shape}, its last axis must be (x, y, z)")
        if numpy.isnan(positions).any():
            raise UsageError("points has a position that is NaN; leave it out")
        return self._core.sample(positions.reshape(-1, 3), filter == "trilinear").reshape(positions.shape[:-1])

    def macrocells(self) -> Macrocells:
        """Bounds of the values in cells of 16^3 voxels and one voxel around each: the file's, else gathered from it, which
        decodes all of it. Raises UsageError for a file elsewhere that has none.
        """
        return Macrocells(*self._core.macrocells())

    def verify(self, progress: Optional[Progress] = None) -> list[Check]:
        """All checks of `weir verify`: structure, checksums, and what file and sidecar say of each other.

        Reads all of the file. It is whole where all(check.ok for check in grid.verify()). progress is called with the pass,
        and its bytes done and in all. Raises InputError where another file is at `path` by now.
        """
        return [Check(*check) for check in self._core.verify(progress)]

    def render(
        self,
        *,
        mode: Optional[str] = None,
        size: Union[str, Sequence[int]] = (960, 720),
        spp: Optional[int] = None,
        seed: Optional[int] = None,
        scene: Optional[Path] = None,
        filter: Optional[str] = None,
        colormap: Optional[str] = None,
        colorbar: bool = False,
        range: Optional[Numbers] = None,
        iso: Optional[float] = None,
        camera: Optional[Numbers] = None,
        lod: Optional[Union[float, str]] = None,
        lod_scattered: Optional[float] = None,
        backend: Optional[str] = None,
        devices: Optional[Union[int, Sequence[int]]] = None,
        threads: Optional[int] = None,
        memory: Optional[Union[int, str]] = None,
        device_memory: Optional[Union[int, str]] = None,
        linear: bool = False,
        progress: Optional[Progress] = None,
    ) -> NDArray[Any]:
        """The picture that `weir render` makes, [y, x, RGB] with rows from the top.

        mode "path", "dvr", "iso" or "mip"; size (width, height), or "960x720"; spp, samples a pixel; seed of their
        random numbers; camera (azimuth, elevation) or (azimuth, elevation, zoom), in degrees; colormap, a name
        ("viridis" for instance); colorbar, whether the colours with their values, name and units stand at the right
        of the picture, which is wider by them; range (low, high) of colours and opacity; iso, the surface's value;
        scene, the path of a scene file, which the others overrule; filter "trilinear", "stochastic" or "nearest";
        lod, level of detail, "auto", "off" or that many levels coarser, and lod_scattered, further levels of light that
        mode "path" scatters; backend "auto", "cpu" or "cuda"; devices, numbers of CUDA devices that share the samples;
        threads, 0: all; memory, bytes or "512MiB", of the CPU, and device_memory of each device: a packed file that
        decodes to more is rendered from a cache. Returns uint8 sRGB or, where `linear`, float32 radiance before tone
        mapping. progress is called with "render" and samples. Raises UsageError for a keyword that is out of its range, and
        for a memory that is too small.
        """
        if linear and colorbar:
            raise UsageError("linear asks for radiance, colorbar for colours as a screen shows them; give one of them")
        options = given_options(
            mode=mode,
            size=size_text(size),
            spp=spp,
            seed=seed,
            scene=scene,
            filter=filter,
            colormap=colormap,
            colorbar=colorbar,
            range=range,
            iso=iso,
            camera=camera,
            lod=lod,
            lod_scattered=lod_scattered,
            backend=backend,
            devices=devices,
            threads=threads,
            memory=memory,
            device_memory=device_memory,
        )
        return self._core.render(options, linear, progress)


def open(path: Path, *, cache: Union[int, str] = "256MiB", storage_options: Optional[dict[str, Any]] = None) -> Grid:
    """Opens a NanoVDB file; of several grids in it the first.

    path
        Of a file, or a URL: "https://host/run/step_0042.nvdb", and what fsspec opens ("s3://...", "memory://..."). Of a
        packed file elsewhere, only the head and the blocks that are asked for are read: a RemoteGrid.
    cache
        Of a URL: bytes of the file, or "256MiB", above which what was read is forgotten when other blocks are asked for.
    storage_options
        Of a URL: what fsspec's file system takes; http and https go through fsspec, too, where there are others than
        "headers".

    Raises InputError where it is no valid one; where it is missing or may not be read, that is a FileNotFoundError or
    PermissionError too. An empty path is a UsageError.
    """
    from .remote import RemoteGrid

    if is_url(path):
        return RemoteGrid(str(path), cache=cache, storage_options=storage_options)
    if storage_options:
        raise UsageError(f"storage_options are for URLs, and {os.fspath(path)!r} is a path")
    return Grid(path)


def _box_of(roi: Any, shape: Sequence[int]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Corners (x, y, z) of what `roi` asks of an array of `shape` [z, y, x]."""
    if roi is None:
        return (0, 0, 0), tuple(shape[::-1])
    shown = described(roi, LONGEST_BOX)
    bad = UsageError(
        f"roi is {shown}, it must be three slices [z0:z1, y0:y1, x0:x1] without steps, or ((x0, y0, z0), (x1, y1, z1))"
    )
    try:
        parts = (roi,) if isinstance(roi, slice) else tuple(roi)
        if any(isinstance(part, slice) for part in parts):
            parts = parts + (slice(None),) * (3 - len(parts))
            ends = [part.indices(count) for part, count in zip(parts, shape, strict=True)]
            if any(step != 1 for _, _, step in ends):
                raise bad
            low, high = ([end[i] for end in ends[::-1]] for i in (0, 1))
        else:
            low, high = ([_whole(end) for end in corner] for corner in parts)
            if len(low) != 3 or len(high) != 3:
                raise bad
    except (AttributeError, OverflowError, TypeError, ValueError):
        raise bad from None
    if not all(0 <= a < b <= count for a, b, count in zip(low, high, shape[::-1])):
        raise UsageError(
            f"roi is {shown}, it must hold a voxel and lie in the {' x '.join(map(str, shape[::-1]))} (x, y, z) there are"
        )
    return tuple(low), tuple(high)


def _whole(number: Any) -> int:
    if int(number) != number:
        raise ValueError
    return int(number)
