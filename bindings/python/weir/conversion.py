"""Implements weir.convert: checks its arguments and passes files or arrays to the C++ module _core."""

from __future__ import annotations

import json
import os
import re
from typing import TYPE_CHECKING, Any, Callable, Optional, Sequence, Union

import numpy
from numpy.typing import NDArray

from . import _core
from .device import DeviceArray, array_of, is_array_elsewhere
from .errors import UsageError
from .labelled import is_data_array, take_apart
from .options import (
    box_text,
    checked_progress,
    described,
    given_options,
    input_bytes,
    is_url,
    path_bytes,
    shown_url,
    text_of,
)
from .undecoded import missing_number

if TYPE_CHECKING:
    import xarray

#: A callback that gets the pass ("survey", "encode", "certify"), the float32 bytes of the pass that are done, and
#: their total. If the source is a .nvdb file, the first pass is "check", which counts the file's bytes.
Progress = Callable[[str, int, int], Any]
Path = Union[str, "os.PathLike[str]"]
Size = Union[int, str]  #: bytes, or "64MiB", "1.5GB"
Numbers = Sequence[float]

_TYPES = {"bool": "uint8"} | {
    name: name
    for name in "uint8 int8 uint16 int16 uint32 int32 uint64 int64 float16 float32 float64 bfloat16".split()
}


