"""Converts volumes to NanoVDB files of exactly the requested size, with a certificate of the error; reads such files.

    import weir
    record = weir.convert(density, "density.nvdb", rate=10)      # a numpy array [z, y, x], or a path
    with weir.open("density.nvdb") as grid:
        grid.certificate["psnr_db"], grid.to_numpy(), grid.sample([[4.5, 4.5, 4.5]]), grid.render(mode="dvr")
"""

import sys

from ._core import __version__
from .conversion import convert
from .errors import BudgetError, Error, InputError, IoError, UsageError
from .grid import Check, Grid, Macrocells, open
from .remote import RemoteGrid

if hasattr(sys.modules.get("xarray"), "register_dataarray_accessor"):
    from . import xarray_accessor as _xarray_accessor

__all__ = [
    "BudgetError",
    "Check",
    "Error",
    "Grid",
    "InputError",
    "IoError",
    "Macrocells",
    "RemoteGrid",
    "UsageError",
    "convert",
    "open",
]
