"""array.weir.convert of every xarray.DataArray. Imported by weir where xarray is imported already."""

from __future__ import annotations

from typing import Any

import xarray

from .conversion import Path, convert


@xarray.register_dataarray_accessor("weir")  # type: ignore[misc]
class WeirAccessor:
    """What weir does with an array: array.weir."""

    def __init__(self, array: xarray.DataArray) -> None:
        self._array = array

    def convert(self, output: Path, **options: Any) -> Any:
        """weir.convert(array, output, **options)."""
        return convert(self._array, output, **options)
