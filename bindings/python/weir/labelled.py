"""An xarray.DataArray as weir.convert takes it: values [z, y, x], their place, and what they mean."""

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

#: Regular coordinates may be off their places by this part of the spacing, and by a rounding of float32.
_TOLERANCE = 1e-3
_EPOCH = "seconds since 1970-01-01 00:00:00"
_KNOWN = {"x": "x", "lon": "x", "longitude": "x", "y": "y", "lat": "y", "latitude": "y", "z": "z"}
#: Names of what may be z, though a name alone does not make it that.
_HEIGHTS = {"altitude", "depth", "height", "lev", "level", "plev", "pressure"}


class Labelled(NamedTuple):
    """An array, and what convert_array takes besides."""

    values: NDArray[Any]  #: [z, y, x]
    spacing: tuple[float, float, float]  #: x, y, z
    origin: tuple[float, float, float]
    name: Optional[str]
    meaning: dict[str, Any]  #: "units", "long_name", "time", "calendar", and of "axes" x, y, z: "name", "units",
    #: "coordinates", "note", "reversed"


def is_data_array(source: Any) -> bool:
    """Whether it is an xarray.DataArray; xarray is not imported for that."""
    xarray = sys.modules.get("xarray")
    return xarray is not None and isinstance(source, getattr(xarray, "DataArray", ()))


class _Axis(NamedTuple):
    """What the coordinates of an axis say."""

    details: dict[str, Any]  #: of Labelled.meaning
    spacing: float = 1.0
    origin: float = 0.0
    falls: str = ""  #: how coordinates that fall are read; empty where they do not fall


def take_apart(array: xarray.DataArray, spaced: bool = False) -> Labelled:
    """Values are read. Axes whose coordinates fall are turned round. `spaced`: the caller gives another spacing, so
    that positions of the array's own are left out.

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
    """As UTF-8 has it."""
    return str(value).encode("utf-8", "replace").decode()


def _attribute(array: xarray.DataArray, shown: str, key: str) -> str:
    """The attribute `key` of `array`, which messages call `shown`; empty where it has none. Raises UsageError."""
    value = array.attrs.get(key)
    if isinstance(value, numpy.ndarray):
        if value.size != 1:
            raise UsageError(f"{shown} has {key} that are {described(value)}; set {shown}.attrs[{key!r}] to a text")
        value = value.item()
    return _text(value) if value else ""


def _known_axes(array: xarray.DataArray) -> dict[str, Any]:
    """The axes that say that they are x, y or z; of several that say the same, the first longer than 1."""
    axis_of: dict[str, Any] = {}
    for name in array.dims:
        said = str(array.coords[name].attrs.get("axis", "")) if name in array.coords else ""
        axis = said.lower() if said in ("X", "Y", "Z") else _KNOWN.get(str(name).lower())
        if axis is not None and (axis not in axis_of or array.sizes[axis_of[axis]] == 1 < array.sizes[name]):
            axis_of[axis] = name
    return axis_of


def _without_further_axes(array: xarray.DataArray) -> xarray.DataArray:
    """Of more than three axes, those of one position left out: time first, x, y and z only where there are no others."""
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
    """The axes in the order z, y, x where two of them say which they are; else as they are."""
    axis_of = _known_axes(array)
    if len(axis_of) == 2:
        (missing,) = set("xyz") - set(axis_of)
        (axis_of[missing],) = set(array.dims) - set(axis_of.values())
    return tuple(axis_of[axis] for axis in "zyx") if len(axis_of) == 3 else array.dims


def _details(axis: _Axis, spaced: bool) -> dict[str, Any]:
    """Of Labelled.meaning. Where the axis is `spaced` otherwise, without its own positions; times stay."""
    details = dict(axis.details)
    if spaced:
        details.pop("note", None)
        counts_time = " since " in details.get("units", "")
        if not counts_time:
            details.pop("coordinates", None)
        elif "coordinates" not in details:  # a distance is no time
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
    if coordinate.dtype.kind == "M":  # a distance is no time
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
    """What is said of coordinates that fall along the axis at `place` of [z, y, x], in the words for files."""
    first, last = (str(value).removesuffix(".0") for value in (coordinates[0], coordinates[-1]))
    elements = ("planes", "rows", "columns")[place]
    return f"falls from {first} to {last}: {elements} are read in reverse order, so that positions rise"


def _seconds(coordinate: xarray.DataArray) -> Any:
    """Of dates, since _EPOCH."""
    return (coordinate.values - numpy.datetime64("1970-01-01")) / numpy.timedelta64(1, "s")


def _time(array: xarray.DataArray) -> dict[str, Any]:
    """The scalar coordinate `time` as "time", its number and what it counts, and "calendar", of a date of cftime.

    Nothing, and a warning, where it has no such number.
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
    """What _time returns, of one of cftime's dates; of anything else nothing."""
    cftime = sys.modules.get("cftime")
    if cftime is None or not isinstance(date, cftime.datetime):
        return {}
    try:
        return {"time": (float(cftime.date2num(date, _EPOCH, date.calendar)), _EPOCH), "calendar": date.calendar}
    except (KeyError, ValueError):  # a date of no calendar
        return {}