def convert(
    source: Union[Path, NDArray[Any], "xarray.DataArray", Any],
    output: Optional[Path] = None,
    *,
    rate: Optional[float] = None,
    size: Optional[Size] = None,
    psnr: Optional[float] = None,
    max_error: Optional[float] = None,
    lossless: bool = False,
    at_most: bool = False,
    encoding: Optional[str] = None,
    preview: Optional[str] = None,
    metric: Optional[str] = None,
    fill: Optional[str] = None,
    background: Union[float, str, None] = None,
    brick: Optional[int] = None,
    preset: Optional[str] = None,
    nonfinite: Optional[str] = None,
    scene: Optional[Path] = None,
    certify: Optional[str] = None,
    spacing: Optional[Numbers] = None,
    origin: Optional[Numbers] = None,
    missing: Union[float, str, None] = None,
    missing_policy: Optional[str] = None,
    roi: Any = None,
    ghost: Union[int, Sequence[int], None] = None,
    dataset: Union[str, Sequence[str], None] = None,
    index: Union[int, str, Sequence[Union[int, str]], None] = None,
    component: Union[int, str, None] = None,
    magnitude: Union[str, Sequence[str], None] = None,
    level: Optional[int] = None,
    levels: Optional[str] = None,
    upsample: Optional[str] = None,
    missing_chunks: Optional[str] = None,
    dims: Optional[Sequence[int]] = None,
    type: Optional[str] = None,
    endian: Optional[str] = None,
    offset: Optional[Size] = None,
    stack: bool = False,
    direct_io: Optional[str] = None,
    memory: Optional[Size] = None,
    threads: Optional[int] = None,
    backend: Optional[str] = None,
    work_dir: Optional[Path] = None,
    resume: Optional[str] = None,
    save_interval: Optional[float] = None,
    overwrite: bool = False,
    progress: Optional[Progress] = None,
) -> Any:
    """Converts a volume to a NanoVDB file at `output` with a sidecar beside it. Returns the sidecar, a dictionary.

    source
        One of these:
        A path of anything that `weir convert` reads.
        A numpy array indexed [z, y, x], as in HDF5, of bool, integers or floats of up to 64 bits in this machine's
        byte order. Any strides, read-only arrays and numpy.memmap are allowed. The array is read in place and not
        copied; it must not change before the call returns.
        An array [z, y, x] of another library that has DLPack or __cuda_array_interface__ (CuPy, PyTorch, Numba, JAX).
        An array in host memory is treated like a numpy array. An array on a CUDA device is read there, after the work
        that the library has queued, and may also be of bfloat16. Float32 without gaps is also encoded on the device
        if encoding is "packed", backend is not "cpu", memory is 1 GiB or more and roi is not given. Then only the
        encoded result crosses the bus.
        An xarray.DataArray of three axes. If the axes' names (x, y, lat, lon ...) or their attribute "axis" say which
        they are, the array is brought into the order z, y, x; otherwise its order is kept. Name, units, long_name and
        time are kept, and the coordinates become spacing and origin. An axis with falling coordinates is reversed,
        and a notice says so. _FillValue and missing_value in attrs are used as missing. An array with scale_factor or
        add_offset in attrs is refused, because it is not decoded (see xarray.decode_cf).
    output
        The path of the NanoVDB file. If source is a path, output may be left out: it is then the source's stem +
        ".nvdb" in the source's folder, and names the chosen volume if the source holds several. An existing file is
        replaced only with overwrite=True.

    At most one of rate, size, psnr, max_error and lossless sets the size. Without any of them rate is 8, or the
    smallest possible file if that is larger. A volume of less than 128^3 voxels that rate 8 would leave below 40 dB
    gets a larger file, of at least 40 dB or lossless, if its encoding can reach that:

    rate
        The file has exactly ceil(float32 bytes of the volume / rate) bytes.
    size
        The file's exact size: bytes, or a text such as "64MiB".
    psnr, max_error
        psnr makes the smallest file of at least this many dB. max_error makes the smallest file in which every voxel
        is within max_error of its source value, as float32; it is refused if float32 rounds values by more.
    lossless
        The smallest file that preserves every bit of every valid voxel as float32. Values of other types that float32
        cannot hold are rounded first: the sidecar's conversion_loss counts them, and a warning is logged.
    at_most
        With rate or size: the file is shorter instead of padded if the volume needs fewer bytes.

    The encoding. The keywords mean the same as the options of `weir convert`: encoding "auto", "float", "fpn", "fp4",
    "fp8", "fp16", "packed"; preview (of a packed file) "auto", "on", "off"; metric "sse", "farthest", "closest",
    "median"; fill "mean", "background"; background "auto" or a value; brick 8, 16, 32 voxels; preset "paper";
    nonfinite "error", "background", "keep"; scene, the path of a scene file. certify="gradient" reads source and file
    once more to measure the error of the gradient, which the sidecar has as error.gradient.

    The volume:

    spacing, origin
        (x, y, z): world units per voxel, and the world position of the centre of voxel (0, 0, 0).
    missing, missing_policy
        missing is a stored value that means "no data". missing_policy says what becomes of voxels without data:
        "error", "background" or "keep" (as data); by default they are treated as nonfinite says, which is "error" by
        default.
    roi
        ((x0, y0, z0), (x1, y1, z1)) in voxels, x0 inclusive, x1 exclusive, or a text as for `--roi`. If the
        coordinates of a file's or an xarray.DataArray's axis fall, the axis is reversed, and roi counts from the
        lowest coordinate.
    ghost
        Layers of ghost cells to leave out at both ends of each axis: a number, or (x, y, z).
    dataset
        The name of a dataset in a container, or the name of the quantity in an array. A list of datasets, in which
        "*" and "/step_%d/rho" match several, converts each of them and returns a list of sidecars. output is then a
        directory ("out/"), a name with {stem}, {dataset} or {step}, or left out.

    For files only: index, a position on each leading axis, (3, 0), or a text as for `--index`, "time=3"; an index
    with a range, "0:2" or "*", converts each position and returns a list of sidecars; component (0, 1, ..., "x", "y",
    "z" or "magnitude") of vectors in HDF5, Zarr, VTK and OpenVDB files; magnitude, the datasets ("u", "v", "w") of
    vector components: the volume is the length of the vectors; level of an AMReX plotfile, 0 is the coarsest;
    upsample ("constant", "linear"); levels ("composite", or "separate", which converts each level to its own file,
    named _level_N with N = 0 for the finest, and returns a list); missing_chunks of a Zarr array or an HDF5 dataset
    ("fill", "error"); dims (x, y, z), type, endian, offset, stack, direct_io.

    memory
        Bytes, or a text; "512MiB" by default. The conversion may take this much in addition to the memory that the
        process holds when the conversion begins. The message about a memory that is too small counts both.
    threads
        The largest number of threads. 0, the default, means one for each core. Results do not depend on it.
    backend
        "auto", "cpu" or "cuda": what surveys and encodes packed blocks. "auto" uses a CUDA device if weir was built
        with CUDA, a device answers and memory is 1 GiB or more. Results do not depend on it.
    work_dir
        The directory for spill files. By default a hidden directory beside the output.
    resume
        "auto", "on" or "off": whether the work of an interrupted conversion of a file is kept, so that the next call
        continues it. The conversion of an array cannot be continued: "on" is refused for arrays.
    save_interval
        For files: seconds between two points that a conversion can be continued from; 0 means as many points as
        possible.
    progress
        Called in the calling thread, at most about twenty times a second, as progress(pass, done, total), with done
        and total in float32 bytes. An exception that it raises, KeyboardInterrupt too, ends the conversion and is
        passed on.

    The output is complete or absent: a conversion that fails or is interrupted leaves nothing behind except the work
    that resume keeps. An exception from a signal handler, such as KeyboardInterrupt, may arrive after the files are
    complete; then they stay. The interpreter's lock is released during the conversion. Warnings go to the logger
    "weir", for example that the smallest possible file is larger than rate asks for.

    Raises UsageError (a ValueError), InputError, BudgetError or IoError. The error for a missing or unreadable file
    is also a FileNotFoundError or PermissionError. Raises TypeError if source is anything else,
    and if output, dataset or progress is of a wrong type.
    """
    meaning: dict[str, Any] = {}
    if is_data_array(source):
        labelled = take_apart(source, spaced=spacing is not None)
        missing = missing_number(source) if missing is None else missing
        source, meaning = labelled.values, labelled.meaning
        spacing = labelled.spacing if spacing is None else spacing
        origin = labelled.origin if origin is None else origin
        dataset = labelled.name if dataset is None else dataset
    ranges = index is not None and any(letter in text_of(index) for letter in ":*")
    listed = dataset is not None and not isinstance(dataset, (str, bytes))
    several = ranges or listed or levels == "separate"
    names = _dataset_names(dataset) if listed else []
    if listed and not names:
        raise UsageError("dataset is an empty list; name a dataset in it")
    checked_progress(progress)
    options = given_options(
        rate=rate,
        size=size,
        psnr=psnr,
        max_error=max_error,
        lossless=lossless,
        at_most=at_most,
        encoding=encoding,
        preview=preview,
        metric=metric,
        fill=fill,
        background=background,
        brick=brick,
        preset=preset,
        nonfinite=nonfinite,
        scene=scene,
        certify=certify,
        spacing=spacing,
        origin=origin,
        missing=missing,
        missing_policy=missing_policy,
        roi=None if roi is None else box_text(roi),
        ghost=ghost,
        dataset="\n".join(map(text_of, names)) if listed else dataset,
        index=index,
        component=component,
        magnitude=magnitude,
        level=level,
        levels=levels,
        upsample=upsample,
        missing_chunks=missing_chunks,
        dims=dims,
        type=type,
        endian=endian,
        offset=offset,
        stack=stack,
        direct_io=direct_io,
        memory=memory,
        threads=threads,
        backend=backend,
        work_dir=work_dir,
        resume=resume,
        save_interval=save_interval,
        overwrite=overwrite,
    )
    target = b"" if output is None else path_bytes(output, "output")
    if is_url(source):
        shown = shown_url(source)
        raise UsageError(f"source is {shown!r}: weir.convert reads files of this machine; copy it here first")
    if isinstance(source, (str, os.PathLike)):
        texts = _core.convert_files(input_bytes(source), target, options, several, progress)
    elif isinstance(source, numpy.ndarray) or is_array_elsewhere(source):
        if not target:
            raise UsageError("output is missing: an array has no name to make one from")
        if listed:
            raise UsageError("dataset is a list; an array is one volume, whose name is a text")
        _refuse_what_is_for_files(options)
        texts = [_convert_array(source, target, options, meaning, progress)]
    else:
        raise TypeError(
            f"source is a {source.__class__.__name__}, it must be a path, a numpy array, an xarray.DataArray"
            f" or an array with DLPack or __cuda_array_interface__{_remedy(source)}"
        )
    records = [json.loads(text) for text in texts]
    return records if several else records[0]


