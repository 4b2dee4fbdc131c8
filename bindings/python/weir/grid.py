"""weir.open and the Grid that it returns."""

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
from .options import LONGEST_BOX, checked_progress, described, given_options, input_bytes, is_url, size_text

if TYPE_CHECKING:
    import xarray

#: Sample positions are clipped to +-_FARTHEST voxels, which lies outside any grid.
_FARTHEST = 2.0**31


class Macrocells(NamedTuple):
    """Bounds of the values that a filtered look-up in each cell of a grid can return."""

    cell: int  #: voxels along an edge
    origin: tuple[int, int, int]  #: the first cell's corner (x, y, z) in voxels from the grid's corner; 0 or below
    min: NDArray[numpy.float32]  #: the smallest value of each cell, float32 [z, y, x]
    max: NDArray[numpy.float32]  #: the largest value of each cell, float32 [z, y, x]


class Check(NamedTuple):
    """One check of Grid.verify: its name, the value found, the value expected, and whether they agree."""

    name: str
    found: str
    expected: str
    ok: bool


class Grid:
    """A mapped and checked NanoVDB file. Values are decoded on request. weir.open makes a Grid.

    A grid is indexed like the array of its values: grid[60:70, :, -1], grid[::16, ::16, ::16] and grid[5] are float32
    arrays. Only the blocks of 8^3 voxels that hold the requested values are decoded. numpy.asarray(grid) returns all
    values. Coordinates (x, y, z) are voxels from the grid's lowest corner; arrays are indexed [z, y, x]. All methods
    may be called from several threads. Returned arrays belong to the caller and outlive the grid. A grid is a context
    manager. A closed grid raises UsageError.
    """

    #: Whether sample() decodes only the blocks that it needs. If not, the first call decodes all of a packed file.
    _samples_decode_their_blocks = False

    def __init__(self, path: Path) -> None:
        name = input_bytes(path)
        self._path = os.fsdecode(name)
        self._absolute = os.path.abspath(self._path)
        self._core = _core.Grid(name)

    def __enter__(self) -> Grid:
        self._refuse_closed()
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
        """Releases the file. Closing twice is allowed."""
        self._core.close()

    @property
    def closed(self) -> bool:
        """Whether close was called."""
        return self._core.closed

    def _refuse_closed(self) -> None:
        """Raises UsageError if the grid is closed."""
        if self.closed:
            raise UsageError(f"{self._path}: is closed; open it again with weir.open")

    @property
    def path(self) -> str:
        """The path that was opened, as text. A URL is shown without user, password and query."""
        return self._path

    @property
    def name(self) -> str:
        """The name of the quantity, for example "density"; may be empty."""
        return self._core.name

    @property
    def type(self) -> str:
        """How leaves are stored: "float32", "fpn", "fp4", "fp8" or "fp16". A `packed` file says "float32", the type
        of the tree that other programs read."""
        return self._core.type

    @property
    def packed(self) -> bool:
        """Whether the file was made with encoding="packed", which codes each block of 8^3 voxels as a whole."""
        return self._core.packed

    @property
    def extent(self) -> tuple[int, int, int]:
        """The number of voxels along (x, y, z)."""
        return self._core.extent

    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of to_numpy(): voxels (z, y, x)."""
        x, y, z = self.extent
        return z, y, x

    @property
    def dtype(self) -> numpy.dtype[numpy.float32]:
        """The dtype of to_numpy(): float32, whatever `type` is."""
        return numpy.dtype(numpy.float32)

    @property
    def ndim(self) -> int:
        """The number of axes: 3."""
        return 3

    @property
    def size(self) -> int:
        """The number of voxels."""
        x, y, z = self.extent
        return x * y * z

    def __len__(self) -> int:
        """The number of planes of constant z."""
        return self.shape[0]

    def __getitem__(self, key: Any) -> Any:
        """Returns to_numpy()[key] as a new float32 array, or as one numpy.float32 if `key` is (z, y, x). Decodes only
        the blocks that hold these values.

        key
            Integers (negative ones count from the end), slices with any step, `...` and None, for the axes [z, y, x].

        Raises IndexError for positions outside the grid and for arrays as indices.
        """
        return self._read(key, 0)

    def _read(self, key: Any, level: int) -> Any:
        """Returns to_numpy(level=level)[key]; for level 0 this is grid[key]."""
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
        """Returns to_numpy(), for numpy.asarray(grid) and numpy's functions. Raises ValueError for copy=False."""
        if copy is False:
            raise ValueError("copy is False, but the values of a grid are decoded into an array of their own")
        values = self.to_numpy()
        return values if dtype is None else values.astype(dtype, copy=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the grid as its path. Unpickling in another process opens the file there."""
        self._refuse_closed()
        return Grid, (self._absolute,)

    @property
    def index_origin(self) -> tuple[int, int, int]:
        """Index (x, y, z) of the lowest voxel in the file. Not 0 if only a region was converted."""
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
        """The value outside the grid; weir's default is the most frequent value in the histogram's fullest bin."""
        return self._core.background

    @property
    def range(self) -> tuple[float, float]:
        """The smallest and the largest value, as the file states them. NaN if the file does not state them."""
        return self._core.range

    @property
    def bytes(self) -> int:
        """The length of the file in bytes."""
        return self._core.bytes

    @property
    def sidecar(self) -> Optional[dict[str, Any]]:
        """What weir.convert returned, read from the sidecar beside this file. None if there is no sidecar.

        Raises InputError if the sidecar is damaged or belongs to another file.
        """
        text = self._core.sidecar()
        return None if text is None else json.loads(text)

    @property
    def certificate(self) -> Optional[dict[str, Any]]:
        """The sidecar's "error": mse, rmse, nmse, psnr_db (None: lossless), max_abs, lossless. None if no sidecar."""
        sidecar = self.sidecar
        return None if sidecar is None else sidecar["error"]

    @property
    def levels(self) -> int:
        """The number of levels of detail that to_numpy offers: 0 ... levels - 1."""
        return self._core.levels

    def level_shape(self, level: int) -> tuple[int, int, int]:
        """Returns the shape of to_numpy(level=level): voxels (z, y, x) halved `level` times, rounded up."""
        is_number = isinstance(level, (int, numpy.integer)) and not isinstance(level, bool)
        if not is_number or not 0 <= level < self.levels:
            raise UsageError(f"level is {described(level)}, it must be a whole number from 0 to {self.levels - 1}")
        z, y, x = (-(-voxels >> int(level)) for voxels in self.shape)
        return z, y, x

    def to_numpy(self, roi: Any = None, level: int = 0) -> NDArray[numpy.float32]:
        """Returns the decoded values as float32 [z, y, x].

        roi
            Slices without steps, numpy.s_[z0:z1, y0:y1, x0:x1], or corners ((x0, y0, z0), (x1, y1, z1)), x1
            exclusive. to_numpy(s, k) equals to_numpy(level=k)[s], but decodes only that part.
        level
            Each value is the mean of a cube with 2^level voxels along an edge. At the upper ends of the axes the mean
            is over the voxels that exist. It is NaN if one of them is NaN. Only some rows of the volume are held in
            memory.

        Raises UsageError for a roi outside the grid and for a level that the grid does not have. Like everything that
        reads values, raises InputError if the file was written to since it was opened.
        """
        low, high = _box_of(roi, self.level_shape(level))
        return self._core.read(low, high, level)

    def to_xarray(self, level: int = 0) -> xarray.DataArray:
        """Returns the values as an xarray.DataArray [z, y, x] that decodes values when they are used.

        Coordinates are the world positions of the voxels' centres, or the source's own coordinates if these are not
        equally spaced. Name, units, long_name, time and the names of the axes come from the sidecar. `level` is as
        for to_numpy. Needs python3-xarray. The grid must stay open. xarray.open_dataset("a.nvdb", engine="weir")
        opens a file in the same way.
        """
        from .xarray_backend import data_array

        return data_array(self, level)

    def sample(self, points: Any, filter: str = "trilinear") -> NDArray[numpy.float32]:
        """Returns the values at positions in voxels: float32, one for each (x, y, z) along the last axis of `points`.

        Voxel i covers [i, i + 1) and has its centre at i + 0.5. Positions outside are clamped to the grid.
        "trilinear" rounds a position to float32 and blends the 8 voxels around it; "nearest" takes the voxel that
        covers the position. Beyond 2^23 voxels along an axis, float32 cannot express the position of every voxel;
        to_numpy(roi) reads such voxels. Raises UsageError for positions that are not numbers or are NaN.
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
                # "nearest" samples at the centre of the covering voxel, found in float64. Rounding the position to
                # float32 first could move it into the next voxel.
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
        """Returns bounds of the values in cells of 16^3 voxels and one voxel around each cell. If the file has no
        such bounds, they are gathered by decoding the whole file. Raises UsageError for a remote file without them.
        """
        return Macrocells(*self._core.macrocells())

    def verify(self, progress: Optional[Progress] = None) -> list[Check]:
        """Runs all checks of `weir verify`: structure, checksums, and whether file and sidecar agree.

        Reads the whole file. The file is intact if all(check.ok for check in grid.verify()). progress is called with
        the pass, its bytes done and their total. Raises InputError if another file is now at `path`.
        """
        return [Check(*check) for check in self._core.verify(checked_progress(progress))]

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
        """Returns the picture that `weir render` makes, [y, x, RGB] with rows from the top: uint8 sRGB, or float32
        radiance before tone mapping if `linear` is true.

        mode: "path", "dvr", "iso" or "mip".
        size: (width, height) in pixels, or "960x720".
        spp, seed: the samples per pixel, and the seed of their random numbers.
        scene: the path of a scene file. The other keywords overrule it.
        filter: "trilinear", "stochastic" or "nearest".
        colormap: the name of a colour map, for example "viridis".
        colorbar: whether a bar with the colours, their values, name and units is added at the right of the picture.
        range: (low, high), the values that colours and opacity span.
        iso: the value of the surface.
        camera: (azimuth, elevation) in degrees, or (azimuth, elevation, zoom).
        lod: the level of detail: "auto", "off" (the default), or how many levels coarser (negative: finer).
        lod_scattered: for mode "path" with lod "auto" or a number: further levels coarser for light after its first
        scattering and on its way from a light source.
        backend: "auto", "cpu" or "cuda".
        devices: the numbers of the CUDA devices that share the samples.
        threads: the number of threads; 0 means one for each core.
        memory: the CPU's limit, bytes or a text such as "512MiB"; by default what is available. A packed file that
        decodes to more is rendered from a cache: the same picture, more slowly.
        device_memory: the same for each CUDA device and any volume; by default what is free.
        progress: called with "render", the samples done and their total.

        Raises UsageError for a keyword that is out of its range and for a memory that is too small.
        """
        if linear and colorbar:
            raise UsageError("linear asks for radiance, colorbar for colours as a screen shows them; give one of them")
        if isinstance(devices, (Sequence, numpy.ndarray)) and numpy.size(devices) == 0:
            raise UsageError("devices is an empty list; name a device in it, or leave it out")
        checked_progress(progress)
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


def open(
    path: Path, *, cache: Optional[Union[int, str]] = None, storage_options: Optional[dict[str, Any]] = None
) -> Grid:
    """Opens a NanoVDB file. If the file holds several grids, opens the first.

    path
        The path of a file, or a URL: "https://host/run/step_0042.nvdb", or any URL that fsspec opens ("s3://...",
        "memory://..."). A URL must name a packed file and returns a RemoteGrid, which reads only the head and the
        requested blocks.
    cache
        For a URL: how many bytes of the file are kept, or a text such as "256MiB", the default. Beyond this size,
        blocks that were read are forgotten when other blocks are requested.
    storage_options
        For a URL: the options of fsspec's file system. http and https also go through fsspec if there are options
        other than "headers".

    Raises InputError if the file is not valid. The error for a missing or unreadable file is also a FileNotFoundError
    or PermissionError. Raises UsageError for an empty path, and TypeError for what is no path.
    """
    from .remote import RemoteGrid

    if is_url(path):
        return RemoteGrid(str(path), "256MiB" if cache is None else cache, storage_options)
    for option, given in (("storage_options are", bool(storage_options)), ("cache is", cache is not None)):
        if given:
            raise UsageError(f"{option} for URLs, and {os.fspath(path)!r} is a path")
    return Grid(path)


def _box_of(roi: Any, shape: Sequence[int]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Returns the corners (x, y, z) of the box that `roi` selects in an array of `shape` [z, y, x]."""
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
