"""Grids for xarray: Grid.to_xarray and the engine "weir" of xarray.open_dataset. Values are decoded on use."""

from __future__ import annotations

import itertools
import logging
import math
import os
import re
from typing import TYPE_CHECKING, Any, Iterable, Optional, Union

import numpy
import xarray
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from . import xarray_accessor as _xarray_accessor  # noqa: F401
from .errors import InputError, UsageError
from .options import is_url

if TYPE_CHECKING:
    from .grid import Grid

#: Edge in voxels of the chunks that dask gets with chunks={}. A chunk has 8 MiB and only whole blocks of 8^3 voxels.
CHUNK = 128
_UNNAMED = "values"


#: Listed positions at most this far apart are read together with the voxels between them, because they lie in one
#: block of 8^3 voxels or in two neighbouring ones.
_GAP = 8
#: The largest number of boxes that are read by separate calls. If there are more, near ones are joined: the gap is
#: doubled until at most this many remain.
_MOST_BOXES = 64
#: The cost of looking up one voxel, in voxels of a decoded box.
_LOOK_UP = 8
#: The cost of a call for one block, in voxels of a decoded box.
_CALL = 2**11
#: The longest axis in voxels, exclusive, for which float32 can express the positions of all voxel centres.
_MOST_SAMPLED = 2**23


