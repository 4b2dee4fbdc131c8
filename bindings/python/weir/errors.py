"""The exceptions that weir raises. A message is one line: what is wrong, where, the value found and what to do."""

from __future__ import annotations

import errno


class Error(Exception):
    """The base class of weir's exceptions. Raised itself if weir has a bug."""

    def __str__(self) -> str:
        # OSError's own text puts "[Errno 2]" before the message and repeats the file name after it.
        if isinstance(self, OSError) and self.strerror is not None:
            return str(self.strerror)
        return super().__str__()


class UsageError(Error, ValueError):
    """An argument is wrong, or two contradict each other."""


class InputError(Error):
    """A file or array is missing, unreadable or invalid."""


class BudgetError(Error):
    """The requested size cannot be met. The message names the smallest size that can."""


class IoError(Error, OSError):
    """The disk is full, a permission is missing, a device fails."""


class InputSystemError(InputError, OSError):
    """An InputError because a system call failed. Has errno and filename."""


class InputNotFoundError(InputSystemError, FileNotFoundError):
    """An input is missing."""


class InputPermissionError(InputSystemError, PermissionError):
    """This user may not read an input."""


class IoNotFoundError(IoError, FileNotFoundError):
    """A directory is missing."""


class IoPermissionError(IoError, PermissionError):
    """This user may not read or write a file or directory."""


_CLASS_OF_NUMBER = {errno.ENOENT: 0, errno.EACCES: 1, errno.EPERM: 1}
_CLASSES: dict[str, tuple[type[Error], type[Error], type[Error]]] = {
    "InputError": (InputNotFoundError, InputPermissionError, InputSystemError),
    "IoError": (IoNotFoundError, IoPermissionError, IoError),
}


def system_error(kind: str, number: int, message: str, filename: str) -> Error:
    """Returns the error of class `kind` for a system call that failed with errno `number` on `filename`. The error is
    also an OSError if `kind` is InputError or IoError."""
    if kind not in _CLASSES:
        classes: dict[str, type[Error]] = {"UsageError": UsageError, "BudgetError": BudgetError}
        return classes.get(kind, Error)(message)
    return _CLASSES[kind][_CLASS_OF_NUMBER.get(number, 2)](number, message, filename)
