"""What the attributes of an xarray.DataArray say of values that xarray did not decode.

xarray moves these attributes into the encoding of what it decodes: where they are in attrs, nobody has applied them.
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

#: Each with the number that changes no value.
_PACKING = {"scale_factor": 1, "add_offset": 0}
#: What _Unsigned says of values whose type of numpy is another one than the file means.
_OTHER_SIGN = {"i": "true", "u": "false"}


def refuse_undecoded(array: xarray.DataArray, shown: str) -> None:
    """Raises UsageError where the values of `array`, which messages call `shown`, are still as the file packs them."""
    for key, value in array.attrs.items():
        packs = key in _PACKING and _numbers(value) != [_PACKING[key]]
        if packs or key == "_Unsigned" and str(value) == _OTHER_SIGN.get(array.dtype.kind):
            raise UsageError(
                f"{shown} has {key} {_text(value)}, so its values are not decoded; give what xarray.decode_cf makes of "
                f"its dataset, or delete {shown}.attrs[{key!r}] where that was applied"
            )


def missing_number(array: xarray.DataArray) -> Union[int, float, None]:
    """The stored number that stands for no data, by _FillValue and missing_value; None where no finite one does.

    A warning says which one no value of the array can be. Raises UsageError where there are several, or no numbers.
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
    """Of an attribute, one or several; None where it has something else."""
    array = numpy.asarray(value)
    return array.ravel().tolist() if array.dtype.kind in "iuf" else None


def _text(value: Any) -> str:
    numbers = _numbers(value)
    return text_of(numbers[0]) if numbers is not None and len(numbers) == 1 else described(value)


def _stored(number: Union[int, float], kind: numpy.dtype[Any]) -> Union[int, float, None]:
    """`number` as an array of `kind` holds it; None where it cannot."""
    if kind.kind == "f":
        with numpy.errstate(over="ignore"):
            stored = float(kind.type(number))
        return None if math.isinf(stored) and math.isfinite(number) else stored
    if not math.isfinite(number):
        return number  # which no voxel has
    limits = numpy.iinfo(kind)
    return int(number) if number == int(number) and limits.min <= number <= limits.max else None