class GridArray(BackendArray):  # type: ignore[misc]
    """A level of a grid as an array that xarray reads. For lists of positions, reads the boxes that hold them."""

    def __init__(self, grid: Grid, level: int) -> None:
        self.grid = grid
        self.level = level
        self.shape = grid.level_shape(level)
        self.dtype = grid.dtype

    def __getitem__(self, key: Any) -> Any:
        # xarray's explicit_indexing_adapter is not used, because it misplaces slices with negative steps.
        parts = tuple(_from_zero(part, axis, self.shape[axis]) for axis, part in enumerate(key.tuple))
        if isinstance(key, indexing.VectorizedIndexer):
            return self._points(parts)
        return self._lists(parts)

    def _lists(self, parts: tuple[Any, ...]) -> Any:
        """Reads the outer product of `parts`: one box for each combination of the lists' runs."""
        lists = {axis: numpy.unique(part, return_inverse=True) for axis, part in enumerate(parts) if _is_list(part)}
        if not lists or any(places.size == 0 for places, _ in lists.values()):
            return self._box(parts, False)
        gap = _GAP
        found = [_runs(places, gap) for places, _ in lists.values()]
        while math.prod(map(len, found)) > _MOST_BOXES:
            gap *= 2
            found = [_runs(places, gap) for places, _ in lists.values()]
        rows = [axis for axis, part in enumerate(parts) if isinstance(part, slice) or axis in lists]
        counts = [len(lists[axis][0]) if axis in lists else len(range(self.shape[axis])[parts[axis]]) for axis in rows]
        values = numpy.empty(counts, self.dtype)
        for runs in itertools.product(*found):
            of_axis = dict(zip(lists, runs))
            box = tuple(lists[axis][0][of_axis[axis]] if axis in lists else part for axis, part in enumerate(parts))
            values[tuple(of_axis.get(axis, slice(None)) for axis in rows)] = self._box(box, False)
        for place, axis in enumerate(rows):
            if axis in lists:
                values = values.take(lists[axis][1], place)
        return values

    def _points(self, parts: tuple[Any, ...]) -> Any:
        """Reads points. If they are few in the box around them, looks up each point or reads each of their blocks."""
        if not all(_is_list(part) for part in parts):
            return self._box(parts, True)
        shape = numpy.broadcast_shapes(*(part.shape for part in parts))
        count = math.prod(shape)
        if count == 0:
            return self._box(parts, True)
        voxels = math.prod(int(part.max()) + 1 - int(part.min()) for part in parts)  # of the box around them
        places = numpy.stack([numpy.broadcast_to(part, shape).ravel() for part in parts], axis=-1)
        sampled = self.grid._samples_decode_their_blocks and self.level == 0 and max(self.shape) < _MOST_SAMPLED
        if sampled and count * _LOOK_UP < voxels:
            return self.grid.sample(places[:, ::-1] + 0.5, "nearest").reshape(shape)
        order = numpy.lexsort((places // 8).T)
        begins = 1 + numpy.flatnonzero(numpy.diff((places // 8)[order], axis=0).any(axis=1))
        if (len(begins) + 1) * _CALL >= voxels:
            return self._box(parts, True)
        values = numpy.empty(count, self.dtype)
        for chosen in numpy.split(order, begins):  # the points of one block
            values[chosen] = self._box(tuple(places[chosen].T), True)
        return values.reshape(shape)

    def _box(self, parts: tuple[Any, ...], together: bool) -> Any:
        """Reads the box that holds everything that `parts` select, and returns the selection. `together` says that
        the lists are coordinates of points."""
        box, rest = zip(*(_box_and_rest(part) for part in parts))
        values = self.grid._read(box, self.level)
        rest = tuple(part for part in rest if part is not None)  # for the axes that remain
        if together:
            return _point_by_point(values, rest)
        for axis, part in enumerate(rest):
            if not isinstance(part, slice):
                values = values.take(part, axis)
        return values


def _is_list(part: Any) -> bool:
    return isinstance(part, numpy.ndarray) and part.ndim > 0


def _from_zero(part: Any, axis: int, count: int) -> Any:
    """Returns a list of positions with negative ones counted from 0, and anything else as it is. Raises IndexError
    for positions outside."""
    if not _is_list(part):
        return part
    places = numpy.where(part < 0, part + count, part)
    outside = part[(places < 0) | (places >= count)]
    if outside.size > 0:
        raise IndexError(f"index {outside[0]} is out of bounds for axis {axis} ({'zyx'[axis]}) with size {count}")
    return places


def _runs(places: Any, gap: int) -> list[slice]:
    """Splits rising `places` at steps of more than `gap`. Returns the slices of `places`."""
    ends = [0, *(numpy.flatnonzero(numpy.diff(places) > gap) + 1).tolist(), len(places)]
    return [slice(begin, end) for begin, end in zip(ends, ends[1:])]


def _box_and_rest(part: Any) -> tuple[Any, Any]:
    """Returns the position or slice of an axis that holds what `part` selects, and the selection within that slice,
    which is None if `part` removes the axis."""
    if isinstance(part, slice):
        return part, slice(None)
    if _is_list(part):
        if part.size == 0:
            return slice(0, 0), part
        return slice(int(part.min()), int(part.max()) + 1), part - part.min()
    return int(part), None


def _point_by_point(values: Any, rest: tuple[Any, ...]) -> Any:
    """Returns values[rest] with the axes of arrays before the axes of slices, as xarray orders them."""
    arrays = [axis for axis, part in enumerate(rest) if isinstance(part, numpy.ndarray)]
    found = values[rest]
    together = arrays == list(range(arrays[0], arrays[-1] + 1)) if arrays else True
    if not arrays or not together:  # numpy puts them first itself
        return found
    count = numpy.broadcast(*(rest[axis] for axis in arrays)).ndim
    return numpy.moveaxis(found, range(arrays[0], arrays[0] + count), range(count))


def _variable_name(grid_name: str, taken: Iterable[str]) -> str:
    """Returns "x" for the grid "/velocity/x", or "velocity_x" if a coordinate is named "x"; otherwise _UNNAMED."""
    parts = [part for part in grid_name.split("/") if part]
    for name in (parts[-1:], parts[-2:] if len(parts) > 1 else []):
        if name and "_".join(name) not in taken:
            return "_".join(name)
    return _UNNAMED


def _sidecar(grid: Grid) -> dict[str, Any]:
    """Returns the sidecar. Empty if absent; empty, with a warning, if damaged or if it belongs to another file."""
    try:
        return grid.sidecar or {}
    except InputError as error:
        logging.getLogger("weir").warning("%s; its values are read without names, units and error", error)
        return {}


def data_array(grid: Grid, level: int = 0, decode_times: bool = True) -> xarray.DataArray:
    """Returns what Grid.to_xarray returns. `decode_times`, as for xarray.open_dataset: whether times become dates."""
    sidecar = _sidecar(grid)
    source = sidecar.get("source", {})
    names = _axis_names(source)
    values = indexing.LazilyIndexedArray(GridArray(grid, level))
    chunks = dict(zip(names, (min(CHUNK, count) for count in grid.level_shape(level))))
    variable = xarray.Variable(names, values, _attributes(sidecar), {"preferred_chunks": chunks})
    coordinates = {name: _coordinate(grid, source, level, axis, name) for axis, name in enumerate(names)}
    if "time" in source and "time" not in coordinates:
        coordinates["time"] = _time(source["time"])
    if decode_times:
        coordinates = {name: _as_dates(name, variable) for name, variable in coordinates.items()}
    name = _variable_name(grid.name, coordinates)
    array = xarray.Dataset({name: variable}, coordinates)[name]  # DataArray(variable) would read all values
    return array.rename(None) if name == _UNNAMED else array


class WeirBackendEntrypoint(BackendEntrypoint):  # type: ignore[misc]
    """The engine "weir" of xarray.open_dataset. A dataset has one variable, the file's first grid."""

    description = "NanoVDB files, with the sidecars of weir"
    open_dataset_parameters = (
        "filename_or_obj", "drop_variables", "decode_times", "level", "storage_options", "remote_cache"
    )

    def open_dataset(
        self,
        filename_or_obj: Any,
        *,
        drop_variables: Optional[Iterable[str]] = None,
        decode_times: bool = True,
        level: int = 0,
        storage_options: Optional[dict[str, Any]] = None,
        remote_cache: Optional[Union[int, str]] = None,
    ) -> xarray.Dataset:
        """Opens a file for xarray. `level` is as for Grid.to_numpy: means over cubes of 2^level voxels along an edge.
        `storage_options` is as for weir.open. `remote_cache` is the `cache` of weir.open; xarray's own `cache` says
        whether xarray keeps values that were used.
        """
        from .grid import open as open_grid

        if not isinstance(filename_or_obj, (str, os.PathLike)):
            raise UsageError(f"filename_or_obj is {filename_or_obj!r}, it must be the path or URL of a NanoVDB file")
        grid = open_grid(filename_or_obj, cache=remote_cache, storage_options=storage_options)
        try:
            array = data_array(grid, level, decode_times)
            dataset = array.to_dataset(name=array.name or _UNNAMED).drop_vars(_listed(drop_variables), errors="ignore")
        except BaseException:
            grid.close()
            raise
        dataset.encoding["source"] = grid.path
        dataset.set_close(grid.close)
        return dataset

    def guess_can_open(self, filename_or_obj: Any) -> bool:
        """Returns whether `filename_or_obj` is the path or URL of an .nvdb file."""
        if not isinstance(filename_or_obj, (str, os.PathLike)):
            return False
        name = re.split("[?#]", filename_or_obj)[0] if is_url(filename_or_obj) else os.fspath(filename_or_obj)
        return name.lower().endswith(".nvdb")


def _listed(names: Optional[Iterable[str]]) -> list[str]:
    return [names] if isinstance(names, str) else list(names or [])


def _axis_names(source: dict[str, Any]) -> tuple[str, ...]:
    """Returns the source's names of [z, y, x] if there are three different ones, otherwise ("z", "y", "x")."""
    given = tuple((source.get("axes") or [])[::-1])
    return given if len(set(given)) == 3 and all(given) else ("z", "y", "x")


def _attributes(sidecar: dict[str, Any]) -> dict[str, Any]:
    """Returns those of units, long_name, max_abs_error (the largest error of a value) and psnr_db that are known."""
    source, error = sidecar.get("source", {}), sidecar.get("error", {})
    found = {key: source.get(key) for key in ("units", "long_name")}
    found["max_abs_error"], found["psnr_db"] = error.get("max_abs"), error.get("psnr_db")
    return {key: value for key, value in found.items() if value not in (None, "")}


def _coordinate(grid: Grid, source: dict[str, Any], level: int, axis: int, name: str) -> xarray.Variable:
    """Returns the world positions of the voxels' centres along `axis` of [z, y, x]. For levels above 0, returns the
    mean position of the voxels in each mean."""
    place = 2 - axis
    first, count = grid.index_origin[place], grid.extent[place]
    listed = (source.get("irregular_axes") or {}).get("xyz"[place])
    if listed and len(listed) >= first + count and first >= 0:
        positions = numpy.array(listed[first : first + count], float)
    else:
        positions = grid.origin[place] + grid.spacing[place] * numpy.arange(first, first + count, dtype=float)
    if level > 0:
        edges = numpy.arange(0, count, 1 << level)
        positions = numpy.add.reduceat(positions, edges) / numpy.diff(numpy.append(edges, count))
    units = (source.get("axis_units") or ["", "", ""])[place]
    return xarray.Variable((name,), positions, {"units": units} if units else {})


def _time(time: dict[str, Any]) -> xarray.Variable:
    return xarray.Variable((), time["value"], {key: time[key] for key in ("units", "calendar") if time.get(key)})


def _as_dates(name: str, variable: xarray.Variable) -> xarray.Variable:
    """Returns `variable` as dates if its units have "since" and xarray knows the calendar; otherwise as it is."""
    if " since " not in variable.attrs.get("units", ""):
        return variable
    try:
        return xarray.decode_cf(xarray.Dataset(coords={name: variable}))[name].variable
    except (ImportError, ValueError):  # cftime is missing, or the units fit no calendar
        return variable
