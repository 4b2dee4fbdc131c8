"""What weir raises: one line that says what, where, the value found and what to do."""


class Error(Exception):
    """Base of all of them; raised itself for a fault of weir."""


class UsageError(Error, ValueError):
    """An argument is wrong, or two contradict each other."""


class InputError(Error):
    """A file or array is missing, unreadable or not what it says."""


class BudgetError(Error):
    """The size that was asked for cannot be met; the message names the least one that can."""


class IoError(Error, OSError):
    """The disk is full, a permission is missing, a device fails."""
