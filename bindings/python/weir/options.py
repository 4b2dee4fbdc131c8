"""Converts keywords to the texts of the `weir` command's options, so that both mean the same."""

from __future__ import annotations

import operator
import os
import re
from typing import Any, Sequence

import numpy

from .errors import UsageError


#: The longest text of a region that a message shows, in characters.
LONGEST_BOX = 150


def _alone(value: Any) -> Any:
    """Returns the one value of an array without axes, of numpy, xarray or another library; anything else as it is.

    Raises UsageError for a masked array with masked values.
    """
    if isinstance(value, numpy.ma.MaskedArray) and numpy.ma.getmaskarray(value).any():
        raise UsageError("a number that is masked has no value; give one")
    no_axes = getattr(value, "ndim", None) == 0 and not isinstance(value, numpy.generic)
    return value.item() if no_axes and hasattr(value, "item") else value


def text_of(value: Any) -> str:
    """Returns a number as text that reads back exactly, a sequence joined by commas, and a path or text as it is."""
    value = _alone(value)
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, (bool, numpy.bool_)):
        return str(bool(value))  # not as 0 or 1: True is hardly meant as a number, so the option's check refuses it
    if isinstance(value, (int, numpy.integer)):
        return str(int(value))
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    if isinstance(value, (Sequence, numpy.ndarray)):
        return ",".join(text_of(part) for part in value)
    return str(value)


def path_bytes(path: Any, name: str = "path") -> bytes:
    """Returns `path`, the argument `name`, as the system takes it. Raises TypeError if it is no path, and UsageError for
    a null byte, which would silently end the name, and for a text that no file system can hold."""
    try:
        found = os.fsencode(path)
    except TypeError:
        raise TypeError(f"{name} is {described(path)}, it must be a path") from None
    except UnicodeEncodeError:
        raise UsageError(f"{name} is {path!r}, which no file system can hold; correct it") from None
    if b"\0" in found:
        raise UsageError(f"path is {found!r}, and no path has a null byte; correct it")
    return found


def input_bytes(path: Any) -> bytes:
    """Returns path_bytes(path) for a file to read. Raises UsageError if `path` is empty, too."""
    found = path_bytes(path)
    if not found:
        raise UsageError("the path is empty; name a file")
    return found


def is_url(path: Any) -> bool:
    """Returns whether weir.open treats `path` as a URL."""
    return isinstance(path, str) and "://" in path


def shown_url(url: str) -> str:
    """Returns `url` as messages show it: without user, password and query, which may be secrets."""
    return re.sub(r"(://[^?]*)\?.+", r"\1?...", re.sub(r"(?<=://)[^/?#]*@", "***@", url), flags=re.DOTALL)


def shown_urls(text: str) -> str:
    """Returns `text` with shown_url() applied to each URL in it."""
    return re.sub(r"\S+://\S+", lambda found: shown_url(found[0]), text)


def described(value: Any, longest: int = 40) -> str:
    """Describes `value` for a message: an array by type and shape, anything else by repr(), or only by its type if
    repr() is longer than `longest` or has unprintable characters."""
    if isinstance(value, numpy.ndarray):
        return f"an array of {value.dtype} with the shape {value.shape}"
    text = repr(value)
    return text if len(text) <= longest and text.isprintable() else f"a {value.__class__.__name__}"


def box_text(box: Any) -> str:
    """Returns ((x0, y0, z0), (x1, y1, z1)), x1 exclusive, as "x0:x1,y0:y1,z0:z1". Returns a text as it is. Raises
    UsageError for anything else."""
    if isinstance(box, str):
        return box
    try:
        low, high = ([text_of(end) for end in corner] for corner in box)
        return ",".join(f"{a}:{b}" for a, b in zip(low, high, strict=True))
    except (TypeError, ValueError):
        raise UsageError(
            f"roi is {described(box, LONGEST_BOX)}, it must be ((x0, y0, z0), (x1, y1, z1)), x0 inclusive, x1 exclusive"
        ) from None


def size_text(size: Any) -> str:
    """Returns (width, height) as "960x720", and a text as it is. Raises UsageError for anything else."""
    if isinstance(size, (str, bytes)):
        return text_of(size)
    try:
        if not isinstance(size, (Sequence, numpy.ndarray)):
            raise TypeError
        width, height = (_alone(side) for side in size)
        if any(isinstance(side, (bool, numpy.bool_)) for side in (width, height)):
            raise TypeError
        return f"{operator.index(width)}x{operator.index(height)}"
    except UsageError:  # for a masked number; a UsageError is a ValueError, too
        raise
    except (TypeError, ValueError):
        raise UsageError(
            f"size is {described(size)}, it must be (width, height), two whole numbers of pixels, or a text, '960x720'"
        ) from None


def checked_progress(progress: Any) -> Any:
    """Returns `progress`. Raises TypeError if it is neither a function nor None."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress is {described(progress)}, it must be a function, progress(pass, done, total)")
    return progress


_FLAGS = {"at_most", "colorbar", "lossless", "stack", "overwrite"}


def given_options(**keywords: Any) -> dict[str, bytes]:
    """Returns the keywords as options: {"max-error": b"0.5", "lossless": b"true"}. Leaves out None and False flags.

    Values are bytes, because a path may hold any bytes. Raises UsageError for a null character and for a text that
    UTF-8 cannot express.
    """
    given = {}
    for name, value in keywords.items():
        value = _alone(value)
        if name in _FLAGS and isinstance(value, (bool, int, numpy.bool_)):
            value = "true" if value else None
        if value is not None:
            text = text_of(value)
            if "\0" in text:
                raise UsageError(f"{name} has a null character, which ends a text; leave it out")
            try:
                given[name.replace("_", "-")] = os.fsencode(text)
            except UnicodeEncodeError:
                raise UsageError(f"{name} is {text!r}, which no file system and no file can hold; correct it") from None
    return given
