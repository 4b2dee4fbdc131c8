"""What weir raises: one line that says what, where, the value found and what to do."""

from __future__ import annotations

import errno


class Error(Exception):
    """Base of all of them; raised itself for a fault of weir."""

    def __str__(self) -> str:
        # An OSError would put "[Errno 2]" before the message, and behind it the name that is in it.
        if isinstance(self, OSError) and self.strerror is not None:
            return str(self.strerror)
        return super().__str__()


class UsageError(Error, ValueError):
    """An argument is wrong, or two contradict each other."""


class InputError(Error):
    """A file or array is missing, unreadable or not what it says."""


class BudgetError(Error):
    """The size that was asked for cannot be met; the message names the least one that can."""


class IoError(Error, OSError):
    """The disk is full, a permission is missing, a device fails."""


class InputSystemError(InputError, OSError):
    """An InputError of a call of the system that failed, with errno and filename."""


class InputNotFoundError(InputSystemError, FileNotFoundError):
    """An input that is missing."""


class InputPermissionError(InputSystemError, PermissionError):
    """An input that may not be read."""


class IoNotFoundError(IoError, FileNotFoundError):
    """A directory that is missing."""


class IoPermissionError(IoError, PermissionError):
    """A file or directory that this user may not read or write."""


_CLASS_OF_NUMBER = {errno.ENOENT: 0, errno.EACCES: 1, errno.EPERM: 1}
_CLASSES: dict[str, tuple[type[Error], type[Error], type[Error]]] = {
    "InputError": (InputNotFoundError, InputPermissionError, InputSystemError),
    "IoError": (IoNotFoundError, IoPermissionError, IoError),
}


def system_error(kind: str, number: int, message: str, filename: str) -> Error:
    """The error of class `kind` where a call of the system failed with errno `number` on `filename`: an OSError too,
    where `kind` is InputError or IoError."""
    if kind not in _CLASSES:
        classes: dict[str, type[Error]] = {"UsageError": UsageError, "BudgetError": BudgetError}
        return classes.get(kind, Error)(message)
    return _CLASSES[kind][_CLASS_OF_NUMBER.get(number, 2)](number, message, filename)
