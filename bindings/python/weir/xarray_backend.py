"""Grids for xarray: Grid.to_xarray, and the engine "weir" of xarray.open_dataset. Values are decoded when they are used."""

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

#: Edge of the chunks that dask gets with chunks={}: 8 MiB, and whole blocks of 8^3 voxels.
CHUNK = 128
_UNNAMED = "values"


#: Places of a list that are closer are read with what lies between them: they are in one block of 8^3 voxels or two.
_GAP = 8
#: A call for each costs more than to decode the box around them where there are more.
_MOST_BOXES = 64
#: A look-up of one voxel takes as long as to decode so many of a box.
_LOOK_UP = 8
#: And a call for one block.
_CALL = 2**11
#: Voxels along an axis, of which float32 has the positions of all centres.
_MOST_SAMPLED = 2**23


class GridArray(BackendArray):  # type: ignore[misc]
    """A level of a grid as xarray reads arrays: of lists of places along axes, the boxes that hold them are read."""

    def __init__(self, grid: Grid, level: int) -> None:
        self.grid = grid
        self.level = level
        self.shape = grid.level_shape(level)
        self.dtype = grid.dtype

    def __getitem__(self, key: Any) -> Any:
        # Not by xarray's explicit_indexing_adapter, which misplaces slices with negative steps.
        parts = tuple(_from_zero(part, axis, self.shape[axis]) for axis, part in enumerate(key.tuple))
        if isinstance(key, indexing.VectorizedIndexer):
            return self._points(parts)
        return self._lists(parts)

    def _lists(self, parts: tuple[Any, ...]) -> Any:
        """Of each combination of runs of the lists one box."""
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
        """Of points that are few in the box around them each by itself, or each of their blocks."""
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
        for chosen in numpy.split(order, begins):  # those of one block
            values[chosen] = self._box(tuple(places[chosen].T), True)
        return values.reshape(shape)

    def _box(self, parts: tuple[Any, ...], together: bool) -> Any:
        """What `parts` ask of the box that holds all of it; whether lists are read together, as points."""
        box, rest = zip(*(_box_and_rest(part) for part in parts))
        values = self.grid._read(box, self.level)
        rest = tuple(part for part in rest if part is not None)  # the axes that are left
        if together:
            return _point_by_point(values, rest)
        for axis, part in enumerate(rest):
            if not isinstance(part, slice):
                values = values.take(part, axis)
        return values


def _is_list(part: Any) -> bool:
    return isinstance(part, numpy.ndarray) and part.ndim > 0


def _from_zero(part: Any, axis: int, count: int) -> Any:
    """A list of places, those from the end counted from 0; anything else as it is. Raises IndexError outside."""
    if not _is_list(part):
        return part
    places = numpy.where(part < 0, part + count, part)
    outside = part[(places < 0) | (places >= count)]
    if outside.size > 0:
        raise IndexError(f"index {outside[0]} is out of bounds for axis {axis} ({'zyx'[axis]}) with size {count}")
    return places


def _runs(places: Any, gap: int) -> list[slice]:
    """Slices of rising `places`, between which there are steps of more than `gap`."""
    ends = [0, *(numpy.flatnonzero(numpy.diff(places) > gap) + 1).tolist(), len(places)]
    return [slice(begin, end) for begin, end in zip(ends, ends[1:])]


def _box_and_rest(part: Any) -> tuple[Any, Any]:
    """The place or slice that holds what `part` asks of an axis, and what it asks of that; None: the axis is gone."""
    if isinstance(part, slice):
        return part, slice(None)
    if _is_list(part):
        if part.size == 0:
            return slice(0, 0), part
        return slice(int(part.min()), int(part.max()) + 1), part - part.min()
    return int(part), None


def _point_by_point(values: Any, rest: tuple[Any, ...]) -> Any:
    """values[rest], the axes of the arrays in it before those of its slices, as xarray has them."""
    arrays = [axis for axis, part in enumerate(rest) if isinstance(part, numpy.ndarray)]
    found = values[rest]
    together = arrays == list(range(arrays[0], arrays[-1] + 1)) if arrays else True
    if not arrays or not together:  # numpy puts them first itself
        return found
    count = numpy.broadcast(*(rest[axis] for axis in arrays)).ndim
    return numpy.moveaxis(found, range(arrays[0], arrays[0] + count), range(count))


def _variable_name(grid_name: str, taken: Iterable[str]) -> str:
    """The last part of "/velocity/x", or, where a coordinate is called so, "velocity_x"."""
    parts = [part for part in grid_name.split("/") if part]
    for name in (parts[-1:], parts[-2:] if len(parts) > 1 else []):
        if name and "_".join(name) not in taken:
            return "_".join(name)
    return _UNNAMED


def _sidecar(grid: Grid) -> dict[str, Any]:
    """What the sidecar says; nothing where there is none, or one of another file or a damaged one, which is logged."""
    try:
        return grid.sidecar or {}
    except InputError as error:
        logging.getLogger("weir").warning("%s; its values are read without names, units and error", error)
        return {}


def data_array(grid: Grid, level: int = 0, decode_times: bool = True) -> xarray.DataArray:
    """What Grid.to_xarray returns; decode_times as of xarray.open_dataset: whether a time is a date, not a number."""
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
    """The engine "weir" of xarray.open_dataset: a dataset with the one variable that the file has."""

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
        remote_cache: Union[int, str] = "256MiB",
    ) -> xarray.Dataset:
        """xarray calls it. level, as of Grid.to_numpy: means over cubes of 2^level voxels along an edge;
        storage_options, as of weir.open, and remote_cache, its cache, for which xarray has another meaning.
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
        """Whether it is the path or URL of an .nvdb file."""
        if not isinstance(filename_or_obj, (str, os.PathLike)):
            return False
        name = re.split("[?#]", filename_or_obj)[0] if is_url(filename_or_obj) else os.fspath(filename_or_obj)
        return name.lower().endswith(".nvdb")


def _listed(names: Optional[Iterable[str]]) -> list[str]:
    return [names] if isinstance(names, str) else list(names or [])


def _axis_names(source: dict[str, Any]) -> tuple[str, ...]:
    """The source's names of [z, y, x] where it has three that differ."""
    given = tuple((source.get("axes") or [])[::-1])
    return given if len(set(given)) == 3 and all(given) else ("z", "y", "x")


def _attributes(sidecar: dict[str, Any]) -> dict[str, Any]:
    """units, long_name and what the values differ from the source's by at most, of those that are known."""
    source, error = sidecar.get("source", {}), sidecar.get("error", {})
    found = {key: source.get(key) for key in ("units", "long_name")}
    found["max_abs_error"], found["psnr_db"] = error.get("max_abs"), error.get("psnr_db")
    return {key: value for key, value in found.items() if value not in (None, "")}


def _coordinate(grid: Grid, source: dict[str, Any], level: int, axis: int, name: str) -> xarray.Variable:
    """World positions of the centres along `axis` of [z, y, x]; of means, the mean of their voxels' positions."""
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
    """Dates where the units say since when, and the calendar is one that xarray knows here; else the numbers."""
    if " since " not in variable.attrs.get("units", ""):
        return variable
    try:
        return xarray.decode_cf(xarray.Dataset(coords={name: variable}))[name].variable
    except (ImportError, ValueError):  # cftime is missing, or the units are of no calendar
        return variable
