"""Reads the attributes of an xarray.DataArray that concern values which xarray did not decode.

When xarray decodes values, it moves these attributes into `encoding`. Attributes still in `attrs` were not applied.
"""

from __future__ import annotations

import logging
import math
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy

from .errors import UsageError
from .options import described, text_of

if TYPE_CHECKING:
    import xarray

#: Attributes of packed values, each with the number that leaves values unchanged.
_PACKING = {"scale_factor": 1, "add_offset": 0}
#: For each kind of numpy type, the value of _Unsigned that says that the file means the other signedness.
_OTHER_SIGN = {"i": "true", "u": "false"}


def refuse_undecoded(array: xarray.DataArray, shown: str) -> None:
    """Raises UsageError if the values of `array`, which messages call `shown`, are still packed as in the file."""
    for key, value in array.attrs.items():
        packs = key in _PACKING and _numbers(value) != [_PACKING[key]]
        if packs or key == "_Unsigned" and str(value) == _OTHER_SIGN.get(array.dtype.kind):
            raise UsageError(
                f"{shown} has {key} {_text(value)}, so its values are not decoded; give what xarray.decode_cf makes of "
                f"its dataset, or delete {shown}.attrs[{key!r}] where that was applied"
            )


def missing_number(array: xarray.DataArray) -> Union[int, float, None]:
    """Returns the stored finite number that means "no data", from _FillValue and missing_value; None if absent.

    Logs a warning for a number that no value of the array can have. Raises UsageError if there are several numbers or
    if an attribute is not a number.
    """
    if array.dtype.kind not in "iuf":
        return None
    found: dict[Union[int, float], str] = {}
    for key in ("_FillValue", "missing_value"):
        value = array.attrs.get(key)
        numbers = [] if value is None else _numbers(value)
        if numbers is None:
            raise UsageError(
                f"source has {key} {_text(value)}, it must be a number; correct or delete source.attrs[{key!r}]"
            )
        for number in numbers:
            stored = _stored(number, array.dtype)
            if stored is None:
                name = "source" if array.name is None else array.name
                logging.getLogger("weir").warning(
                    f"{name}: its attribute {key} is {text_of(number)}, and no {array.dtype} is, so it marks no voxel; "
                    "missing names the stored value that stands for no data"
                )
            elif math.isfinite(stored):
                found.setdefault(stored, key)
    if len(found) > 1:
        several = " and ".join(f"{key} {text_of(number)}" for number, key in found.items())
        raise UsageError(
            f"source has {several}, and one number can stand for no data; give what xarray.decode_cf makes of its "
            "dataset, or name the one with missing"
        )
    return next(iter(found), None)


def _numbers(value: Any) -> Optional[list[Union[int, float]]]:
    """Returns the numbers of an attribute's value. None if the value is not made of numbers."""
    array = numpy.asarray(value)
    return array.ravel().tolist() if array.dtype.kind in "iuf" else None


def _text(value: Any) -> str:
    numbers = _numbers(value)
    return text_of(numbers[0]) if numbers is not None and len(numbers) == 1 else described(value)


def _stored(number: Union[int, float], kind: numpy.dtype[Any]) -> Union[int, float, None]:
    """Returns `number` as an array of type `kind` stores it. None if the type cannot."""
    if kind.kind == "f":
        with numpy.errstate(over="ignore"):
            stored = float(kind.type(number))
        return None if math.isinf(stored) and math.isfinite(number) else stored
    if not math.isfinite(number):
        return number  # no voxel of an integer type has this value
    limits = numpy.iinfo(kind)
    return int(number) if number == int(number) and limits.min <= number <= limits.max else None
