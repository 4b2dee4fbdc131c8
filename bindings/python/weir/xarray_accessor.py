"""Adds array.weir.convert to every xarray.DataArray. weir imports this module if xarray is already imported."""

from __future__ import annotations

from typing import Any

import xarray

from .conversion import Path, convert


@xarray.register_dataarray_accessor("weir")  # type: ignore[misc]
class WeirAccessor:
    """The accessor array.weir: weir's functions for an xarray.DataArray."""

    def __init__(self, array: xarray.DataArray) -> None:
        self._array = array

    def convert(self, output: Path, **options: Any) -> Any:
        """Calls weir.convert(array, output, **options) and returns the sidecar."""
        return convert(self._array, output, **options)
