"""Translates the indices and slices of grid[...] into the voxels that they select."""

from __future__ import annotations

import operator
from typing import Any, NamedTuple

import numpy

from .options import described


class Selection(NamedTuple):
    """The selected voxels along the axes [z, y, x]: first, first + step, ..., `count` of them; the result's shape."""

    first: tuple[int, ...]
    step: tuple[int, ...]
    count: tuple[int, ...]
    shape: tuple[int, ...]  #: of the resulting array: an index removes its axis, None adds an axis of length 1

    @property
    def low(self) -> tuple[int, ...]:
        """The lowest voxel (z, y, x). Needs a `count` of at least 1 along each axis."""
        return tuple(min(a, a + (n - 1) * s) for a, s, n in zip(self.first, self.step, self.count))

    @property
    def high(self) -> tuple[int, ...]:
        """One past the highest voxel (z, y, x)."""
        return tuple(max(a, a + (n - 1) * s) + 1 for a, s, n in zip(self.first, self.step, self.count))


def select(key: Any, shape: tuple[int, int, int]) -> Selection:
    """Returns what `key` selects in an array of `shape` [z, y, x]. `key` may have integers (negative ones count from
    the end), slices, `...` and None.

    Raises IndexError for a position outside, and for the other kinds of index that numpy allows.
    """
    parts = _with_all_axes(key if isinstance(key, tuple) else (key,))
    ends: list[tuple[int, int, int]] = []
    axes: list[int] = []
    for part in parts:
        if part is None:
            axes.append(1)
            continue
        voxels = shape[len(ends)]
        if isinstance(part, slice):
            begin, end, step = part.indices(voxels)
            count = len(range(begin, end, step))
            step = step if count > 1 else 1
            axes.append(count)
        else:
            begin, step, count = _position(part, len(ends), shape), 1, 1
        ends.append((begin, step, count))
    first, step_of, count_of = zip(*ends)
    return Selection(first, step_of, count_of, tuple(axes))


def _with_all_axes(parts: tuple[Any, ...]) -> list[Any]:
    """Returns `parts` with full slices for the axes that `...` stands for or that are not given."""
    dots = [place for place, part in enumerate(parts) if part is Ellipsis]
    if len(dots) > 1:
        raise IndexError("an index can only have a single ellipsis ('...')")
    given = sum(part is not None and part is not Ellipsis for part in parts)
    if given > 3:
        raise IndexError(f"too many indices: a grid has the 3 axes [z, y, x], but {given} were given")
    place = dots[0] if dots else len(parts)
    return [*parts[:place], *[slice(None)] * (3 - given), *parts[place + 1 :]]


def _position(part: Any, axis: int, shape: tuple[int, int, int]) -> int:
    """Returns the integer `part` as a position along `axis`, counted from 0. Raises IndexError."""
    try:
        if isinstance(part, (bool, numpy.bool_)) or (isinstance(part, numpy.ndarray) and part.ndim > 0):
            raise TypeError
        place = operator.index(part)
    except TypeError:
        raise IndexError(
            "an index of a grid is a whole number, a slice, ... or None, not "
            f"{described(part)}; for others index to_numpy()"
        ) from None
    voxels = shape[axis]
    if not -voxels <= place < voxels:
        extent = " x ".join(map(str, shape))
        raise IndexError(
            f"index {place} is out of bounds for axis {axis} ({'zyx'[axis]}) with size {voxels}; "
            f"the grid has {extent} voxels [z, y, x]"
        )
    return place % voxels
