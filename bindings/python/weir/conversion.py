"""weir.convert."""

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
from .options import box_text, given_options, input_bytes, is_url, path_bytes, shown_url, text_of
from .undecoded import missing_number

if TYPE_CHECKING:
    import xarray

#: Called with the pass ("survey", "encode", "certify"), and its float32 bytes done and in all; of a .nvdb file that is
#: converted with "check" before, and the file's bytes.
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
    """Converts a volume to a NanoVDB file at `output` and its sidecar beside it; returns the sidecar, a dictionary.

    source
        A path of anything that `weir convert` reads, or a numpy array indexed [z, y, x] as HDF5 does it: of bool,
        integers or floats of up to 64 bits in this machine's byte order, with any strides, read-only or not, a
        numpy.memmap too. An array is read where it is and not copied; it must not change before the call returns.
        Or an array of another library, [z, y, x] too, that has DLPack or __cuda_array_interface__ (CuPy, PyTorch, Numba,
        JAX): of the host's memory as one of numpy's; on a CUDA device it is read there, after the work that the library
        has queued, and float32 without gaps is coded there where encoding is "packed", backend not "cpu", memory 1 GiB
        or more and no roi given: then only what becomes of the values crosses the bus. There bfloat16 is known as well.
        Or an xarray.DataArray of three axes: in the order z, y, x where their names (x, y, lat, lon ...) or attributes
        "axis" say which they are, else as they are. Its name, units, long_name and time are kept, its coordinates become
        spacing and origin; an axis whose coordinates fall is turned round, and a notice says so. _FillValue and
        missing_value in its attrs are taken as missing; with scale_factor or add_offset there, it is not decoded
        (xarray.decode_cf), and refused.
    output
        May be left out for a path: its stem + ".nvdb", beside it; where the file holds several volumes, with what was
        chosen in the name. An existing file is replaced with overwrite=True only.

    How large, one of these; rate=8 where none is given, and of less than 128^3 voxels what keeps at least 40 dB:

    rate
        The file has exactly ceil(float32 bytes of the volume / rate) bytes.
    size
        The file has exactly so many bytes.
    psnr, max_error
        The smallest file of at least so many dB, or in which every voxel is within that of its value as float32; refused where
        float32 rounds values by more.
    lossless
        The smallest file that preserves every bit of every valid voxel as float32. Values of other types that float32
        does not hold are rounded first: the record's conversion_loss counts them, and a warning says so.
    at_most
        With rate or size: a shorter file, not padding, where the volume needs less.

    What is kept, as the options of `weir convert` of the same names: encoding "auto", "float", "fpn", "fp4", "fp8",
    "fp16", "packed"; preview (of a packed file) "auto", "on", "off"; metric "sse", "farthest", "closest", "median"; fill "mean", "background"; background "auto" or a value;
    brick 8, 16, 32 voxels; preset "paper"; nonfinite "error", "background", "keep"; scene, a path. certify="gradient" reads source and file once more for the
    error of the gradient, the sidecar's error.gradient.

    The volume: spacing (x, y, z) in world units per voxel; origin, the world position of the centre of voxel (0, 0,
    0); missing, a stored value that says "no data"; missing_policy "error", "background", "keep" (as data), what
    becomes of such voxels, by default what nonfinite says, which is "error"; roi ((x0, y0, z0), (x1, y1, z1)) in
    voxels, x0 inclusive, x1 exclusive, or a text as `--roi` takes it; where the coordinates of a file or of an
    xarray.DataArray fall, the axis is turned round, and roi counts from the lowest one; ghost, layers of ghost
    cells left out at both ends of each axis, a number or (x, y, z); dataset, the name in a container, or of what an
    array holds. A list of datasets, in which "*" and "/step_%d/rho" stand for several, converts each of them and
    returns a list of sidecars: output is then a directory ("out/"), a name with {stem}, {dataset} or {step}, or
    left out. Of files also index, a position on each leading axis, (3, 0), or a text as `--index` takes it,
    "time=3"; one with a range, "0:2" or "*", converts each and returns a list, too; component (0, 1, ..., "x", "y",
    "z" or "magnitude" of vectors in HDF5, Zarr, VTK and OpenVDB files), magnitude (("u", "v", "w"), the datasets
    that are the components of the vectors whose length is the volume), level (of an AMReX plotfile, 0 the coarsest)
    and upsample ("constant", "linear"), levels ("composite", or "separate", which converts each level to a file of
    its own, named _level_N with N from 0, the finest, on, and returns a list), missing_chunks (of a Zarr array or
    an HDF5 dataset: "fill", "error"), dims (x, y, z), type, endian, offset, stack, direct_io.

    memory
        Bytes, or "512MiB" (the default): what the conversion may take besides what the process holds when it
        begins; what is said of a memory that is too small counts both.
    threads
        At most so many work; 0, the default: one for each core. Results do not depend on it.
    backend
        "auto", "cpu" or "cuda": what surveys and encodes packed blocks, auto: a CUDA device where one answers, if weir was
        built for one and memory is 1 GiB or more. Results do not depend on it.
    work_dir
        For spill files; by default a hidden directory beside the output.
    resume
        "auto", "on" or "off": whether what an interrupted conversion of a file did is kept for the next. Never of an
        array, for which "on" is refused.
    save_interval
        Of files: seconds between two points that it can be continued from; 0: as many as there are.
    progress
        Called in this thread some twenty times a second at most as progress(pass, done, total), in float32 bytes.
        What it raises, KeyboardInterrupt too, ends the conversion and goes on.

    The output is there whole or not at all: nothing is left of a conversion that fails or is interrupted, but for what
    resume keeps. What a signal handler raises, as KeyboardInterrupt, may come when the files are complete already; then
    they stay. The interpreter's lock is
    free while it runs. Warnings, for instance that the least size is larger than the rate's, go to the logger
    "weir".

    Raises UsageError (a ValueError), InputError, BudgetError or IoError, of which those of missing and unreadable files
    are FileNotFoundError or PermissionError too; TypeError where source is something else.
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
    if listed and not dataset:
        raise UsageError("dataset is an empty list; name a dataset in it")
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
        dataset="\n".join(map(text_of, dataset)) if listed else dataset,
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
    target = b"" if output is None else path_bytes(output)
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


def _remedy(source: Any) -> str:
    """What to give instead of `source`, for the end of a message; empty where that is not known."""
    if hasattr(source, "data_vars"):
        return "; give one of its arrays, source[NAME]"
    if source.__class__.__module__.partition(".")[0] in ("h5py", "zarr"):
        array = ", or numpy.asarray(source)" if hasattr(source, "__array__") else ""
        return f"; give the path of its file with dataset=NAME, which is streamed{array}"
    return "; give numpy.asarray(source)" if hasattr(source, "__array__") else ""


def _refuse_what_is_for_files(options: dict[str, bytes]) -> None:
    """Raises UsageError for options without a meaning for arrays. Wrong values are left to the check of all options."""
    remedy = "which is for files; the conversion of an array cannot be continued, leave it out"
    if options.get("resume") == b"on":
        raise UsageError(f"resume is 'on', {remedy}")
    interval = options.get("save-interval", b"").decode()
    if re.match(r"[0-9.]", interval):
        raise UsageError(f"save_interval is {interval}, {remedy}")


def _convert_array(
    source: Any, target: bytes, options: dict[str, bytes], meaning: dict[str, Any], progress: Optional[Progress]
) -> str:
    """The sidecar's text."""
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
    """weir's name of an array's type. Raises UsageError for what is no volume of scalars."""
    if axes != 3:
        raise UsageError(f"source has {axes} axes, it must have three: [z, y, x]")
    if name not in _TYPES:
        raise UsageError(f"source is of {name}, it must be one of {', '.join(_TYPES)}")
    return _TYPES[name]
