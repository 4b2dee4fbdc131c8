"""Reads ranges of a file through any of fsspec's file systems."""

from __future__ import annotations

from typing import Any, Optional, Sequence

from .errors import Error, InputError, InputNotFoundError, InputPermissionError, IoError, UsageError
from .options import shown_url, shown_urls
from .remote_file import (
    LONGEST_SIDECAR,
    MISSING_FILE_STATUSES,
    Range,
    RemoteFile,
    changed_while_read,
    sidecar_text,
    sidecar_url,
)

#: Keys of a file system's info() that identify a version of a file: its size, tag and times.
_OF_VERSION = ("size", "ETag", "etag", "generation", "mtime", "created", "modified", "LastModified", "last_modified")


class FsspecFile(RemoteFile):
    """A file that is read through one of fsspec's file systems."""

    def __init__(self, url: str, options: dict[str, Any]) -> None:
        super().__init__()
        self._url = url
        self._shown = shown_url(url)
        try:
            import fsspec.core
        except ImportError:
            raise UsageError(f"{self._shown}: reading it wants fsspec; install python3-fsspec") from None
        self._options = options
        try:
            self._connect()
        except (ImportError, TypeError, ValueError) as error:
            raise UsageError(f"{self._shown}: cannot be opened: {shown_urls(str(error))}") from self._cause(error)
        self._version: Optional[dict[str, Any]] = None  # as of the first bytes that were read

    def read(self, ranges: Sequence[Range]) -> list[bytes]:
        if self._version is None:
            self._version = self._run(self._found_version, [(0, 0)])[0]
        found = super().read(ranges)
        version = self._run(self._found_version, [(0, 0)])[0]
        if self._version is not None and version is not None and version != self._version:
            raise changed_while_read(self._shown)
        return found

    def _connect(self) -> None:
        import fsspec.core

        self._system, self._path = fsspec.core.url_to_fs(self._url, **self._options)

    def _found_version(self, _: Range) -> Optional[dict[str, Any]]:
        """Returns the file's current version, see _OF_VERSION. None if the file system does not tell."""
        try:
            self._system.invalidate_cache(self._path)
            info = self._system.info(self._path)
        except Exception:  # each file system raises its own; reading the file then reports what is wrong
            return None
        # For local files "created" changes with any change, even of the file's mode, so "mtime" replaces it.
        said = [name for name in _OF_VERSION if name in info and (name != "created" or "mtime" not in info)]
        return {name: info[name] for name in said}

    def _read_piece(self, piece: Range) -> bytes:
        offset, count = piece
        try:
            data = self._system.cat_file(self._path, start=offset, end=offset + count)
        except Exception as error:  # each file system raises its own
            raise _failure(error, self._shown) from self._cause(error)
        if len(data) != count:
            raise InputError(
                f"{self._shown}: {len(data)} bytes instead of {count} at byte {offset}; "
                "is it complete, and a NanoVDB file?"
            )
        return self._count(data)

    def read_beside(self, url: str) -> Optional[str]:
        self._leave_the_forks_connections()
        try:
            data = self._system.cat_file(sidecar_url(self._path), start=0, end=LONGEST_SIDECAR + 1)
        except (FileNotFoundError, PermissionError):
            return None
        except Exception as error:  # for http an exception of aiohttp, with the status
            if getattr(error, "status", None) in MISSING_FILE_STATUSES:
                return None
            raise _failure(error, shown_url(url)) from self._cause(error)
        return sidecar_text(shown_url(url), self._count(data))

    def _cause(self, error: Exception) -> Optional[Exception]:
        """Returns `error` as the cause of weir's error. None if the URL hides parts that `error` might show."""
        return error if self._shown == self._url else None


def _failure(error: Exception, shown: str) -> Error:
    """Returns weir's error for the `error` that a file system raised for the file `shown`."""
    if isinstance(error, FileNotFoundError):
        return InputNotFoundError(2, f"{shown}: there is no such file", shown)
    said = shown_urls(str(error)) or error.__class__.__name__
    if isinstance(error, PermissionError):
        return InputPermissionError(13, f"{shown}: may not be read: {said}", shown)
    return IoError(f"{shown}: cannot be read: {said}")
