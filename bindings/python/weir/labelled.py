"""Takes an xarray.DataArray apart for weir.convert: values [z, y, x], spacing and origin, name, units and time."""

from __future__ import annotations

import logging
import sys
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy
from numpy.typing import NDArray

from .errors import UsageError
from .options import described
from .undecoded import refuse_undecoded

if TYPE_CHECKING:
    import xarray

#: Regular coordinates may deviate from equal spacing by this fraction of it, plus a rounding error of their type.
_TOLERANCE = 1e-3
_EPOCH = "seconds since 1970-01-01 00:00:00"
_KNOWN = {"x": "x", "lon": "x", "longitude": "x", "y": "y", "lat": "y", "latitude": "y", "z": "z"}
#: Names of axes that are probably vertical. Such a name alone does not make an axis z.
_HEIGHTS = {"altitude", "depth", "height", "lev", "level", "plev", "pressure"}


class Labelled(NamedTuple):
    """An array and its description, as convert_array takes them."""

    values: NDArray[Any]  #: [z, y, x]
    spacing: tuple[float, float, float]  #: x, y, z
    origin: tuple[float, float, float]
    name: Optional[str]
    meaning: dict[str, Any]  #: "units", "long_name", "time", "calendar", and "axes": for each of x, y, z a dictionary
    #: with "name", "units", "coordinates", "note", "reversed"


def is_data_array(source: Any) -> bool:
    """Returns whether `source` is an xarray.DataArray. Does not import xarray."""
    xarray = sys.modules.get("xarray")
    return xarray is not None and isinstance(source, getattr(xarray, "DataArray", ()))


class _Axis(NamedTuple):
    """An axis as its coordinates describe it."""

    details: dict[str, Any]  #: the axis's entry in Labelled.meaning["axes"]
    spacing: float = 1.0
    origin: float = 0.0
    falls: str = ""  #: the note on falling coordinates; empty if they do not fall


def take_apart(array: xarray.DataArray, spaced: bool = False) -> Labelled:
    """Reads the values of `array` and reverses axes with falling coordinates. `spaced` says that the caller gives
    another spacing; the array's own positions are then left out.

    Raises UsageError for other than three axes, and for values and coordinates that are not decoded.
    """
    refuse_undecoded(array, "source")
    array = _without_further_axes(array)
    if array.ndim != 3:
        axes = ", ".join(map(str, array.dims))
        remedy = f"; choose with source.isel({array.dims[0]}=0)" if array.ndim > 3 else ""
        raise UsageError(f"source has the axes ({axes}), it must have three{remedy}")
    array = array.transpose(*_z_y_x(array))
    values = array.values
    axes, spacing, origin = [], [], []
    for place in (2, 1, 0):
        axis = _axis(array, place)
        axes.append(_details(axis, spaced))
        spacing.append(axis.spacing)
        origin.append(axis.origin)
        if axis.falls:
            values = numpy.flip(values, place)
    attributes = {key: _attribute(array, "source", key) for key in ("units", "long_name")}
    meaning: dict[str, Any] = {"axes": axes, **{key: text for key, text in attributes.items() if text}, **_time(array)}
    x, y, z = spacing
    a, b, c = origin
    return Labelled(values, (x, y, z), (a, b, c), None if array.name is None else _text(array.name), meaning)


def _text(value: Any) -> str:
    """Returns str(value), with "?" for characters that UTF-8 cannot express."""
    return str(value).encode("utf-8", "replace").decode()


def _attribute(array: xarray.DataArray, shown: str, key: str) -> str:
    """Returns the attribute `key` of `array`, which messages call `shown`. Empty if absent. Raises UsageError."""
    value = array.attrs.get(key)
    if isinstance(value, numpy.ndarray):
        if value.size != 1:
            raise UsageError(f"{shown} has {key} that are {described(value)}; set {shown}.attrs[{key!r}] to a text")
        value = value.item()
    return _text(value) if value else ""


def _known_axes(array: xarray.DataArray) -> dict[str, Any]:
    """Returns {"x": name of the axis, ...} for the axes known to be x, y or z. If several claim the same, the first
    longer than 1 counts, otherwise the first."""
    axis_of: dict[str, Any] = {}
    for name in array.dims:
        said = str(array.coords[name].attrs.get("axis", "")) if name in array.coords else ""
        axis = said.lower() if said in ("X", "Y", "Z") else _KNOWN.get(str(name).lower())
        if axis is not None and (axis not in axis_of or array.sizes[axis_of[axis]] == 1 < array.sizes[name]):
            axis_of[axis] = name
    return axis_of


def _without_further_axes(array: xarray.DataArray) -> xarray.DataArray:
    """Drops axes of length 1 until three axes are left: time first, and x, y and z only if there are no others."""
    known = _known_axes(array).values()

    def rank(name: Any) -> int:
        coordinate = array.coords[name] if name in array.coords else None
        if name in known:
            return 3
        if str(name).lower() in _HEIGHTS or coordinate is not None and "positive" in coordinate.attrs:
            return 2
        return 0 if str(name).lower() == "time" or coordinate is not None and coordinate.dtype.kind == "M" else 1

    single = sorted((name for name in array.dims if array.sizes[name] == 1), key=rank)
    return array.isel(dict.fromkeys(single[: max(0, array.ndim - 3)], 0))


def _z_y_x(array: xarray.DataArray) -> tuple[Any, ...]:
    """Returns the axes in the order z, y, x if at least two of them are known; otherwise in the array's own order."""
    axis_of = _known_axes(array)
    if len(axis_of) == 2:
        (missing,) = set("xyz") - set(axis_of)
        (axis_of[missing],) = set(array.dims) - set(axis_of.values())
    return tuple(axis_of[axis] for axis in "zyx") if len(axis_of) == 3 else array.dims