def _dataset_names(dataset: Any) -> list[Union[str, bytes]]:
    """Returns the names in a list of datasets. Raises TypeError for anything else."""
    try:
        names = list(dataset)
    except TypeError:
        names = [dataset]
    if not all(isinstance(name, (str, bytes)) for name in names):
        raise TypeError(f"dataset is {described(dataset)}, it must be a text or a list of texts")
    return names


def _remedy(source: Any) -> str:
    """Returns the end of a message: what to give instead of `source`. Empty if that is not known."""
    if hasattr(source, "data_vars"):
        return "; give one of its arrays, source[NAME]"
    if source.__class__.__module__.partition(".")[0] in ("h5py", "zarr"):
        array = ", or numpy.asarray(source)" if hasattr(source, "__array__") else ""
        return f"; give the path of its file with dataset=NAME, which is streamed{array}"
    for_numpy = hasattr(source, "__array__") or hasattr(source, "__array_interface__")
    return "; give numpy.asarray(source)" if for_numpy else ""


def _refuse_what_is_for_files(options: dict[str, bytes]) -> None:
    """Raises UsageError for options that have no meaning for arrays. Leaves invalid values to the later checks."""
    remedy = "which is for files; the conversion of an array cannot be continued, leave it out"
    if options.get("resume") == b"on":
        raise UsageError(f"resume is 'on', {remedy}")
    interval = options.get("save-interval", b"").decode()
    if re.match(r"[0-9.]", interval):
        raise UsageError(f"save_interval is {interval}, {remedy}")


def _convert_array(
    source: Any, target: bytes, options: dict[str, bytes], meaning: dict[str, Any], progress: Optional[Progress]
) -> str:
    """Converts the array `source` and returns the sidecar's text."""
    array = source if isinstance(source, numpy.ndarray) else array_of(source)
    if isinstance(array, DeviceArray):
        kind = _scalar_type(array.type, len(array.shape))
        return _core.convert_device_array(
            array.address, array.shape, array.strides, kind, array.stream, target, options, meaning, progress
        )
    if isinstance(array, numpy.ma.MaskedArray):
        raise UsageError("source is a masked array; give source.filled(VALUE), missing=VALUE and missing_policy")
    kind = _scalar_type(array.dtype.name, array.ndim)
    if not array.dtype.isnative:
        raise UsageError(
            f"source has the other byte order ({array.dtype.str}); give source.astype(source.dtype.newbyteorder('='))"
        )
    return _core.convert_array(array, kind, target, options, meaning, progress)


def _scalar_type(name: str, axes: int) -> str:
    """Returns weir's name for numpy's type `name`. Raises UsageError for unknown types and for other than 3
    `axes`."""
    if axes != 3:
        raise UsageError(f"source has {axes} axes, it must have three: [z, y, x]")
    if name not in _TYPES:
        raise UsageError(f"source is of {name}, it must be one of {', '.join(_TYPES)}")
    return _TYPES[name]