def _details(axis: _Axis, spaced: bool) -> dict[str, Any]:
    """Returns the axis's entry in Labelled.meaning["axes"]. If the caller gives a spacing (`spaced`), the axis's own
    positions are left out, except times."""
    details = dict(axis.details)
    if spaced:
        details.pop("note", None)
        counts_time = " since " in details.get("units", "")
        if not counts_time:
            details.pop("coordinates", None)
        elif "coordinates" not in details:  # the caller's spacing is a distance, not a time
            del details["units"]
    if axis.falls:
        details["reversed"] = True
        details["note"] = "; ".join(note for note in (axis.falls, details.get("note")) if note)
    return details


def _axis(array: xarray.DataArray, place: int) -> _Axis:
    name = array.dims[place]
    axis: dict[str, Any] = {"name": _text(name)}
    if name not in array.coords:
        return _Axis(axis)
    coordinate = array.coords[name]
    shown = f"source[{name!r}]"
    refuse_undecoded(coordinate, shown)
    units = _attribute(coordinate, shown, "units")
    if units:
        axis["units"] = units
    if coordinate.dtype.kind == "M":  # dates; the spacing is a distance, not a time
        axis["units"] = _EPOCH
        axis["coordinates"] = _seconds(coordinate).tolist()
        axis["note"] = f"dates from {coordinate.values[0]} to {coordinate.values[-1]}, taken as indices"
        return _Axis(axis)
    if coordinate.dtype.kind not in "iuf":
        axis["note"] = f"coordinates of type {coordinate.dtype}, taken as indices"
        return _Axis(axis)
    positions = coordinate.values.astype(float)
    if not numpy.isfinite(positions).all():
        axis["note"] = "coordinates that are missing or not finite, taken as indices"
        return _Axis(axis)
    if len(positions) == 1:
        return _Axis(axis, origin=float(positions[0]))
    steps = numpy.diff(positions)
    falls = ""
    if (steps < 0).all():
        falls = _fall(coordinate.values, place)
        positions = positions[::-1]
    elif not (steps > 0).all():
        axis["coordinates"] = positions.tolist()
        from_to = f"coordinates from {positions[0]:.9g} to {positions[-1]:.9g}"
        if (steps == 0).any():
            axis["note"] = f"{from_to}, some of them equal, taken as indices"
        else:
            axis["note"] = f"{from_to} that rise and fall, taken as indices; source.sortby({str(name)!r}) puts them in order"
        return _Axis(axis)
    first, last = float(positions[0]), float(positions[-1])
    step = (last - first) / (len(positions) - 1)
    single = coordinate.dtype.kind == "f" and coordinate.dtype.itemsize <= 4
    precision = 2.0**-23 if single else 2.0**-52
    allowed = _TOLERANCE * step + precision * max(abs(first), abs(last))
    regular = first + step * numpy.arange(len(positions))
    if step > 0 and (abs(positions - regular) <= allowed).all():
        return _Axis(axis, step, first, falls)
    axis["coordinates"] = positions.tolist()
    axis["note"] = f"irregular coordinates from {first:.9g} to {last:.9g}, taken as indices"
    return _Axis(axis, falls=falls)


def _fall(coordinates: NDArray[Any], place: int) -> str:
    """Returns the note on coordinates that fall along the axis at `place` of [z, y, x], worded as for files."""
    first, last = (str(value).removesuffix(".0") for value in (coordinates[0], coordinates[-1]))
    elements = ("planes", "rows", "columns")[place]
    return f"falls from {first} to {last}: {elements} are read in reverse order, so that positions rise"


def _seconds(coordinate: xarray.DataArray) -> Any:
    """Returns dates as seconds since _EPOCH."""
    return (coordinate.values - numpy.datetime64("1970-01-01")) / numpy.timedelta64(1, "s")


def _time(array: xarray.DataArray) -> dict[str, Any]:
    """Returns the scalar coordinate `time` as {"time": (number, units)}, with "calendar" if it is a date of cftime.

    Returns {} if there is no such coordinate. Also returns {}, with a warning, if it has no finite number.
    """
    if "time" not in array.coords or array.coords["time"].ndim != 0:
        return {}
    coordinate = array.coords["time"]
    refuse_undecoded(coordinate, "source['time']")
    found: dict[str, Any] = {}
    if coordinate.dtype.kind == "M":
        found = {"time": (float(_seconds(coordinate)), _EPOCH)}
    elif coordinate.dtype.kind == "m":
        found = {"time": (float(coordinate.values / numpy.timedelta64(1, "s")), "s")}
    elif coordinate.dtype.kind in "iuf":
        found = {"time": (float(coordinate), _attribute(coordinate, "source['time']", "units"))}
    elif coordinate.dtype.kind == "O":
        found = _date_of_calendar(coordinate.item())
    if found and numpy.isfinite(found["time"][0]):
        return found
    shown = described(str(coordinate.values[()]))
    source = "source" if array.name is None else _text(array.name)
    logging.getLogger("weir").warning(
        f"{source}: time is {shown}, no date of a known calendar and no finite number; it is left out"
    )
    return {}


def _date_of_calendar(date: Any) -> dict[str, Any]:
    """Returns what _time returns for a date of cftime, and {} for anything else."""
    cftime = sys.modules.get("cftime")
    if cftime is None or not isinstance(date, cftime.datetime):
        return {}
    try:
        return {"time": (float(cftime.date2num(date, _EPOCH, date.calendar)), _EPOCH), "calendar": date.calendar}
    except (KeyError, ValueError):  # the date has no calendar
        return {}
